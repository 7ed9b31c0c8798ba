"""The experiments of paper 002: rows (experiment, filter, arithmetic, metric, value or Interval, runs). K_ef(k) is the paper's: the
Kalman filter's variance over the filter's at each sample of an experiment of 50 runs. k_ef_steady and k_ef_pooled are ours: mean square errors, bias
included, pooled over a window of all runs. All on the same realisations."""
import math
from collections import namedtuple

import numpy as np
from synthesis.batch import run_seed
from synthesis.counted import rows as rows_counted
from variable_structure.intervals import Interval

from .filters import (CLEAN, ENTRIES, GATED, GROUP, IN_RUNS, LEARNING, LIBRARY, LINEAR, MEDIAN, MERGED, PLAIN, PUBLISHED, READINGS, REFERENCES,
                      SAMPLES, SHIPPED, STAY, TABLE1, Scenario, at_rest, back_deg, contestants, fixed, fixed_names, gated, in_double, others,
                      ratios, returned, scored, shares, steady_sigma_deg, through_burst)

WINDOWS = {"k_ef_steady": 0, "k_ef_pooled_1_60": 1, "k_ef_pooled_6_60": 2}
# of K_ef(k) over the samples of a window, those of one experiment
POINTWISE = {"p10": 0.1, "median": 0.5, "p90": 0.9, "peak": 1.0}
WARM_UP_ROWS = 5
LEARNT = 0.05  # q1 is, that near to the truth
NORMAL_95 = 1.959964
Spread = namedtuple("Spread", "value low high sample")  # an interval, and the experiments that it is of


def seeds_of(seed, runs):
    return np.array([run_seed(seed, run) for run in range(runs)], dtype=np.uint64)


def quantile(values, part):
    """Linear between order statistics; infinite members sort last and do not mix."""
    ordered = np.sort(values)
    at = part * (len(ordered) - 1)
    below, above = ordered[int(at)], ordered[min(int(at) + 1, len(ordered) - 1)]
    return below if at == int(at) or below == above else below + (at - int(at)) * (above - below)


def share(count, total):
    """With Wilson's interval."""
    z, p = NORMAL_95, count / total
    middle = (p + z * z / (2.0 * total)) / (1.0 + z * z / total)
    half = z / (1.0 + z * z / total) * math.sqrt(p * (1.0 - p) / total + z * z / (4.0 * total * total))
    return Interval(p, min(p, max(0.0, middle - half)), max(p, middle + half))


def row(experiment, f, metric, value, runs):
    return experiment, f.name, f.arithmetic, metric, value, runs


# --- K_ef from a start: of all references, of the printed readings, of the shipped code


def place(filters, name, arithmetic):
    return next((i for i, f in enumerate(filters) if (f.name, f.arithmetic) == (name, arithmetic)), None)


def standards(filters, name=PLAIN):
    """The place of the filter that each is compared with, in the same arithmetic."""
    return [place(filters, name, f.arithmetic) for f in filters]


def ratio_rows(experiment, filters, squares, metric, name, options):
    window, standard = squares[:, WINDOWS[metric]], standards(filters)
    for i, (f, found) in enumerate(zip(filters, ratios(window[standard], window, options.seed))):
        if i != standard[i]:
            yield row(experiment, f, name, Interval(*found), options.runs)


def of_experiments(found):
    """Median over experiments of the paper's size, or over runs; the interval holds nine in ten of them."""
    return Spread(*(quantile(found, part) for part in (0.5, 0.05, 0.95)), found)


def group_ratio(above, below):
    count = len(above) // GROUP * GROUP
    # one run after the other, as a sum of so few is printed to nine digits
    over, under = (np.cumsum(values[:count].reshape(-1, GROUP), axis=1)[:, -1] for values in (above, below))
    return of_experiments(over / under)


def group_rows(experiment, filters, squares, metric, options):
    window, standard = squares[:, WINDOWS[metric]], standards(filters)
    for i, f in enumerate(filters):
        if i != standard[i] and options.runs >= GROUP:
            yield row(experiment, f, f"{metric}_median_of_50", group_ratio(window[standard[i]], window[i]), options.runs)


