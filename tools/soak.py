#!/usr/bin/env python3
"""Hours of simulated time with random faults: nothing may hang, reset by itself, or show a row that is not right.

    soak.py [--fw ELF] [--hours H] [--seed N] [--every S]

Two halves run side by side, one with the filter adaptive and one with kf, each with its own seed, in one piece each; a fault of each kind
comes about every --every seconds (600). Results: build/soak.json. Exit status 1 when anything is not as it has to be.
"""
import argparse
import json
import pathlib
import signal
import subprocess
import sys
import time

from faults_judge import PASS_CYCLES
from faults_runs import KINDS, REST, RESET_MS, SIMRUN, STATUS_WORDS, need

FILTERS = ("adaptive", "kf")
RATE_HZ, ROWS_AT_LEAST = 100, 0.9
ASKED = [kind for kind in KINDS if kind.detectable and kind.rate == RATE_HZ]
# Faults overlap: when one is over the longest other one may just have begun; then the longest recovery, and a row. As long may no
# row at all show a sample: the fault itself, recovery and a row.
GOOD_ROW_WITHIN_MS = max(kind.lasts_ms for kind in ASKED) + RESET_MS + 1000 / RATE_HZ
HOURS_MAX, EVERY_MAX_S = 1000, 1e6


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"soak: {message}")


def arguments(words=None):
    parser = Parser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--fw", default="build/uno/firmware.elf")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--every", type=float, default=600.0)
    options = parser.parse_args(words)
    # comparisons that nan does not pass
    if not 0 < options.hours <= HOURS_MAX:
        sys.exit(f"soak: --hours wants more than 0 and at most {HOURS_MAX}, not {options.hours:g}")
    if not 1 <= options.every <= EVERY_MAX_S:
        sys.exit(f"soak: --every wants 1 to {EVERY_MAX_S:g} seconds, not {options.every:g}")
    if not 1 <= options.seed < 2**32 - 1:
        sys.exit(f"soak: --seed wants 1 to {2**32 - 2}, not {options.seed}")
    return options


def faults_of(every_s):
    """(WHEN:KIND of simrun, resets it asks for) of every kind that can be seen, at 100 Hz."""
    chance = 1.0 / (every_s * RATE_HZ)
    return [(f"p:{chance:.9f}:{what}", kind.resets) for kind in ASKED for what in kind.what]


def simrun(firmware, filter_name, ms, stats, *more):
    command = [SIMRUN, "--fw", firmware, "--in", REST, "--loop", "--out", "/dev/null", "--max-ms", f"{ms:.0f}", "--filter", filter_name,
               "--stats", stats, *more]
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


def started(options, number, ms):
    stats = pathlib.Path(f"build/soak-{number}.json")
    stats.unlink(missing_ok=True)
    seed = options.seed + number
    print(f"soak: half {number + 1}: filter {FILTERS[number]}, seed {seed}, {ms / 3.6e6:g} hours", flush=True)
    faults = [word for fault, _ in faults_of(options.every) for word in ("--fault", fault)]
    return simrun(options.fw, FILTERS[number], ms, stats, "--seed", seed, *faults), stats


def row_of(number, stats, faults):
    """What build/soak.json says of a half."""
    asked = sum(stats[f"fault_{n}_injected"] for n, (_, resets) in enumerate(faults, 1) if resets)
    came = sum(stats[f"fault_{n}_injected"] for n in range(1, len(faults) + 1))
    slowest = max(range(1, len(faults) + 1), key=lambda n: stats[f"fault_{n}_worst_recovery_ms"])
    return {"half": number + 1, "filter": FILTERS[number], "hours": stats["sim_ms"] / 3.6e6, "faults": came, "rows": stats["rows"],
            "judged": stats["rows_judged"], "wrong": stats["rows_wrong"], "stale": stats["rows_stale"], "twice": stats["rows_twice"],
            "steps_back": stats["t_us_steps_back"], "resets": stats["resets"], "resets_asked_for": asked,
            "longest_pass_cycles": stats["pass_max_cycles"], "worst_gap_ms": stats["rows_gap_ms"],
            "worst_ms_to_good": stats[f"fault_{slowest}_worst_recovery_ms"], "worst_fault": stats[f"fault_{slowest}"].split(":", 2)[2]}


def judged(number, status, said, stats_path, ms, faults):
    """(row of build/soak.json, what is wrong) of a half that ran until ms; None: until it was ended."""
    if not stats_path.is_file():
        return {"half": number + 1}, [f"simrun gave status {status} and no statistics: {said.strip()[-300:]}"]
    stats = json.loads(stats_path.read_text(encoding="ascii"))
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
    return row, wrong + stream_ends(stats) + (["no fault came"] if row["faults"] == 0 else [])


def stream_ends(stats):
    last_ms, nominal = stats["rows_last_good_ms"], stats["sim_ms"] / 1000 * RATE_HZ
    wrong = [f"{stats['rows']} rows of {nominal:.0f}"] if stats["rows"] < ROWS_AT_LEAST * nominal else []
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


def ended_by_signal(number, frame):
    """Once: `timeout` sends its signal to the program and then to its group."""
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def main():
    options = arguments()
    need(SIMRUN, "make build/sim/simrun", "soak")
    need(options.fw, f"make {options.fw}", "soak")
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, ended_by_signal)
    check_firmware(options.fw)
    ms, began = options.hours * 3.6e6 / 2, time.monotonic()
    runs = [started(options, number, ms) for number in range(2)]
    complete = wait_for(runs)
    faults, rows, bad = faults_of(options.every), [], 0
    for number, (process, stats_path) in enumerate(runs):
        row, wrong = judged(number, process.returncode, process.stderr.read(), stats_path, ms if complete else None, faults)
        rows.append(row)
        bad += bool(wrong)
        print(f"half {number + 1}: " + ", ".join(f"{key} {value}" for key, value in row.items() if key != "half"))
        print("".join(f"    WRONG: {words}\n" for words in wrong), end="")
    pathlib.Path("build/soak.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="ascii")
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
