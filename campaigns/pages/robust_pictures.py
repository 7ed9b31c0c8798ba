"""The pictures of docs/results/robust-filters.md: raw readings and what some filters make of them, beside the truth. Each file holds the hash of what
it shows, so that one that a new run would draw otherwise is noticed by any version of matplotlib."""
import hashlib
import io
import pathlib
from dataclasses import dataclass

import numpy as np

from robust_runs import FLAG_GATED, Fault, errors_cdeg, unfiltered
from laws import PLAIN, ROBUST
from results import PICTURES

MAX_BYTES = 60_000
INCHES, DPI, COLOURS = (10.0, 6.2), 90, 192
# colour and width of line: where several run alike all can be seen
SHOWN = {PLAIN: ("#e08e0b", 1.6), ROBUST: ("#7db4f5", 4.0), "soft": ("#1b7f3b", 2.0), "pbf": ("#c0187a", 0.9)}
GATING = ROBUST  # whose refused samples are marked
RAW_COLOUR, GATED_COLOUR, TRUTH_COLOUR = "#9aa3ad", "#d1495b", "#111111"
KEY = "robust-data"


@dataclass
class Panel:
    """A stretch of a stream; error: the height of a second panel with the filters' errors in degrees, 0 for none."""

    title: str
    from_s: float
    to_s: float
    low_deg: float
    high_deg: float
    error_deg: float = 0.0


@dataclass
class Picture:
    path: pathlib.Path
    title: str
    panels: list
    stream: object
    runs: dict
    digest: str = ""


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


# --- what a picture shows ---------------------------------------------------------------------------------------------


def contents(streams, runs):
    """The pictures, each with its hash: of this file and of every number that it draws."""
    by_name = {stream.name: stream for stream in streams}
    pictures = []
    for name, title, panels in WANTED:
        stream = by_name[name]
        shown = {kind: runs[name, kind] for kind in SHOWN if (name, kind) in runs}
        if len(shown) < len(SHOWN):
            raise Fault(f"the pictures want the filters {', '.join(SHOWN)}, and one of them is not in the list")
        picture = Picture(PICTURES / f"robust-{name}.png", title, panels, stream, shown)
        picture.digest = digest_of(picture)
        pictures.append(picture)
    return pictures


def digest_of(picture):
    digest = hashlib.sha256(pathlib.Path(__file__).read_bytes())
    for array in (picture.stream.lsb, picture.stream.truth_cdeg, *(part for run in picture.runs.values() for part in (run.angles_cdeg, run.flags))):
        digest.update(np.ascontiguousarray(array, dtype="<i8").tobytes())
    return digest.hexdigest()


def digest_in(path):
    """The hash that a picture holds (a tEXt chunk: key, NUL, text); empty if it is none of these."""
    data = path.read_bytes() if path.is_file() else b""
    place = data.find(b"tEXt" + KEY.encode("ascii") + b"\0")
    begin = place + len(KEY) + 5
    return data[begin:begin + 64].decode("ascii", "replace") if place >= 0 else ""


def stale(pictures):
    """One sentence for each picture that does not show this run, and for each file that is no picture of this page."""
    faults = [f"{p.path}: does not show what this run gives: make robust draws it" for p in pictures if digest_in(p.path) != p.digest]
    sizes = {p.path: p.path.stat().st_size for p in pictures if p.path.is_file()}
    faults += [f"{path}: {size} bytes, more than {MAX_BYTES}" for path, size in sizes.items() if size > MAX_BYTES]
    known = {p.path for p in pictures}
    return faults + [f"{path}: not drawn by make robust" for path in sorted(PICTURES.glob("robust-*")) if path not in known]


def draw_stale(pictures):
    """Draws those that do not show this run; how many."""
    todo = [picture for picture in pictures if digest_in(picture.path) != picture.digest]
    for picture in todo:
        draw(picture)
    return len(todo)


# --- drawing ----------------------------------------------------------------------------------------------------------


