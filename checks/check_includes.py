#!/usr/bin/env python3
"""Who may include whom: the table of the design, enforced. Prints every breach as file:line and exits 1 on any."""
import pathlib
import re

import comments
from check_support import FOLDERS, Stop, files, main, report

STANDARD = {"stdint.h", "stdbool.h", "stddef.h"}
MACHINES = {"machine.h"}
LIBC = STANDARD | {"assert.h", "ctype.h", "errno.h", "float.h", "inttypes.h", "limits.h", "math.h", "setjmp.h", "stdarg.h", "stdio.h",
                   "stdlib.h", "string.h", "time.h"}
AVR_LIBC = re.compile(r"^(avr|util|compat)/|^setbaud\.h$")
SIMAVR = re.compile(r"^(sim_\w+\.h|avr_\w+\.h|uart_pty\.h|libelf\.h|gelf\.h|getopt\.h|unistd\.h|sys/\w+\.h|fcntl\.h|pthread\.h|signal\.h|"
                    r"poll\.h|termios\.h|pty\.h)$")
INCLUDE = re.compile(r"^\s*#\s*(?:include|include_next|import)\b\s*(.*?)\s*$")
NAMED = re.compile(r'^([<"])([^>"]+)[>"]')


def headers(*folders):
    return {p.name for folder in folders for p in pathlib.Path(folder).glob("*.h")}


HAL = headers("hal")
FILTERS, TILT, ADXL = headers("lib/filters/src"), headers("lib/tilt/src"), headers("lib/adxl345/src")
# what of lib/filters is for its laws, tests and proof alone
INSIDE = {"tracker.h", "kalman.h", "wide.h", "mixture.h", "fx_avr.h"} | {path.name for path in pathlib.Path("lib/filters/src").glob("*_table.h")}
NAV, NAV_IMAGE = headers("nav/lib"), headers("nav/image")
SIM = headers("sim/model", "sim/run", "sim/faults", "sim/judge")
MODEL = {"adxl345_model.h", "adxl345_variants.h", "feed.h", "stream.h"}
# the rooms of the firmware, and which others each may use: nothing points up. A header is included with its room.
ROOMS = {
    "base": (),
    "settings": ("base",),
    "path": ("base",),
    "output": ("path", "base"),
    "control": ("path", "settings", "base"),
    "console": ("control", "output", "path", "settings", "base"),
    "app": ("console", "control", "output", "path", "settings", "base"),
}
BELOW = STANDARD | MACHINES | FILTERS | TILT | ADXL | HAL  # what lies under the firmware


def room_headers(room):
    return {f"{name}/{path.name}" for name in (room, *ROOMS[room]) for path in pathlib.Path("firmware", name).glob("*.h")}


# folder -> (names allowed, pattern of further names allowed); a folder below goes with the longest name
RULES = {
    "lib/machine/src": ({"stdint.h"}, None),
    "lib/filters/src": (STANDARD | MACHINES | FILTERS, None),
    "lib/filters/examples": (STANDARD | FILTERS | TILT | {"Arduino.h", "Wire.h", "SPI.h"}, None),
    "lib/tilt/src": (STANDARD | MACHINES | TILT | FILTERS - INSIDE, None),
    "lib/adxl345/src": (STANDARD | MACHINES | ADXL | HAL, None),
    "nav/lib": (STANDARD | NAV | {"math.h"}, None),
    "hal": (STANDARD | MACHINES, None),
    "hal/avr": (STANDARD | MACHINES | HAL | headers("hal/avr"), AVR_LIBC),
    "hal/host": (LIBC | MACHINES | HAL | MODEL | headers("hal/host"), None),
    **{f"firmware/{room}": (BELOW | room_headers(room), None) for room in ROOMS},
    "nav/image": (STANDARD | MACHINES | NAV_IMAGE | NAV | HAL, None),
    "sim/model": (LIBC | headers("sim/model") | {"adxl345_registers.h"}, SIMAVR),
    "wokwi": (LIBC | MODEL | {"wokwi-api.h"}, None),
    "sim": (LIBC | SIM | {"adxl345_registers.h"}, SIMAVR),
}
# everything but hal/avr: here what must not be included; AVR headers where the code is for the chip
TESTS, TESTS_NEVER = ("host_tests", "nav/tests"), re.compile(r"hal/avr/")
# programs for the chip: they may know it, but stand on the contracts as the firmware does
CHIP_TESTS, CHIP_TESTS_NEVER = ("host_tests/chip", "nav/tests/chip"), re.compile(r"hal/(avr|host)/")
# the two that may know the machine inside the pure libraries: its words, and arithmetic in its assembler; AVR headers under a guard
WORDS = pathlib.Path("lib/machine/src/machine.h")
KNOW_MACHINE = {WORDS, pathlib.Path("lib/filters/src/fx.h")}
PURE = ("lib", "firmware", "nav/lib", "nav/image")
# names that tell one machine from another, wherever they stand in the code
MACHINE = re.compile(r"\b(__AVR\w*|AVR|ARDUINO\w*|__GNUC_AVR\w*|__INT_MAX__|__INT_WIDTH__|__SIZEOF_\w+|__WORDSIZE)\b")


