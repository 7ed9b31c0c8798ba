"""One picture of a design and its alternatives: step, error under the v-th difference, gain, poles."""
import pathlib

import matplotlib
import numpy as np
from scipy.signal import lfilter

from .response import frequency, moving_error, numbers, step

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

INCHES, DPI = (10.5, 7.4), 100
COLOURS = ("#0b5394", "#d1495b", "#1b7f3b", "#8a5fbf")
STYLES = ("-", "--", "-.", ":")
FAINT = "#8a939c"
LEAST_DB = -60


def shown_samples(filters):
    return max(12, min(400, int(1.3 * max(step(f).settled_at for f in filters)) + 4))


def draw_step(axis, filters, period_s, samples):
    time = np.arange(samples) * period_s
    for (name, f), colour, style in zip(filters, COLOURS, STYLES):
        wave = lfilter(numbers(f.b), numbers(f.characteristic), np.ones(samples))
        axis.plot(time, wave, style, color=colour, label=name, marker="." if samples < 60 else None)
    axis.axhspan(0.98, 1.02, color=FAINT, alpha=0.25, lw=0)
    axis.axhline(1.0, color=FAINT, lw=0.8)
    axis.set(title="Response to a step (grey: within 2 %)", xlabel="time, s", ylabel="estimate / step", ylim=(min(0.0, axis.get_ylim()[0]), None))
    axis.legend(loc="lower right", fontsize=9)


def draw_error(axis, filters, period_s, samples, scale, limit, unit):
    """scale: error in units for a dynamic error of 1 sample^v."""
    time = np.arange(samples) * period_s
    for (_, f), colour, style in zip(filters, COLOURS, STYLES):
        axis.plot(time, moving_error(f, samples) * scale, style, color=colour, marker="." if samples < 60 else None)
    if limit is not None:
        axis.axhline(limit, color="#111111", lw=0.9, ls=(0, (2, 2)))
        axis.annotate("bound", (time[-1], limit), xytext=(0, 3), textcoords="offset points", ha="right", fontsize=9)
    word = {1: "rate", 2: "acceleration", 3: "jerk"}.get(filters[0][1].v, f"{filters[0][1].v}th derivative")
    axis.axhline(0.0, color=FAINT, lw=0.8)
    axis.set(title=f"Error from the start of a constant {word}", xlabel="time, s", ylabel=f"x - x^, {unit}")


def draw_gain(axis, filters, period_s):
    grid = np.linspace(1e-4, 0.5, 2000)
    for (_, f), colour, style in zip(filters, COLOURS, STYLES):
        gain = 20 * np.log10(np.maximum(np.abs(frequency(f, grid)), 1e-9))
        axis.plot(grid / period_s, np.maximum(gain, LEAST_DB), style, color=colour)
    axis.axhline(-3.01, color=FAINT, lw=0.8)
    axis.annotate("-3 dB", (0.5 / period_s, -3.01), xytext=(0, 2), textcoords="offset points", ha="right", fontsize=8, color="#555555")
    axis.set(title="Gain over frequency", xlabel="frequency, Hz", ylabel="|B / C|, dB", xlim=(0, 0.5 / period_s))
    axis.grid(True, color="#e3e6e8", lw=0.7)


def draw_poles(axis, filters):
    turn = np.linspace(0, 2 * np.pi, 361)
    axis.plot(np.cos(turn), np.sin(turn), color=FAINT, lw=0.9)
    axis.axhline(0, color=FAINT, lw=0.5)
    axis.axvline(0, color=FAINT, lw=0.5)
    for (_, f), colour, size in zip(filters, COLOURS, (9, 8, 7, 6)):
        poles = np.roots(numbers(f.characteristic))
        zeros = np.roots(numbers(f.b))
        zeros = zeros[np.abs(zeros) < 2.5]
        axis.plot(poles.real, poles.imag, "x", color=colour, ms=size, mew=2)
        axis.plot(zeros.real, zeros.imag, "o", color=colour, ms=size - 2, mfc="none")
    axis.set(title="Poles (x) and zeros (o)", xlabel="real", ylabel="imaginary")
    axis.set_aspect("equal", adjustable="datalim")


def draw(folder, title, filters, period_s, scale, limit, unit, kinds=("png", "svg")):
    """Writes folder/design.png and .svg; returns the paths. filters: (name, Filter), the design first."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    filters = filters[:len(COLOURS)]
    samples = shown_samples([f for _, f in filters])
    with plt.rc_context({"font.size": 10, "axes.titlesize": 11, "svg.hashsalt": "design"}):
        figure, axes = plt.subplots(2, 2, figsize=INCHES, layout="constrained")
        draw_step(axes[0][0], filters, period_s, samples)
        draw_error(axes[0][1], filters, period_s, samples, scale, limit, unit)
        draw_gain(axes[1][0], filters, period_s)
        draw_poles(axes[1][1], filters)
        figure.suptitle(title, fontsize=12)
        paths = [folder / f"design.{kind}" for kind in kinds]
        for path in paths:
            figure.savefig(path, dpi=DPI, metadata={"Date": None} if path.suffix == ".svg" else {"Software": None})
        plt.close(figure)
    return paths
