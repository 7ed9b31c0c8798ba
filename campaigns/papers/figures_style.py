"""The one style of the papers' figures: sizes, colours, panels, and how what a paper prints is marked. A printed mark is black and dashed or hatched,
and carries the gid PRINTED, by which a test finds it."""
import hashlib
import pathlib
from dataclasses import dataclass, field
from typing import Callable

import pictures
from pictures import RAW_COLOUR, TRUTH_COLOUR, Picture, plain
from results import PICTURES

WIDTH, ROW = 10.0, 2.3  # inches: of a figure, of a row of panels
GREEN, ORANGE, BLUE, PINK, VIOLET, BROWN = "#1b7f3b", "#e08e0b", "#0b5394", "#c0187a", "#7a4fb5", "#8a5a2b"
AXES = (BLUE, ORANGE, GREEN)  # of three axes or three sensors
PRINTED, PRINTED_COLOUR = "printed", "#111111"
TEXT = 8
STYLE = hashlib.sha256(pathlib.Path(__file__).read_bytes()).hexdigest()  # a picture drawn in another style is stale
pictures.MAX_BYTES = 100_000  # each of these holds several figures


@dataclass
class Drawn:
    """A picture that holds some figures of a paper; beside: (what, printed, ours) of the page's table."""

    name: str
    title: str
    rows: float
    draw: Callable
    data: object
    source: str
    words: str
    beside: list = field(default_factory=list)

    def picture(self):
        return Picture(PICTURES / f"paper-{self.name}.png", self.title, (WIDTH, 0.5 + ROW * self.rows),
                       lambda figure, data: self.draw(figure, data[0]), (self.data, STYLE), self.source, 0.985)


def panel(axes, title, x, y):
    """Labels with units, a title on the left."""
    plain(axes, x, y)
    axes.set_axisbelow(True)
    axes.set_title(title, fontsize=9, loc="left", pad=4)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def truth(axes, times, values):
    axes.plot(times, values, "-", lw=0.8, color=TRUTH_COLOUR, label="truth", zorder=4)


def readings(axes, times, values, label="measured"):
    axes.plot(times, values, ".", ms=3, color=RAW_COLOUR, label=label, zorder=1)


def legend(axes, **options):
    axes.legend(**{"fontsize": TEXT, "frameon": False, "loc": "upper left", "ncol": 3, **options})


def printed_level(axes, span, levels, text=""):
    """Dashed lines at values that the paper prints for a stretch of the axis, with their text at the first."""
    for level in levels:
        axes.plot(span, [level, level], "--", lw=1.3, color=PRINTED_COLOUR, gid=PRINTED, zorder=6)
    if text:
        axes.annotate(text, (span[1], levels[0]), xytext=(-2, 3), textcoords="offset points", fontsize=TEXT, ha="right", color=PRINTED_COLOUR,
                      gid=PRINTED, zorder=7)


def printed_range(axes, span, low, high, text, above=True):
    """A hatched box: the range that the paper prints for a stretch of the axis."""
    axes.fill_between(span, low, high, facecolor="none", edgecolor=PRINTED_COLOUR, hatch="////", lw=1.0, alpha=0.55, gid=PRINTED, zorder=5)
    axes.annotate(text, (span[0], high if above else low), xytext=(2, 3 if above else -10), textcoords="offset points", fontsize=TEXT,
                  color=PRINTED_COLOUR, gid=PRINTED, zorder=7)


def printed_words(axes, x, y, text, **options):
    """Printed numbers beside ours, in a corner or above a stretch; y: share of the height."""
    axes.annotate(text, (x, y), xycoords=axes.get_xaxis_transform(), fontsize=TEXT, color=PRINTED_COLOUR, gid=PRINTED, zorder=7,
                  **{"va": "top", "bbox": {"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.8}, **options})
