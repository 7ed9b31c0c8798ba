"""`mode plot` as the plotters of the Arduino IDE see it: a plotter written from the rules of IDE 2 (protocol page and behaviour of
arduino-serial-plotter-webapp) reads what the firmware sends in the simulator, with faults injected and commands typed in between.

The rules: the first line after opening may be torn and is not looked at; lines end with LF or CRLF; a line with a colon behind its first
character is label:value parts, any other one values with the names `value 1`, `value 2` and so on; parts are separated by commas, spaces and
tabs; what begins as no number is NaN; eight series at most, the first names have the places, and a name without a point among the last 50
lines gives its place back.
"""
import math
import pathlib
import random
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import system_support
from system_support import OUT, SIMRUN, STREAMS, run_all, test
from laws import PLAIN  # noqa: E402

SERIES = ["roll_raw", "roll", "pitch_raw", "pitch", "gated"]
ROW = re.compile("^" + ",".join(rf"{name}:-?\d{{1,3}}\.\d\d" for name in SERIES[:-1]) + ",gated:[01]$")
NUMBER = re.compile(r"[+-]?(Infinity|(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)")


def number(text):
    """As much of the text as is a number, else NaN."""
    found = NUMBER.match(text.strip())
    return float(found[0]) if found else math.nan


def parts(line):
    """[(name, number)] of a line."""
    words = re.split("[, \t]+", line)
    if ":" not in line[1:]:
        return [(f"value {place}", number(word)) for place, word in enumerate(words, 1) if word]
    pairs = [word.split(":") for word in words]
    return [(pair[0].strip(), number(pair[1])) for pair in pairs if len(pair) > 1 and pair[0].strip() and pair[1].strip()]


class Plotter:
    PLACES, POINTS = 8, 50

    def __init__(self):
        self.rest, self.lines = None, 0
        self.series = {}  # name: [(line, number)]

    def receive(self, text):
        """What has come since the last time."""
        if self.rest is None:
            _, end, text = text.partition("\n")
            if not end:
                return
            self.rest = ""
        *whole, self.rest = (self.rest + text).split("\n")
        lines = [parts(line.removesuffix("\r")) for line in whole if line.removesuffix("\r")]
        for name, _ in (part for line in lines for part in line):
            if len(self.series) < self.PLACES:
                self.series.setdefault(name, [])
        for line in lines:
            self.lines += 1
            for name, value in line:
                if name in self.series:
                    self.series[name].append((self.lines, value))
        self.series = {name: kept for name, points in self.series.items()
                       if (kept := [point for point in points if point[0] > self.lines - self.POINTS])}

    def names(self):
        return list(self.series)


def shown(text, *sizes):
    """The plotter behind a text that came in pieces of these sizes, again and again; none: line by line."""
    plotter, at, turn = Plotter(), 0, 0
    pieces = text.splitlines(keepends=True) if not sizes else []
    while sizes and at < len(text):
        pieces.append(text[at:at + sizes[turn % len(sizes)]])
        at, turn = at + len(pieces[-1]), turn + 1
    for piece in pieces:
        plotter.receive(piece)
    return plotter


def findings(lines):
    """What a plotter cannot show of these lines, each as a sentence."""
    said = []
    for place, line in enumerate(lines, 1):
        named = parts(line)
        if not ROW.match(line):
            said.append(f"line {place}: '{line}' is no row of a plot")
        elif [name for name, _ in named] != SERIES:
            said.append(f"line {place}: series {[name for name, _ in named]}")
        said += [f"line {place}: {name} is {value}, outside +-180 degrees" for name, value in named
                 if name != "gated" and not -180 <= value <= 180]
    return said


def sent(name, *options, stream="outliers-15pct"):
    """The bytes of a run."""
    out = OUT / f"plot-{name}.txt"
    system_support.run(SIMRUN, "--fw", system_support.FW, "--in", STREAMS / f"{stream}.csv", "--loop", "--out", out, *options)
    said = out.read_bytes().decode("ascii")
    return said[:said.rindex("\n") + 1]  # the end of the run cuts a line


def words(option, values):
    return [word for value in values for word in (option, value)]


def behind(text, reply):
    """What was sent behind the first line that is this reply."""
    return text[text.index(f"{reply}\n") + len(reply) + 1:]


@test
def the_rules_of_the_plotter():
    nan = math.nan
    for line, expected in (("a:1,b:-2.5", [("a", 1), ("b", -2.5)]), ("1, 2\t3", [("value 1", 1), ("value 2", 2), ("value 3", 3)]),
                           ("t_us,x_lsb", [("value 1", nan), ("value 2", nan)]), ("# fault 1: no sensor", []), ("E:bus", [("E", nan)]),
                           ("h:0x1F", [("h", 0)]), ("a b:1", [("b", 1)]), ("a:1:2", [("a", 1)]), (":5", [("value 1", nan)]), ("a:1e2x", [("a", 100)]),
                           ("# every 10", [("value 1", nan), ("value 2", nan), ("value 3", 10)])):
        assert repr(parts(line)) == repr([(name, float(value)) for name, value in expected]), (line, parts(line))
    assert shown("torn:1\na:1\r\n\na:2\nb:").series == {"a": [(1, 1.0), (2, 2.0)]}
    nine = " ".join(f"s{n}:1" for n in range(9))
    assert shown("\n" + f"{nine}\n").names() == [f"s{n}" for n in range(8)]
    # 49 lines without a name leave its last point; with the 50th its place is free, and the next name takes it
    assert shown("\n" + f"{nine}\n" + "s1:0\n" * 49).names() == [f"s{n}" for n in range(8)]
    assert shown("\n" + f"{nine}\n" + "s1:0\n" * 50 + "s8:0\n").names() == ["s1", "s8"]


