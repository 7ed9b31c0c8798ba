"""What the fault campaign does in one run of simrun; how the run is judged is in faults_judge.py, the campaign in faults.py."""
import csv
import itertools
import json
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading

import faults_judge
import images
import latency
from faults_judge import Ending, Result
from faults_kinds import BEGIN_MS, KINDS, LONG, REST, RUN_MS, SIX_SIDES

SIMRUN = pathlib.Path("build/sim/simrun")
PERIOD_MS = 10.0
STATUS_WORDS = {1: "simrun failed", 2: "refused", 3: "crash", 4: "illegal opcode", 5: "stack overrun", 6: "UART overrun",
                8: "sleeps with interrupts off", 9: "the sensor is not used"}
SIDES = ((0, 0, 1), (1, 0, 0), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (0, 0, -1))
RAW_FLAGS = 1 | 2 | 16 | 32 | 64


class Fault(Exception):
    """One sentence about what is wrong with the campaign itself."""


LOCAL, LOCK = threading.local(), threading.Lock()
STREAMS = tempfile.TemporaryDirectory(prefix="faults-streams-")


def ended_by_signal(number, frame):
    """Once: `timeout` sends its signal to the program and then to its group; the second must not disturb the report after the first."""
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def folder():
    """Each thread has a folder of its own for the files of its runs."""
    if not hasattr(LOCAL, "folder"):
        LOCAL.folder = tempfile.TemporaryDirectory(prefix="faults-")
    return pathlib.Path(LOCAL.folder.name)


RUNNING = set()


