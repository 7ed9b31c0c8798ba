#!/usr/bin/env python3
"""The fault campaign: every fault of simrun at every bus byte, main-loop stage and moment, every pair of faults, every
command under a fault, judged by the model.

    faults.py [--fw ELF] [--sample N] [--pairs N] [--jobs N] [--seed N] [--no-page] [WORD...]

WORDs: only kinds whose name begins with one of them; A+B: the pairs of two such kinds; no word: all. --sample: so many runs in all,
chosen by the seed. Results go into build/faults.json, those of a whole campaign into docs/results/faults-campaign.md too, what
fails to stdout. Exit status 1 when anything is above its limit.
"""
import argparse
import collections
import concurrent.futures
import itertools
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import coverage
import faults_commands
import faults_judge
import faults_runs
import images
import page_faults
import page_sources
from faults_kinds import KINDS, LONG, MOVING, OF, REST, TYPED, rated
from faults_runs import (Fault, SIMRUN, attempt, ended_by_signal, flagged_share, moments, need, phases, roll_differences, seeded_pairs, simulate,
                         write_whole)
from laws import DEFAULT, LIGHT

RESULTS = pathlib.Path("build/faults.json")
PHASES, MOMENTS, FILTERS = faults_judge.PHASES_AT_LEAST, 8, (DEFAULT, LIGHT)
SHARE_FLAGGED, SHARE_ROLL, ROLL_CDEG = 0.99, 0.999, 50
# a share of less is none; and of the rows of the run without faults, so many may have no partner in the run with them
LARGE_AT_LEAST, MISSING_MOST = 100, 0.01
FLAGGED_S = 400  # of single flipped bits, one in three changes a value by so much
# what it changes is never large: the rest of a sample is of the one before, 10 ms older, and no stream moves by 8 sigma in that time
NEVER_LARGE = ("mixed",)
# (what, faults, stream): once in a thousand samples
ROLL_RUNS = [("bad reads, at rest", ["arb", "nack", "buserr", "torn"], REST), ("bad reads, moving", ["arb", "nack", "buserr", "torn"], MOVING),
             ("bit flips, at rest", ["flip:1"], REST), ("bit flips, moving", ["flip:1"], MOVING)]


class Parser(argparse.ArgumentParser):
    def error(self, message):
        sys.exit(f"faults: {message}")


def arguments():
    parser = Parser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--fw", default="build/uno/firmware.elf")
    parser.add_argument("--sample", type=int)
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-page", action="store_true")
    parser.add_argument("words", nargs="*")
    options = parser.parse_args()
    if options.sample is not None and options.sample < 1 or options.pairs < 0 or options.jobs < 1:
        sys.exit("faults: --sample and --jobs want 1 or more, --pairs 0 or more")
    return options


def wanted(words, *kinds):
    """Whether a word asks for a kind, or a word A+B for a pair."""
    names = [kind.name for kind in kinds]
    return not words or any(len(begins) == len(names) and any(all(map(str.startswith, order, begins)) for order in (names, names[::-1]))
                            for begins in (word.split("+") for word in words))


def check_words(words):
    """Ends the program at a word that asks for nothing."""
    kinds = KINDS + LONG + rated() + TYPED + faults_commands.KINDS
    for word in words:
        if any(wanted([word], kind) for kind in kinds) or any(wanted([word], a, b) for a, b in itertools.combinations(KINDS, 2)):
            continue
        begins = word.split("+")
        unknown = [begin for begin in begins if not any(wanted([begin], kind) for kind in kinds)]
        if unknown:
            sys.exit(f"faults: {word}: no kind begins with {unknown[0]}; there are: {', '.join(OF)}")
        sys.exit(f"faults: {word}: " + ("no kind makes a pair with itself: name two" if len(begins) == 2 else "a pair is A+B, of two kinds"))


