#!/usr/bin/env python3
"""Race mode: each image for simulated minutes, with every interrupt served where main shares something with its handler (simrun --race).

    race.py [--minutes M] [--seed N] [IMAGE...]    all images of mk/images.mk; two run side by side

No row may be wrong or step back in time, nothing may hang or reset, and each pair of an instruction of main and a vector must be taken,
guarded by a section, or listed as not reached: build/race-IMAGE.csv. Exit status 1 when anything is not as it has to be.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import images

SIMRUN, STREAM = "build/sim/simrun", "sim/streams/outliers-15pct.csv"
RATES = (800, 100, 400, 12.5, 200, 800, 50, 400, 25, 100)
# of a phase: what is typed, and which share of it has passed then; listings hold the rows for 2 s
TYPED = (("rate {rate}", 0.05), ("filter {filter}", 0.3), ("every {every}", 0.4), ("settings", 0.45), ("save", 0.5), ("status", 0.97))
FAULTS = ("nack", "storm:300:400", "sda:40", "noint:300", "rxflood:60", "unplug:60", "nackdata", "scl:40", "storm:2000:100", "hang:5")
STARVED = "p:0.02:starve:1.3"  # so that samples come at any place of main's pass
SILENT_MS = 4000  # without a good row: a listing holds the rows for 2 s, a fault of the wires in them and what follows take 1 s


def options_of(ms, phases, filters, faults=True):
    """Words for simrun: so many phases, each with its rate, filter and fault."""
    phase_ms = (ms - 1500) / phases
    words = ["--baud", "500000", "--fault", STARVED]
    for n in range(phases):
        rate = RATES[n % len(RATES)]
        says = {"rate": rate, "filter": filters[n % len(filters)], "every": 4 if rate == 800 else 1}
        for text, share in TYPED:
            words += ["--cmd", f"{1500 + phase_ms * (n + share):.0f}:{text.format(**says)}"]
        if faults:
            words += ["--fault", f"{1500 + phase_ms * (n + 0.7):.0f}ms:{FAULTS[n % len(FAULTS)]}"]
    return words


def pairs_of(path):
    """Rows of what simrun --race wrote, `taken` being how often."""
    pairs = list(csv.DictReader(open(path, encoding="ascii")))
    for pair in pairs:
        pair["taken"] = int(pair["before"]) + int(pair["after"])
    return pairs


def faults_of(stats, pairs):
    """What is wrong with a run that ended well and whose rows simrun --judge found right."""
    wrong = [f"{key}: {stats[key]}" for key in ("rows_wrong", "rows_stale", "rows_twice", "t_us_steps_back", "resets") if stats[key]]
    silent_ms = max(stats["rows_gap_ms"], stats["sim_ms"] - stats["rows_last_good_ms"])
    wrong += [f"{silent_ms:.0f} ms without a good row"] if silent_ms > SILENT_MS else []
    odd = [p for p in pairs if (p["state"] == "taken") != (p["taken"] > 0) or p["state"] not in ("taken", "guarded", "not reached")]
    wrong += [f"{len(odd)} pairs neither taken nor listed"] if odd else []
    return wrong + ([] if any(p["taken"] for p in pairs) else ["no pair taken"])


def name_of(image):
    return pathlib.Path(image).parent.name.replace("uno", "everyday")


def run(image, minutes, seed):
    """(image, what was found, what is wrong)."""
    base = pathlib.Path("build", f"race-{name_of(image)}")
    ms = 60000 * minutes
    done = subprocess.run([SIMRUN, "--fw", image, "--in", STREAM, "--out", f"{base}.out.csv", "--loop", "--max-ms", f"{ms:.0f}", "--judge", "--seed",
                           str(seed), "--stats", f"{base}.json", "--race", f"{base}.csv", *options_of(ms, len(RATES), images.filters_of(image))],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return image, "", [done.stderr.strip().splitlines()[-1]]
    stats, pairs = json.loads(pathlib.Path(f"{base}.json").read_text(encoding="ascii")), pairs_of(f"{base}.csv")
    states = collections.Counter(pair["state"] for pair in pairs)
    found = ", ".join(f"{states[state]} {state}" for state in ("taken", "guarded", "not reached"))
    return image, f"{stats['rows_judged']} rows; pairs: {found}", faults_of(stats, pairs)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("images", nargs="*", default=images.SET_IMAGES)
    words = parser.parse_args()
    if not 1 <= words.minutes <= 1000:
        sys.exit(f"race: --minutes wants 1 to 1000, not {words.minutes:g}")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for image, found, wrong in pool.map(lambda image: run(image, words.minutes, words.seed), words.images):
            print(f"race: {name_of(image)}: {'; '.join([found, *wrong]).lstrip('; ')}", flush=True)
            failed += bool(wrong)
    print(f"{len(words.images) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
