"""Bands of make papers as host_tests/papers/expected_*.csv states them: numbers, other numbers of the same run, widths in standard errors."""
import re

from page_sources import Fault
from papers_verdict import TAKES

REF = r"(?:@\w+|#\S+|[\w(][\w().:=-]*)"
BOUND = re.compile(rf"(?:(-?\d+(?:\.\d+)?(?:e-?\d+)?)|(?:(\d+(?:\.\d+)?) x )?({REF}))(?: \+ (\d) se)?$")
PART = re.compile(r"(\d+(?:\.\d+)?(?:e-?\d+)?)( se| %)?$")
SE_MOST = 4  # of a thousand numbers one leaves four standard errors once in sixteen seeds
NORMAL_95 = 1.959964


class Rows:
    """The numbers of one run, by what they are."""

    def __init__(self, rows):
        self.values = {(r["experiment"], r["filter"], r["arithmetic"], r["metric"]): r["value"] for r in rows}

    def find(self, row, ref, line):
        """What ref means for a row: `exact` is the same filter's number without chance, `@METRIC` another number of it, `#EXPERIMENT` its
        number there, a name another filter's (in double where that is all there is)."""
        experiment, name, metric = row["experiment"], row["filter"], row["metric"]
        if ref == "exact":
            metric = f"exact_{metric}"
        elif ref.startswith("@"):
            metric = ref[1:]
        elif ref.startswith("#"):
            experiment = ref[1:]
        else:
            name = ref
        for arithmetic in (row["arithmetic"], "double"):
            if (experiment, name, arithmetic, metric) in self.values:
                return self.values[experiment, name, arithmetic, metric]
        raise Fault(f"{line}: this run has no number for {experiment}, {name} ({row['arithmetic']}), {metric}")


def bound_value(text, row, rows, line):
    number, factor, ref, _ = BOUND.match(text).groups()
    return float(number) if number else float(factor or 1) * rows.find(row, ref, line)


def allowance(text, row, few):
    """What chance may put beyond a limit: `0.64 + 3 se` says it; of fewer runs than the page's it is four standard errors."""
    errors = SE_MOST if few else int(BOUND.match(text)[4] or 0)
    return errors * (standard_error(row) or 0)


def standard_error(row):
    return None if row.get("ci_lo") is None else (row["ci_hi"] - row["ci_lo"]) / (2 * NORMAL_95)


def parts_of(text):
    """[(number as typed, unit)] of a width "+-0.2 % +-4 se"; None for what is none."""
    found = [PART.match(part) for part in re.split(r"\s*\+-", text.strip())[1:]] if text.startswith("+-") else [None]
    return None if None in found else [(part[1], (part[2] or "").strip()) for part in found]


def width_of(text, centre, row, line):
    total = 0.0
    for number, unit in parts_of(text):
        error = standard_error(row) if unit == "se" else None
        if unit == "se" and error is None:
            raise Fault(f"{line}: {row['experiment']}, {row['filter']}, {row['metric']} has no standard error")
        total += float(number) * (error if unit == "se" else abs(centre) / 100 if unit == "%" else 1)
    return total


def limit_of(rule, row, rows):
    """What a one-sided rule says, without what chance may put beyond it."""
    return bound_value(rule["high"], row, rows, rule["line"]) if rule["high"] and not rule["high"].startswith("+-") else None


def band_of(rule, row, rows, few=False):
    """(low, high) of a rule for a row; None for what does not bind. few: fewer runs than the page's."""
    low = bound_value(rule["low"], row, rows, rule["line"]) if rule["low"] else None
    if rule["high"].startswith("+-"):
        width = width_of(rule["high"], low, row, rule["line"])
        width += allowance("0", row, few) if " se" not in rule["high"] else 0
        return low - width, low + width
    high = limit_of(rule, row, rows)
    if None in (low, high) or few:  # one limit, or limits met by what is known less well
        low = None if low is None else low - allowance(rule["low"], row, few)
        high = None if high is None else high + allowance(rule["high"], row, few)
    return low, high


def faulty_cells(rule):
    """Sentences about bounds that cannot be read."""
    low, high = rule["low"], rule["high"]
    if low and not BOUND.match(low):
        yield f"'{low}' is no bound"
    if high.startswith("+-") and (parts_of(high) is None or not low):
        yield f"'{high}' is no width about '{low}'"
    if high and not high.startswith("+-") and not BOUND.match(high):
        yield f"'{high}' is no bound"
    takes = TAKES.match(rule["takes"])
    if takes and takes[3] and not BOUND.match(takes[3]):
        yield f"'{takes[3]}' is no bound"


def unreasoned(rule):
    """Why a band is wider than its row says; None for one that is not. What is typed stands in the reason: a number of the issue, of a paper's
    table or of a closed form, with how exact it is. What the run itself gives, exact values and standard errors, needs no reason."""
    typed = []
    if rule["high"].startswith("+-"):
        for number, unit in parts_of(rule["high"]):
            if unit == "se" and float(number) > SE_MOST:
                return f"{number} standard errors, {SE_MOST} at most"
            typed += [] if unit == "se" else [f"{number} {unit}".strip()]
    else:
        cells = [cell for cell in (rule["low"], rule["high"]) if cell]
        exact = len(cells) == 2 and cells[0] == cells[1]
        typed += [] if exact else [BOUND.match(cell)[1] or (f"{BOUND.match(cell)[2]}" if BOUND.match(cell)[2] else "") for cell in cells]
    missing = [text for text in typed if text and not re.search(rf"(?<![\d.]){re.escape(text)}(?!\.?\d)", rule["reason"])]
    return f"the reason does not say {' and '.join(missing)}" if missing else None


def too_wide(rule, row, rows):
    """Of a number with chance: how many of its standard errors its band is wide, when that is more than four and neither the issue asks for it
    nor the bounds are two statements about other numbers of the run; else None."""
    low, high = band_of(rule, row, rows)
    error = standard_error(row)
    related = not rule["high"].startswith("+-") and any(BOUND.match(cell)[3] for cell in (rule["low"], rule["high"]) if cell)
    if None in (low, high) or not error or related or "issue" in rule["reason"]:
        return None
    return f"{(high - low) / 2 / error:.1f} standard errors" if (high - low) / 2 > (SE_MOST + 0.01) * error else None
