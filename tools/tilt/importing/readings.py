"""The result of every format's reader: the numbers as in the file, and their lines."""
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from tilt.errors import TiltError, at

FLAG_COASTED, FLAG_SILENT = 2, 16
MEND = ": correct or delete this line"
MISSING_FLAGS = FLAG_COASTED | FLAG_SILENT  # docs/protocol.md: rows with these are not readings


@dataclass
class Readings:
    """values: (n, 3) float64 in the file's unit, NaN for a missing reading. lines: line of each row, counted from 1, or None.
    time: n float64 in time_unit (s, ms, us, ns; clock: seconds of a day; days: s, day and month perhaps the other way round; count: samples;
    None: determined by its steps), or None."""
    path: str
    form: str
    values: np.ndarray
    lines: Optional[np.ndarray] = None
    time: Optional[np.ndarray] = None
    time_unit: Optional[str] = None
    decimals: Optional[int] = None  # digits after the decimal point of printed values, None: not printed in decimals
    unit: Optional[str] = None  # as the file states it
    multiplier: Optional[np.ndarray] = None  # a scale per row, if the file has one
    kept: dict = field(default_factory=dict)  # columns of our own streams: flags, roll_true_cdeg, pitch_true_cdeg
    segments: list = field(default_factory=list)  # rows before which the header is repeated
    notes: list = field(default_factory=list)
    other_sensors: bool = False
    own: bool = False  # a stream by docs/protocol.md: its time is kept
    parts: Optional[list] = None  # of joined files: (first row, path)

    def fault(self, row, reason):
        """The error for a row."""
        path = self.path
        for first, name in self.parts or ():
            path = name if row >= first else path
        return at(path, int(self.lines[row]), reason) if self.lines is not None else TiltError(f"{path}: row {row + 1}: {reason}")


def kind_of(readings):
    return readings.form, readings.time is None, readings.time_unit, readings.unit, readings.multiplier is None, sorted(readings.kept)


def joined(readings):
    """One Readings of several files in order. They must have the same form."""
    first = readings[0]
    for other in readings[1:]:
        if kind_of(other) != kind_of(first):
            raise TiltError(f"{other.path}: not in the form of {first.path}: times, units or columns differ: import it alone")
    starts = np.cumsum([0] + [len(part.values) for part in readings])

    def together(name):
        arrays = [getattr(part, name) for part in readings]
        return None if any(array is None for array in arrays) else np.concatenate(arrays)
    decimals = [part.decimals for part in readings]
    return Readings(first.path, first.form, together("values"), together("lines"), together("time"), first.time_unit,
                    None if None in decimals else max(decimals), first.unit, together("multiplier"),
                    {name: np.concatenate([part.kept[name] for part in readings]) for name in first.kept},
                    [int(start) + row for start, part in zip(starts, readings) for row in part.segments],
                    list(dict.fromkeys(note for part in readings for note in part.notes)),
                    any(part.other_sensors for part in readings), first.own, [(int(start), part.path) for start, part in zip(starts, readings)])
