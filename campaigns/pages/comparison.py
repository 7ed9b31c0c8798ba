"""make comparison: ours beside the filters of the literature and of other people's toolboxes, on the same samples: paper 002's scenario, tilt among
outliers and bursts, lag, the class table that decides the default, cycles and flash; into docs/results/comparison.md.

    comparison.py --flags "..." --sources "..." --peers FOLDER [--runs N]       N: 1000 for the page; else page and pictures are left alone
"""
import argparse
import json
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import comparison_chip
    import comparison_classes
    import comparison_pictures
    import comparison_runs as made
    import pictures
except ImportError as missing:
    sys.exit(f"comparison: {missing.name} is missing: run make comparison, which installs it")
import laws
from comparison_filters import FUSION, NAMES, OF_PAPER, OURS, compared, words
from default_score import CANDIDATE, geometric_mean
from laws import PLAIN
from papers_program import whole_number
from results import FOLDER, Results, run_as_program, table

PAGE_RUNS = 1000
JSON = pathlib.Path("build/comparison.json")
ABOUT = f"""
Ours as the firmware runs them, beside an exponential mean (EMA), the same behind a median or a Hampel filter, the 1-euro filter, Kalman filters with
Huber's weight, with Student's t noise and with maximum correntropy, an interacting multiple model of three, and the accelerometer's path of
[Fusion](https://github.com/xioTechnologies/Fusion) (its gyroscope at zero, settings as delivered). The peers are ours to write
(`host_tests/support/peers.c`, `robust_peers.c`); the Kalman ones have `{PLAIN}`'s defaults and are given the noise that the firmware's
estimator gives.
[How this compares](../comparison.md) says what follows.
"""
PAGE = Results(FOLDER / "comparison.md", "Ours beside other filters: results", "make comparison", ABOUT)


OF_CLASSES = """\
Root mean square error in LSB (256 per g): the table that decides the [default](default-filter.md), whose streams, faults and reference it has. The
first column is the geometric mean over the classes of the error by the default's. Fusion gives a direction, here times 1 g: forces beside gravity
are its error too."""
OF_RECORDED = """\
What paper 002 has and the library has not, or not by default, in double: one decision for all axes, and outliers expected in runs. LSB as above, of
the real recordings alone, where (11) is told 0.8. Each beside the same code without the change: all four know no gaps and no rails, so they are not
to be set beside the shipped filters above. On the paper's scenario: [paper 002](papers-002.md)."""
OF_SCENARIO = """\
K_ef, mean square error of the Kalman filter that is told Table 1's noise over that of the filter, samples 201 to 400; more is better. The
Kalman filters among ours and the peers are told Table 1's noise; the others, and the default, are not, and have their defaults for 40.5 Hz. Runs:
an outlier follows an outlier with probability 0.8."""
OF_TILT = """\
Roll of 20 degrees to either side in 10 s, 100 Hz, noise 2 LSB; outliers of 20 times the noise, on each axis by itself. Error in degrees: rms /
largest of 40 s, median over the runs."""
OF_LAG = """\
100 Hz, noise 2 LSB. Step of 30 degrees: time to 90 % of it and overshoot; ramp of 90 degrees a second for one second: behind in its second half,
overshoot; sine of 30 degrees at 1 Hz: behind, gain."""
OF_COST = """\
Cycles of one sample of one axis in the simulated ATmega328P, avr-gcc 5.4.0, -Os; flash and RAM beside an empty program. Ours in fixed point; the
peers in float, for the mean and the 1-euro filters one program, for the four Kalman ones another, so flash and RAM are those of all in it. Fusion:
all three axes in one call."""


def number(value):
    return "never" if value == float("inf") else f"{value:.3g}"


def class_table(classes):
    fusion = [FUSION] if FUSION in classes["rest"] else []
    best = {min(set(laws.names()) & set(found), key=found.get): None for found in classes.values()}
    order = [*OURS, *(name for name in best if name not in OURS), *NAMES[len(OURS):], *OF_PAPER, *fusion, "raw"]
    lines = []
    for name in order:
        values = [found[name] for found in classes.values()]
        ratio = geometric_mean(value / found[CANDIDATE] for value, found in zip(values, classes.values()))
        lines.append([words(name), f"{ratio:.2f}", *map(number, values)])
    return table("Classes of motion and faults", OF_CLASSES,
                 ["filter", f"by `{CANDIDATE}`", *classes], lines)


def recorded_table(recorded):
    names = [name for pair in OF_PAPER.items() for name in reversed(pair)]
    return table("Paper 002's equation (11) and one gate over all axes, on recordings", OF_RECORDED, ["filter", *recorded],
                 [[words(name), *(number(found[name]) for found in recorded.values())] for name in names])


