"""What the whole-firmware tests share: runs of simrun, readers of what came out, the list of tests and their runner."""
import csv
import importlib.util
import itertools
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import traceback

sys.dont_write_bytecode = True
import images  # noqa: E402
from images import FW, SET_IMAGES  # noqa: E402
from unity_report import failure, reason_of  # noqa: E402

SHARE = re.compile(r"(\d+)of(\d+)")  # a word of the command line: 2of6 is every sixth test, from the second on
SHARES = [word for word in sys.argv[1:] if SHARE.fullmatch(word)]
# programs that run at the same time do not write the same files
OUT = pathlib.Path("build/system", "-".join([pathlib.Path(sys.argv[0]).stem, *SHARES]))
SIMRUN = "build/sim/simrun"
STREAMS = pathlib.Path("sim/streams")
# images whose clock does not start at 0
CLOCK_STARTS = dict(re.findall(r"IMAGE,(\w+),.*HAL_TIME_START_US=(\d+)ul", pathlib.Path("mk/images.mk").read_text(encoding="utf-8")))
TESTS = []
# a folder for the profile of each run of the firmware as shipped (make coverage); several programs may fill it
PROFILES = os.environ.get("PROFILES")
RUN_NUMBERS = itertools.count()


# cycle and size bounds are for this compiler; elsewhere they are reported
BOUNDS = subprocess.run(["avr-gcc", "-dumpversion"], capture_output=True, text=True).stdout.strip() == "5.4.0"


def within(what, value, limit):
    print(f"    {what}: {value} (limit {limit})")
    assert value <= limit or not BOUNDS, f"{what}: {value} above {limit}"


def image_with(filter_name):
    """As images.image_with, over the images of this module."""
    return images.image_with(filter_name, SET_IMAGES)


class Skip(Exception):
    """A test that cannot run here, with the reason."""


def needs(group, *packages):
    """Where a package is not installed, all tests of the program are one that says so; tools/deps.sh has them by group."""
    missing = [package for package in packages if importlib.util.find_spec(package) is None]
    if missing:
        @test
        def everything():
            raise Skip(f"{' and '.join(missing)}: not installed for {sys.executable}: sh tools/deps.sh {group}")

        sys.exit(run_all())


def test(function):
    TESTS.append(function)
    return function


def refused(kind, function, *words):
    """A call that must raise this kind of exception, with these words in its text; returns that."""
    try:
        function()
    except kind as fault:
        assert all(word in str(fault) for word in words), fault
        return str(fault)
    raise AssertionError(f"not refused; wanted: {words}")


def run(*command, expect=0):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600)
    if expect is not None:
        assert done.returncode == expect, f"{command[0]} gave status {done.returncode}: {done.stderr.strip()}"
    return done


def image_for(options, fw=FW):
    """The image, or where it does not hold the filter that these options ask for, the one that does."""
    words = [str(word) for word in options]
    if fw != FW or "--filter" not in words:
        return fw
    return image_with(words[words.index("--filter") + 1])


def lasts_a_minute(options):
    """A long run reaches no line that the short ones leave."""
    return "--max-ms" in options and float(options[options.index("--max-ms") + 1]) >= 60_000


def simrun(name, stream, *options, fw=FW, expect=0, judge=True):
    """A run, of which simrun finds every row right unless judge=False; returns (rows, notes, served, stats)."""
    base = OUT / name
    fw = image_for(options, fw)
    options += ("--clock-start", CLOCK_STARTS.get(pathlib.Path(fw).parent.name, "0"), *(["--judge"] if judge else []))
    if PROFILES and fw == FW and "--profile" not in options and not lasts_a_minute(options):
        options += ("--profile", pathlib.Path(PROFILES) / f"{OUT.name}-{next(RUN_NUMBERS):04}.csv")
    done = run(SIMRUN, "--fw", fw, "--in", stream, "--out", f"{base}.csv", "--served", f"{base}.served.csv", "--stats", f"{base}.json",
               *options, expect=expect)
    rows, notes = read_output(f"{base}.csv")
    served = list(csv.DictReader(open(f"{base}.served.csv")))
    stats = json.load(open(f"{base}.json"))
    stats["stderr"] = done.stderr
    return rows, notes, served, stats