def planned(options):
    """[(kinds, whens, filter)] of the campaign."""
    kinds = [kind for kind in KINDS if wanted(options.words, kind)]
    others = [kind for kind in rated() + TYPED + LONG if wanted(options.words, kind)]
    singles = [((kind,), (when,), name) for kind in kinds for name in FILTERS for when in phases(options.fw, kind, name, PHASES)]
    singles += [((kind,), (when,), kind.filter_name) for kind in others for when in moments(kind, MOMENTS, options.seed)]
    singles += [((kind,), (when,), kind.filter_name) for kind in faults_commands.KINDS if wanted(options.words, kind)
                for when in faults_commands.phases(options.fw, kind, options.seed)]
    pairs = [(kinds, whens, FILTERS[0]) for kinds, whens in seeded_pairs(options.pairs, options.seed) if wanted(options.words, *kinds)]
    if not singles and not pairs:
        sys.exit(f"faults: {' '.join(options.words)}: no run of a pair with --pairs 0")
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


def side_by_side(jobs, calls, take):
    """take() receives what each of the calls (function, arguments) gives, in their order; so many run at a time."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        try:
            for future in [pool.submit(*call) for call in calls]:
                take(future.result())
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            faults_runs.end_runs()
            raise


def carried_out(options, runs, profile, results):
    """Adds the results in the order of the plan, with a line of progress every ten seconds; profile: receives the addresses that ran."""
    told = time.monotonic()

    def take_and_tell(result):
        nonlocal told
        results.append(result)
        if time.monotonic() - told > 10:
            told = time.monotonic()
            print(f"  {len(results)} of {len(runs)} runs, {sum(bool(r.failures()) for r in results)} failed", flush=True)

    side_by_side(options.jobs, [(attempt, options.fw, name, kinds, whens, profile) for kinds, whens, name in runs], take_and_tell)


def group_of(kinds):
    if len(kinds) > 1:
        return "pair"
    if kinds[0].command:
        return "command"
    return "rate" if kinds[0].base else "typed" if kinds[0] in TYPED else "long" if kinds[0] in LONG else "single"


def summarised(results):
    """A row of build/faults.json per kind or pair."""
    groups = collections.defaultdict(list)
    for result in results:
        groups[result.kinds].append(result)
    rows = []
    for kinds, group in groups.items():
        came = [r for r in group if r.injected]
        rows.append({"fault": " + ".join(k.name for k in kinds), "group": group_of(kinds), "detectable": all(k.detectable for k in kinds),
                     "phases": len({r.when for r in came}), "runs": len(came), "recovered": sum(r.recovered for r in came),
                     "limit_ms": max(k.limit_ms for k in kinds), "worst_ms_to_good": round(max((r.ms_to_good for r in came), default=0.0), 3),
                     "worst_rows_lost": max((r.lost for r in came if r.lost is not None), default=None),
                     "longest_pass_cycles": max((r.pass_cycles for r in came), default=0),
                     "worst_calm_gap_ms": round(max((r.calm_gap_ms for r in came), default=0.0), 3), "wrong_rows": sum(r.wrong for r in came),
                     "hangs": sum(bool(r.hang) for r in group), "wrong_resets": sum(r.wrong_resets() for r in came),
                     "failed": sum(bool(r.failures()) for r in group), "never_came": len(group) - len(came)})
    return rows


def share_flagged(firmware, kind, name, stream, sigma, seconds):
    large, flagged = flagged_share(firmware, kind, stream, sigma, seconds)
    return {"fault": f"{kind.name}, {name}", "changes_of_8_sigma": large, "flagged": flagged,
            "good": large >= LARGE_AT_LEAST and flagged >= SHARE_FLAGGED * large}


def share_of_roll(firmware, what, faults, stream, seconds):
    differences, missing = roll_differences(firmware, [f"p:1e-3:{fault}" for fault in faults], stream, seconds)
    share = sum(d <= ROLL_CDEG for d in differences) / len(differences)
    return {"fault": what, "rows": len(differences), "rows_without_partner": missing, "share_within_half_degree": round(share, 6),
            "worst_cdeg": max(differences), "good": share >= SHARE_ROLL and missing <= MISSING_MOST * (len(differences) + missing)}


def share(function, firmware, what, *more):
    """What function gives; one that dies is a failure of its own."""
    try:
        return function(firmware, what, *more)
    except Exception as problem:
        return {"fault": str(getattr(what, "name", what)), "died": f"{type(problem).__name__}: {str(problem)[:200]}", "good": False}


def shares(options, extra):
    """Adds rows of what no firmware can see to be wrong, and of roll at one fault in a thousand samples; with whether each is within its limit."""
    seconds = 20 if options.sample else 300
    calls = [(share, share_flagged, options.fw, kind, name, stream, sigma, FLAGGED_S) for kind in KINDS
             if not kind.detectable and kind.name not in NEVER_LARGE for name, stream, sigma in (("at rest", REST, 2.0), ("moving", MOVING, 2.6))]
    side_by_side(options.jobs, calls + [(share, share_of_roll, options.fw, *run, 2 * seconds) for run in ROLL_RUNS], extra.append)


def lines_that_ran(options, profile):
    """The row of the lines of the AVR binary that the campaign's runs have executed."""
    executed, whole, missed = coverage.campaign_lines(options.fw, {int(address, 16) for address in profile})
    print("\n".join(["lines of the AVR binary that no run reaches:", *(f"    {line}" for line in missed)]))
    return {"fault": "lines of the AVR binary", "lines": whole, "lines_executed": executed, "good": executed >= coverage.CAMPAIGN_LINES / 100 * whole}