def lost_of(classes):
    """{class: (the best of all compared but the default, its LSB, the default's)}"""
    found = {}
    for group, scores in classes.items():
        name = min((name for name in scores if name not in (CANDIDATE, "raw")), key=scores.get)
        found[group] = name, scores[name], scores[CANDIDATE]
    return found


def lost_table(lost):
    return table(f"Where `{CANDIDATE}` wins and loses", "Against the best of all others in each class, ours and theirs.",
                 ["class", "best other", "its error, LSB", f"`{CANDIDATE}`, LSB", "ratio"],
                 [[group, words(name), number(best), number(ours), f"{ours / best:.2f}"] for group, (name, best, ours) in lost.items()])


def scenario_table(gains):
    names = list(next(iter(gains.values())))
    return table("Paper 002's scenario", OF_SCENARIO,
                 ["filter", *gains], [[words(name), *(number(found[name]) for found in gains.values())] for name in names])


def tilt_table(tilts):
    names = list(next(iter(tilts.values())))
    return table("Tilt among outliers and bursts", OF_TILT, ["filter", *tilts],
                 [[words(name), *(f"{found[name][0]:.2f} / {found[name][1]:.1f}" for found in tilts.values())] for name in names])


def lag_table(lags):
    return table("Lag", OF_LAG,
                 ["filter", "step to 90 %, ms", "overshoot, %", "ramp, ms behind", "overshoot, degrees", "1 Hz, ms behind", "gain"],
                 [[words(name), number(step), f"{over:.0f}", f"{ramp:.0f}", f"{beyond:.1f}", f"{sine:.0f}", f"{gain:.2f}"]
                  for name, (step, over, ramp, beyond, sine, gain) in lags.items()])


def cost_table(chip):
    return table("Cost on the chip", OF_COST,
                 ["filter", "cycles, median", "most", "flash, B", "RAM, B"],
                 [[words(name), row["median"], row["worst"], row["flash"], row["ram"]] for name, row in chip.items()])


def json_rows(classes, recorded, gains, tilts, lags, chip):
    rows = [{"part": part, "what": group, "filter": name, "value": value} for part, of in (("class", classes), ("recordings", recorded))
            for group, found in of.items() for name, value in found.items()]
    rows += [{"part": "k_ef", "what": scenario, "filter": name, "value": value} for scenario, found in gains.items() for name, value in found.items()]
    rows += [{"part": "tilt", "what": f"{tilt}, {metric}", "filter": name, "value": value} for tilt, found in tilts.items()
             for name, pair in found.items() for metric, value in zip(("rms", "largest"), pair)]
    keys = ("step_ms", "step_overshoot", "ramp_ms", "ramp_overshoot", "sine_ms", "sine_gain")
    rows += [{"part": "lag", "what": key, "filter": name, "value": None if value == float("inf") else value}
             for name, values in lags.items() for key, value in zip(keys, values)]
    return rows + [{"part": "chip", "what": key, "filter": name, "value": row[key]} for name, row in chip.items()
                   for key in ("median", "worst", "flash", "ram")]


def options_of():
    parser = argparse.ArgumentParser(usage='comparison.py --flags "..." --sources "..." --peers FOLDER [--runs N]')
    parser.add_argument("--flags", required=True)
    parser.add_argument("--sources", required=True)
    parser.add_argument("--peers", type=pathlib.Path, required=True)
    parser.add_argument("--runs", type=whole_number, default=PAGE_RUNS)
    return parser.parse_args()


def main():
    options = options_of()
    gains, tilts = made.k_ef(options.runs), made.among_outliers(max(2, options.runs // 20))
    lags, chip = made.lags(max(2, options.runs // 30)), comparison_chip.measure(options.flags.split(), options.sources.split(), options.peers)
    classes, recordings, recorded = comparison_classes.measured()
    JSON.write_text(json.dumps(json_rows(classes, recorded, gains, tilts, lags, chip), indent=0) + "\n", encoding="ascii")
    lost = lost_of(classes)
    shown = comparison_pictures.contents(lost)
    lines = [*pictures.on_page(shown), *class_table(classes), *lost_table(lost), *recorded_table(recorded), *tilt_table(tilts),
             *scenario_table(gains), *lag_table(lags), *cost_table(chip)]
    missing = [*([] if FUSION in compared() else [f"no Fusion in {options.peers}"]), *([] if recordings else ["no recordings in build/default.json"])]
    if missing or options.runs != PAGE_RUNS:
        print("\n".join(lines))
        print(f"skipped: {len(missing)} ({'; '.join(missing) or 'few runs'}): {PAGE.document} is left as it is")
        return 0
    return PAGE.publish(lines, shown)


if __name__ == "__main__":
    run_as_program("comparison", main)
