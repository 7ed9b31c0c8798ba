"""The tables of docs/results/papers-002.md."""
from laws import ROBUST
from papers_page import BESIDE, grid, pick, table, verdicts

CHANCE_FREE = ("covariance", "steady_gain", "table2", "operations", "matrix_step")
STEPS = ("1..5", "5", "10", "20", "50", "100", "5..100")
FACTORS = ("1/16", "1/4", "1/2", "1", "2", "4", "16")
LOCKOUT_NOTE = ('"Not back" means not within the limit: P widens the gate of `sprf_paper` too slowly, and a sample taken by chance '
                "closes it again.")
CURVE = (("lowest tenth", "p10"), ("median", "median"), ("highest tenth", "p90"), ("peak", "peak"))
GATES = ("1", "2", "2.5", "3", "3.5", "4")


def runs_of(runs):
    return f"{runs:,} runs per experiment ({10 * runs:,} trials for lock-out)"


def starts_alike(row):
    """Not where the reference of sprf_paper begins with Table 1's estimate and the shipped code with its first sample."""
    return not (row["filter"].startswith("sprf_paper") and row["experiment"] in ("median_start", "shipped_start") and
                (row["arithmetic"] == "double" or row["metric"].endswith("by_double")))


def starting(rows):
    return [row for row in rows if starts_alike(row)]


def efficiency(rows):
    part, rows = [], starting(rows)
    for title, experiment in (("Start of Table 1", "table1_start"), ("Start of Table 1, first sample no outlier", "first_sample_clean"),
                              ("Median of five, the rate as in Table 1", "median_start"), ("As shipped at 40.5 Hz", "shipped_start")):
        part += [f"**{title}**", "", *grid(rows, [
            ("steady", experiment, ["k_ef_steady"]), ("steady, median of groups of 50 [5 %, 95 %]", experiment, ["k_ef_steady_median_of_50"]),
            ("k = 6..60", experiment, ["k_ef_pooled_6_60"]), ("k = 1..60", experiment, ["k_ef_pooled_1_60"]),
            ("locked out", experiment, ["lockout_rate"])], intervals=True)]
    return part


def curves(rows):
    """K_ef(k) as the paper defines it."""
    for title, experiment in (("from Table 1's start", "table1_start"), ("the first sample no outlier", "first_sample_clean")):
        for words, window in (("k = 2..60", ""), ("k = 201..400", "steady_")):
            yield f"K_ef(k) of 50 runs, {title}: the curve over {words}, the middle of all experiments [5 %, 95 % of them]", grid(starting(rows), [
                (name, experiment, [f"k_ef_pointwise_{window}{metric}"]) for name, metric in CURVE], intervals=True)


def table_2(rows):
    """Ours, the most of any sample, beside the paper's three columns."""
    names = list(dict.fromkeys(r["filter"] for r in rows if r["experiment"] == "operations"))
    lines = []
    for name in names:
        cells = []
        for metric in ("multiplications_most", "additions_most", "memory_cells"):
            row = pick(rows, "operations", name, "fixed", metric)
            cells += [f"{row['value']:g}" if row else "", (row or {}).get("published") or "-"]
        lines.append([f"`{name}`", *cells])
    return table(["filter", "multiplications", "paper", "additions", "paper", "bytes / 4", "paper's cells"], lines)