def tell_failures(results, extra, lacking, most=12):
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
    for row in extra:
        if not row["good"]:
            print(f"faults: {row['fault']}: " + (row.get("died") or "not within its limit: " + ", ".join(
                f"{key} {value}" for key, value in row.items() if key not in ("fault", "good"))))
    for sentence in lacking:
        print(f"faults: {sentence}")


def main():
    options = arguments()
    check_words(options.words)
    for each in (signal.SIGTERM, signal.SIGINT):
        signal.signal(each, ended_by_signal)
    need(SIMRUN, "make build/sim/simrun")
    need(options.fw, f"make {options.fw}")
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="faults-programs-") as kept:
        # what is built anew meanwhile does not disturb
        firmware, options.fw = options.fw, images.copied(options.fw, kept)
        faults_runs.SIMRUN = shutil.copy(SIMRUN, kept)
        if not simulate(options.fw, None, max_ms=1000)[2]["rows"]:
            raise Fault(f"{firmware} gives no row in a second: is it the firmware?")
        return carried_out_and_told(options, began)


def carried_out_and_told(options, began):
    runs, results, extra, profile = [], [], [], set()
    sources = page_sources.hash_now(page_faults.DOCUMENT)
    complete = not (options.words or options.sample)
    try:
        runs += planned(options)
        print(f"faults: {len(runs)} runs, seed {options.seed}, {options.jobs} at a time", flush=True)
        carried_out(options, runs, profile, results)
        if not options.words:
            shares(options, extra)
        extra += [lines_that_ran(options, profile)] if complete else []
        ended = False
    except KeyboardInterrupt:
        print(f"faults: ended by a signal after {len(results)} of {len(runs) or '?'} runs", flush=True)
        ended = True
    rows = summarised(results)
    lacking = faults_judge.shortfalls(rows, KINDS, LONG, faults_commands.KINDS) if complete and not ended else []
    absent = sum(not r.injected and not r.failures() for r in results)
    lacking += [f"{absent} of {len(results)} faults never came: more than one in ten"] if absent > len(results) // 10 else []
    RESULTS.parent.mkdir(exist_ok=True)
    write_whole(RESULTS, json.dumps(rows + extra, indent=1) + "\n")
    tell_failures(results, extra, lacking)
    print("\n".join(page_faults.tables(rows, extra)))
    if complete and not ended and not options.no_page:
        page_faults.write(rows, extra, sources)
    bad = sum(bool(r.failures()) for r in results) + sum(not r["good"] for r in extra) + len(lacking)
    good = sum(r.injected and not r.failures() for r in results) + sum(r["good"] for r in extra)
    print(f"faults: {time.monotonic() - began:.0f} s, {absent} faults never came; {RESULTS} written")
    print(f"{good} passed, {bad} failed")
    return 1 if bad or ended else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        sys.exit(f"faults: {problem}")
