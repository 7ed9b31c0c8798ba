"""What the tests of make papers share: rows of an experiment in small, and rows and rules that are made up."""
import copy
import types

import papers
import papers_judge

RUNS = {"000": 1000, "001": 1000, "002": 300, "003": 300, "004": 1600}  # 400 of paper 000, 200 of 001, six flights of 003
ROWS = {}


def rows_of(paper, experiment, runs=None, program=0):
    """Made once."""
    key = paper, experiment, runs or RUNS[paper], program
    if key not in ROWS:
        ROWS[key] = papers.run_one(papers.PAPERS[paper][0][program], experiment, types.SimpleNamespace(runs=key[2], seed=7))
    return copy.deepcopy(ROWS[key])


def expected(paper):
    return papers_judge.read_expected(papers.PAPERS[paper][1])


def faults_of(paper, rows):
    """What the judge says of a part of a paper's rows."""
    return papers_judge.judge(rows, expected(paper), True, papers.FULL_RUNS[paper], papers.WANTED[paper])


def value(rows, experiment, name, arithmetic, metric):
    found = [r["value"] for r in rows if (r["experiment"], r["filter"], r["arithmetic"], r["metric"]) == (experiment, name, arithmetic, metric)]
    assert len(found) == 1, f"{experiment}, {name} ({arithmetic}), {metric}: {len(found)} rows"
    return found[0]


def within(low, number, high, what):
    assert low <= number <= high, f"{what} = {number:g}, not within {low:g} .. {high:g}"


def made(**changes):
    """A row."""
    return {"experiment": "e", "filter": "f", "arithmetic": "double", "metric": "m", "value": 35.0, "ci_lo": 34.0, "ci_hi": 36.0, "runs": 1,
            **changes}


def rule(**changes):
    """A line of the accepted bands."""
    whole = {"experiment": "e", "filter": "f", "arithmetic": "double", "metric": "m", "low": "", "high": "", "published": "", "takes": "",
             "reason": "", "line": "expected:1", **changes}
    return {**whole, "low": str(whole["low"]), "high": str(whole["high"])}


def changed_are_found(paper, rows, arithmetic, changes):
    """Each (filter, metric, factor) makes a number that the judge names; the rows as they are have no fault."""
    assert faults_of(paper, copy.deepcopy(rows)) == []
    for name, metric, factor in changes:
        changed = copy.deepcopy(rows)
        row = next(r for r in changed if (r["filter"], r["metric"], r["arithmetic"]) == (name, metric, arithmetic))
        row["value"] *= factor
        assert any(fault.startswith(papers_judge.name_of(row)) for fault in faults_of(paper, changed)), papers_judge.name_of(row)
