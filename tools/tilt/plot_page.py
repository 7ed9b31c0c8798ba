"""Recordings as one HTML file: the series inside as base64 of little-endian numbers; the page draws them itself (page/plot.html, page/plot.js)."""
import base64
import html
import json
import pathlib

import numpy as np

from tilt import protocol, spectrum, thin
from tilt.angles import ANGLES
from tilt.look import FILE_COLOURS, FLAG_COLOURS
from tilt.output import whole_file
from tilt.pictured import AXES, same_readings

FOLDER = pathlib.Path(__file__).parent / "page"
DATA_MARK, TITLE_MARK, PROGRAM_MARK = "/*DATA*/null", "<!--TITLE-->", "/*PROGRAM*/"
ROWS_MAX = 1_000_000  # rows of one file in the page; a longer file is thinned to a quarter of this
TICK_S = 1e-4         # unit of times: a uint32 holds 119 hours
PER_DEGREE, PER_MG = 100.0, 2.0  # scales in the page: 180 degrees and 16,000 mg fit int16
NOTHING = -32768      # marks a missing value in a series


def packed(values, kind):
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")


def scale_of(kind):
    return PER_DEGREE if kind in ANGLES else PER_MG


def series_of(values, kept, kind):
    scaled = np.round(values[kept] * scale_of(kind))
    return packed(np.where(np.isnan(scaled), NOTHING, np.clip(scaled, -32767, 32767)), "<i2")


def rows_to_keep(one, kinds):
    series = [table[kind] for table in (one.raw, one.filtered, one.truth) for kind in kinds if kind in table]
    if len(one) <= ROWS_MAX:
        return np.arange(len(one))
    return thin.extremes(one.t_s, series, ROWS_MAX // (8 * (1 + len(series))))


def density_of(one):
    found = {}
    for name, density in (("raw", one.raw_density), ("filtered", one.filtered_density)):
        if density is not None:
            found["hz"] = packed(density.hz, "<f4")
            found[name] = [packed(density.lsb_rthz[:, i], "<f4") for i in range(len(AXES))]
    return found


def recording(one, kinds):
    kept = rows_to_keep(one, kinds)
    flags = thin.joined_flags(one.flags, kept)
    begins = np.maximum.reduceat(one.begins, np.concatenate(([0], kept[:-1] + 1)))
    tables = {"raw": one.raw, "filtered": one.filtered, "truth": one.truth}
    return {"name": one.name, "rows": len(one), "kept": len(kept), "rate": one.rate_hz, "gated": int(one.gated.sum()),
            "counts": {str(bit): int(np.sum((one.flags & bit) != 0)) for bit in protocol.FLAG_NAMES},
            "t": packed(np.round(one.t_s[kept] / TICK_S), "<u4"), "flags": packed(flags, "<u2"), "begins": packed(begins, "u1"),
            "missing": packed(one.missing[kept], "u1"),
            "series": {name: {kind: series_of(table[kind], kept, kind) for kind in kinds if kind in table} for name, table in tables.items()},
            "density": density_of(one) if "spectrum" in kinds else {}}


def data_of(files, kinds, overlay, title):
    return {"title": title, "overlay": overlay, "kinds": [kind for kind in kinds if kind in (*ANGLES, *AXES)], "flags": "flags" in kinds,
            "spectrum": "spectrum" in kinds, "tick": TICK_S, "scales": {kind: scale_of(kind) for kind in (*ANGLES, *AXES)},
            "sameReadings": overlay and same_readings(files), "flagNames": {str(bit): name for bit, name in protocol.FLAG_NAMES.items()},
            "flagColours": {str(bit): colour for bit, colour in FLAG_COLOURS.items()}, "colours": FILE_COLOURS,
            "floors": [{"name": "at rest, data sheet", "lsb": spectrum.sheet_lsb_rthz(files[0].rate_hz or 100.0)},
                       {"name": "at rest, parts measured", "lsb": spectrum.parts_lsb_rthz()}],
            "files": [recording(one, kinds) for one in files]}


def write(path, files, kinds, overlay, title):
    text = json.dumps(data_of(files, kinds, overlay, title), separators=(",", ":")).replace("</", "<\\/")
    page, program = ((FOLDER / name).read_text(encoding="utf-8") for name in ("plot.html", "plot.js"))
    page = page.replace(PROGRAM_MARK, program).replace(TITLE_MARK, html.escape(title)).replace(DATA_MARK, text)
    with whole_file(path) as file:
        file.write(page)
