#!/usr/bin/env python3
"""Hours of simulated time with random faults: nothing may hang, reset by itself, or show a row that is not right.

    soak.py [--fw ELF] [--hours H] [--seed N] [--every S]

Two halves run side by side, one with the default filter and one with a plain Kalman filter, each with its own seed, in one piece each; a fault
of each kind comes once at a moment of its own, and about every --every seconds (600, or a third of a shorter half) as chance has it.
Results: build/soak.json. Exit status 1 when anything is not as it has to be.
"""
import argparse
import collections
import json
import pathlib
import random
import signal
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import images
from faults_judge import NO_LIMIT, PASS_CYCLES
from faults_kinds import BUS_MS, KINDS, REST, RESET_MS
from faults_runs import SIMRUN, STATUS_WORDS, ended_by_signal, need, write_whole
from laws import DEFAULT, PLAIN

FILTERS = (DEFAULT, PLAIN)
RATE_HZ, START_MS = 100, 1000  # until rows come, and filters have warmed up
ASKED = [kind for kind in KINDS if kind.detectable and kind.rate == RATE_HZ]
# Faults overlap: when one is over the longest other one may just have begun; then the longest recovery allowed, and a row. As long may no
# row at all show a sample: the fault itself, recovery and a row.
GOOD_ROW_WITHIN_MS = max(kind.lasts_ms for kind in ASKED) + RESET_MS + 1000 / RATE_HZ
# in less the faults overlap so much that one delays the recovery from another, and no number of rows is certain
HOURS_MIN, HOURS_MAX, EVERY_S, EVERY_MAX_S = 0.1, 1000, 600.0, 1e6


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"soak: {message}")


def arguments(words=None):
    parser = Parser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--fw", default="build/uno/firmware.elf")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--every", type=float)
    options = parser.parse_args(words)
    # comparisons that nan does not pass
    if not HOURS_MIN <= options.hours <= HOURS_MAX:
        sys.exit(f"soak: --hours wants {HOURS_MIN} (in less, faults overlap) to {HOURS_MAX}, not {options.hours:g}")
    if options.every is None:
        options.every = min(EVERY_S, options.hours * 1800 / 3)
    if not 1 <= options.every <= EVERY_MAX_S:
        sys.exit(f"soak: --every wants 1 to {EVERY_MAX_S:g} seconds, not {options.every:g}")
    if not 1 <= options.seed < 2**32 - 1:
        sys.exit(f"soak: --seed wants 1 to {2**32 - 2}, not {options.seed}")
    return options


def faults_of(every_s, half_ms, seed):
    """(WHEN:KIND of simrun, its kind) of every kind that can be seen, at 100 Hz: by chance, and once for sure in a share of the half's time."""
    chance = 1.0 / (every_s * RATE_HZ)
    source = random.Random(seed)
    share_ms = (half_ms - 2 * START_MS) / len(ASKED)
    sure = [(START_MS + (n + source.random() / 2) * share_ms, kind) for n, kind in enumerate(source.sample(ASKED, len(ASKED)))]
    return ([(f"p:{chance:.9f}:{what}", kind) for kind in ASKED for what in kind.what]
            + [(f"{ms:.3f}ms:{what}", kind) for ms, kind in sure for what in kind.what])


def simrun(firmware, filter_name, ms, stats, *more):
    command = [SIMRUN, "--fw", images.image_for(firmware, filter_name), "--in", REST, "--loop", "--out", "/dev/null",
               "--max-ms", f"{ms:.0f}", "--filter", filter_name, "--stats", stats, *more]
    return subprocess.Popen([str(word) for word in command], stderr=subprocess.PIPE, text=True)


def check_firmware(firmware):
    """Ends the program when it is none that streams with these filters: a second of each, without faults."""
    for filter_name in FILTERS:
        path = pathlib.Path("build/soak-trial.json")
        path.unlink(missing_ok=True)
        process = simrun(firmware, filter_name, 1000, path)
        said = process.communicate()[1].strip()
        if not path.is_file() or process.returncode != 0:
            sys.exit(f"soak: {firmware} does not run: {said.splitlines()[-1] if said else f'simrun gave status {process.returncode}'}")
        if json.loads(path.read_text(encoding="ascii"))["rows_judged"] == 0:
            sys.exit(f"soak: {firmware} gives no row in a second with the filter {filter_name}: is it the firmware?")


def started(options, number, ms, asked):
    stats = pathlib.Path(f"build/soak-{number}.json")
    stats.unlink(missing_ok=True)
    seed = options.seed + number
    print(f"soak: half {number + 1}: filter {FILTERS[number]}, seed {seed}, {ms / 3.6e6:g} hours", flush=True)
    faults = [word for fault, _ in asked for word in ("--fault", fault)]
    return simrun(options.fw, FILTERS[number], ms, stats, "--seed", seed, *faults), stats


def what_of(fault):
    """KIND:PARAM behind p:CHANCE: or MSms:."""
    return fault.split(":", 2 if fault.startswith("p:") else 1)[-1]


def came_of(stats, faults):
    """{(KIND:PARAM, its kind): how often it came}."""
    came = collections.Counter()
    for n, (fault, kind) in enumerate(faults, 1):
        came[what_of(fault), kind] += stats[f"fault_{n}_injected"]
    return came


