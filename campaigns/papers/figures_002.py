"""Figures 2 to 7 of paper 002: estimates of the elevation angle, variances of their errors over the paper's 50 runs, what is learnt
of q1, and K_ef(k) over many experiments of 50 runs. The filters are the references in double, from the start of Table 1."""
import numpy as np
from figures_style import BLUE, BROWN, GREEN, ORANGE, PINK, VIOLET, Drawn, legend, panel, printed_level, printed_range, printed_words, readings, truth
from figures_traces import GRID, realisations, reference, seconds
from pictures import TRUTH_COLOUR, plain
from resilience.filters import CLEAN, ENTRIES, PLAIN, Scenario

SEED, RUNS, SAMPLES = 2024, 50, 400  # RUNS: the paper's N_p
TRANSIENT, STEADY = (1, 59), (200, 399)  # samples
# those that Table 2 counts, in the order of ENTRIES; the grid that learns q1 stands there after its recursive form
LINEAR, GATED, SHORT, MERGED, GRID_OF_Q1 = (name for name, entry in ENTRIES.items() if entry.products)
RECURSIVE = list(ENTRIES)[list(ENTRIES).index(GRID_OF_Q1) - 1]
NAMES = {PLAIN: PLAIN.upper(), MERGED: MERGED.upper(), GRID_OF_Q1: RECURSIVE.upper(), SHORT: "Sh" + SHORT[2:].upper(), GATED: "SpRF",
         LINEAR: LINEAR.upper()}
COLOUR = dict(zip(NAMES, (ORANGE, BLUE, PINK, VIOLET, BROWN, GREEN)))
# Table 2: accuracy gain, transient and steady; of the grid, which is about 30 there, within half a unit of its last digit, as papers_verdict.py
GAINS = {MERGED: ((20, 85), (30, 40)), GRID_OF_Q1: ((30, 60), (29.5, 30.5)), SHORT: ((20, 80), (20, 30)), GATED: ((15, 20), (12, 15)),
         LINEAR: ((0.8, 2.5), (0.3, 0.5))}
ANGLE, TIME, VARIANCE = "elevation in degrees", "time in seconds", "variance of the error in degree$^2$"


def variance(error):
    """Over the runs, central, sample by sample."""
    return np.var(error, axis=0, ddof=1)


def experiment(number=0, scenario=None, names=tuple(NAMES)):
    """(truth, y, outlier, {filter: facts}) of one experiment of 50 runs."""
    true, y, outlier = realisations(SEED, RUNS * number, RUNS, SAMPLES, scenario)
    return true, y, outlier, {name: reference(ENTRIES[name].reference, y, outlier, density=name == GRID_OF_Q1) for name in names}


def angle_panel(axes, title, true, y, lines):
    """One run's estimates."""
    times = seconds(SAMPLES)
    readings(axes, times, y)
    for name, x in lines.items():
        axes.plot(times, x, "-", lw=1.4, color=COLOUR[name], label=NAMES[name], zorder=3)
    truth(axes, times, true)
    panel(axes, title, TIME, ANGLE)
    low, high = np.quantile(true, (0.0, 1.0))
    axes.set_ylim(low - 1.5, high + 2.0)
    beyond = int(np.sum((y < low - 1.5) | (y > high + 2.0)))
    axes.set_title(f"{beyond} measurements beyond the panel", fontsize=8, loc="right", color="#555555")
    legend(axes, ncol=4)


def variance_panel(axes, title, lines):
    """lines: (name, variance, what is added to the name, style)."""
    for name, values, more, style in lines:
        axes.semilogy(seconds(SAMPLES), values, style, lw=1.3, color=COLOUR[name], label=NAMES[name] + more)
    panel(axes, title, TIME, VARIANCE)
    axes.set_ylim(top=6.0 * axes.get_ylim()[1])
    legend(axes, loc="upper right", ncol=4)


def set_times(figure):
    for axes in figure.axes:
        axes.set_xlim(0.0, seconds(SAMPLES)[-1])


# --- Fig. 2 and Fig. 3: the pseudo-Bayesian filter and the one that learns


def probability_panel(axes, title, facts, outlier):
    times, bad = seconds(SAMPLES), outlier > 0.0
    axes.vlines(times, 0.0, facts, color=PINK, lw=1.0, label="a posteriori probability of an outlier")
    axes.plot(times[bad], np.full(int(np.sum(bad)), 1.06), "|", ms=6, color=TRUTH_COLOUR, label="outliers in truth")
    panel(axes, title, TIME, "probability")
    axes.set_ylim(0.0, 1.5)
    axes.set_yticks((0.0, 0.5, 1.0))
    legend(axes)


