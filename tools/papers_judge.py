"""Judging of make papers: accepted bands and verdicts, read from host_tests/papers/expected_*.csv."""
import csv
import fnmatch
import math
import re

FIELDS = ["experiment", "filter", "arithmetic", "metric", "low", "high", "published", "verdict", "reason"]
VERDICTS = ("", "reproduced", "not reproduced", "refuted", "not comparable")


class Fault(Exception):
    """One sentence about what is wrong."""


def read_expected(path):
    """Rows of FIELDS; experiment and filter are patterns (several words: any of them), arithmetic is double, fixed or both; a bound that
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
        if row["verdict"] not in VERDICTS or row["arithmetic"] not in ("double", "fixed", "both"):
            raise Fault(f"{path}:{number}: verdict '{row['verdict']}' or arithmetic '{row['arithmetic']}' is unknown")
        if bool(row["published"]) != bool(row["verdict"]) or (row["verdict"] and not row["reason"]):
            raise Fault(f"{path}:{number}: what is published has a verdict and a reason, and nothing else has a verdict")
        for bound in ("low", "high"):
            row[bound] = float(row[bound]) if row[bound] else None
        rows.append(row)
    if not rows:
        raise Fault(f"{path}: expects nothing")
    return rows


def published_range(text):
    """(low, high) of "30-40", of "~30" (10 % to either side) of a number with its tolerance "0.0867 +-5 %" and of a whole number; None for words."""
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
    found = re.match(r"(\d+)$", text)
    return (float(found.group(1)),) * 2 if found else None


def name_of(row):
    return f"{row['experiment']}, {row['filter']} ({row['arithmetic']}), {row['metric']}"


def fits(row, rule):
    return (any(fnmatch.fnmatchcase(row["experiment"], p) for p in rule["experiment"].split()) and
            any(fnmatch.fnmatchcase(row["filter"], p) for p in rule["filter"].split()) and
            rule["arithmetic"] in ("both", row["arithmetic"]) and row["metric"] == rule["metric"])


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


def judge_row(row, rule, full_runs=VERDICT_RUNS):
    """Sentences about what is wrong; the row gets its band and its verdict. full_runs: of the page, of which a verdict may hang."""
    value, faults = row["value"], []
    row["band"] = (rule["low"], rule["high"]) if (rule["low"], rule["high"]) != (None, None) else row.get("band")
    if math.isnan(value):
        faults.append(f"{name_of(row)} is not a number")
    if rule["low"] is not None and value < rule["low"]:
        faults.append(f"{name_of(row)} = {value:.6g}, below its band from {rule['low']:g} ({rule['line']})")
    if rule["high"] is not None and value > rule["high"]:
        faults.append(f"{name_of(row)} = {value:.6g}, above its band to {rule['high']:g} ({rule['line']})")
    if rule["published"]:
        row.update(published=rule["published"], verdict=rule["verdict"], reason=rule["reason"])
        limits = published_range(rule["published"])
        if rule["verdict"] == "not comparable":
            return faults
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
    """What is wrong. Each number against every rule that fits it; a rule that fits none is wrong unless only a part was run."""
    faults, claims = [], {}
    fixed = {row["filter"] for row in rows if row["arithmetic"] == "fixed" and "(" not in row["filter"]}  # with brackets: of one tuning
    for rule in expected:
        matched = {"double": set(), "fixed": set()}
        for row in rows:
            if fits(row, rule):
                target = row
                # the paper says it twice, and not the same
                if rule["published"] and row.get("verdict"):
                    target = dict(row)
                    claims.setdefault(id(row), []).append(target)
                faults += judge_row(target, rule, full_runs)
                matched[row["arithmetic"]].add(row["filter"])
        if partial:
            continue
        for name in rule["filter"].split():
            for arithmetic in ("double", "fixed") if rule["arithmetic"] == "both" else (rule["arithmetic"],):
                if not any(fnmatch.fnmatchcase(f, name) for f in matched[arithmetic]):
                    faults.append(f"{rule['line']}: no number for {rule['experiment']}, {name} ({arithmetic}), {rule['metric']}")
    if not partial:
        faults += unjudged(rows, fixed, wanted)
    rows[:] = [entry for row in rows for entry in (row, *claims.get(id(row), []))]
    return faults


def unjudged(rows, fixed, wanted=BANDED):
    """Every shipped filter but the yardstick has a limit on the wanted numbers: K_ef and coming back."""
    banded = {(row["filter"], row["metric"]) for row in rows if row["arithmetic"] == "fixed" and row.get("band")}
    return [f"{name} is in FILTER_LIST and {metric} of its fixed-point code has no band" for name in sorted(fixed - {"kf"})
            for metric in wanted if (name, metric) not in banded]
