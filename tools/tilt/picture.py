"""Recordings as a picture by matplotlib (PNG, SVG): one panel per quantity, the flags below, the spectrum at the bottom."""
import matplotlib
import numpy as np

from tilt import protocol, spectrum, thin
from tilt.angles import ANGLES, seam_crossings
from tilt.look import (AXIS_COLOURS, FILE_COLOURS, FLAG_COLOURS, GATED_COLOUR, GRID_COLOUR, MISSING_BAND, RAW_COLOUR, TRUTH_COLOUR,
                       WARMING_BAND)
from tilt.output import whole_file
from tilt.pictured import AXES, same_readings

matplotlib.use("Agg")
from matplotlib.colors import to_rgb  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

WIDTH_INCHES, PANEL_INCHES, LANE_INCHES, SPECTRUM_INCHES, DPI = 12.0, 3.0, 0.22, 3.2, 100
COLUMNS, LEVELS = 2400, 600  # grid to which points are thinned: finer than the picture
POINTS_AS_SHAPES = 6000  # above this an SVG too holds pixels: nothing opens a file of tens of MB
LANE_COLUMNS, LEAST_SHADE = 900, 0.3
LIMIT_PERCENTILES = (0.5, 99.5)


def style(axes, label):
    axes.set_ylabel(label)
    axes.grid(True, color=GRID_COLOUR, lw=0.6)
    axes.set_axisbelow(True)


# --- one quantity over time, used by tools/plot_run.py too ---------------------------------------------------------


def limits_of(raw, lines):
    """Limits that show all of the lines, and the raw points except the most extreme percent."""
    shown = [*np.percentile(raw, LIMIT_PERCENTILES)] if len(raw) else []
    for line in lines:
        shown += [np.nanmin(line), np.nanmax(line)] if np.any(~np.isnan(line)) else []
    low, high = (min(shown), max(shown)) if shown else (0.0, 1.0)
    margin = max(0.06 * (high - low), 0.5)
    return low - margin, high + margin


def shade(axes, t_s, mask, colour, label):
    """Vertical bands over the stretches of rows where the mask is true."""
    half_step = 0.5 * float(np.median(np.diff(t_s))) if len(t_s) > 1 else 0.005
    for begin, end in thin.runs(mask):
        axes.axvspan(t_s[begin] - half_step, t_s[end] + half_step, color=colour, alpha=0.55, lw=0, label=label, zorder=0)
        label = None


def line(axes, t_s, values, begins, seam, **look):
    """A line through the rows, thinned to its extremes, broken at gaps and at the +-180 seam."""
    breaks = begins | seam_crossings(values) if seam else begins
    kept = thin.extremes(t_s, [values], COLUMNS)
    broken = np.flatnonzero(np.diff(np.cumsum(breaks)[kept]) > 0) + 1
    axes.plot(np.insert(t_s[kept], broken, np.nan), np.insert(values[kept].astype(float), broken, np.nan), **look)


def points(axes, t_s, values, mask, limits, **look):
    shown = np.flatnonzero(mask)
    shown = shown[thin.spots(t_s[shown], values[shown], COLUMNS, LEVELS, limits)] if len(shown) else shown
    axes.plot(t_s[shown], values[shown], rasterized=len(shown) > POINTS_AS_SHAPES, **look)


def refused(axes, t_s, values, mask, limits, colour, label):
    """Crosses at the gated readings; triangles at the edge for those outside the picture, so that all are visible."""
    if not np.any(mask):
        return
    low, high = limits
    points(axes, t_s, values, mask & (values >= low) & (values <= high), limits, ls="", marker="x", ms=3.2, mew=0.7, color=colour, alpha=0.75,
           label=label, zorder=2)
    for outside, edge, marker in ((mask & (values > high), high, "^"), (mask & (values < low), low, "v")):
        if np.any(outside):
            points(axes, t_s, np.full(len(t_s), edge), outside, limits, ls="", marker=marker, ms=3.5, color=colour, alpha=0.75, zorder=2,
                   clip_on=False)


def outside_note(raw, limits):
    """How many raw points lie outside the picture; "" for none."""
    outside = int(np.sum((raw < limits[0]) | (raw > limits[1])))
    return f"{outside:,} raw points outside ({raw.min():.1f} to {raw.max():.1f})" if outside else ""


# --- recordings -------------------------------------------------------------------------------------------------------


def unit(kind):
    return f"{kind} in degrees" if kind in ANGLES else f"{kind} in mg"