def tables(rows):
    """(heading, lines) of the page."""
    back = ["reacq_median", "reacq_p95"]
    yield BESIDE, verdicts(rows)
    yield from curves(rows)
    yield "Ours, pooled: mean square error of the Kalman filter over that of the filter", efficiency(rows)
    yield "Outliers in runs, 15 % in all; (eq11) is told 0.8, true in runs of five (first sample no outlier, as shipped at 40.5 Hz)", grid(rows, [
        *((f"{words}: {title}", experiment, [metric]) for words, experiment in (("independent", "independent"), ("in runs of five", "in_runs"))
          for title, metric in (("pooled, steady", "k_ef_steady"), ("K_ef(k), median of k = 201..400", "k_ef_pointwise_steady_median"))),
        ("in runs of two (0.5): pooled, steady", "in_runs_of_two", ["k_ef_steady"]),
        ("of twenty (0.95): pooled, steady", "in_runs_of_twenty", ["k_ef_steady"])], intervals=True)
    yield "Three axes: one gate over all against a gate for each, (eq11) beside: pooled K_ef, and a burst of ten", grid(
        [row for row in rows if row["experiment"].startswith("three_axes")],
        [(f"outliers {words}", f"three_axes_{experiment}", ["k_ef_steady"]) for words, experiment in (
            ("on each axis by itself", "apart"), ("on all at once", "together"), ("by itself, in runs", "apart_in_runs"),
            ("at once, in runs", "together_in_runs"))] +
        [(f"burst on {words}: peak error in steady sigmas, median / 95 %", f"three_axes_burst_on_{which}",
          ["peak_error_sigma_median", "peak_error_sigma_p95"]) for words, which in (("one", "one"), ("all", "all"))], intervals=True)
    yield "What is learnt of q1 = 0.85", grid(rows, [("mean after 50 samples", "learning", ["q1_after_50"]), (
        "after 400", "learning", ["q1_after_400"]), ("samples until the mean stays within 5 %", "learning", ["q1_mean_within_5_percent"]),
        ("until a run does: the middle one [5 %, 95 % of the runs]", "learning", ["q1_run_within_5_percent"])], intervals=True)
    yield "Steady K_ef of fixed point by that of double, same runs", grid(starting(rows), [
        (title, experiment, ["k_ef_steady_by_double"]) for title, experiment in (
            ("Start of Table 1", "table1_start"), ("first sample no outlier", "first_sample_clean"), ("median of five", "median_start"),
            ("as shipped", "shipped_start"))])
    yield "Equations as printed: pooled K_ef from the start of Table 1", grid(rows, [
        ("steady", "printed", ["k_ef_steady"]), ("k = 1..60", "printed", ["k_ef_pooled_1_60"]),
        ("steady, first sample no outlier", "printed_first_sample_clean", ["k_ef_steady"]),
        ("k = 1..60, first sample no outlier", "printed_first_sample_clean", ["k_ef_pooled_1_60"])], intervals=True)
    yield "Without outliers: the Kalman filter's mean square error over the filter's", grid(rows, [
        ("pooled", "clean", ["clean_efficiency"]), ("K_ef(k), median of k = 201..400", "clean", ["k_ef_pointwise_steady_median"])], intervals=True)
    yield "Width of the gate in sigma: false alarms / misses (first sample no outlier)", grid(
        [r for r in rows if r["filter"] == ROBUST], [(g, f"gate_{g}_sigma", ["false_alarm", "miss"]) for g in GATES])
    yield "Width of the gate in sigma: K_ef", grid(rows, [(g, f"gate_{g}_sigma", ["k_ef_steady"]) for g in GATES])
    yield "Samples until back after a step of so many sigma, no outliers: median / 95 %", grid(
        rows, [(s, f"step_clean_{s}_sigma", back) for s in STEPS])
    yield "The same with 15 % outliers", grid(rows, [(s, f"step_15_percent_{s}_sigma", back) for s in STEPS])
    yield "Bursts of outliers on clean data", grid(rows, [(f"{n}: {title}", f"burst_{n}", metrics) for n in (10, 30) for title, metrics in (
        ("peak error in steady sigmas, median / 95 %", ["peak_error_sigma_median", "peak_error_sigma_p95"]),
        ("samples until back, 95 %", ["recovery_p95"]))])
    yield "Steady K_ef with R wrong by a factor (first sample no outlier)", grid(rows, [(f, f"wrong_r_{f}", ["k_ef_steady"]) for f in FACTORS])
    yield "Lock-out: steps of 1 to 100 sigma in a random phase, 0 to 30 % outliers", [LOCKOUT_NOTE, "", *grid(rows, [
        (title, "lockout", [metric]) for title, metric in (
            ("limit, samples", "limit_samples"), ("trials not back", "not_back"), ("99.9 %", "samples_p999"),
            ("worst", "samples_worst"))])]
    yield "Table 2: most operations per sample, and the state", table_2(rows)
    yield "Operations per sample of the shipped code, counted: median / most", grid(rows, [
        (title, "operations", [metric, f"{metric}_most"]) for title, metric in (
            ("multiplications", "multiplications"), ("additions", "additions"), ("reciprocals", "divisions"))])
    yield "A step of the Kalman filter in matrices, counted (Table 2: 47 and 32)", grid(rows, [
        (metric, "matrix_step", [metric]) for metric in ("multiplications", "additions", "quotients")])
    yield "Gain at rest; fixed point by double", grid(rows, [("gain", "steady_gain", ["gain"]), ("by double", "steady_gain", ["gain_by_double"])])