def read_output(path):
    rows, notes = [], []
    for line in open(path, encoding="ascii"):
        line = line.rstrip("\n")
        if re.fullmatch(r"\d+(,-?\d+){8},\d+", line):
            rows.append([int(f) for f in line.split(",")])
        else:
            notes.append(line)
    return rows, notes


def triplets(served):
    return [[int(s["x_lsb"]), int(s["y_lsb"]), int(s["z_lsb"])] for s in served]


def start_offset_us(served, rows):
    """How much later than the MCU the firmware's clock started: from the sample served nearest to the first row's stamp."""
    offset = min((int(s["t_us"]) - rows[0][0] for s in served), key=lambda d: abs(d - 300))
    assert 0 <= offset <= 2000, f"clock starts {offset} us after the MCU"
    return offset


def assert_nothing_lost(rows, served, every=1, from_us=0, end_us=None):
    """Every served sample in the period (or one in `every`) has its row, with its readings, in order, stamped within 50 us."""
    rows = [r for r in rows if r[0] >= from_us]
    # the firmware's clock starts some hundred microseconds after the MCU
    late_us = start_offset_us(served, rows)
    samples = [(int(s["t_us"]) - late_us, t) for s, t in zip(served, triplets(served))]
    first = next(i for i, (t, _) in enumerate(samples) if abs(t - rows[0][0]) <= 50)
    expected = samples[first::every]
    if end_us is not None:
        expected = [e for e in expected if e[0] <= end_us]
    assert len(rows) >= len(expected) - 1, f"{len(expected)} samples, {len(rows)} rows"
    for row, (t_us, lsb) in zip(rows, expected):
        assert abs(row[0] - t_us) <= 50, f"row at {row[0]} us, sample at {t_us} us"
        assert row[1:4] == lsb, f"row {row} shows {row[1:4]}, the sensor latched {lsb}"


def processor_s():
    """Of this process and of those that it has run."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in used)


def chosen(tests, words):
    """All tests, or those whose name contains one of the words, without those that contain a word after a minus; of these the share asked for."""
    shares = [SHARE.fullmatch(word) for word in words]
    wrong = [share[0] for share in shares if share and not 1 <= int(share[1]) <= int(share[2])]
    if wrong:
        sys.exit(f"{wrong[0]} is no share: the first of three is 1of3, the last 3of3")
    only = [word for word, share in zip(words, shares) if not share and not word.startswith("-")]
    without = [word[1:] for word in words if word.startswith("-")]
    found = [each for each in tests if not only or any(word in each.__name__ for word in only)]
    found = [each for each in found if not any(word in each.__name__ for word in without)]
    for share in filter(None, shares):
        found = found[int(share[1]) - 1::int(share[2])]
    return found


def run_all():
    """The tests that the command line chooses."""
    OUT.mkdir(parents=True, exist_ok=True)
    if PROFILES:
        pathlib.Path(PROFILES).mkdir(parents=True, exist_ok=True)
    file = pathlib.Path(sys.argv[0]).name
    failed = skipped = count = 0
    times = {}
    for function in chosen(TESTS, sys.argv[1:]):
        name = function.__name__
        count += 1
        before_s = processor_s()
        try:
            function()
            print(f"{file}:{name}:PASS", flush=True)
        except Skip as reason:
            skipped += 1
            print(f"{file}:{name}:IGNORE: {reason}", flush=True)
        except Exception as problem:  # a reason here and a trace in the log
            failed += 1
            print(failure(file, name, reason_of(problem)), flush=True)
            traceback.print_exc()
        times[name] = processor_s() - before_s
    slowest = sorted(times, key=times.get, reverse=True)[:8]
    shown = ", ".join(f"{name} {times[name]:.1f}" for name in slowest if times[name] > 0.1)
    print(f"\nprocessor time {sum(times.values()):.0f} s{', of which ' if shown else ''}{shown}")
    print(f"{count} Tests {failed} Failures {skipped} Ignored")
    return 1 if failed or count == 0 else 0
