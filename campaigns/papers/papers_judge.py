"""Judging of make papers: accepted bands and what is printed, read from host_tests/papers/expected_*.csv; verdicts: papers_verdict.py.

A bound is a number, or `F x REF`: F times another number of the same run (papers_bands.py); `+ 3 se` after a limit allows for chance. A
`high` of `+-4 se` or `+-0.1 %` (or a sum of such) is a width about `low`.
"""
import csv
import fnmatch
import math

from laws import PLAIN
from papers_bands import Fault, Rows, band_of, bound_value, faulty_cells, limit_of, too_wide
from papers_verdict import OTHER, TAKES, published_range, rule_of, share_within, verdict

FIELDS = ["experiment", "filter", "arithmetic", "metric", "low", "high", "published", "takes", "reason"]
ARITHMETICS = ("double", "float", "fixed")
BOTH = ("double", "fixed")


def read_expected(path):
    """Rows of FIELDS; experiment and filter are patterns (several words: any of them), arithmetic is double, float, fixed or both, which is double
    and fixed; a bound that is empty does not bind."""
    rows = []
    with open(path, encoding="utf-8", newline="") as file:
        lines = [(n, line) for n, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
    for (number, line), cells in zip(lines, csv.reader(line for _, line in lines)):
        if cells == FIELDS:
            continue
        if len(cells) != len(FIELDS):
            raise Fault(f"{path}:{number}: {len(cells)} fields, wanted {','.join(FIELDS)}")
        row = dict(zip(FIELDS, cells), line=f"{path}:{number}", matched=0)
        if not TAKES.match(row["takes"]) or row["arithmetic"] not in (*ARITHMETICS, "both"):
            raise Fault(f"{path}:{number}: takes '{row['takes']}' or arithmetic '{row['arithmetic']}' is unknown")
        if bool(row["published"]) < bool(row["takes"]) or (row["published"] and not row["reason"]):
            raise Fault(f"{path}:{number}: what is published has a reason, and nothing else takes a verdict")
        for text in faulty_cells(row):
            raise Fault(f"{path}:{number}: {text}")
        needs_range = row["published"] and row["takes"] != OTHER and not TAKES.match(row["takes"])[2]
        if needs_range and published_range(row["published"]) is None:
            raise Fault(f"{path}:{number}: a claim in words needs a limit, '<= BOUND' or 'order <= BOUND'")
        rows.append(row)
    if not rows:
        raise Fault(f"{path}: expects nothing")
    return rows


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


def judge_row(row, rule, full_runs=VERDICT_RUNS, rows=None):
    """Sentences about what is wrong; the row gets its band and its verdict. full_runs: of the page; rows: of the same run, which bounds may
    name."""
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
    if rule["published"]:
        shown = rule_of(rule["published"], rule["takes"], lambda text: bound_value(text, row, rows, rule["line"]))
        share = share_within(shown, row["sample"]) if row.get("sample") and shown != OTHER else None
        row.update(published=rule["published"], rule=shown, share=share, reason=rule["reason"],
                   verdict=verdict(shown, value, row.get("ci_lo"), row.get("ci_hi"), share))
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
