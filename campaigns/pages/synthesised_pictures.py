"""The pictures of docs/results/synthesised-filters.md."""
import numpy as np
from scipy.signal import lfilter

from design.response import numbers
from pictures import RAW_COLOUR, TRUTH_COLOUR, Picture, plain
from results import PICTURES

FILTERS = {"synth": ("#1b7f3b", 1.5), "kf": ("#e08e0b", 1.5), "adaptive": ("#0b5394", 2.0)}
OTHERS = {"alpha-beta": ("#c0187a", 1.6), "steady Kalman (kf)": ("#e08e0b", 1.6)}
FAINT = "#8a939c"
STEP_SAMPLES = 60


def contents(steps, trade, roll, gates):
    """The pictures of this run."""
    waves = [(a1, b0, gain, wave(ours), wave(theirs)) for a1, b0, gain, ours, theirs in steps]
    wanted = [("step", "A step, at equal noise gain", 3.6, draw_steps, waves),
              ("floor", "Noise gain against what remains under acceleration", 4.6, draw_trade, trade),
              ("outliers", "A roll of paper 000 (cos60), 5 % of the samples with 20 times the noise", 5.6, draw_roll, roll),
              ("gate", "adaptive: what the width of its gate trades, 10 Hz", 4.2, draw_gate, gates)]
    return [Picture(PICTURES / f"synthesised-{name}.png", title, (10.0, inches), draw, data, __file__) for name, title, inches, draw, data in wanted]


def wave(f):
    return lfilter(numbers(f.b), numbers(f.characteristic), np.ones(STEP_SAMPLES))


# --- drawing ----------------------------------------------------------------------------------------------------------


def draw_steps(figure, waves):
    for axes, (a1, b0, gain, ours, theirs) in zip(figure.subplots(1, len(waves), sharey=True), waves):
        axes.axhspan(0.98, 1.02, color=FAINT, alpha=0.25, lw=0)
        axes.plot(ours, "-", color=FILTERS["synth"][0], lw=1.6, label="synth")
        axes.plot(theirs, "-", color=OTHERS["alpha-beta"][0], lw=1.6, label="alpha-beta")
        axes.set_title(f"a1 = {a1:g}, b0 = {b0:.3g}: noise gain {gain:.3f}", fontsize=9, loc="left")
        plain(axes, "sample", "")
        axes.legend(fontsize=9, frameon=False, loc="lower right")
    figure.axes[0].set_ylabel("estimate / step", fontsize=9)


def draw_trade(figure, trade):
    lags, curves, kalman, held, marks = trade
    axes = figure.subplots()
    axes.axhspan(0.0, 0.5, color=FILTERS["synth"][0], alpha=0.07, lw=0)
    axes.axhline(0.5, color=FILTERS["synth"][0], lw=1.0, ls=(0, (4, 3)))
    axes.annotate("floor of the structure: R / 2", (900, 0.5), xytext=(0, -12), textcoords="offset points", ha="right", fontsize=9,
                  color=FILTERS["synth"][0])
    axes.plot(*np.array(held).T, "-", color="#9ec3ee", lw=7.0, label="adaptive's memories (k from 0.6 to 0.1)", solid_capstyle="round")
    axes.plot(lags, curves["synth"], "-", color=FILTERS["synth"][0], lw=2.0, label="synth, the best b0 (a1 = 0)")
    axes.plot(*np.array(kalman).T, "-", color=OTHERS["steady Kalman (kf)"][0], lw=1.6, label="steady Kalman (kf)")
    axes.plot(lags, curves["alpha-beta"], "--", color=OTHERS["alpha-beta"][0], lw=1.6, label="alpha-beta, the best (synth_plus)")
    for lag, gain, name in marks:
        axes.plot([lag], [gain], "o", color=FILTERS["synth"][0], ms=5)
        axes.annotate(name, (lag, gain), xytext=(6, 4), textcoords="offset points", fontsize=8, color="#333333")
    axes.set_xscale("log")
    axes.set_xlim(0.05, 1000)
    axes.set_ylim(0.0, 1.0)
    plain(axes, "error under constant acceleration, in second differences of the signal", "variance of the estimate / R")
    axes.legend(fontsize=9, frameon=False, loc="lower left")


def draw_roll(figure, roll):
    truth, raw, estimates = roll
    t_s = np.arange(len(truth)) / 10.0
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    top.plot(t_s, raw, ".", ms=5, color=RAW_COLOUR, label="raw", zorder=1)
    for (name, (colour, width)), estimate in zip(FILTERS.items(), np.asarray(estimates).T):
        top.plot(t_s, estimate, "-", lw=width, color=colour, label=name, zorder=3)
        bottom.plot(t_s, estimate - truth, "-", lw=width, color=colour, zorder=3)
    top.plot(t_s, truth, "-", lw=0.8, color=TRUTH_COLOUR, label="truth", zorder=4)
    bottom.axhline(0.0, lw=0.7, color=TRUTH_COLOUR)
    bottom.set_ylim(-15.0, 15.0)
    top.set_xlim(0.0, 15.0)
    plain(top, "", "roll in degrees")
    plain(bottom, "time in seconds", "roll less truth")
    top.legend(fontsize=9, frameon=False, loc="upper left", ncol=5)


def draw_gate(figure, gates):
    grid, chosen = gates
    widths = sorted({gate for gate, _, _ in grid})
    axes = figure.subplots()
    for profile, share, window, colour, style, name in (
            ("sine30", 0.0, 1, "#0b5394", "-", "sine30 clean, 6-10 s"), ("sine30", 0.05, 1, "#0b5394", "--", "sine30, 5 % outliers"),
            ("sine30", 0.15, 1, "#0b5394", ":", "sine30, 15 %"), ("bump30", 0.05, 1, "#c0187a", "--", "bump30, 5 %, 6-10 s"),
            ("cos60", 0.05, 2, "#e08e0b", "--", "cos60, 5 %, 11-15 s")):
        axes.plot(widths, [grid[gate, profile, share][window] for gate in widths], style, color=colour, lw=1.7, label=name)
    axes.axvline(chosen, color=FAINT, lw=1.0)
    axes.annotate("default at 10 Hz", (chosen, 0.93), xycoords=axes.get_xaxis_transform(), xytext=(4, 0), textcoords="offset points", fontsize=8,
                  color="#555555")
    for bound, colour in ((1.0, "#c0187a"), (0.20, "#e08e0b")):
        axes.axhline(bound, color=colour, lw=0.7, alpha=0.6)
        axes.annotate("bound", (widths[-1], bound), xytext=(-2, 2), textcoords="offset points", fontsize=8, ha="right", color=colour)
    axes.set_yscale("log")
    axes.set_xlim(widths[0], widths[-1])
    plain(axes, "gate in sigmas of the innovation", "mean square error, degree^2")
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
