"""Converts a recording in any known format to a stream file."""
import numpy as np

from tilt.importing import clock, cwa, jsons, report, source, text, units
from tilt.importing.readings import FLAG_COASTED, MEND, MISSING_FLAGS, joined
from tilt.output import whole_file

CHUNK_ROWS = 200_000


def read(path, options):
    """The Readings of one file of any format. options: sensor, columns."""
    head = source.begin(path)
    with open(path, "rb") as file:
        if source.is_cwa(head):
            return cwa.read(path, file)
        body = source.as_text(path, file, head)
        if jsons.is_json(head):
            return jsons.read(path, body, options)
        return text.read(path, body, head, options)


def scale_of(readings, asked, notes):
    """(Scale, reason for it)"""
    if asked is not None and asked not in units.UNITS:
        return units.forced(asked, readings.values, readings.decimals, notes), "--unit"
    if readings.multiplier is not None:
        return multiplied(readings, notes)
    unit = asked or readings.unit
    why = "--unit" if asked else "stated by the file" if readings.unit else "found by whole numbers"
    return units.choose(readings.path, readings.values, readings.decimals, unit, notes, readings.other_sensors), why


def multiplied(readings, notes):
    """For a file with a multiplier in each row, whose values are counts or counts times the multiplier: takes the counts."""
    if (readings.multiplier <= 0.0).any() or not np.isfinite(readings.multiplier).all():
        row = int(np.flatnonzero(~(readings.multiplier > 0.0))[0])
        raise readings.fault(row, f"a multiplier of {readings.multiplier[row]:g}{MEND}")
    counts = units.tried(units.candidates("raw")[0], units.sample_of(readings.values), 1e-7)
    if counts.fits:
        return counts, "counts; the file's multiplier is not needed"
    readings.values = readings.values / readings.multiplier[:, None]
    scale = units.choose(readings.path, np.where(np.abs(readings.values - np.rint(readings.values)) < units.MARGIN_LSB, np.rint(readings.values),
                                                 readings.values), 0, "raw", notes)
    return scale, "divided by the file's multiplier"


def converted(paths, options, out):
    """Writes the stream of one file, or of several joined, to out; returns the lines to print. options: sensor, columns, unit, rate."""
    parts = [read(path, options) for path in paths]
    readings = parts[0] if len(parts) == 1 else joined(parts)
    notes = []
    scale, why = scale_of(readings, options.unit, notes)
    lsb, missing = units.to_lsb(readings, scale, notes)
    t_us = clock.to_us(readings, options.rate, notes)
    write(out, t_us, lsb, missing, readings.kept)
    name = paths[0] if len(paths) == 1 else f"{paths[0]} and {len(paths) - 1} more"
    lines = [report.summary(name, out, readings, scale, t_us, why)]
    shown = report.notes_of(t_us, lsb, flagged(missing, readings.kept, notes))
    return lines + [f"  {note}" for note in readings.notes + notes + shown]


def flagged(missing, kept, notes):
    """Marks the rows without a reading, including those that the file itself flags."""
    marked = (kept.get("flags", np.zeros(len(missing), dtype=np.int64)) & MISSING_FLAGS) != 0
    if marked.any():
        notes.append(f"{int(marked.sum()):,} rows are flagged as missing samples by the file")
    return missing | marked


def columns_of(t_us, lsb, missing, kept):
    """{name: whole numbers} of the stream (docs/protocol.md)."""
    found = {"t_us": t_us, "x": lsb[:, 0], "y": lsb[:, 1], "z": lsb[:, 2], **kept}
    if missing.any():
        found["flags"] = found.get("flags", np.zeros(len(t_us), dtype=np.int64)) | np.where(missing, FLAG_COASTED, 0)
    return found


def write(out, t_us, lsb, missing, kept):
    """Writes the stream to a temporary file and moves it to its place when complete."""
    found = columns_of(t_us, lsb, missing, kept)
    form = ",".join(["%d"] * len(found)) + "\n"
    with whole_file(out) as file, source.progress(len(t_us), out, "write") as bar:
        file.write(",".join(found) + "\n")
        for start in range(0, len(t_us), CHUNK_ROWS):
            part = [column[start:start + CHUNK_ROWS].tolist() for column in found.values()]
            file.writelines(form % row for row in zip(*part))
            bar.update(len(part[0]))