def called(command):
    """(exit status, stderr) of simrun; end_runs() ends it."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        RUNNING.add(process)
        try:
            said = process.communicate(timeout=600)[1]
            return process.returncode, said
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        finally:
            RUNNING.discard(process)


def write_whole(path, text):
    """A file as a whole: what cannot be written, a full disk or a signal, leaves the one before."""
    beside = path.with_name(path.name + ".new")
    try:
        beside.write_text(text, encoding="utf-8")
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def end_runs():
    for process in list(RUNNING):
        process.terminate()


def simulate(firmware, filter_name, *options, stream=None, max_ms=RUN_MS, rate=100, profile=None):
    """(exit status, what simrun said, --stats) of one run; the rows lie in folder()/out.csv."""
    base = folder()
    command = [SIMRUN, "--fw", images.image_for(firmware, filter_name), "--in", stream or noise_at(rate), "--loop", "--out", base / "out.csv"]
    command += ["--stats", base / "stats.json", "--max-ms", max_ms]
    command += ["--filter", filter_name] if filter_name else []
    command += ["--baud", 500000] if rate > 100 else []
    command += ["--rate", f"{rate:g}"] if rate != 100 else []
    command += ["--profile", base / "profile.csv"] if profile is not None else []
    (base / "stats.json").unlink(missing_ok=True)
    status, said = called([str(c) for c in command + list(options)])
    if not (base / "stats.json").is_file():
        raise Fault(f"simrun gave status {status} and no statistics: {said.strip()[:300]}")
    if status == 1:
        raise Fault(f"simrun failed: {said.strip()[-300:]}")
    try:
        stats = json.loads((base / "stats.json").read_text(encoding="ascii"))
    except json.JSONDecodeError:
        raise Fault(f"{base / 'stats.json'} breaks off: is the disk full?") from None
    if profile is not None and images.image_for(firmware, filter_name) == firmware:  # another image has its own addresses
        profile.update(line.partition(",")[0] for line in (base / "profile.csv").read_text(encoding="ascii").splitlines()[1:])
    return status, said, stats


def noise_at(rate, memory={}):
    """A stream for rates above that of REST, which would show every reading several times: at rest, white noise of 2 LSB rms."""
    if rate <= 100:
        return REST
    with LOCK:
        if rate not in memory:
            memory[rate] = written(f"rest-{rate}", rate, 2, itertools.repeat((31, 52, 249), 4 * rate))
    return memory[rate]


def six_sides(memory=[]):
    """A stream for cal6: each side up for six seconds, then turned to the next one in one."""
    with LOCK:
        if not memory:
            turned = ((side, max(0, n - 600) / 100) for side in range(len(SIDES)) for n in range(700))
            means = (tuple(256 * (a * (1 - t) + b * t) for a, b in zip(SIDES[side], SIDES[(side + 1) % len(SIDES)])) for side, t in turned)
            memory.append(written("six-sides", 100, 1, means))
    return memory[0]


def written(name, rate, sigma, means):
    """A stream of these readings at a rate, with white noise."""
    path, source = pathlib.Path(STREAMS.name) / f"{name}.csv", random.Random(name)
    with open(path, "w", encoding="ascii") as file:
        file.write("t_us,x,y,z\n")
        for n, reading in enumerate(means):
            x, y, z = (round(source.gauss(mean, sigma)) for mean in reading)
            file.write(f"{round(1e6 * n / rate)},{x},{y},{z}\n")
    return path


# --- phases -----------------------------------------------------------------------------------------------------------

def bus_bytes(firmware, filter_name, rate):
    """WHEN of each byte of a read that comes soon after BEGIN_MS."""
    short = simulate(firmware, filter_name, max_ms=BEGIN_MS, rate=rate)[2]
    long = simulate(firmware, filter_name, max_ms=BEGIN_MS + 500, rate=rate)[2]
    reads = long["i2c_transfers"] - short["i2c_transfers"]
    count = round((long["i2c_bytes"] - short["i2c_bytes"]) / max(1, reads))
    if not 9 <= count <= 20:
        raise Fault(f"a read of a sample has {count} bytes on the bus: does the firmware stream?")
    return [f"xfer:{short['i2c_transfers'] + 2}.{byte}" for byte in range(1, count + 1)]


def entries(firmware, filter_name, rate, ms):
    """{function: how often it was entered}."""
    simulate(firmware, filter_name, max_ms=ms, rate=rate, profile=set())
    names = [(row["symbol"].rpartition("+"), int(row["count"])) for row in csv.DictReader(open(folder() / "profile.csv", encoding="ascii"))]
    return {name: count for (name, _, offset), count in names if offset == "0x0" and re.fullmatch(r"[a-z]\w*(\.\w+)*|__vector_\d+", name)}


def stages(firmware, filter_name, rate):
    """WHEN of each function that runs for every second sample or more often, at its first call after BEGIN_MS."""
    before, after = (entries(firmware, filter_name, rate, ms) for ms in (BEGIN_MS, BEGIN_MS + 400))
    return [f"pc:{name}#{before.get(name, 0) + 1}" for name in after if after[name] - before.get(name, 0) >= 0.2 * rate]


def phases(firmware, kind, filter_name, wanted, memory={}):
    """WHENs of a kind: every byte of a read, every stage of the main loop, and moments spread over a sample's period."""
    key = (kind.rate, filter_name)
    if key not in memory:
        memory[key] = bus_bytes(firmware, filter_name, kind.rate) + stages(firmware, filter_name, kind.rate)
    whens = list(memory[key])
    spread = max(wanted - len(whens), 10)
    return whens + [f"{BEGIN_MS + PERIOD_MS * (i + 0.37) / spread:.3f}ms" for i in range(spread)]


def moments(kind, count, seed):
    """WHENs spread over two periods, each somewhere in its share of them."""
    source = random.Random(f"{seed} {kind.name}")
    return [f"{BEGIN_MS + 2000 / kind.rate * (i + source.random()) / count:.3f}ms" for i in range(count)]


# --- one run ----------------------------------------------------------------------------------------------------------

def ends_of(stats):
    """(end in ms, ms from it to the first good row or None) of every fault that came."""
    for n in itertools.count(1):
        if f"fault_{n}" not in stats:
            return
        if stats[f"fault_{n}_injected"]:
            good = stats[f"fault_{n}_recovered"] == stats[f"fault_{n}_injected"]
            yield stats[f"fault_{n}_last_end_ms"], stats[f"fault_{n}_worst_recovery_ms"] if good else None