def pointwise_rows(experiment, filters, variances, options):
    """K_ef(k) by the paper's definition: what its curve is over the samples of a window."""
    runs, standard = len(variances) * GROUP, standards(filters)
    for i, f in enumerate(filters):
        if i == standard[i] or not runs:
            continue
        curves = variances[:, standard[i]] / variances[:, i]
        for window, part in (("", curves[:, 1:60]), ("steady_", curves[:, 200:])):
            for metric, share_of_k in POINTWISE.items():
                yield row(experiment, f, f"k_ef_pointwise_{window}{metric}", of_experiments(np.quantile(part, share_of_k, axis=1)), runs)


def loss_rows(experiment, filters, squares, variances, options):
    """Mean square error over that of the PBF, of those that Table 2 compares with it; and by the paper's variances, sample by sample."""
    steady, standard = squares[:, 0], standards(filters, MERGED)
    found = ratios(steady, steady[standard], options.seed)
    for i, f in enumerate(filters):
        if f.name != MERGED and f.name in LIBRARY and ENTRIES[f.name].products:
            yield row(experiment, f, f"loss_to_{MERGED}", Interval(*found[i]), options.runs)
            if len(variances):
                curves = (variances[:, i] / variances[:, standard[i]])[:, 200:]
                yield row(experiment, f, f"loss_to_{MERGED}_pointwise", of_experiments(np.median(curves, axis=1)), len(variances) * GROUP)


def agreement_rows(experiment, filters, squares, options):
    """How far the fixed-point code's K_ef is from the reference's on the same runs."""
    standard, total = standards(filters), np.cumsum(squares[:, 0], axis=1)[:, -1]
    for i, f in enumerate(filters):
        twin = place(filters, f.name, "double")
        if f.arithmetic == "fixed" and twin is not None and f.name != PLAIN:
            ours, theirs = (total[standard[which]] / total[which] for which in (i, twin))
            yield row(experiment, f, "k_ef_steady_by_double", ours / theirs, options.runs)


def start_rows(experiment, filters, scenario, options):
    """All rows of a start."""
    filters = filters + others()
    squares, locked, variances = scored(filters, scenario, seeds_of(options.seed, options.runs))
    for metric in WINDOWS:
        yield from ratio_rows(experiment, filters, squares, metric, metric, options)
    yield from pointwise_rows(experiment, filters, variances, options)
    yield from group_rows(experiment, filters, squares, "k_ef_steady", options)
    yield from loss_rows(experiment, filters, squares, variances, options)
    for f, count in zip(filters, locked):
        yield row(experiment, f, "lockout_rate", share(count, options.runs), options.runs)
    yield from agreement_rows(experiment, filters, squares, options)


def table1_start(options):
    return start_rows("table1_start", contestants(REFERENCES, TABLE1), Scenario(), options)


def first_sample_clean(options):
    return start_rows("first_sample_clean", contestants(REFERENCES, TABLE1), Scenario(first_clean=True), options)


def after_warm_up(experiment, start, options):
    filters = contestants(REFERENCES, start)
    for f in filters:
        yield row(experiment, f, "warm_up_rows", 0 if f.name.startswith(PUBLISHED) else WARM_UP_ROWS, 1)
    yield from start_rows(experiment, filters, Scenario(), options)


def median_start(options):
    return after_warm_up("median_start", MEDIAN, options)


def shipped_start(options):
    return after_warm_up("shipped_start", SHIPPED, options)


def clean_data(options):
    filters = contestants(REFERENCES, MEDIAN)
    squares, _, variances = scored(filters, Scenario(outliers=0.0), seeds_of(options.seed, options.runs))
    yield from ratio_rows("clean", filters, squares, "k_ef_steady", "clean_efficiency", options)
    yield from pointwise_rows("clean", filters, variances, options)


def printed_readings(options):
    filters = [in_double(name) for name in (PLAIN, *READINGS)]
    for experiment, scenario in (("printed", Scenario()), ("printed_first_sample_clean", Scenario(first_clean=True))):
        squares, _, variances = scored(filters, scenario, seeds_of(options.seed, options.runs))
        for metric in ("k_ef_steady", "k_ef_pooled_1_60"):
            yield from ratio_rows(experiment, filters, squares, metric, metric, options)
        yield from pointwise_rows(experiment, filters, variances, options)


