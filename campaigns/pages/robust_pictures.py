"""The pictures of docs/results/robust-filters.md: raw readings and what some filters make of them, beside the truth."""
from dataclasses import dataclass

import numpy as np

from laws import PLAIN, ROBUST
from pictures import RAW_COLOUR, TRUTH_COLOUR, Picture, plain
from results import PICTURES, Fault
from robust_runs import FLAG_GATED, errors_cdeg, unfiltered

# colour and width of line: where several run alike all can be seen
SHOWN = {PLAIN: ("#e08e0b", 1.6), ROBUST: ("#7db4f5", 4.0), "soft": ("#1b7f3b", 2.0), "pbf": ("#c0187a", 0.9)}
GATED_COLOUR = "#d1495b"  # of samples that ROBUST refused


@dataclass
class Panel:
    """A stretch of a stream; error: the height of a second panel with the filters' errors in degrees, 0 for none."""

    title: str
    from_s: float
    to_s: float
    low_deg: float
    high_deg: float
    error_deg: float = 0.0


def steps(at_s, note):
    """One panel for each size of step in roll, from a quarter of a second before it."""
    sizes = ((0.5, 3.0), (2.0, 9.0), (10.0, 15.0), (45.0, 21.0))
    return [Panel(f"{size:g} degrees{note}", at - at_s, at + 2.0 * at_s, 12.0 - max(0.4 * size, 2.5), 12.0 + size + max(0.4 * size, 2.5))
            for size, at in sizes]


WANTED = (
    ("outliers-15pct", "15 % outliers of 20 times the noise (stream outliers-15pct)", [Panel("", 21.0, 24.0, -30.0, 60.0, 8.0)]),
    ("vibration", "Bursts of vibration (stream vibration)", [Panel("", 16.0, 18.5, -70.0, 10.0, 4.0)]),
    ("bad-reads", "Single bad reads (stream bad-reads)", [Panel("", 9.0, 14.5, -45.0, 15.0, 3.0)]),
    ("clipping", "Shocks beyond the range (stream clipping)", [Panel("", 7.0, 13.0, -60.0, 120.0, 30.0)]),
    ("steps", "Steps of the tilt itself (stream steps)", steps(0.25, "")),
    ("steps-outliers", "The same steps among 15 % outliers (stream steps-outliers)", steps(0.25, ", outliers")),
)


def contents(streams, runs):
    """The pictures of this run."""
    by_name = {stream.name: stream for stream in streams}
    lacking = [kind for kind in SHOWN if any((name, kind) not in runs for name, _, _ in WANTED)]
    if lacking:
        raise Fault(f"the pictures want the filters {', '.join(SHOWN)}, and {lacking[0]} is not in the list")
    return [Picture(PICTURES / f"robust-{name}.png", title, (10.0, 6.2), draw,
                    (by_name[name], {kind: runs[name, kind] for kind in SHOWN}, panels), __file__, 0.975) for name, title, panels in WANTED]


# --- drawing ----------------------------------------------------------------------------------------------------------


def draw_angle(axes, stream, runs, panel):
    """Raw roll, those that the gate refused, the filters, the truth."""
    rows = (stream.t_s >= panel.from_s) & (stream.t_s <= panel.to_s)
    t_s, truth = stream.t_s[rows], stream.truth_cdeg[rows, 0] / 100.0
    raw = unfiltered(stream, runs[ROBUST].flags).angles_cdeg[rows, 0] / 100.0
    gated = (runs[ROBUST].flags[rows] & FLAG_GATED) != 0
    axes.plot(t_s[~gated], raw[~gated], ".", ms=4, color=RAW_COLOUR, label="raw", zorder=1)
    axes.plot(t_s[gated], raw[gated], "x", ms=5, mew=1.0, color=GATED_COLOUR, label=f"raw, a sample refused by {ROBUST}", zorder=2)
    for name, (colour, width) in SHOWN.items():
        axes.plot(t_s, runs[name].angles_cdeg[rows, 0] / 100.0, "-", lw=width, color=colour, label=name, zorder=3)
    axes.plot(t_s, truth, "-", lw=0.7, color=TRUTH_COLOUR, label="truth", drawstyle="steps-post", zorder=5)
    axes.set_ylim(panel.low_deg, panel.high_deg)
    outside = int(np.sum((raw < panel.low_deg) | (raw > panel.high_deg)))
    note = f"raw readings beyond the panel: {outside}" if outside else ""
    axes.set_title("   ".join(part for part in (panel.title, note) if part), fontsize=9, loc="right", pad=3)


def draw_errors(axes, stream, runs, panel):
    rows = (stream.t_s >= panel.from_s) & (stream.t_s <= panel.to_s)
    for name, (colour, width) in SHOWN.items():
        axes.plot(stream.t_s[rows], errors_cdeg(stream, runs[name])[rows, 0] / 100.0, "-", lw=width, color=colour, zorder=3)
    axes.axhline(0.0, lw=0.7, color=TRUTH_COLOUR)
    axes.set_ylim(-panel.error_deg, panel.error_deg)


def draw(figure, data):
    stream, runs, panels = data
    if len(panels) == 1:
        top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        draw_angle(top, stream, runs, panels[0])
        draw_errors(bottom, stream, runs, panels[0])
        plain(top, "", "roll in degrees")
        plain(bottom, "time in seconds", "roll less truth in degrees")
        top.set_xlim(panels[0].from_s, panels[0].to_s)
    else:
        for axes, panel in zip(figure.subplots(2, 2).flat, panels):
            draw_angle(axes, stream, runs, panel)
            plain(axes, "time in seconds", "roll in degrees")
            axes.set_xlim(panel.from_s, panel.to_s)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.958), ncol=len(labels), fontsize=9, frameon=False)