def draw_2(figure, what):
    true, y, outlier, plain, merged, ratio = what
    top, middle, bottom = figure.subplots(3, 1)
    angle_panel(top, "Fig. 2a: one run", true[0], y[0], {PLAIN: plain["x"][0], MERGED: merged["x"][0]})
    variance_panel(middle, "Fig. 2b: variance over 50 runs",
                   [(PLAIN, variance(plain["x"] - true), "", "-"), (MERGED, variance(merged["x"] - true), "", "-")])
    printed_words(middle, 0.1, 0.98, f"printed: at some points more than ten times; ours: at {100 * np.mean(ratio > 10):.0f} % of the samples")
    probability_panel(bottom, f"Fig. 2c: which samples the {NAMES[MERGED]} takes for outliers", merged["abnormal"][0], outlier[0])
    set_times(figure)


def draw_3(figure, what):
    true, y, outlier, learns = what
    top, middle, bottom = figure.subplots(3, 1)
    angle_panel(top, "Fig. 3a: one run", true[0], y[0], {GRID_OF_Q1: learns["x"][0]})
    variance_panel(middle, f"Fig. 3b: variance of the {NAMES[GRID_OF_Q1]}",
                   [(GRID_OF_Q1, variance(learns["x"] - true), ", over 50 runs", "-")])
    middle.semilogy(seconds(SAMPLES), np.mean(learns["p11"], axis=0), "-", lw=1.3, color=BLUE, label="its own P11, mean")
    legend(middle, loc="upper right", ncol=4)
    probability_panel(bottom, "Fig. 3c: probability of an outlier, and the mean of q1", learns["abnormal"][0], outlier[0])
    bottom.plot(seconds(SAMPLES), np.mean(learns["q_mean"], axis=0), "-", lw=1.8, color=BLUE, label="mean of q1, 50 runs")
    printed_level(bottom, [0.0, seconds(SAMPLES)[-1]], (CLEAN,))
    printed_words(bottom, seconds(SAMPLES)[-1], 0.98, "printed: 0.85, reached very slowly", ha="right")
    legend(bottom)
    set_times(figure)


def draw_4(figure, what):
    density, = what
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    q1 = (np.arange(GRID) + 0.5) / GRID
    image = left.pcolormesh(seconds(SAMPLES), q1, GRID * density.T, cmap="Blues", vmax=12.0, shading="nearest", rasterized=True)
    bar = left.figure.colorbar(image, ax=left, pad=0.01)
    plain(bar.ax, "", "density of q1")
    printed_level(left, [0.0, seconds(SAMPLES)[-1]], (CLEAN,))
    panel(left, f"Fig. 4: what the {NAMES[GRID_OF_Q1]} holds for q1, one run", TIME, "q1, probability of a normal sample")
    for k, width in ((0, 0.8), (10, 1.1), (50, 1.5), (200, 1.9), (399, 2.4)):
        right.plot(q1, GRID * density[k], "-", lw=width, color=BLUE, alpha=0.35 + 0.65 * k / 399, label=f"after {k + 1} samples")
    right.axvline(CLEAN, ls="--", lw=1.3, color="#111111", gid="printed")
    panel(right, "cuts through it", "q1, probability of a normal sample", "density of q1")
    right.set_xlim(0.0, 1.0)
    legend(right, ncol=1)
    printed_words(right, 0.84, 0.5, "printed 0.85", ha="right")
    left.set_xlim(0.0, seconds(SAMPLES)[-1])


# --- Figs 5 and 6: the simplified filters


def draw_5(figure, what):
    true, y, linear, short, gated = what
    top, bottom = figure.subplots(2, 1)
    angle_panel(top, "Fig. 5a: the linear robust filter, one run", true, y, {LINEAR: linear})
    angle_panel(bottom, f"Fig. 5b: {NAMES[SHORT]} and {NAMES[GATED]}, the same run", true, y, {GATED: gated, SHORT: short})
    apart = float(np.sqrt(np.mean(np.square(gated - short))))
    printed_words(bottom, 0.1, 0.12, f"printed: a slight discrepancy between the two; ours: rms {apart:.3f} degrees", va="bottom")
    set_times(figure)