def stream_of(kind):
    """The stream of a kind's run, where it is not that of its rate."""
    if kind.command:
        return noise_at(kind.command.rate)
    return six_sides() if kind.stream == SIX_SIDES else kind.stream


def options_of(kinds, whens):
    """What a run with these kinds, each beginning at its WHEN, gives to simrun."""
    options = [word for kind, when in zip(kinds, whens) for fault in kind.faults(when) for word in ("--fault", fault)]
    options += ["--expect-resets", sum(kind.resets for kind in kinds)]
    options += [word for kind in kinds for typed in kind.typed for word in ("--cmd", typed)]
    stream = stream_of(kinds[0])
    return options + (["--in", stream] if stream else [])


def attempt(firmware, filter_name, kinds, whens, profile=None):
    """One run, judged. One that dies is a failure of its own: the others go on."""
    options = options_of(kinds, whens)
    max_ms = RUN_MS + (1500 if sum(kind.resets for kind in kinds) > 1 else 0) + sum(kind.lasts_ms for kind in kinds if kind in LONG)
    max_ms += sum(kind.more_ms for kind in kinds)
    command = " ".join(map(str, options))
    try:
        done = simulate(firmware, filter_name, *options, rate=max(kind.rate for kind in kinds), profile=profile, max_ms=max_ms)
        result = judged(filter_name, kinds, whens, max_ms, command, *done)
        result.ending = ending(kinds[0].command, done[2]) if kinds[0].command else None
        printed = "\n" + (folder() / "out.csv").read_text(encoding="ascii", errors="replace")
        result.missing = tuple(kind.prints for kind in kinds if f"\n{kind.prints}" not in printed)
        return result
    except Exception as problem:
        return Result(kinds, " + ".join(whens), filter_name, f"the run died: {type(problem).__name__}: {str(problem)[:200]}", injected=False,
                      recovered=False, ms_to_good=0.0, lost=None, wrong=0, steps_back=0, altered=0, resets=0, resets_due=None, pass_cycles=0,
                      waits=(), calm_gap_ms=0.0, since_good_ms=None, command=command)


def waits_of(kinds, stats):
    """How long interrupts waited, and may: the baud rate is the fastest that the run has."""
    typed = [int(baud) for kind in kinds for line in kind.typed for baud in re.findall(r":baud (\d+)$", line)]
    baud = max([500000 if max(kind.rate for kind in kinds) > 100 else 115200, *typed])
    return tuple(latency.waits(stats, baud, any("rxflood" in what for kind in kinds for what in kind.what)))


def judged(filter_name, kinds, whens, max_ms, command, status, said, stats):
    """What simrun gave for a run, as the judge looks at it."""
    last_line = said.strip().splitlines()[-1] if said.strip() else "?"
    hang = "" if status in (0, 7) else f"{STATUS_WORDS.get(status, status)}: {last_line}"
    if not hang and stats["sim_ms"] < max_ms - 1:
        hang = f"ended after {stats['sim_ms']:.0f} of {max_ms:.0f} ms"
    ends = list(ends_of(stats))
    ms = max(ends, key=lambda end: end[0])[1] if ends else None
    wrong = stats["rows_wrong"] + stats["rows_stale"] + stats["rows_twice"]
    last_ms = stats["rows_last_good_ms"]
    return Result(kinds, " + ".join(whens), filter_name, hang, injected=bool(ends), recovered=bool(ends) and ms is not None, ms_to_good=ms or 0.0,
                  lost=stats["lost"], wrong=wrong, steps_back=stats["t_us_steps_back"], altered=stats["samples_altered"],
                  resets=stats["resets"], resets_due=faults_judge.resets_due(kinds, whens),
                  pass_cycles=stats["pass_max_cycles"], waits=waits_of(kinds, stats), calm_gap_ms=stats["rows_calm_gap_ms"],
                  since_good_ms=None if last_ms is None else stats["sim_ms"] - last_ms, command=command)