@test
def what_a_plot_may_not_have_is_found():
    row = "roll_raw:1.23,roll:-1.20,pitch_raw:-0.42,pitch:179.99,gated:0"
    assert findings([row, row.replace("gated:0", "gated:1")]) == []
    for broken in ("# fault 1: no sensor answers", "1234,5", row.replace("roll:", "roll :"), row.replace(",gated:0", ""), row + ",x:1",
                   row.replace("gated:0", "gated:2"), row.replace("179.99", "180.01"), row[:-1], row.replace(",", ";"), ""):
        assert findings([row, broken]), broken


# one of each kind that is told by lines in csv, none overlapping the next; the rest strikes single transfers
LASTING = ["1500ms:unplug:300", "2500ms:power:50", "3500ms:sda:200", "4500ms:scl:200", "5500ms:noint:400", "6500ms:inthigh:400",
           "7500ms:frozen:400", "8500ms:devid:0:300", "9500ms:double:z", "9600ms:storm:2000:200", "10000ms:hang", "10200ms:starve:100"]
SINGLE = ["p:3e-3:nack", "p:3e-3:arb", "p:3e-3:buserr", "p:3e-3:torn"]


@test
def nothing_stands_between_the_rows_whatever_fails():
    text = sent("faults", "--cmd", "500:mode plot", *words("--fault", LASTING + SINGLE), "--max-ms", "11000", "--cmd", "10700:mode csv")
    plot, told = behind(text, "# mode plot").split("# mode csv\n")
    lines = plot.splitlines()
    assert findings(lines) == [], findings(lines)[:5]
    assert shown(plot, 7, 64, 1).names() == SERIES
    # rows go on through the faults by prediction: 100 a second but where a fault is longer than a second
    assert len(lines) >= 0.9 * 1020, len(lines)
    # in csv they are told: what the plot kept back was there
    csv = sent("faults-csv", *words("--fault", LASTING + SINGLE), "--max-ms", "11000")
    assert len(re.findall("^# fault .*over", csv, re.M)) >= 6, csv
    assert all(line.startswith(("#", "t_us")) or line[0].isdigit() for line in told.splitlines()), told


TYPED = ["status", "every 5", "every", "nonsense", "rate 200", "range 4", "help", f"filter {PLAIN}",
         "every 1", "baud", "mode", "stop", "go", "mode soon",
         "rate 100", "status"]


def replies(mode, faults):
    """(rows, replies with # for each number) of a run in which all of TYPED is typed, each 300 ms behind the one before."""
    typed = [f"{1000 + 300 * n}:{text}" for n, text in enumerate(TYPED)]
    end_ms = 1000 + 300 * len(TYPED) + 500
    text = sent(f"typed-{mode}", "--cmd", f"500:mode {mode}", *words("--cmd", typed), *words("--fault", faults), "--max-ms", end_ms)
    lines = behind(text, f"# mode {mode}").splitlines()
    said = [re.sub(r"\d+(\.\d+)?", "#", line).replace("plot", "csv") for line in lines if line.startswith("#")]
    return [line for line in lines if not line.startswith("#")], said


@test
def what_is_typed_is_answered_and_nothing_else_is_said():
    rows, said = replies("plot", ["2000ms:power:30", "3500ms:sda:60", *SINGLE])
    _, expected = replies("csv", [])
    assert findings(rows) == [], findings(rows)[:5]
    assert said == expected and len(said) >= len(TYPED), [pair for pair in zip(said, expected) if pair[0] != pair[1]]


@test
def a_plotter_that_was_open_from_the_reset_on_shows_the_plot_after_50_rows():
    text = sent("opened", "--cmd", "900:mode plot", "--max-ms", "2500")
    begin, plot = text.split("# mode plot\n")
    rows = plot.splitlines(keepends=True)
    assert all(name.startswith("value ") for name in shown(begin).names())
    assert shown(begin + "# mode plot\n" + "".join(rows[:51])).names() == SERIES


@test
def a_plotter_may_be_opened_at_any_byte_and_get_pieces_of_any_size():
    plot = behind(sent("pieces", "--cmd", "500:mode plot", "--max-ms", "1500"), "# mode plot")
    end_of_third = len("".join(plot.splitlines(keepends=True)[:3]))
    assert all(shown(plot[at:]).names() == SERIES for at in range(end_of_third))
    source = random.Random(20261122)
    whole = shown(plot).series
    for _ in range(20):
        # as from a port: no line is left in pieces at the end, and what came at once is told at once
        assert shown(plot, *(source.randint(1, 200) for _ in range(50))).series == whole


# a small window of the plotter; there the gate's step of one degree takes two pixels where all series together span 150 degrees
PIXELS_HIGH, STEP_PIXELS = 300, 2


@test
def a_plot_is_legible_without_scaling():
    """All series are degrees on one axis: at rest and in motion the least of them is still seen. Raw outliers of 180 degrees hide it themselves."""
    for stream in ("rest-2lsb", "tilt-slow", "tilt-fast", "steps"):
        text = sent("legible", "--cmd", "500:mode plot", "--max-ms", "6000", stream=stream)
        *lines, _ = behind(text, "# mode plot").split("\n")
        assert findings(lines) == [], findings(lines)[:5]
        values = [value for line in lines for _, value in parts(line)]
        pixels = PIXELS_HIGH / (max(values) - min(values))
        print(f"    {stream}: {min(values):.2f} to {max(values):.2f} degrees, the gate's step {pixels:.1f} pixels of {PIXELS_HIGH}")
        assert pixels >= STEP_PIXELS, (stream, pixels)


if __name__ == "__main__":
    print("seed 20261122")
    raise SystemExit(run_all())
