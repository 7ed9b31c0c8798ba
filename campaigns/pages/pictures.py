"""Pictures of docs/results. Each file holds the hash of what it shows and of the sources that draw it, so that one that a new run would draw
otherwise is noticed by any version of matplotlib, and an equal one is left as it is."""
import hashlib
import io
import pathlib
from dataclasses import dataclass, is_dataclass
from typing import Callable

import numpy as np

from results import PICTURES, Fault

MAX_BYTES = 60_000
DPI, COLOURS = 90, 192
RAW_COLOUR, TRUTH_COLOUR, GRID_COLOUR = "#9aa3ad", "#111111", "#e3e6ea"
KEY = b"page-data"


def flat(data):
    """All the numbers and names of nested data, in order, as text."""
    if is_dataclass(data):
        data = vars(data)
    if isinstance(data, dict):
        data = [part for item in data.items() for part in item]
    if isinstance(data, (list, tuple)):
        return " ".join(map(flat, data))
    if isinstance(data, np.ndarray) and data.dtype.kind in "iub":
        return hashlib.sha256(np.ascontiguousarray(data, dtype="<i8").tobytes()).hexdigest()
    if isinstance(data, np.ndarray):
        return " ".join(f"{float(x):.5g}" for x in data.ravel())
    return f"{data:.5g}" if isinstance(data, float) else str(data)


def plain(axes, x, y):
    """Labels, and a style that all axes of these pictures share."""
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(True, color=GRID_COLOUR, lw=0.6)


@dataclass
class Picture:
    """draw(figure, data) draws it below its title; source is the file that has that function."""

    path: pathlib.Path
    title: str
    inches: tuple
    draw: Callable
    data: object
    source: str
    top: float = 0.99  # of what is drawn, as a share of the height

    def digest(self):
        sources = [pathlib.Path(source).read_bytes() for source in (__file__, self.source)]
        return hashlib.sha256(b"".join([*sources, flat(self.data).encode("ascii")])).hexdigest()

    def stale(self):
        """Whether its file does not hold its hash (a tEXt chunk: key, NUL, text)."""
        data = self.path.read_bytes() if self.path.is_file() else b""
        return b"tEXt" + KEY + b"\0" + self.digest().encode("ascii") not in data

    def draw_if_stale(self):
        stale = self.stale()
        if stale:
            self.save()
        return stale

    def save(self):
        try:
            import matplotlib
            matplotlib.use("Agg")
            import matplotlib.pyplot as plt
            from PIL import Image, PngImagePlugin
        except ImportError as missing:
            raise Fault(f"{missing.name} is missing, which draws the pictures: the make target of this page installs it") from missing
        figure = plt.figure(figsize=self.inches, dpi=DPI)
        self.draw(figure, self.data)
        figure.suptitle(self.title, x=0.01, ha="left", fontsize=12, fontweight="bold")
        figure.tight_layout(rect=(0.0, 0.0, 1.0, self.top))
        drawn, text = io.BytesIO(), PngImagePlugin.PngInfo()
        figure.savefig(drawn, format="png")
        plt.close(figure)
        text.add_text(KEY.decode("ascii"), self.digest())
        self.path.parent.mkdir(parents=True, exist_ok=True)
        Image.open(drawn).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(self.path, optimize=True, pnginfo=text)
        if self.path.stat().st_size > MAX_BYTES:
            raise Fault(f"{self.path}: {self.path.stat().st_size} bytes, more than {MAX_BYTES}")


def on_page(pictures):
    """The lines of a page that show them."""
    return [line for picture in pictures for line in (f"![{picture.title}]({PICTURES.name}/{picture.path.name})", "")]