def ending(command, stats):
    """What a run with a command has come to, from its rows, from what it said, and from the virtual sensor."""
    rows = read_rows(folder() / "out.csv")
    begin_ms, end_ms = (stats["sim_ms"] - ms for ms in (faults_judge.LAST_MS, faults_judge.END_MS))
    late = [row for row in rows if 1000 * begin_ms < row[0] < 1000 * end_ms]
    said = (folder() / "out.csv").read_text(encoding="ascii", errors="replace")
    states = re.findall(r"^# state (\w+),.* rate ([\d.]+) Hz(?:, measured ([\d.]+) Hz)?", said, re.MULTILINE)
    over = max([command.given_ms(), *(end for end, _ in ends_of(stats))])
    return Ending(stats["sensor_hz"], stats["sensor_range_g"], stats["sensor_last_tick_ms"] - over,
                  tuple(b[0] - a[0] for a, b in zip(late, late[1:])), sum(bool(row[9] & 2) for row in late),
                  sum(row[0] > 1000 * (command.given_ms() + faults_judge.STOP_MS) for row in rows),
                  tuple((state, float(rate), float(measured or 0)) for state, rate, measured in states),
                  tuple(int(lost) for lost in re.findall(r"^# lost (\d+),", said, re.MULTILINE)), len(re.findall("^# fault 1:", said, re.MULTILINE)))


# --- values that no firmware can see to be wrong ----------------------------------------------------------------------

def read_rows(path):
    """Whole rows of the firmware's output, as numbers."""
    with open(path, encoding="ascii") as file:
        return [[int(v) for v in line.split(",")] for line in file if re.fullmatch(r"\d+(,-?\d+){8},\d+\n", line)]


def flagged_share(firmware, kind, stream, sigma_lsb, seconds):
    """(changes of 8 sigma or more, those of them that no row shows without a flag) with the default filter."""
    path = folder() / "altered.csv"
    options = ["--altered", path, "--seed", 7] + [word for fault in kind.faults("p:0.01") for word in ("--fault", fault)]
    simulate(firmware, None, *options, stream=stream, max_ms=1000 * seconds)
    rows = read_rows(folder() / "out.csv")
    shown = {}
    for row in rows:
        shown.setdefault(tuple(row[1:4]), []).append(row)
    large = unflagged = 0
    for line in csv.DictReader(open(path, encoding="ascii")):
        arrived = tuple(int(line[f"{a}_lsb"]) for a in "xyz")
        sent = tuple(int(line[f"{a}_sent_lsb"]) for a in "xyz")
        if max(abs(a - b) for a, b in zip(arrived, sent)) < 8 * sigma_lsb or int(line["t_us"]) < 500000:
            continue
        large += 1
        unflagged += any(abs(row[0] - int(line["t_us"])) < 15000 and not row[9] & RAW_FLAGS for row in shown.get(arrived, []))
    return large, large - unflagged


def roll_differences(firmware, faults, stream, seconds):
    """Differences of roll in hundredths of a degree, row by row, from the run without faults; default filter."""
    rolls = []
    for options in ([], [word for fault in faults for word in ("--fault", fault)]):
        simulate(firmware, None, "--seed", 11, *options, stream=stream, max_ms=1000 * seconds)
        rolls.append({round(row[0] / (1000 * PERIOD_MS)): row[7] for row in read_rows(folder() / "out.csv")})
    calm, faulty = rolls
    both = [n for n in calm if n in faulty]
    if len(both) < 0.9 * len(calm):
        raise Fault(f"{stream}: only {len(both)} of {len(calm)} rows are stamped alike with and without faults")
    return [abs((calm[n] - faulty[n] + 18000) % 36000 - 18000) for n in both], len(calm) - len(both)


def seeded_pairs(count, seed):
    """(kinds, whens) of every unordered pair of kinds at so many moments."""
    source = random.Random(seed)
    for a, b in itertools.combinations(KINDS, 2):
        for _ in range(count):
            yield (a, b), tuple(f"{BEGIN_MS + source.uniform(0, 100):.3f}ms" for _ in range(2))


def need(path, how, program="faults"):
    if not pathlib.Path(path).is_file():
        sys.exit(f"{program}: there is no file {path}: {how}")
