#!/usr/bin/env python3
"""The fault campaign: every fault of simrun at every bus byte, main-loop stage and moment, every pair of faults, judged by the model.

    faults.py [--fw ELF] [--sample N] [--pairs N] [--jobs N] [--seed N] [--profiles FOLDER] [--no-page] [WORD...]

WORDs: only kinds whose name begins with one of them, and no pairs. --sample: so many runs in all, chosen by the seed. Results go
into build/faults.json, the table into docs/faults-campaign.md (whole campaigns only), what fails to stdout. Exit status 1 when
anything is above its limit.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import faults_runs
from faults_runs import (KINDS, MOVING, NO_LIMIT, OF, REST, Fault, SIMRUN, attempt, flagged_share, need, phases, roll_differences, seeded_pairs)

PAGE = pathlib.Path("docs/faults-campaign.md")
RESULTS = pathlib.Path("build/faults.json")
PHASES, FILTERS = 50, ("adaptive", "kf")
SHARE_FLAGGED, SHARE_ROLL, ROLL_CDEG = 0.99, 0.999, 50
# (what, faults, stream): once in a thousand samples
ROLL_RUNS = [("bad reads, at rest", ["arb", "nack", "buserr", "torn"], REST), ("bad reads, moving", ["arb", "nack", "buserr", "torn"], MOVING),
             ("bit flips, at rest", ["flip:1"], REST), ("bit flips, moving", ["flip:1"], MOVING)]


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--fw", default="build/uno/firmware.elf")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--profiles")
    parser.add_argument("--no-page", action="store_true")
    parser.add_argument("words", nargs="*")
    options = parser.parse_args()
    if options.sample < 0 or options.pairs < 0 or options.jobs < 1:
        sys.exit("faults: --sample and --pairs want 0 or more, --jobs 1 or more")
    return options


def planned(options):
    """[(kinds, whens, filter)] of the campaign."""
    kinds = [kind for kind in KINDS if not options.words or any(kind.name.startswith(word) for word in options.words)]
    if not kinds:
        sys.exit(f"faults: no kind begins with {' '.join(options.words)}; there are: {', '.join(OF)}")
    singles = [((kind,), (when,), name) for kind in kinds for name in FILTERS for when in phases(options.fw, kind, name, PHASES)]
    pairs = [] if options.words else [(*pair, FILTERS[0]) for pair in seeded_pairs(options.pairs, options.seed)]
    if not options.sample or options.sample >= len(singles) + len(pairs):
        return singles + pairs
    source = random.Random(options.seed)
    return take(source, singles, options.sample - options.sample // 4) + take(source, pairs, options.sample // 4)


def take(source, runs, count):
    """So many runs, as evenly from all kinds as it goes, in the order of the plan."""
    by_kind = collections.defaultdict(list)
    for number, run in enumerate(runs):
        by_kind[run[0]].append(number)
    for numbers in by_kind.values():
        source.shuffle(numbers)
    queues = list(by_kind.values())
    source.shuffle(queues)
    chosen = []
    while len(chosen) < count and any(queues):
        chosen += [numbers.pop() for numbers in queues if numbers]
    return [runs[n] for n in sorted(chosen[:count])]


def carried_out(options, runs):
    """The results in the order of the plan, with a line of progress every ten seconds."""
    profiles = pathlib.Path(options.profiles) if options.profiles else None
    if profiles:
        profiles.mkdir(parents=True, exist_ok=True)
    results, told = [], time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(attempt, options.fw, name, kinds, whens, profiles / f"{n:05}.csv" if profiles and len(kinds) == 1 else None)
                   for n, (kinds, whens, name) in enumerate(runs)]
        try:
            for future in waiting:
                results.append(future.result())
                if time.monotonic() - told > 10:
                    told = time.monotonic()
                    print(f"  {len(results)} of {len(runs)} runs, {sum(bool(r.failures()) for r in results)} failed", flush=True)
        except KeyboardInterrupt:
            print(f"faults: ended by hand after {len(results)} of {len(runs)} runs", flush=True)
            pool.shutdown(cancel_futures=True)
    return results


def summarised(results):
    """A row of build/faults.json per kind or pair."""
    groups = collections.defaultdict(list)
    for result in results:
        groups[result.kinds].append(result)
    rows = []
    for kinds, group in groups.items():
        came = [r for r in group if r.injected]
        rows.append({"fault": " + ".join(k.name for k in kinds), "detectable": all(k.detectable for k in kinds),
                     "phases": len({r.when for r in came}), "runs": len(came), "recovered": sum(r.recovered for r in came),
                     "limit_ms": max(k.limit_ms for k in kinds), "worst_ms_to_good": round(max((r.ms_to_good for r in came), default=0.0), 3),
                     "worst_rows_lost": max((r.lost for r in came), default=0), "wrong_rows": sum(r.wrong for r in came),
                     "hangs": sum(bool(r.hang) for r in group), "resets": sum(r.resets for r in came),
                     "failed": sum(bool(r.failures()) for r in group), "never_came": len(group) - len(came)})
    return rows


def share_flagged(firmware, kind, name, stream, sigma, seconds):
    large, flagged = flagged_share(firmware, kind, stream, sigma, seconds)
    return {"fault": f"{kind.name}, {name}", "changes_of_8_sigma": large, "flagged": flagged, "good": flagged >= SHARE_FLAGGED * large}


def share_of_roll(firmware, what, faults, stream, seconds):
    differences, missing = roll_differences(firmware, [f"p:1e-3:{fault}" for fault in faults], stream, seconds)
    share = sum(d <= ROLL_CDEG for d in differences) / len(differences)
    return {"fault": what, "rows": len(differences), "rows_without_partner": missing, "share_within_half_degree": round(share, 6),
            "worst_cdeg": max(differences), "good": share >= SHARE_ROLL}


def shares(options):
    """Rows of what no firmware can see to be wrong, and of roll at one fault in a thousand samples; with whether each is within its limit."""
    seconds = 20 if options.sample else 300
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(share_flagged, options.fw, kind, name, stream, sigma, seconds) for kind in KINDS if not kind.detectable
                   for name, stream, sigma in (("at rest", REST, 2.0), ("moving", MOVING, 2.6))]
        waiting += [pool.submit(share_of_roll, options.fw, *run, 2 * seconds) for run in ROLL_RUNS]
        return [future.result() for future in waiting]


def tables(rows, extra):
    """The page's tables, as lines."""
    lines = ["| fault | phases | recovered | worst ms to a good row | limit | worst rows lost | wrong rows | resets not asked for | failed |",
             "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        if " + " in row["fault"]:
            continue
        wrong = row["wrong_rows"] if row["detectable"] else f"{row['wrong_rows']} (not detectable)"
        limit = row["limit_ms"] if row["limit_ms"] < NO_LIMIT else "-"
        lines.append(f"| {row['fault']} | {row['phases']} | {row['recovered']} of {row['runs']} | {row['worst_ms_to_good']:.1f} | "
                     f"{limit} | {row['worst_rows_lost']} | {wrong} | {row['resets']} | {row['failed']} |")
    pairs = [row for row in rows if " + " in row["fault"]]
    failing = [row for row in pairs if row["failed"]]
    lines += ["", f"Pairs: {len(pairs)} of them, {sum(r['runs'] for r in pairs)} runs, {sum(r['failed'] for r in pairs)} failed"
              + (": " + "; ".join(f"{r['fault']} ({r['failed']} of {r['runs']})" for r in failing[:40]) if failing else "") + ".", ""]
    lines += ["| values changed on their way | changes of 8 sigma or more | flagged | share |", "|---|---|---|---|"]
    lines += [f"| {r['fault']} | {r['changes_of_8_sigma']} | {r['flagged']} | {100 * r['flagged'] / max(1, r['changes_of_8_sigma']):.2f} % |"
              for r in extra if "flagged" in r]
    lines += ["", "| once in 1,000 samples | rows | roll within 0.5 degree of the run without faults | worst (degree) |", "|---|---|---|---|"]
    lines += [f"| {r['fault']} | {r['rows']} | {100 * r['share_within_half_degree']:.3f} % | {r['worst_cdeg'] / 100:.2f} |"
              for r in extra if "rows" in r]
    return lines


def tell_failures(results, most=12):
    """What fails and where, a few phases of each kind."""
    groups = collections.defaultdict(list)
    for result in results:
        if result.failures() or not result.injected:
            groups[" + ".join(k.name for k in result.kinds)].append(result)
    for name, group in groups.items():
        print(f"{name}: {len(group)} runs")
        for result in group[:most]:
            words = "; ".join(result.failures()) or "never came"
            print(f"    {result.when} {result.filter_name}: {words}    [{result.command}]")
        if len(group) > most:
            print(f"    and {len(group) - most} more")


def write_page(rows, extra):
    text = PAGE.read_text(encoding="utf-8")
    head, begin, rest = text.partition("<!-- table: make faults -->\n")
    _, end, tail = rest.partition("<!-- end -->")
    if not begin or not end:
        raise Fault(f"{PAGE} has no lines '<!-- table: make faults -->' and '<!-- end -->'")
    PAGE.write_text(head + begin + "\n".join(tables(rows, extra)) + "\n" + end + tail, encoding="utf-8")


def main():
    options = arguments()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    need(SIMRUN, "make build/sim/simrun")
    need(options.fw, f"make {options.fw}")
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="faults-programs-") as kept:
        # what is built anew meanwhile does not disturb
        options.fw = shutil.copy(options.fw, kept)
        faults_runs.SIMRUN = shutil.copy(SIMRUN, kept)
        return carried_out_and_told(options, began)


def carried_out_and_told(options, began):
    runs = planned(options)
    print(f"faults: {len(runs)} runs, seed {options.seed}, {options.jobs} at a time", flush=True)
    results = carried_out(options, runs)
    rows = summarised(results)
    whole = len(results) == len(runs)
    extra = shares(options) if whole and not options.words else []
    RESULTS.parent.mkdir(exist_ok=True)
    RESULTS.write_text(json.dumps(rows + extra, indent=1) + "\n", encoding="ascii")
    tell_failures(results)
    print("\n".join(tables(rows, extra)))
    if whole and not (options.words or options.sample or options.no_page):
        write_page(rows, extra)
    bad = sum(bool(r.failures()) for r in results) + sum(not r["good"] for r in extra)
    good = len(results) + len(extra) - bad
    absent = sum(not r.injected for r in results)
    print(f"faults: {time.monotonic() - began:.0f} s, {absent} faults never came; {RESULTS} written")
    print(f"{good - absent} passed, {bad} failed")
    return 1 if bad or not whole or absent > len(results) // 10 else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        sys.exit(f"faults: {problem}")