def draw_quantity(axes, group, colours, kind):
    alone, shared = len(group) == 1, same_readings(group)
    lines = [one.filtered[kind] for one in group if kind in one.filtered] + [one.truth[kind] for one in group[:1] if kind in one.truth]
    raw = np.concatenate([one.raw[kind][~one.missing] for one in (group[:1] if shared else group)])
    limits = limits_of(raw, lines)
    if alone:
        shade(axes, group[0].t_s, group[0].missing, *MISSING_BAND)
        shade(axes, group[0].t_s, (group[0].flags & protocol.WARMING_UP) != 0, *WARMING_BAND)
    for i, (one, colour) in enumerate(zip(group, colours)):
        measured = ~one.missing
        if i == 0 or not shared:
            points(axes, one.t_s, one.raw[kind], measured & ~one.gated if alone else measured, limits, ls="", marker=".", ms=2.4,
                   color=RAW_COLOUR if shared else colour, alpha=1.0 if shared else 0.25, zorder=1, label="raw" if shared else f"raw, {one.name}")
        refused(axes, one.t_s, one.raw[kind], measured & one.gated, limits, GATED_COLOUR if alone else colour,
                "raw of gated rows" if alone else f"gated by {one.name}")
        if kind in one.filtered:
            line(axes, one.t_s, one.filtered[kind], one.begins, kind == "roll", lw=1.5, color=colour, zorder=4,
                 label="filtered" if alone else one.name)
        if kind in one.truth and i == 0:
            line(axes, one.t_s, one.truth[kind], one.begins, kind == "roll", lw=1.0, ls="--", color=TRUTH_COLOUR, zorder=5, label="truth")
    axes.set_ylim(*limits)
    style(axes, unit(kind))
    axes.set_title(outside_note(raw, limits) if len(raw) else "", loc="right", fontsize=9, color="#444444", pad=3)


def lanes_of(group):
    """(label, recording, bit) for each flag that occurs."""
    alone = len(group) == 1
    return [(words if alone else f"{words}, {one.name}", one, bit) for bit, words in protocol.FLAG_NAMES.items() for one in group
            if np.any(one.flags & bit)]


def draw_flags(axes, group, span):
    """A lane per flag: the more of the rows under a point have it, the darker; a single row is visible."""
    lanes = lanes_of(group)
    for lane, (_, one, bit) in enumerate(lanes):
        mask = (one.flags & bit) != 0
        share = thin.shares(one.t_s, mask, LANE_COLUMNS, span)
        image = np.zeros((1, LANE_COLUMNS, 4))
        image[0, :, :3] = to_rgb(FLAG_COLOURS[bit])
        image[0, :, 3] = np.where(share > 0.0, LEAST_SHADE + (1.0 - LEAST_SHADE) * share, 0.0)
        axes.imshow(image, extent=(*span, lane + 0.4, lane - 0.4), aspect="auto", interpolation="nearest", zorder=2)
        axes.text(1.005, lane, f"{int(mask.sum()):,} rows, {100.0 * mask.mean():.2g} %", transform=axes.get_yaxis_transform(), fontsize=8,
                  va="center", color="#444444")
    axes.set_yticks(range(len(lanes)), [label for label, _, _ in lanes], fontsize=8)
    axes.set_ylim(max(len(lanes), 1) - 0.5, -0.5)
    axes.grid(True, axis="x", color=GRID_COLOUR, lw=0.6)
    if not lanes:
        axes.set_yticks([])
        axes.text(0.5, 0.5, "no row has a flag", transform=axes.transAxes, ha="center", va="center", color="#444444")


def mean_of_axes(density):
    return np.sqrt(np.mean(density.lsb_rthz ** 2, axis=1))


