"""The verdict of make papers, computed here and nowhere else, from a number, its interval and the row's rule; nobody types one.

What a paper prints, and how it is to be taken, stands in two columns of host_tests/papers/expected_*.csv: `published` and `takes`. From them
rule_of() makes the rule that the results pages show, with its numbers:

    takes                rule shown              the number is judged by
    (empty)              20 to 85                the printed range, or a printed number within half a unit of its last digit
    own numbers          own: 1.05 to 1.07       the same, of a number that the paper's own numbers give without chance
    <= BOUND, >= BOUND   <= 0.82                 a claim in words, as a limit
    order <= BOUND       order: <= 0.82          a claim that one choice is better than another
    other things         other things            nothing: other things are counted, or the paper has no such case
"""
import math
import re

REPRODUCED, SPREAD, NOT_REPRODUCED, REFUTED, NOT_COMPARABLE = VERDICTS = (
    "reproduced", "reproduced within the spread", "not reproduced", "refuted", "not comparable")
OTHER, OWN, ORDER = "other things", "own numbers", "order "
FAR = 10.0  # times beyond what is printed: refuted
LEAST_SHARE = 1 / 10  # of experiments of the paper's size, within what is printed: within the spread. At 1 / 20 two rows hang on the seed
TAKES = re.compile(r"(?:|own numbers|other things|(order )?(<=|>=) (.+))$")
SHOWN = re.compile(r"(?:(own): )?(\S+) to (\S+)$|(?:(order): )?(<=|>=) (\S+)$")
NUMBER = r"(-?\d+(?:\.\d+)?)"


def half(text):
    """A unit of the last digit, a zero too, halved: of 30 it is 0.5."""
    return 0.5 * 10.0 ** -len(text.partition(".")[2])


def about(low, high=None):
    high = high or low
    return float(low) - half(low), float(high) + half(high)


FORMS = ((rf"{NUMBER}-(\d+(?:\.\d+)?)$", lambda low, high: (float(low), float(high))), (rf"~{NUMBER}(?:-(\d+(?:\.\d+)?))?$", about),
         (rf"{NUMBER} \+-(\d+(?:\.\d+)?)$", lambda x, width: (float(x) - float(width), float(x) + float(width))),
         (rf"< {NUMBER}$", lambda x: (-math.inf, float(x))), (r"(-?\d+\.\d+)$", about),
         (r"(\d+) degrees?$", lambda x: (float(x) - 0.5, float(x) + 0.5)), (r"(\d+)$", lambda x: (float(x), float(x))))


def published_range(text):
    """(low, high) of "30-40", "~30", "~60-80" and "0.37" (half a unit of the last digit to either side), "6 degrees" (likewise), "0 +-0.05", "< 2",
    and a count, exactly; None for words."""
    for pattern, limits in FORMS:
        found = re.match(pattern, text)
        if found:
            return limits(*found.groups())
    return None


def rule_of(published, takes, bound):
    """The rule as the page shows it; bound gives the value of a bound as typed."""
    if takes == OTHER:
        return OTHER
    limit = TAKES.match(takes)
    if limit[2]:
        return f"{'order: ' if limit[1] else ''}{limit[2]} {bound(limit[3]):.6g}"
    low, high = published_range(published)
    return f"<= {high:.6g}" if low == -math.inf else f"{'own: ' if takes == OWN else ''}{low:.8g} to {high:.8g}"


def limits_of(rule):
    """(kind: own, order or none; low; high) of a rule as shown."""
    own, low, high, order, sign, bound = SHOWN.match(rule).groups()
    if low is not None:
        return own, float(low), float(high)
    return (order, -math.inf, float(bound)) if sign == "<=" else (order, float(bound), math.inf)


def beyond(value, low, high):
    """Ten times off to either side; of a limit of zero everything is."""
    return (value > FAR * high >= 0) or (low > 0 and FAR * value < low)


def share_within(rule, sample):
    """Of experiments of the paper's size, those whose number is within a rule as shown."""
    _, low, high = limits_of(rule)
    return sum(low <= value <= high for value in sample) / len(sample)


def verdict(rule, value, ci_lo=None, ci_hi=None, share=None):
    """Of a number, its interval where it has one, and the share of experiments where it is one of many, by a rule as shown. An interval between two
    peaks reaches into what no experiment gives: where there are experiments, they decide."""
    if rule == OTHER:
        return NOT_COMPARABLE
    kind, low, high = limits_of(rule)
    if low <= value <= high:
        return REPRODUCED
    least, most = (value, value) if ci_lo is None else (ci_lo, ci_hi)
    if (least <= high and most >= low) if share is None else share >= LEAST_SHARE:
        return SPREAD
    return REFUTED if kind or beyond(value, low, high) else NOT_REPRODUCED