def row_of(number, stats, faults):
    """What build/soak.json says of a half."""
    came = came_of(stats, faults)
    asked = sum(count for (_, kind), count in came.items() if kind.resets)
    slowest = max(range(1, len(faults) + 1), key=lambda n: stats[f"fault_{n}_worst_recovery_ms"])
    return {"half": number + 1, "filter": FILTERS[number], "hours": stats["sim_ms"] / 3.6e6, "faults": sum(came.values()), "rows": stats["rows"],
            "judged": stats["rows_judged"], "wrong": stats["rows_wrong"], "stale": stats["rows_stale"], "twice": stats["rows_twice"],
            "steps_back": stats["t_us_steps_back"], "resets": stats["resets"], "resets_asked_for": asked,
            "longest_pass_cycles": stats["pass_max_cycles"], "worst_gap_ms": stats["rows_gap_ms"],
            "worst_ms_to_good": stats[f"fault_{slowest}_worst_recovery_ms"], "worst_fault": what_of(stats[f"fault_{slowest}"])}


def judged(number, status, said, stats_path, ms, faults):
    """(row of build/soak.json, what is wrong) of a half that ran until ms; None: until it was ended."""
    if not stats_path.is_file():
        return {"half": number + 1}, [f"simrun gave status {status} and no statistics: {said.strip()[-300:]}"]
    try:
        stats = json.loads(stats_path.read_text(encoding="ascii"))
    except json.JSONDecodeError:
        return {"half": number + 1}, [f"{stats_path} breaks off: is the disk full?"]
    row = row_of(number, stats, faults)
    wrong = [f"{key}: {row[key]}" for key in ("wrong", "stale", "twice", "steps_back") if row[key]]
    good = (0, 7) if ms is not None else (0, 1, 7)  # 1: ended
    wrong += [STATUS_WORDS.get(status, f"status {status}") + f": {said.strip().splitlines()[-1]}"] if status not in good else []
    wrong += [f"ended after {stats['sim_ms']:.0f} of {ms:.0f} ms"] if ms is not None and stats["sim_ms"] < ms - 1 else []
    asked = row["resets_asked_for"]
    wrong += [f"{row['resets'] - asked} resets not asked for"] if row["resets"] > asked else []
    # one reset ends a starvation that would have had its own: of one in a thousand starvations, when a kind comes every 600 s
    wrong += [f"{asked - row['resets']} resets asked for did not come"] if asked - row["resets"] > 1 + asked // 100 else []
    wrong += [f"{row['worst_ms_to_good']:.0f} ms to a good row after {row['worst_fault']}"] if row["worst_ms_to_good"] > GOOD_ROW_WITHIN_MS else []
    wrong += [f"{row['worst_gap_ms']:.0f} ms without a sample's row"] if row["worst_gap_ms"] > GOOD_ROW_WITHIN_MS else []
    wrong += [f"a pass of {row['longest_pass_cycles']} cycles"] if row["longest_pass_cycles"] > PASS_CYCLES else []
    wrong += [f"{what} never came" for (what, _), count in came_of(stats, faults).items() if count == 0 and ms is not None]
    return row, wrong + stream_ends(stats, came_of(stats, faults))


def rows_at_least(stats, came):
    """Without those of the start, and of the time that each fault lasts and may need until the first good row."""
    gone_ms = START_MS + sum(count * (kind.lasts_ms + (kind.limit_ms if kind.limit_ms < NO_LIMIT else BUS_MS)) for (_, kind), count in came.items())
    return (stats["sim_ms"] - gone_ms) / 1000 * RATE_HZ


def stream_ends(stats, came):
    """What says that rows do not go on; a half that was ended while it started has none yet."""
    last_ms, least = stats["rows_last_good_ms"], rows_at_least(stats, came)
    if stats["sim_ms"] < 2 * START_MS:
        return []
    wrong = [f"{stats['rows']} rows of {least:.0f} at least"] if stats["rows"] < least else []
    if last_ms is None:
        return wrong + ["no good row"]
    since_ms = stats["sim_ms"] - last_ms
    return wrong + ([f"last good row {since_ms:.0f} ms before the end"] if since_ms > GOOD_ROW_WITHIN_MS else [])


def wait_for(runs):
    """False when a signal ended them before their time."""
    began = told = time.monotonic()
    try:
        while any(process.poll() is None for process, _ in runs):
            time.sleep(0.2)
            if time.monotonic() - told > 30:
                told = time.monotonic()
                print(f"  {told - began:.0f} s", flush=True)
    except KeyboardInterrupt:
        for process, _ in runs:
            process.terminate()
            process.wait()
        return False
    return True


def main():
    options = arguments()
    need(SIMRUN, "make build/sim/simrun", "soak")
    need(options.fw, f"make {options.fw}", "soak")
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, ended_by_signal)
    check_firmware(options.fw)
    ms, began = options.hours * 3.6e6 / 2, time.monotonic()
    asked = [faults_of(options.every, ms, options.seed + number) for number in range(2)]
    runs = [started(options, number, ms, asked[number]) for number in range(2)]
    complete = wait_for(runs)
    rows, bad = [], 0
    for number, (process, stats_path) in enumerate(runs):
        row, wrong = judged(number, process.returncode, process.stderr.read(), stats_path, ms if complete else None, asked[number])
        rows.append(row)
        bad += bool(wrong)
        print(f"half {number + 1}: " + ", ".join(f"{key} {value}" for key, value in row.items() if key != "half"))
        print("".join(f"    WRONG: {words}\n" for words in wrong), end="")
    write_whole(pathlib.Path("build/soak.json"), json.dumps(rows, indent=1) + "\n")
    hours = sum(row.get("hours", 0.0) for row in rows)
    ended = "" if complete else f", ended by a signal, of {options.hours:g}"
    print(f"soak: {hours:.3g} simulated hours in {time.monotonic() - began:.0f} s{ended}; build/soak.json written")
    print(f"{len(rows) - bad} passed, {bad} failed")
    return 1 if bad or not complete else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("soak: ended by a signal before it ran\n0 passed, 0 failed")
        sys.exit(1)
    except OSError as problem:
        sys.exit(f"soak: {problem}")
