"""docs/variable-structure.md: its tables, the numbers in its text and its picture, from the experiments of campaigns/variable_structure with the
seed and the runs of make papers. Fails with the name of each number that does not come out again."""
import argparse
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import structure_picture
    from variable_structure.experiments import EXPERIMENTS
    from variable_structure.intervals import Interval
    from variable_structure.program import DEFAULT_RUNS, DEFAULT_SEED
except ImportError as missing:
    sys.exit(f"structure: {missing.name} is missing: run make structure, which installs it")
from page import Page, run_as_program
from papers_page import shown, table

DOCUMENT = pathlib.Path("docs/variable-structure.md")
PAGE = Page(DOCUMENT, "<!-- written by make structure: begin -->", "<!-- written by make structure: end -->")
RULES = {"fixed_1": "sensor 1 always (0.15 m/s)", "fixed_2": "sensor 2 always (0.4 m/s)", "fixed_3": "sensor 3 always (0.25 m/s)",
         "fuse": "all three, nominal noise", "degree_only": "degree of observability (14) alone", "trend_acceptor": "trend acceptor (25)",
         "gate_then_degree": "acceptor's gate, then the degree", "normalised_innovation": "normalised innovation, may coast",
         "oracle": "the best sensor, told", "sample_gate": "3 sigma gate at each sample"}
TABLES = (("A frozen sensor stuck at zero", "stuck_at_zero"), ("A frozen sensor at its last value", "frozen_at_last"),
          ("Troubles that last five windows, a frozen sensor at its last value", "lasting"))
COLUMNS = (("median rms, m/s", "rms_median"), ("95 % of the runs", "rms_p95"), ("best sensor", "best_sensor"), ("within twice", "within_2x"),
           ("frozen one taken", "frozen_taken"))
TRENDS = {"hold": "hold the last estimate", "linear": "linear (18)", "harmonic": "harmonic (19)", "demark": "modified DeMark (20), (21), increments",
          "self_organised": "self-organised choice by (24) + (25)", "model": "the filter's own model", "demark_printed": "(20), (21) as printed",
          "linear_separate": "linear, amplitudes by (22), (23)"}


def measured(experiments=tuple(EXPERIMENTS)):
    """{(experiment, rule, metric): number}"""
    found = {}
    for name in experiments:
        for rule, metric, value, _ in EXPERIMENTS[name][1](DEFAULT_RUNS, DEFAULT_SEED, lambda part: None):
            found[name, rule, metric] = value.value if isinstance(value, Interval) else value
    return found


def cell(found, *key):
    return shown(found[key]) if key in found else ""


def rule_table(found, title, kind):
    """One line for each rule: what it reaches when it sees its window, and the median when the window before chooses."""
    lines = [[words, *(cell(found, f"windows_{kind}", rule, metric) for _, metric in COLUMNS), cell(found, f"next_window_{kind}", rule, "rms_median")]
             for rule, words in RULES.items()]
    return [f"### {title}", "", *table(["rule", *(column for column, _ in COLUMNS), "median, chosen by the window before"], lines)]


def trend_table(found):
    lines = [[words, *(cell(found, "trends", name, metric) for metric in ("error_median", "picked"))] for name, words in TRENDS.items()]
    return ["### Trends: the 20 s after 40 s of estimates", "", *table(["prediction", "rms error in m/s, median", "chosen"], lines)]


def tables(found):
    return [line for title, kind in TABLES for line in rule_table(found, title, kind)] + trend_table(found)


def values_of(found):
    """Numbers of the text by name; those without chance to six digits."""
    return {" ".join(key): f"{number:.6g}" if key[0] == "observability" else shown(number) for key, number in found.items()}


def main(arguments=None):
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args(arguments)
    found = measured()
    faults = PAGE.write(DOCUMENT.read_text(encoding="utf-8"), ["", *tables(found)], values_of(found))
    drawn = structure_picture.draw_stale()
    for fault in faults:
        print(f"structure: {DOCUMENT}: {fault}", file=sys.stderr)
    print(f"structure: {DOCUMENT} written, {'the picture drawn anew' if drawn else 'its picture as it was'}, {len(faults)} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    run_as_program("structure", main)