def draw_angle(axes, picture, panel):
    """Raw roll, those that the gate refused, the filters, the truth."""
    stream = picture.stream
    rows = (stream.t_s >= panel.from_s) & (stream.t_s <= panel.to_s)
    t_s, truth = stream.t_s[rows], stream.truth_cdeg[rows, 0] / 100.0
    raw = unfiltered(stream, picture.runs[GATING].flags).angles_cdeg[rows, 0] / 100.0
    gated = (picture.runs[GATING].flags[rows] & FLAG_GATED) != 0
    axes.plot(t_s[~gated], raw[~gated], ".", ms=4, color=RAW_COLOUR, label="raw", zorder=1)
    axes.plot(t_s[gated], raw[gated], "x", ms=5, mew=1.0, color=GATED_COLOUR, label=f"raw, a sample refused by {GATING}", zorder=2)
    for name, (colour, width) in SHOWN.items():
        axes.plot(t_s, picture.runs[name].angles_cdeg[rows, 0] / 100.0, "-", lw=width, color=colour, label=name, zorder=3)
    axes.plot(t_s, truth, "-", lw=0.7, color=TRUTH_COLOUR, label="truth", drawstyle="steps-post", zorder=5)
    axes.set_ylim(panel.low_deg, panel.high_deg)
    outside = int(np.sum((raw < panel.low_deg) | (raw > panel.high_deg)))
    note = f"raw readings beyond the panel: {outside}" if outside else ""
    axes.set_title("   ".join(part for part in (panel.title, note) if part), fontsize=9, loc="right", pad=3)


def draw_errors(axes, picture, panel):
    stream = picture.stream
    rows = (stream.t_s >= panel.from_s) & (stream.t_s <= panel.to_s)
    for name, (colour, width) in SHOWN.items():
        axes.plot(stream.t_s[rows], errors_cdeg(stream, picture.runs[name])[rows, 0] / 100.0, "-", lw=width, color=colour, zorder=3)
    axes.axhline(0.0, lw=0.7, color=TRUTH_COLOUR)
    axes.set_ylim(-panel.error_deg, panel.error_deg)


def finish(axes, panel, what):
    axes.set_xlim(panel.from_s, panel.to_s)
    axes.set_ylabel(f"{what} in degrees", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(True, color="#e3e6ea", lw=0.6)


def draw(picture):
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        from PIL import Image, PngImagePlugin
    except ImportError as missing:
        raise Fault(f"{missing.name} is missing, which draws the pictures: run make robust") from missing
    if len(picture.panels) == 1:
        figure, (top, bottom) = plt.subplots(2, 1, sharex=True, figsize=INCHES, dpi=DPI, height_ratios=(3, 2))
        draw_angle(top, picture, picture.panels[0])
        draw_errors(bottom, picture, picture.panels[0])
        finish(top, picture.panels[0], "roll")
        finish(bottom, picture.panels[0], "roll less truth")
        bottom.set_xlabel("time in seconds", fontsize=9)
    else:
        figure, grid = plt.subplots(2, 2, figsize=INCHES, dpi=DPI)
        for axes, panel in zip(grid.flat, picture.panels):
            draw_angle(axes, picture, panel)
            finish(axes, panel, "roll")
            axes.set_xlabel("time in seconds", fontsize=9)
    legend = (grid.flat[0] if len(picture.panels) > 1 else top).get_legend_handles_labels()
    figure.suptitle(picture.title, x=0.01, ha="left", fontsize=12, fontweight="bold")
    figure.legend(*legend, loc="upper center", bbox_to_anchor=(0.5, 0.958), ncol=len(legend[1]), fontsize=9, frameon=False)
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.975))
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png")
    plt.close(figure)
    text = PngImagePlugin.PngInfo()
    text.add_text(KEY, picture.digest)
    picture.path.parent.mkdir(parents=True, exist_ok=True)
    few = Image.open(drawn).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    few.save(picture.path, optimize=True, pnginfo=text)
    if picture.path.stat().st_size > MAX_BYTES:
        raise Fault(f"{picture.path}: {picture.path.stat().st_size} bytes, more than {MAX_BYTES}")
