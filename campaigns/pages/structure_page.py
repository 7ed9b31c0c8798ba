"""docs/results/variable-structure.md and its picture, from the experiments of campaigns/variable_structure with the seed and the runs of make
papers. Fails with the name of each number that does not come out again."""
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import structure_picture
    from variable_structure.experiments import EXPERIMENTS
    from variable_structure.intervals import Interval
    from papers_program import DEFAULT_RUNS, DEFAULT_SEED
except ImportError as missing:
    sys.exit(f"structure: {missing.name} is missing: run make structure, which installs it")
from papers_page import shown
from results import FOLDER, PICTURES, Results, run_as_program, table

ABOUT = f"""
Which of three sensors a rule of [paper 004](../variable-structure.md) chooses for each window of 20 s, and what the estimate is worth:
{DEFAULT_RUNS} simulated flights of 400 s. Velocity is measured once a second; from the third window on a sensor is in each window degraded
(20 %: 6 to 20 times its noise), frozen (8 %) or biased by 3 m/s (8 %). rms of the velocity's error from 40 s on.

"Best sensor": how often the one of least true error is chosen; "within twice": one of at most twice that error; "frozen one taken": of the windows
in which a sensor is frozen. The last column of the first three tables is the same rule when it knows only the window before.
"""
PAGE = Results(FOLDER / "variable-structure.md", "Variable structure: results", "make structure", ABOUT)
PICTURE = (f"![Above: measurements of three sensors, the trend's prediction of each 20 s window, estimate and truth. Below: the trouble of each "
           f"sensor in each window and which one two rules choose]({PICTURES.name}/variable-structure.png)")
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

CHANNEL = {"sum_a2_2": "sum a^2 of the tilt", "sum_a2_3": "sum a^2 of the drift", "condition": "condition of O"}


def measured(experiments=tuple(EXPERIMENTS)):
    """{(experiment, rule, metric): number}"""
    found = {}
    for name in experiments:
        for rule, metric, value, _ in EXPERIMENTS[name][1](DEFAULT_RUNS, DEFAULT_SEED):
            found[name, rule, metric] = value.value if isinstance(value, Interval) else value
    return found


def cell(found, *key):
    return shown(found[key]) if key in found else ""


def rule_table(found, title, kind):
    """One line for each rule: what it reaches when it sees its window, and the median when the window before chooses."""
    lines = [[words, *(cell(found, f"windows_{kind}", rule, metric) for _, metric in COLUMNS), cell(found, f"next_window_{kind}", rule, "rms_median")]
             for rule, words in RULES.items()]
    return table(title, "", ["rule", *(column for column, _ in COLUMNS), "median, chosen by the window before"], lines)


def trend_table(found):
    lines = [[words, *(cell(found, "trends", name, metric) for metric in ("error_median", "picked"))] for name, words in TRENDS.items()]
    return table("Trends: the 20 s after 40 s of estimates", "", ["prediction", "rms error in m/s, median", "chosen"], lines)


def exact_table(found):
    """Rules without a choice, whose mean square error can be worked out (campaigns/variable_structure/moments.py)."""
    kind = "windows_stuck_at_zero"
    lines = [[words, *(cell(found, kind, rule, metric) for metric in ("exact_mse", "mse"))]
             for rule, words in RULES.items() if (kind, rule, "exact_mse") in found]
    return table("Without a choice: mean square error", "A frozen sensor stuck at zero, (m/s)^2.", ["rule", "worked out", "measured"], lines)


def channel_table(found):
    """What has no chance in it, to six digits."""
    lines = [[words, f"{found['observability', 'channel', metric]:.6g}"] for metric, words in CHANNEL.items()]
    return table("Noise of the pseudo-inverse, (12)", "Of the channel [velocity error, platform tilt, gyro drift].", ["", "value"], lines)


def tables(found):
    rules = [line for title, kind in TABLES for line in rule_table(found, title, kind)]
    return [PICTURE, "", *rules, *trend_table(found), *exact_table(found), *channel_table(found)]


def main():
    return PAGE.publish(tables(measured()), [structure_picture.picture()])


if __name__ == "__main__":
    run_as_program("structure", main)