def draw_6(figure, what):
    lines, words = what
    top, middle, bottom = figure.subplots(3, 1)
    variance_panel(top, f"Fig. 6a: the gated filter ({NAMES[GATED]})", lines[0])
    printed_words(top, 0.1, 0.42, words[0])
    variance_panel(middle, f"Fig. 6b: {NAMES[SHORT]} and {NAMES[LINEAR]}", lines[1])
    printed_words(middle, 0.1, 0.36, words[1])
    variance_panel(bottom, f"{NAMES[LINEAR]} without outliers", lines[2])
    printed_words(bottom, 0.1, 0.98, words[2])
    set_times(figure)


def figure_6(whole, clean, first_clean):
    """Variances, and what the paper says of them beside what they say themselves."""
    def spread(name, of):
        return variance(of[3][name]["x"] - of[0])

    plain, merged, short, linear, gated = (spread(name, whole) for name in (PLAIN, MERGED, SHORT, LINEAR, GATED))
    kept, steady = spread(GATED, first_clean), slice(200, 400)
    lines = ([(PLAIN, plain, "", "-"), (MERGED, merged, "", "-"), (GATED, gated, "", "-"), (GATED, kept, ", first sample no outlier", ":")],
             [(PLAIN, plain, "", "-"), (MERGED, merged, "", "-"), (SHORT, short, "", "-"), (LINEAR, linear, "", "-")],
             [(PLAIN, spread(PLAIN, clean), "", "-"), (LINEAR, spread(LINEAR, clean), "", "-")])
    of_gated, of_short, of_linear = (float(np.mean((a / b)[steady])) for a, b in ((kept, merged), (short, merged), (plain, linear)))
    fall = float(np.sqrt(np.mean(lines[2][1][1][steady]) / np.mean(lines[2][0][1][steady])))
    name = {key: NAMES[key] for key in (PLAIN, MERGED, SHORT, LINEAR, GATED)}
    beside = [(f"Fig. 6a, variance of {name[GATED]} / {name[MERGED]}, steady, first sample no outlier", "3 to 5", f"{of_gated:.2f}"),
              (f"Fig. 6b, variance of {name[SHORT]} / {name[MERGED]}, steady", "1.4 to 1.5", f"{of_short:.2f}"),
              (f"Fig. 6b, variance of {name[PLAIN]} / {name[LINEAR]}, steady", "2 to 2.5", f"{of_linear:.2f}"),
              (f"Fig. 6, rms of {name[LINEAR]} / {name[PLAIN]} without outliers, steady", "nearly 2", f"{fall:.2f}")]
    words = (f"printed: 3 to 5 times the {name[MERGED]}'s; ours, first sample no outlier: {of_gated:.2f}",
             f"printed: {name[SHORT]} 1.4 to 1.5 times the {name[MERGED]}'s, {name[LINEAR]} 2 to 2.5 times below the {name[PLAIN]}; "
             f"ours: {of_short:.2f} and {of_linear:.2f}",
             f"printed: accuracy falls nearly two-fold; ours: rms {fall:.2f} times the {name[PLAIN]}'s")
    return (lines, words), beside


# --- Fig. 7: K_ef(k) = variance of the Kalman filter / variance of the filter, over the 50 runs of an experiment


FIRST_CLEAN = "first sample no outlier"


def k_ef_curves(groups):
    """{filter: groups x samples}, and FIRST_CLEAN: of the gated one when its first sample is never an outlier. The grid's is its recursive form's."""
    found = {name: [] for name in (*GAINS, FIRST_CLEAN)}
    for number in range(groups):
        true, _, _, facts = experiment(number, None, (PLAIN, *(RECURSIVE if name == GRID_OF_Q1 else name for name in GAINS)))
        facts[GRID_OF_Q1], top = facts.pop(RECURSIVE), variance(facts[PLAIN]["x"] - true)
        for name in GAINS:
            found[name].append(top / variance(facts[name]["x"] - true))
        true, _, _, facts = experiment(number, Scenario(first_clean=True), (PLAIN, GATED))
        found[FIRST_CLEAN].append(variance(facts[PLAIN]["x"] - true) / variance(facts[GATED]["x"] - true))
    return {name: np.array(curves) for name, curves in found.items()}


def bands(curves):
    return {name: np.quantile(values, (0.1, 0.5, 0.9), axis=0) for name, values in curves.items()}


def said(name, transient):
    """The range as Table 2 prints it."""
    least, most = GAINS[name][0 if transient else 1]
    return "about 30" if (name, transient) == (GRID_OF_Q1, False) else f"{least:g}-{most:g}"