def draw_spectrum(axes, files):
    """One file: its three axes, raw and filtered; several: the mean over the axes of each."""
    drawn = [one for one in files if one.raw_density is not None]
    if len(files) == 1 and drawn:
        raw, filtered = drawn[0].raw_density, drawn[0].filtered_density
        for i, axis in enumerate(AXES):
            axes.loglog(raw.hz, raw.lsb_rthz[:, i], lw=0.9, alpha=0.55, color=AXIS_COLOURS[axis], label=f"{axis} raw")
            if filtered is not None:
                axes.loglog(filtered.hz, filtered.lsb_rthz[:, i], lw=1.7, color=AXIS_COLOURS[axis], label=f"{axis} filtered")
    elif drawn:
        shared = same_readings(files)
        for i, (one, colour) in enumerate(zip(files, FILE_COLOURS * len(files))):
            if one.raw_density is not None and (i == 0 or not shared):
                axes.loglog(one.raw_density.hz, mean_of_axes(one.raw_density), lw=0.9, alpha=0.8, color=RAW_COLOUR if shared else colour,
                            ls="-" if shared else ":", label="raw" if shared else f"raw, {one.name}")
            if one.filtered_density is not None:
                axes.loglog(one.filtered_density.hz, mean_of_axes(one.filtered_density), lw=1.6, color=colour, label=one.name)
    if not drawn:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "no spectrum: no stretch without a gap is long enough", transform=axes.transAxes, ha="center", color="#444444")
        return
    floor(axes, drawn[0].rate_hz)
    style(axes, "LSB/$\\sqrt{Hz}$" + ("" if len(files) == 1 else ", mean of x, y, z"))
    axes.set_title("spectrum: motion to the left, noise to the right", loc="left", fontsize=10, pad=3)
    axes.set_xlabel("Hz")
    axes.set_xlim(drawn[0].raw_density.hz[0], max(one.raw_density.hz[-1] for one in drawn))
    axes.legend(fontsize=8, ncol=2, loc="upper right", framealpha=0.9)


def floor(axes, rate_hz):
    """Noise at rest: by the data sheet, and as measured on real sensors."""
    sheet, parts = spectrum.sheet_lsb_rthz(rate_hz), spectrum.parts_lsb_rthz()
    axes.axhspan(sheet[0], sheet[2], color="#777777", alpha=0.25, lw=0,
                 label=f"at rest, data sheet: {sheet[0]:.2f} (x, y) to {sheet[2]:.2f} (z)")
    axes.axhspan(parts[0], parts[2], color="#c9a227", alpha=0.22, lw=0, label=f"at rest, parts measured: {parts[0]:.2f} (x, y) to {parts[2]:.2f} (z)")


def heights_of(kinds, groups):
    heights = []
    for group in groups:
        heights += [PANEL_INCHES] * len([kind for kind in kinds if kind in (*ANGLES, *AXES)])
        heights += [0.35 + LANE_INCHES * max(1, len(lanes_of(group)))] * ("flags" in kinds)
    return heights


def draw(files, kinds, overlay, title):
    """The Figure. files: Pictured; kinds: of roll pitch x y z flags spectrum; overlay: all in one set of panels, else stacked."""
    groups = [files] if overlay else [[one] for one in files]
    heights = heights_of(kinds, groups)
    over_time, foot = len(heights), [SPECTRUM_INCHES] * ("spectrum" in kinds)
    figure = Figure(figsize=(WIDTH_INCHES, sum(heights) + sum(foot) + 0.45 * (over_time + len(foot)) + 0.7), dpi=DPI, layout="constrained")
    panels = figure.subplots(over_time + len(foot), 1, gridspec_kw={"height_ratios": heights + foot}, squeeze=False)[:, 0]
    begin, end, at = min(one.t_s[0] for one in files), max(one.t_s[-1] for one in files), 0
    span = (begin, max(end, begin + 0.01))
    for group in groups:
        at = draw_group(panels, at, group, kinds, span, "" if overlay else group[0].name)
    for axes in panels[:over_time]:
        axes.set_xlim(*span)
        axes.tick_params(labelbottom=axes is panels[over_time - 1])
    if over_time:
        panels[over_time - 1].set_xlabel("seconds")
    if foot:
        draw_spectrum(panels[-1], files)
    figure.suptitle(title, x=0.01, ha="left", fontsize=13, fontweight="bold")
    return figure


def draw_group(panels, at, group, kinds, span, name):
    colours = [FILE_COLOURS[i % len(FILE_COLOURS)] for i in range(len(group))]
    first = at
    for kind in [kind for kind in kinds if kind in (*ANGLES, *AXES)]:
        draw_quantity(panels[at], group, colours, kind)
        at += 1
    if at > first:
        panels[first].set_title(name, loc="left", fontsize=10, fontweight="bold", pad=3)
        handles, labels = panels[first].get_legend_handles_labels()
        panels[first].legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.08), ncol=min(len(labels), 6), fontsize=9,
                             frameon=False, markerscale=2.0)
    if "flags" in kinds:
        draw_flags(panels[at], group, span)
        at += 1
    return at


def write(path, kind, files, kinds, overlay, title):
    """kind: "png" or "svg"."""
    figure = draw(files, kinds, overlay, title)
    with whole_file(path, "wb") as file, matplotlib.rc_context({"svg.hashsalt": "tilt"}):
        figure.savefig(file, format=kind, metadata={"Date": None} if kind == "svg" else None)
