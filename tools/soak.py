#!/usr/bin/env python3
"""Hours of simulated time with random faults: nothing may hang, reset by itself, or show a row that is not right.

    soak.py [--fw ELF] [--hours H] [--seed N] [--every S]

Two halves run side by side, one with the filter adaptive and one with kf, each with its own seed, in one piece each; a fault of each kind
comes about every --every seconds (600). Results: build/soak.json. Exit status 1 when anything is not as it has to be.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import time

from faults_runs import KINDS, REST, SIMRUN, STATUS_WORDS, need

FILTERS = ("adaptive", "kf")
# faults overlap, and what lasts keeps the next good row away; longer than this is no recovery
GOOD_ROW_WITHIN_MS, ROWS_AT_LEAST = 5000, 0.9
RATE_HZ = 100


def faults_of(every_s):
    """(WHEN:KIND of simrun, resets it asks for) of every kind that can be seen, at 100 Hz."""
    chance = 1.0 / (every_s * RATE_HZ)
    return [(f"p:{chance:.9f}:{what}", kind.resets) for kind in KINDS if kind.detectable and kind.rate == RATE_HZ for what in kind.what]


def started(options, number, ms):
    stats = pathlib.Path(f"build/soak-{number}.json")
    stats.unlink(missing_ok=True)
    seed = options.seed + number
    print(f"soak: half {number + 1}: filter {FILTERS[number]}, seed {seed}, {ms / 3.6e6:g} hours", flush=True)
    command = [SIMRUN, "--fw", options.fw, "--in", REST, "--loop", "--out", "/dev/null", "--max-ms", f"{ms:.0f}", "--filter", FILTERS[number],
               "--seed", seed, "--stats", stats]
    for fault, _ in faults_of(options.every):
        command += ["--fault", fault]
    return subprocess.Popen([str(c) for c in command], stderr=subprocess.PIPE, text=True), stats


def judged(number, status, said, stats_path, ms, faults):
    """(row of build/soak.json, what is wrong)."""
    if not stats_path.is_file():
        return {"half": number + 1}, [f"simrun gave status {status} and no statistics: {said.strip()[-300:]}"]
    stats = json.loads(stats_path.read_text(encoding="ascii"))
    asked = sum(stats[f"fault_{n}_injected"] for n, (_, resets) in enumerate(faults, 1) if resets)
    came = sum(stats[f"fault_{n}_injected"] for n in range(1, len(faults) + 1))
    slowest = max(range(1, len(faults) + 1), key=lambda n: stats[f"fault_{n}_worst_recovery_ms"])
    row = {"half": number + 1, "filter": FILTERS[number], "hours": ms / 3.6e6, "faults": came, "rows": stats["rows"], "judged": stats["rows_judged"],
           "wrong": stats["rows_wrong"], "stale": stats["rows_stale"], "twice": stats["rows_twice"], "steps_back": stats["t_us_steps_back"],
           "resets": stats["resets"], "resets_asked_for": asked, "worst_ms_to_good": stats[f"fault_{slowest}_worst_recovery_ms"],
           "worst_fault": stats[f"fault_{slowest}"].split(":", 2)[2]}
    wrong = [f"{key}: {row[key]}" for key in ("wrong", "stale", "twice", "steps_back") if row[key]]
    wrong += [STATUS_WORDS.get(status, f"status {status}") + f": {said.strip().splitlines()[-1]}"] if status not in (0, 7) else []
    wrong += [f"{stats['resets'] - asked} resets not asked for"] if stats["resets"] > asked else []
    wrong += [f"{row['worst_ms_to_good']:.0f} ms to a good row after {row['worst_fault']}"] if row["worst_ms_to_good"] > GOOD_ROW_WITHIN_MS else []
    nominal = ms / 1000 * RATE_HZ
    wrong += [f"{stats['rows']} rows of {nominal:.0f}"] if stats["rows"] < ROWS_AT_LEAST * nominal else []
    wrong += ["no fault came"] if came == 0 else []
    return row, wrong


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--fw", default="build/uno/firmware.elf")
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--every", type=float, default=600.0)
    options = parser.parse_args()
    if options.hours <= 0 or options.every <= 0 or options.seed < 1:
        sys.exit("soak: --hours and --every want more than 0, --seed 1 or more")
    need(SIMRUN, "make build/sim/simrun")
    need(options.fw, f"make {options.fw}")
    ms, began = options.hours * 3.6e6 / 2, time.monotonic()
    runs = [started(options, number, ms) for number in range(2)]
    told = began
    while any(process.poll() is None for process, _ in runs):
        time.sleep(0.2)
        if time.monotonic() - told > 30:
            told = time.monotonic()
            print(f"  {told - began:.0f} s", flush=True)
    faults, rows, bad = faults_of(options.every), [], 0
    for number, (process, stats_path) in enumerate(runs):
        row, wrong = judged(number, process.returncode, process.stderr.read(), stats_path, ms, faults)
        rows.append(row)
        bad += bool(wrong)
        print(f"half {number + 1}: " + ", ".join(f"{key} {value}" for key, value in row.items() if key != "half"))
        print("".join(f"    WRONG: {words}\n" for words in wrong), end="")
    pathlib.Path("build/soak.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="ascii")
    print(f"soak: {options.hours:g} simulated hours in {time.monotonic() - began:.0f} s; build/soak.json written")
    print(f"{len(rows) - bad} passed, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as problem:
        sys.exit(f"soak: {problem}")