def wrong_r(options):
    for factor in (1.0 / 16, 0.25, 0.5, 1.0, 2.0, 4.0, 16.0):
        filters = contestants(LIBRARY, TABLE1, factor)
        # the standard is the Kalman filter that knows R
        filters = [(fixed if f.arithmetic == "fixed" else in_double)(PLAIN) if f.name == PLAIN else f for f in filters]
        squares, *_ = scored(filters, Scenario(first_clean=True), seeds_of(options.seed, options.runs))
        said = f"1/{1.0 / factor:g}" if factor < 1.0 else f"{factor:g}"
        yield from ratio_rows(f"wrong_r_{said}", filters, squares, "k_ef_steady", "k_ef_steady", options)


# --- outliers in runs, equation (11), and how the adaptive filters learn the share of normal samples


def outliers_in_runs(options):
    """15 % outliers, independent and in runs of five on average, the first sample none."""
    filters = contestants([name for name in LIBRARY if not name.startswith(PUBLISHED)] + IN_RUNS, SHIPPED) + others()
    for experiment, stay in (("independent", 0.0), ("in_runs", STAY)):
        squares, _, variances = scored(filters, Scenario(first_clean=True, stay=stay), seeds_of(options.seed + 5, options.runs))
        yield from ratio_rows(experiment, filters, squares, "k_ef_steady", "k_ef_steady", options)
        yield from pointwise_rows(experiment, filters, variances, options)
    # what (11) is told is wrong
    few = [f for f in filters if f.name in (PLAIN, MERGED, *IN_RUNS)]
    for experiment, stay in (("in_runs_of_two", 0.5), ("in_runs_of_twenty", 0.95)):
        squares, *_ = scored(few, Scenario(first_clean=True, stay=stay), seeds_of(options.seed + 5, options.runs))
        yield from ratio_rows(experiment, few, squares, "k_ef_steady", "k_ef_steady", options)


def learning(options):
    """q1 of Table 1 is 0.85; what learns it begins with 1/2."""
    filters = contestants(LEARNING)
    for f, q1, within in zip(filters, *shares(filters, Scenario(), seeds_of(options.seed, options.runs), LEARNT)):
        outside = np.flatnonzero(np.abs(q1 - CLEAN) > LEARNT * CLEAN)
        yield row("learning", f, "q1_after_50", q1[49], options.runs)
        yield row("learning", f, f"q1_after_{SAMPLES}", q1[-1], options.runs)
        yield row("learning", f, "q1_mean_within_5_percent", float(outside[-1] + 2 if len(outside) else 1), options.runs)
        yield row("learning", f, "q1_run_within_5_percent", of_experiments(within), options.runs)


# --- the width of the gate: false alarms, misses, and what it is good for


def gate_width(options):
    for width in (1.0, 2.0, 2.5, 3.0, 3.5, 4.0):
        experiment = f"gate_{width:g}_sigma"
        filters = contestants([PLAIN]) + contestants([PUBLISHED, GATED], TABLE1, 1.0, width)
        squares, counts = gated(filters, Scenario(first_clean=True), seeds_of(options.seed + 1, options.runs))
        standard = [1 if f.arithmetic == "fixed" else 0 for f in filters]  # the Kalman filters lead
        found = ratios(squares[standard], squares, options.seed)
        for f, ratio, (normal, outliers, false_alarms, misses) in list(zip(filters, found, counts))[2:]:
            yield row(experiment, f, "k_ef_steady", Interval(*ratio), options.runs)
            if f.name == GATED:  # the printed one is locked out too often for its gate to be judged
                yield row(experiment, f, "false_alarm", share(false_alarms, normal), options.runs)
                yield row(experiment, f, "miss", share(misses, outliers), options.runs)


# --- how filters come back: after steps, after bursts, and whether they ever do not


def step_rows(experiment, low_sigma, high_sigma, outliers, filters, options):
    limit, back = 600, np.full(len(filters), 4.0 * steady_sigma_deg(PLAIN))
    found = returned(filters, Scenario(outliers, True), low_sigma, high_sigma, seeds_of(options.seed + 2, options.runs), [limit] * len(filters), back)
    for f, samples in zip(filters, found):
        yield row(experiment, f, "reacq_median", quantile(samples, 0.5), options.runs)
        yield row(experiment, f, "reacq_p95", quantile(samples, 0.95), options.runs)
        yield row(experiment, f, "not_back_in_600", share(float(np.sum(np.isinf(samples))), options.runs), options.runs)


