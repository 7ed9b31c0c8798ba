"""A recording prepared for drawing: time from its start, raw and filtered series, flags, truth, spectrum."""
import pathlib
from dataclasses import dataclass

import numpy as np

from tilt import Stream, protocol, spectrum
from tilt.angles import ANGLES, LSB_PER_G, raw_angles_deg
from tilt.errors import TiltError

AXES = ("x", "y", "z")
FILTERED = {"roll": "roll_cdeg", "pitch": "pitch_cdeg", "x": "x_mg", "y": "y_mg", "z": "z_mg"}
GAP_STEPS, GAP_US = 3.5, 250_000  # lines break at gaps longer than both: in a long silence the board sends a row every 100 ms


@dataclass
class Pictured:
    """raw, filtered, truth: {quantity: series} in degrees (roll, pitch) and mg (x, y, z; raw: a typical sensor); filtered, truth may lack some."""
    name: str
    t_s: np.ndarray
    raw: dict
    filtered: dict
    truth: dict
    lsb: np.ndarray
    flags: np.ndarray
    missing: np.ndarray
    begins: np.ndarray  # rows after a gap: the line breaks there
    rate_hz: float
    raw_density: spectrum.Density | None = None
    filtered_density: spectrum.Density | None = None

    def __len__(self):
        return len(self.t_s)

    @property
    def gated(self):
        return (self.flags & protocol.GATED) != 0


def same_readings(group):
    """Whether these are one recording, or several runs over the same readings."""
    return len(group) == 1 or all(len(one) == len(group[0]) and np.array_equal(one.lsb, group[0].lsb) for one in group[1:])


def columns_in(path):
    """Names in the first header of the file, or none: stream.read reports what is wrong with the file."""
    try:
        with open(path, encoding="utf-8-sig", errors="replace") as file:
            for line in file:
                if line.strip() and not line.startswith("#"):
                    return [name.strip() for name in line.split(",")]
    except OSError:
        pass
    return []


def filters_in(names):
    """Suffix of each filter's columns in a file: "" as from the firmware, "_kf" as from `tilt replay` with several; [""] without any."""
    suffixes = [name.removeprefix("roll_cdeg") for name in names if name == "roll_cdeg" or name.startswith("roll_cdeg_")]
    return suffixes or [""]


def load(path, from_s=None, to_s=None, progress=None):
    """One Pictured per filter in the file, of the part between two times from the start. TiltError: the file is not a stream, or has no row
    there."""
    names = columns_in(path)
    suffixes = filters_in(names)
    extra = [name + end for end in suffixes for name in (*FILTERED.values(), *(("flags",) if end else ())) if name + end in names]
    whole = Stream.read(path, extra, progress)
    t_s = whole.t_us * 1e-6
    part = slice(*np.searchsorted(t_s, [-1.0 if from_s is None else from_s, np.inf if to_s is None else to_s]).tolist())
    if part.start >= part.stop:
        raise TiltError(f"{path}: no rows from {from_s or 0:g} s to {whole.seconds if to_s is None else to_s:g} s; it has {whole.seconds:.1f} s")
    return [of_filter(pathlib.Path(path).name, whole, t_s, part, end) for end in suffixes]


def of_filter(name, whole, t_s, part, end):
    begins = np.concatenate(([True], np.diff(whole.t_us) > max(GAP_STEPS * whole.step_us, GAP_US)))
    begins[[segment.start for segment in whole.segments]] = True
    lsb, missing = whole.lsb[part], whole.missing[part]
    filtered = {kind: whole.columns[column + end][part] / (100.0 if kind in ANGLES else 1.0) for kind, column in FILTERED.items()
                if column + end in whole.columns}
    raw = raw_angles_deg(lsb) | {axis: lsb[:, i] * (1000.0 / LSB_PER_G[i]) for i, axis in enumerate(AXES)}
    truth = {"roll": whole.roll_true_cdeg[part] / 100.0, "pitch": whole.pitch_true_cdeg[part] / 100.0} if whole.has_truth else {}
    flags = whole.columns.get("flags" + end, whole.flags)[part] if end else whole.flags[part]
    shown = Pictured(name + (f": {end[1:]}" if end else ""), t_s[part], raw, filtered, truth, lsb, flags, missing, begins[part], whole.rate_hz)
    add_spectrum(shown, whole, part)
    return shown


def add_spectrum(shown, whole, part):
    segments = [slice(max(s.start - part.start, 0), s.stop - part.start) for s in whole.segments if s.stop > part.start and s.start < part.stop]
    stretches = spectrum.even_stretches(whole.t_us[part], shown.missing, segments, whole.step_us)
    shown.raw_density = spectrum.density(shown.lsb.astype(float), stretches, shown.rate_hz)
    if all(axis in shown.filtered for axis in AXES):
        lsb = np.stack([shown.filtered[axis] for axis in AXES], axis=1) * (LSB_PER_G / 1000.0)
        shown.filtered_density = spectrum.density(lsb, stretches, shown.rate_hz)
