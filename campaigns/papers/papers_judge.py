"""Judging of make papers: accepted bands and verdicts, read from host_tests/papers/expected_*.csv.

A bound is a number, or `F x REF`: F times another number of the same run (papers_bands.py); `+ 3 se` after a limit allows for chance. A
`high` of `+-4 se` or `+-0.1 %` (or a sum of such) is a width about `low`. A claim in words has in place of its verdict the limits that make
it one:
`reproduced <= BOUND; refuted >= BOUND`; between them it is not reproduced.
"""
import csv
import fnmatch
import math
import re

from papers_bands import BOUND_RULES, Fault, Rows, band_of, faulty_cells, limit_of, too_wide, verdict_by
from laws import PLAIN

FIELDS = ["experiment", "filter", "arithmetic", "metric", "low", "high", "published", "verdict", "reason"]
ARITHMETICS = ("double", "float", "fixed")
BOTH = ("double", "fixed")
VERDICTS = ("", "reproduced", "not reproduced", "refuted", "not comparable")


def read_expected(path):
    """Rows of FIELDS; experiment and filter are patterns (several words: any of them), arithmetic is double, float, fixed or both, which is double
    and fixed; a bound that
    is empty does not bind."""
    rows = []
    with open(path, encoding="utf-8", newline="") as file:
        lines = [(n, line) for n, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
    for (number, line), cells in zip(lines, csv.reader(line for _, line in lines)):
        if cells == FIELDS:
            continue
        if len(cells) != len(FIELDS):
            raise Fault(f"{path}:{number}: {len(cells)} fields, wanted {','.join(FIELDS)}")
        row = dict(zip(FIELDS, cells), line=f"{path}:{number}", matched=0)
        if (row["verdict"] not in VERDICTS and not BOUND_RULES.match(row["verdict"])) or row["arithmetic"] not in (*ARITHMETICS, "both"):
            raise Fault(f"{path}:{number}: verdict '{row['verdict']}' or arithmetic '{row['arithmetic']}' is unknown")
        if bool(row["published"]) != bool(row["verdict"]) or (row["verdict"] and not row["reason"]):
            raise Fault(f"{path}:{number}: what is published has a verdict and a reason, and nothing else has a verdict")
        for text in faulty_cells(row):
            raise Fault(f"{path}:{number}: {text}")
        words = row["published"] and published_range(row["published"]) is None
        if words and row["verdict"] != "not comparable" and not BOUND_RULES.match(row["verdict"]):
            raise Fault(f"{path}:{number}: a claim in words needs limits for its verdict, 'reproduced <= BOUND; refuted >= BOUND'")
        rows.append(row)
    if not rows:
        raise Fault(f"{path}: expects nothing")
    return rows


def published_range(text):
    """(low, high) of "30-40", of "~30" (10 % to either side) of a number with its tolerance "0.0867 +-5 %", of "< 2" and of a whole
    number; None for words."""
    found = re.match(r"(\d+(?:\.\d+)?)-(\d+(?:\.\d+)?)$", text)
    if found:
        return float(found.group(1)), float(found.group(2))
    found = re.match(r"~(\d+(?:\.\d+)?)$", text)
    if found:
        return 0.9 * float(found.group(1)), 1.1 * float(found.group(1))
    found = re.match(r"(\d+(?:\.\d+)?) \+-(\d+(?:\.\d+)?) %$", text)
    if found:
        middle, part = float(found.group(1)), float(found.group(2)) / 100
        return middle * (1 - part), middle * (1 + part)
    found = re.match(r"< (\d+(?:\.\d+)?)$", text)
    if found:
        return -math.inf, float(found.group(1))
    found = re.match(r"(\d+)$", text)
    return (float(found.group(1)),) * 2 if found else None


def name_of(row):
    return f"{row['experiment']}, {row['filter']} ({row['arithmetic']}), {row['metric']}"


def arithmetics_of(rule):
    return BOTH if rule["arithmetic"] == "both" else (rule["arithmetic"],)


def fits(row, rule):
    return (any(fnmatch.fnmatchcase(row["experiment"], p) for p in rule["experiment"].split()) and
            any(fnmatch.fnmatchcase(row["filter"], p) for p in rule["filter"].split()) and
            row["arithmetic"] in arithmetics_of(rule) and row["metric"] == rule["metric"])


VERDICT_RUNS = 10000
BANDED = ("k_ef_steady", "not_back")  # of each shipped filter, in paper 002


def agrees(row, limits):
    """The measured number, or its interval, meets the published range."""
    low = row["value"] if row.get("ci_lo") is None else row["ci_lo"]
    high = row["value"] if row.get("ci_hi") is None else row["ci_hi"]
    # the spread of groups of 50 runs is not an uncertainty of their median
    if row["metric"].endswith("of_50"):
        low = high = row["value"]
    return low <= limits[1] and high >= limits[0]


def judge_row(row, rule, full_runs=VERDICT_RUNS, rows=None):
    """Sentences about what is wrong; the row gets its band and its verdict. full_runs: of the page, of which a verdict may hang; rows: of
    the same run, which bounds may name."""
    value, faults, rows = row["value"], [], rows or Rows([row])
    low, high = band_of(rule, row, rows, 1 < row["runs"] < full_runs)
    if (low, high) != (None, None):
        row.update(band=(low, high), limit=limit_of(rule, row, rows))
    if math.isnan(value):
        faults.append(f"{name_of(row)} is not a number")
    if low is not None and value < low:
        faults.append(f"{name_of(row)} = {value:.6g}, below its band from {low:g} ({rule['line']})")
    if high is not None and value > high:
        faults.append(f"{name_of(row)} = {value:.6g}, above its band to {high:g} ({rule['line']})")
    if not rule["published"]:
        return faults
    if BOUND_RULES.match(rule["verdict"]):
        row.update(published=rule["published"], verdict=verdict_by(rule, row, rows), reason=rule["reason"])
        return faults
    row.update(published=rule["published"], verdict=rule["verdict"], reason=rule["reason"])
    return faults + ([] if rule["verdict"] == "not comparable" else wrong_verdict(row, rule, full_runs))


def wrong_verdict(row, rule, full_runs):
    """A verdict beside a published number that the measured one gainsays."""
    value, faults, limits = row["value"], [], published_range(rule["published"])
    # of fewer runs the interval is so wide that it may meet what the number does not
    undecided = 1 < row["runs"] < full_runs and limits and agrees(row, limits)
    if limits and not undecided and agrees(row, limits) != (rule["verdict"] == "reproduced"):
        seen = "meets" if agrees(row, limits) else "does not meet"
        faults.append(f"{name_of(row)} = {value:.6g} {seen} the published {rule['published']}, "
                      f"so it cannot be '{rule['verdict']}' ({rule['line']})")
    # the page's word for K_ef: refuted is ten times off and more
    far = limits and row["metric"].startswith("k_ef") and 10 * value < limits[0]
    if limits and row["metric"].startswith("k_ef") and rule["verdict"] != "reproduced" and bool(far) != (rule["verdict"] == "refuted"):
        faults.append(f"{name_of(row)} = {value:.6g} is {'' if far else 'not '}ten times below the published {rule['published']}, "
                      f"so it cannot be '{rule['verdict']}' ({rule['line']})")
    return faults


def judge(rows, expected, partial=False, full_runs=VERDICT_RUNS, wanted=BANDED):
    """What is wrong. Each number against every rule that fits it; a rule that fits none is wrong unless only a part was run. The bands of papers
    000 and 001 are not wider than four standard errors (those of 002 are of issue 4, by groups of runs)."""
    strict = wanted is not BANDED
    faults, claims, of_run = [], {}, Rows(rows)
    fixed = {row["filter"] for row in rows if row["arithmetic"] == "fixed" and "(" not in row["filter"]}  # with brackets: of one tuning
    for rule in expected:
        matched = {arithmetic: set() for arithmetic in ARITHMETICS}
        for row in rows:
            if fits(row, rule):
                target = row
                # the paper says it twice, and not the same
                if rule["published"] and row.get("verdict"):
                    target = dict(row)
                    claims.setdefault(id(row), []).append(target)
                try:
                    faults += judge_row(target, rule, full_runs, of_run)
                    wide = too_wide(rule, target, of_run) if strict else None
                except Fault as fault:  # a bound of another experiment, which a part may lack
                    faults += [] if partial else [str(fault)]
                    continue
                faults += [f"{name_of(row)}: its band is {wide} wide ({rule['line']})"] if wide else []
                matched[row["arithmetic"]].add(row["filter"])
        if partial:
            continue
        for name in rule["filter"].split():
            for arithmetic in arithmetics_of(rule):
                if not any(fnmatch.fnmatchcase(f, name) for f in matched[arithmetic]):
                    faults.append(f"{rule['line']}: no number for {rule['experiment']}, {name} ({arithmetic}), {rule['metric']}")
    if not partial:
        faults += unjudged(rows, fixed, wanted)
    rows[:] = [entry for row in rows for entry in (row, *claims.get(id(row), []))]
    return faults


def unjudged(rows, fixed, wanted=BANDED):
    """Every shipped filter but the yardstick has a limit on the wanted numbers: K_ef and coming back."""
    banded = {(row["filter"], row["metric"]) for row in rows if row["arithmetic"] == "fixed" and row.get("band")}
    return [f"{name} is in FILTER_LIST and {metric} of its fixed-point code has no band" for name in sorted(fixed - {PLAIN})
            for metric in wanted if (name, metric) not in banded]
