"""Recordings through the firmware's own filters, as tables: what `import tilt` offers, and the command line is built on."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from tilt import native
from tilt.errors import TiltError
from tilt.stream import Stream

if TYPE_CHECKING:
    import pandas as pd

ROW = ("x_mg", "y_mg", "z_mg", "roll_cdeg", "pitch_cdeg", "flags")  # what the filter makes of a sample, as the firmware sends it
RANGES_G = (2, 4, 8, 16)


def filters() -> list[str]:
    """Names of all filters, the default first."""
    return native.filters()


def known(filter: str) -> str:
    if filter not in native.filters():
        raise TiltError(f"no filter '{filter}': choose from {' '.join(native.filters())}")
    return filter


def parameters(filter: str, rate_hz: float = 100.0) -> dict[str, native.Parameter]:
    """{name: Parameter} of a filter at an output data rate: unit, low, high, default."""
    return native.parameters(known(filter), native.rate_of(None, rate_hz))


def replay(stream: Stream | str | os.PathLike, filter: str, *, rate_hz: float | None = None, range_g: int = 16, **values: float) -> "pd.DataFrame":
    """The rows that the board would send for a recording, with a filter and its parameters (`q=500`), the others at their defaults.

    Columns as in docs/protocol.md, t_us of the recording; the truth if the recording has it. rate_hz: the sensor's output data rate, by default the
    firmware's nearest to the recording's. TiltError: a file, a name or a value that cannot be used.
    """
    import pandas as pd

    if not isinstance(stream, Stream):
        stream = Stream.read(stream)
    if range_g not in RANGES_G:
        raise TiltError(f"range_g {range_g}: choose from {' '.join(map(str, RANGES_G))}")
    tables = runs(stream, [known(filter)], native.rate_of(stream, rate_hz), int(range_g), values=values)
    rows = tables[filter]
    lsb = dict(zip(("x_lsb", "y_lsb", "z_lsb"), rows["lsb"].T))
    return pd.DataFrame({"t_us": rows["t_us"] + stream.start_us, **lsb, **columns_of(tables), **truth_of(stream, rows)})


def runs(stream: Stream, names: list[str], rate_dhz: int, range_g: int = 16, report=None, values: dict[str, float] | None = None) -> dict:
    """{filter: rows (native.ROW)}; TiltError: a value that the filter refuses, or no row."""
    for name in names:
        every = native.parameters(name, rate_dhz)
        for key, value in (values or {}).items():
            if key not in every:
                raise TiltError(f"{name} has no parameter '{key}': choose from {' '.join(every)}")
            every[key].check(value)
    tables = native.replay(stream, names, rate_dhz, range_g, report, values)
    if not len(tables[names[0]]):
        raise TiltError(f"{stream.path}: no usable row: every row is missing or reads -1,-1,-1, like a sensor without power")
    return tables


def columns_of(tables: dict) -> dict:
    """{column: numbers} of the rows of all filters, and the flags common to all."""
    found, alone = {}, len(tables) == 1
    for name, rows in tables.items():
        own = dict(zip(ROW, (*rows["mg"].T, rows["roll_cdeg"], rows["pitch_cdeg"], rows["flags"])))
        found |= {column if alone else f"{column}_{name}": values for column, values in own.items()}
    if not alone:
        found["flags"] = np.bitwise_and.reduce([rows["flags"] for rows in tables.values()])
    return found


def truth_of(stream: Stream, rows) -> dict:
    """The truth columns for these rows; a prediction has that of the previous row."""
    if not stream.has_truth:
        return {}
    source = np.maximum.accumulate(rows["source"])
    return {"roll_true_cdeg": stream.roll_true_cdeg[source], "pitch_true_cdeg": stream.pitch_true_cdeg[source]}
