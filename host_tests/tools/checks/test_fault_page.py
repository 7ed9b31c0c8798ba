"""docs/faults.md lists exactly the fault codes of driver and firmware and the words that the firmware has for them, and each counter of `status`."""
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import run_all, test

PAGE = pathlib.Path("docs/faults.md")
TEXTS = pathlib.Path("firmware/console/reply_texts.h")
INCLUDES = ["-Ifirmware", "-Ilib/machine/src", "-Ihal", "-Ihal/host"]


def texts():
    """name -> lines of the replies and of firmware/console/reply_texts.h, a byte of enum say as .. ."""
    source = ('#include "console/reply_texts.h"\n#define SHOWN(name, words) @name words\n#define COMMAND(name, typed, words) @name words\n'
              'REPLY_TEXTS(SHOWN, COMMAND)\n')
    done = subprocess.run(["gcc", "-E", "-P", *INCLUDES, "-xc", "-"], input=source, capture_output=True, text=True, check=True)
    raw = {}
    for entry in done.stdout.split("@")[1:]:
        name, rest = re.match(r"(\w+)(.*)", entry, re.S).groups()
        words = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', rest))
        raw[name] = re.sub(r"\\x([0-9A-Fa-f]{2})", lambda code: chr(int(code[1], 16)), words)
    header = TEXTS.read_text(encoding="utf-8")
    line, check_bus = (chr(int(re.search(rf'V_{name} "\\x(\w\w)"', header)[1], 16)) for name in ("LINE", "CHECK_BUS"))
    raw = {name: words.replace(check_bus, raw["CHECK_BUS"]).split(line) for name, words in raw.items()}
    return {name: "\n".join(re.sub("[\x01-\x1f\x7b-\x8f]", "..", words) for words in lines) for name, lines in raw.items()}


def codes():
    """name -> number of the driver's enumeration, without NONE, and the firmware's own after them."""
    text = pathlib.Path("lib/adxl345/src/adxl345.h").read_text(encoding="utf-8")
    found = {name: int(number) for name, number in re.findall(r"ADXL345_FAULT_(\w+) = (\d+)", text)}
    assert found.pop("NONE") == 0
    watch = pathlib.Path("firmware/control/sensor_watch.h").read_text(encoding="utf-8")
    first, last, others = re.search(r"FAULT_(\w+) = ADXL345_FAULT_(\w+) \+ 1((?:, FAULT_\w+)*)", watch).groups()
    names = [first, *re.findall(r"FAULT_(\w+)", others)]
    return found | {name: found[last] + 1 + i for i, name in enumerate(names)}


def rows():
    """(code, words, flashes) of the page's table."""
    found = re.findall(r"^\| (\d+) \| (.+?) \| (\d) \| .+ \| .+ \|$", PAGE.read_text(encoding="utf-8"), re.M)
    assert found, f"no table in {PAGE}"
    return [(int(code), words, int(times)) for code, words, times in found]


@test
def every_code_and_no_other_is_on_the_page():
    assert [row[0] for row in rows()] == sorted(codes().values()), f"{rows()} and {codes()}"


@test
def words_are_those_of_the_firmware():
    said = texts()
    first = list(said).index("NO_SENSOR")
    for code, words, _ in rows():
        firmware = list(said.values())[first + code - 1]
        assert words == firmware, f"fault {code}: the page has {words!r}, the firmware {firmware!r}"


@test
def flashes_are_those_of_the_led():
    source = pathlib.Path("firmware/control/sensor_watch.c").read_text(encoding="utf-8")
    table = {name: int(times) for name, times in re.findall(r"\[(?:ADXL345_)?FAULT_(\w+)\] = (\d)", source)}
    assert {number: table[name] for name, number in codes().items()} == {code: times for code, _, times in rows()}


@test
def every_counter_and_cause_is_on_the_page():
    page = PAGE.read_text(encoding="utf-8")
    said = texts()
    section = page.partition("## Counters\n")[2].partition("\n## ")[0]
    told = {name for cell in re.findall(r"^\| [a-z]* ?\| ([^|]+) \|", section, re.M) for name in cell.split(", ")}
    for line in said["STATUS"].split("\n")[1:-1]:
        for name in re.findall(r"([a-z][a-z ]*) \.\.", line):
            assert name in told, f"{PAGE}: no counter {name!r} in the table"
    for cause in ("POWER_ON", "EXTERNAL", "BROWN_OUT"):
        assert f"| {said[cause]} |" in page, f"{PAGE}: no cause {said[cause]!r}"


if __name__ == "__main__":
    raise SystemExit(run_all())