def draw_gain(axes, name, band):
    times = seconds(SAMPLES)
    low, middle, high = (values[1:] for values in band[name])
    axes.fill_between(times[1:], low, high, color=COLOUR[name], alpha=0.25, lw=0)
    axes.semilogy(times[1:], middle, "-", lw=1.3, color=COLOUR[name], label="median, 10 to 90 %")
    if name == GATED:
        axes.semilogy(times[1:], band[FIRST_CLEAN][1][1:], ":", lw=1.3, color=COLOUR[name], label=FIRST_CLEAN)
    for (begin, end), (least, most) in zip((TRANSIENT, STEADY), GAINS[name]):
        # above these two there is a curve
        above = begin < 100 and name not in (GATED, LINEAR)
        printed_range(axes, [times[begin], times[end]], least, most, said(name, begin < 100), above)
    axes.axhline(1.0, lw=0.7, color="#555555")
    axes.set_ylim(0.03, 2000.0)
    panel(axes, NAMES[name], TIME, "K$_{ef}$, variance ratio")
    legend(axes, ncol=1, loc="upper right")


def draw_7(figure, band):
    grid = figure.subplots(2, 3, sharex=True, sharey=True).flat
    for axes, name in zip(grid, GAINS):
        draw_gain(axes, name, band)
    last = figure.axes[5]
    for name in GAINS:
        last.semilogy(seconds(SAMPLES)[1:], band[name][1][1:], "-", lw=1.2, color=COLOUR[name], label=NAMES[name])
    panel(last, f"medians of all; {NAMES[PLAIN]} = 1", TIME, "K$_{ef}$, variance ratio")
    legend(last, loc="upper right")
    set_times(figure)


def beside_7(curves):
    """The gain over the samples of an experiment's curve (10, 50, 90 %), median over the experiments."""
    rows = []
    for name in GAINS:
        for words, (begin, end) in zip(("transient", "steady"), (TRANSIENT, STEADY)):
            shares = np.median(np.quantile(curves[name][:, begin:end + 1], (0.1, 0.5, 0.9), axis=1), axis=1)
            rows.append((f"Fig. 7, {NAMES[name]}, {words}, K_ef: 10, 50, 90 % of its samples", said(name, words == "transient"),
                         " / ".join(f"{share:.3g}" for share in shares)))
    return rows


def figures(runs):
    """runs: experiments of 50 runs are a tenth of them."""
    groups = max(2, runs // 10)
    whole, clean = experiment(), experiment(0, Scenario(outliers=0.0), (PLAIN, LINEAR))
    first_clean = experiment(0, Scenario(first_clean=True), (PLAIN, GATED))
    true, y, outlier, facts = whole
    curves = k_ef_curves(groups)
    ratio = variance(facts[PLAIN]["x"] - true) / variance(facts[MERGED]["x"] - true)
    of_6, beside_6 = figure_6(whole, clean, first_clean)
    q_late = float(np.mean(facts[GRID_OF_Q1]["q_mean"][:, 50]))
    scenario = "Table 1: elevation of an aircraft, one sample in seven an outlier of 20 times the noise."
    return [
        Drawn("002-2", "Paper 002, Fig. 2", 3, draw_2, (true, y, outlier, facts[PLAIN], facts[MERGED], ratio), __file__,
              f"{scenario} Kalman filter and pseudo-Bayesian filter.",
              [("Fig. 2b, samples at which the variances differ more than ten times", "some points", f"{100 * np.mean(ratio > 10):.0f} %")]),
        Drawn("002-3", "Paper 002, Fig. 3", 3, draw_3, (true, y, outlier, facts[GRID_OF_Q1]), __file__,
              "The filter that learns q1 with the rest.",
              [("Fig. 3c, mean of q1 after 50 samples (0.85 in truth)", "very slowly", f"{q_late:.3f}")]),
        Drawn("002-4", "Paper 002, Fig. 4", 1.5, draw_4, (facts[GRID_OF_Q1]["density"],), __file__,
              "The distribution of q1 on the grid of 50 points."),
        Drawn("002-5", "Paper 002, Fig. 5", 2, draw_5, (true[0], y[0], *(facts[name]["x"][0] for name in (LINEAR, SHORT, GATED))), __file__,
              "The simplified filters on the run of Fig. 2."),
        Drawn("002-6", "Paper 002, Fig. 6", 3, draw_6, of_6, __file__, "Variances over 50 runs.", beside_6),
        Drawn("002-7", "Paper 002, Fig. 7", 2.2, draw_7, bands(curves), __file__,
              f"K_ef at each sample, of {groups} experiments of 50 runs. Hatched: Table 2, its transient and its steady mode; that which learns\n"
              "is the recursive one.",
              beside_7(curves))]