def steps(name, outliers, options):
    filters = contestants(LIBRARY, MEDIAN)
    for low, high in (*((size, size) for size in (1.0, 5.0, 10.0, 20.0, 50.0, 100.0)), (1.0, 5.0), (5.0, 100.0)):
        sizes = f"{low:g}" if low == high else f"{low:g}..{high:g}"
        yield from step_rows(f"{name}_{sizes}_sigma", low, high, outliers, filters, options)


def steps_clean(options):
    return steps("step_clean", 0.0, options)


def steps_with_outliers(options):
    return steps("step_15_percent", 0.15, options)


def bursts(options):
    filters = contestants(LIBRARY, MEDIAN) + [in_double(name, MEDIAN) for name in IN_RUNS]
    for length in (10, 30):
        peaks, backs = through_burst(filters, length, seeds_of(options.seed + 3, options.runs))
        for f, peak, back in zip(filters, peaks, backs):
            yield row(f"burst_{length}", f, "peak_error_sigma_median", quantile(peak, 0.5), options.runs)
            yield row(f"burst_{length}", f, "peak_error_sigma_p95", quantile(peak, 0.95), options.runs)
            yield row(f"burst_{length}", f, "recovery_p95", quantile(back, 0.95), options.runs)


def lockout(options):
    """A step of 1..100 sigma in a random phase under 0..30 % outliers, for those that refuse samples or take them for what they are."""
    trials, filters = 10 * options.runs, contestants([name for name in fixed_names() if name != PLAIN], SHIPPED)
    limits = [ENTRIES[f.name].returns_within for f in filters]
    found = returned(filters, Scenario(-1.0), 1.0, 100.0, seeds_of(options.seed + 4, trials), limits, back_deg(filters))
    for f, limit, samples in zip(filters, limits, found):
        yield row("lockout", f, "limit_samples", limit, trials)
        yield row("lockout", f, "not_back", float(np.sum(np.isinf(samples))), trials)
        yield row("lockout", f, "samples_p999", quantile(samples, 0.999), trials)
        yield row("lockout", f, "samples_worst", quantile(samples, 1.0), trials)


# --- without chance: covariances of the linear filters, gains at rest, Table 2


def covariance(_options):
    def one(name, metric, value):
        return "covariance", name, "double", metric, value, 1

    _, _, (_, r_both), _ = at_rest(LINEAR)
    _, _, (r_plain, _), _ = at_rest(PLAIN)
    p, plain_gain, _, plain_variances = at_rest(PLAIN, (r_both, r_plain))
    _, linear_gain, _, linear_variances = at_rest(LINEAR, (r_both, r_plain))
    yield from (one(PLAIN, metric, value) for metric, value in (("p11", p[0]), ("p12", p[1]), ("p22", p[3]), ("gain", plain_gain[0])))
    yield one(LINEAR, "gain", linear_gain[0])
    for metric, plain, linear in zip(("variance_ratio", "variance_ratio_clean"), plain_variances, linear_variances):
        yield one(LINEAR, metric, plain / linear)


def table2(_options):
    """The columns of Table 2 that are quotients of its others."""
    for name, entry in ENTRIES.items():
        if entry.products:
            yield "table2", name, "double", "multiplications_by_kf", entry.products / 47.0, 1
            yield "table2", name, "double", "additions_by_kf", entry.sums / 32.0, 1


def matrix_step(_options):
    return rows_counted("matrix_step", ["kalman_in_matrices"])


def steady_gain(_options):
    """Both arithmetics read 3.2 degrees for ever: 160 counts, no innovation."""
    for name in fixed_names():
        ours, reference = fixed(name, SHIPPED), in_double(name, SHIPPED)
        gain, expected = (f.gain_at_rest(3.2, 2000) for f in (ours, reference))
        yield row("steady_gain", ours, "gain", gain, 1)
        yield row("steady_gain", reference, "gain", expected, 1)
        yield row("steady_gain", ours, "gain_by_double", gain / expected, 1)