def home(path, folders):
    """The longest of the folders that holds the file."""
    return max((f for f in folders if f in map(str, path.parents)), key=len, default=None)


def code(path):
    """(line number, line) of a file, comments taken out."""
    text = comments.without(path.read_text(encoding="utf-8"), path.suffix)
    yield from enumerate(text.replace("\\\n", " \n").splitlines(), 1)


def includes(path):
    """(line number, what stands behind #include) of a file."""
    for number, line in code(path):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1)


def guarded(path):
    """Numbers of the lines that only a compiler for AVR sees."""
    inside, stack = set(), []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if re.match(r"\s*#\s*if", line):
            stack.append(bool(re.match(r"\s*#\s*if(def)?\s+(defined\s*\(?\s*)?(__AVR__|AVR)\b", line)))
        elif re.match(r"\s*#\s*(else|elif)", line) and stack:
            stack[-1] = False
        elif re.match(r"\s*#\s*endif", line) and stack:
            stack.pop()
        elif any(stack):
            inside.add(number)
    return inside


def for_the_chip(path, number):
    return path.stem.endswith("_chip") or number in guarded(path)


def refused(path, number, name):
    """Why this file may not include that name there; None when it may."""
    folder = home(path, [*RULES, *TESTS, *CHIP_TESTS])
    if folder is None:
        raise Stop(f"{path}: the table has no row for its folder (RULES in checks/check_includes.py)")
    if folder in RULES:
        names, pattern = RULES[folder]
        allowed = name in names or (pattern and pattern.match(name)) or (folder == "hal" and name == port_of(path))
        if path == WORDS and name == "avr/pgmspace.h":
            return None if number in guarded(path) else f"{name} outside #ifdef __AVR__"
        return None if allowed else f"{folder} may not include {name}"
    never = TESTS_NEVER if folder in TESTS else CHIP_TESTS_NEVER
    if folder in TESTS and AVR_LIBC.match(name) and not for_the_chip(path, number):
        return f"{folder} may include {name} only in code for the chip"
    return f"{folder} may not include {name}" if never.search(name) else None


def breaches():
    for path in files(".c", ".h", ".cpp", ".hpp", ".ino", folders=[*FOLDERS, "wokwi"]):
        for number, text in includes(path):
            found = NAMED.match(text)
            reason = refused(path, number, found.group(2)) if found else f"cannot see what is included by {text}"
            if reason:
                yield f"{path}:{number}: {reason}"


def port_of(contract):
    """The header in which each port has what a contract cannot declare: inline bodies, macros."""
    return f"{contract.stem}_port.h"


def contracts_end_with_port():
    """Where a port has such a header: behind the declarations, so that the compiler compares the bodies with them."""
    for path in sorted(pathlib.Path("hal").glob("*.h")):
        names = [NAMED.match(text).group(2) for _, text in includes(path) if NAMED.match(text)]
        ports = [folder for folder in ("hal/avr", "hal/host") if pathlib.Path(folder, port_of(path)).exists()]
        if ports and names[-1:] != [port_of(path)]:
            yield f"{path}:1: the last include of this contract is {port_of(path)}"
        if len(ports) == 1:
            yield f"{path}:1: {port_of(path)} is in {ports[0]} alone"


def machine_guards():
    """Only two headers ask for the machine."""
    for path in files(".c", ".h", folders=PURE):
        if path not in KNOW_MACHINE:
            for number, line in code(path):
                asked = MACHINE.search(re.sub(r'"[^"]*"', "", line))
                if asked:
                    yield f"{path}:{number}: only {WORDS} may ask for the machine, by {asked.group()}"


def check():
    found = list(breaches()) + list(contracts_end_with_port()) + list(machine_guards())
    return report("include table", found, f"{len(files('.c', '.h', '.cpp', '.hpp', '.ino'))} files, no breach")


if __name__ == "__main__":
    main(check)
