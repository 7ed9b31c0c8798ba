"""The verdict of make papers, computed here and nowhere else, from a number, its interval and the row's rule; nobody types one.

What a paper prints, and how it is to be taken, stands in two columns of host_tests/papers/expected_*.csv: `published` and `takes`. From them
rule_of() makes the rule that the results pages show, with its numbers:

    takes                rule shown              the number is judged by
    (empty)              20 to 85                the printed range, or a printed number with its tolerance
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
TAKES = re.compile(r"(?:|own numbers|other things|(order )?(<=|>=) (.+))$")
SHOWN = re.compile(r"(?:(own): )?(\S+) to (\S+)$|(?:(order): )?(<=|>=) (\S+)$")
NUMBER = r"(-?\d+(?:\.\d+)?)"
FORMS = ((rf"{NUMBER}-(\d+(?:\.\d+)?)$", lambda low, high: (low, high)), (rf"~{NUMBER}$", lambda x: (0.9 * x, 1.1 * x)),
         (rf"~{NUMBER}-(\d+)$", lambda low, high: (0.9 * low, 1.1 * high)),
         (rf"{NUMBER} \+-(\d+(?:\.\d+)?) %$", lambda x, part: (x - abs(x) * part / 100, x + abs(x) * part / 100)),
         (rf"{NUMBER} \+-(\d+(?:\.\d+)?)$", lambda x, width: (x - width, x + width)),
         (rf"< {NUMBER}$", lambda x: (-math.inf, x)), (r"(\d+)$", lambda x: (x, x)))


def published_range(text):
    """(low, high) of "30-40", "~30" and "~60-80" (10 % to either side), "0.0867 +-5 %", "0 +-0.05", "< 2" and a whole number; None for words."""
    for pattern, limits in FORMS:
        found = re.match(pattern, text)
        if found:
            return limits(*map(float, found.groups()))
    return None


def rule_of(published, takes, bound):
    """The rule as the page shows it; bound gives the value of a bound as typed."""
    if takes == OTHER:
        return OTHER
    limit = TAKES.match(takes)
    if limit[2]:
        return f"{'order: ' if limit[1] else ''}{limit[2]} {bound(limit[3]):.6g}"
    low, high = published_range(published)
    return f"<= {high:.6g}" if low == -math.inf else f"{'own: ' if takes == OWN else ''}{low:.6g} to {high:.6g}"


def limits_of(rule):
    """(kind: own, order or none; low; high) of a rule as shown."""
    own, low, high, order, sign, bound = SHOWN.match(rule).groups()
    if low is not None:
        return own, float(low), float(high)
    return (order, -math.inf, float(bound)) if sign == "<=" else (order, float(bound), math.inf)


def beyond(value, low, high):
    """Ten times off to either side; of a limit of zero everything is."""
    return (value > FAR * high >= 0) or (low > 0 and FAR * value < low)


def verdict(rule, value, ci_lo=None, ci_hi=None):
    """Of a number, and its interval where it has one, by a rule as shown."""
    if rule == OTHER:
        return NOT_COMPARABLE
    kind, low, high = limits_of(rule)
    if low <= value <= high:
        return REPRODUCED
    least, most = (value, value) if ci_lo is None else (ci_lo, ci_hi)
    if least <= high and most >= low:
        return SPREAD
    return REFUTED if kind or beyond(value, low, high) else NOT_REPRODUCED
