"""What the first lines of a text settle for the whole file: how a line becomes fields, their number, and their meaning."""
import functools
import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Optional

import numpy as np

from tilt.errors import TiltError, at
from tilt.importing import columns as cols
from tilt.importing import forms

SAMPLE_LINES, SAMPLE_ROWS = 4000, 400
NAME = re.compile(r"[A-Za-z_][\w ()/^*.-]*")
DAY = r"\d{4}[./-]\d{1,2}[./-]\d{1,2}|\d{1,2}[./-]\d{1,2}[./-]\d{4}"
WALL = re.compile(rf"(?:(?P<day>{DAY})(?:,? |T))?(\d{{1,2}}):(\d{{2}}):(\d{{2}}(?:[.,]\d+)?)(?:Z|[+-]\d{{2}}:?\d{{2}})?")


@dataclass
class Settled:
    plan: forms.Plan
    columns: cols.Columns
    header: Optional[list]
    width: int  # fields of a row
    trail: int  # empty fields after them
    decimals: int
    time_unit: Optional[str]


def number_or_time(text):
    """(value, unit): a number (unit None), a time of day in seconds (clock), or a day and time in seconds since 1970 (s; days: day and month may
    be the other way round). Otherwise ValueError."""
    try:
        return float(text), None
    except ValueError:
        pass
    wall = WALL.fullmatch(text.strip("\"'"))
    if wall is None:
        raise ValueError(text)
    day, hours, minutes, seconds = wall.groups()
    midnight, unit = midnight_of(day) if day else (0, "clock")
    return midnight + int(hours) * 3600 + int(minutes) * 60 + float(seconds.replace(",", ".")), unit


@functools.lru_cache(maxsize=64)
def midnight_of(day):
    """(seconds since 1970, unit) of a day; a slash puts the month first, where that gives a day."""
    first, second, third = map(int, re.split("[./-]", day))
    if first > 31:
        return datetime(first, second, third, tzinfo=timezone.utc).timestamp(), "s"
    month, date = (first, second) if second > 12 or ("/" in day and first <= 12) else (second, first)
    return datetime(third, month, date, tzinfo=timezone.utc).timestamp(), "days"


def header_cells(line, wanted=frozenset()):
    """The names in a header line, None for any other line. wanted: names in --columns. Klipper's header follows a #."""
    text = line.strip()
    if text.startswith("##"):
        return None
    text = text.lstrip("#").strip()
    _, text = forms.clocked(text)
    for separator in (",", ";", "\t", None):
        cells = [cell.strip() for cell in text.split(separator)]
        if cols.is_header(cells, wanted):
            return cells
    return None


def find_header(lines, wanted):
    """The first header before the first row."""
    for line in lines:
        cells = header_cells(line, wanted)
        if cells:
            return cells
        if len(forms.NUMBERS.findall(line)) >= 3 and not line.lstrip().startswith("#"):
            return None
    return None


def unknown_header(plan, lines, rows, first_line):
    """Names, none of them known, in the line above the first row: rejected rather than taken for text above x, y, z."""
    line, cells = rows[0]
    above = [text for text in lines[:line - first_line] if text.strip()]
    names = [name.strip() for name in above[-1].split(plan.separator)] if above and plan.separator and plan.names is None else []
    return names if len(names) == len(cells) and all(NAME.fullmatch(name) for name in names) else None


def sampled(plan, lines, first_line):
    """([(line, fields)] of the first rows, the stamp of the serial monitor before the first)"""
    rows, stamp = [], None
    for line, text in enumerate(lines, first_line):
        found = plan.payload(text) if text.strip() and text.lstrip()[0] != "#" else None
        cells = plan.fields(found[1]) if found else None
        if cells and sum(forms.is_number(cell) for cell in cells) >= 3:
            stamp = stamp if rows else found[0]
            rows.append((line, cells))
        if len(rows) == SAMPLE_ROWS:
            break
    return rows, stamp


def whole_sensors(header, width):
    """Whether rows lack the last sensors that the header names: they have the time and a whole number of triples."""
    return width < len(header) and width % 3 == 1 and len(header) % 3 == 1 and cols.plain_name(header[0])[0] in cols.TIMES


def width_of(path, header, rows):
    """(fields of a row, empty fields after them, note or None). TiltError if header and rows do not match."""
    line, width = rows[0][0], Counter(len(cells) for _, cells in rows).most_common(1)[0][0]
    ends_empty = all(cells[-1] == "" for _, cells in rows)
    if header is None:
        return (width - 1, 1, None) if ends_empty else (width, 0, None)
    if width == len(header):
        return width, 0, None
    if width == len(header) + 1 and ends_empty:
        return width - 1, 1, None
    if whole_sensors(header, width):
        return width, 0, f"rows of {width} fields under a header of {len(header)}: the last {(len(header) - width) // 3} sensors are missing"
    raise at(path, line, f"{len(rows[0][1])} fields where the header has {len(header)}: name every column in it, or delete it")


def columns_of(path, options, header, rows, width):
    if options.columns:
        chosen = cols.of_option(options.columns, header, path)
    elif header:
        chosen = cols.of_header(header[:width], path, options.sensor)
    else:
        chosen = cols.of_numbers(numbers_of(rows, width), path)
    if max(chosen.axes + (chosen.time or 0,)) >= width:
        raise TiltError(f"{path}: column {max(chosen.axes + (chosen.time or 0,)) + 1} requested, but rows have {width}: count from 1 in --columns")
    return chosen


def numbers_of(rows, width):
    """The rows with that many fields, NaN for a field that is not a number."""
    def number(cell):
        try:
            return number_or_time(cell)[0]
        except ValueError:
            return np.nan
    return np.array([[number(cell) for cell in cells[:width]] for _, cells in rows if len(cells) >= width])


def day_of(header, chosen, cells):
    """The column of the day, where the time is a clock without one; else None."""
    names = [name for name, _ in cols.names_of(header or [])]
    day = names.index("date") if "date" in names else None
    if day in (None, chosen.time) or chosen.time is None or day >= len(cells) or unit_of(cells[chosen.time]) != "clock":
        return None
    if unit_of(f"{cells[day]} {cells[chosen.time]}") is None:
        chosen.notes.append(f"the day '{cells[day]}' is in no known form: ignored")
        return None
    return day


def unit_of(text):
    """The unit of a time with colons; None for any other text."""
    try:
        return number_or_time(text)[1]
    except ValueError:
        return None  # reading the row reports it


def decimals_of(rows, axes):
    """The most digits after a decimal point in the sample."""
    cells = [cells[index] for _, cells in rows for index in axes if index < len(cells)]
    return max([len(cell.partition(".")[2].rstrip()) + (20 if "e" in cell.lower() else 0) for cell in cells] or [0])


def no_rows_hint(lines):
    if any(re.match(r"\W*(?:\d+:[\d:.]+ -> )?x\w*\s*[=:]\s*-?\d", line, re.I) for line in lines):
        return "x, y and z are on lines of their own, print them on one line"
    return "each row needs x, y and z, for example 12,-3,250"


def settle(path, options, lines, first_line):
    """Settles the first lines of a file. options: sensor, columns. TiltError if it is not a recording."""
    header = find_header(lines, cols.names_in(options.columns))
    plan = forms.plan_of(lines, options.sensor)
    if header and not options.columns:
        cols.of_header(header, path, 1)  # a spectrum, or not accelerations
    if plan is None and header:
        raise TiltError(f"{path}: only a header, no rows of numbers: record again")
    if plan is not None and header:
        plan.lead = 0
    rows, stamp = sampled(plan, lines, first_line) if plan else ([], None)
    if not rows:
        raise TiltError(f"{path}: not a recording: no row of three numbers in its first {len(lines)} lines: {no_rows_hint(lines)}")
    header = list(plan.names) if plan.names is not None else header or unknown_header(plan, lines, rows, first_line)
    width, trail, note = width_of(path, header, rows)
    chosen = columns_of(path, options, header, rows, width)
    if plan.keywords[1:]:
        chosen.other_sensors = True
        chosen.notes.append(f"lines '{plan.keyword}:' used, of {', '.join(plan.keywords)} (--sensor N for another)")
    chosen.notes += [note] if note else []
    first = next(cells for _, cells in rows if len(cells) >= width)
    chosen.day = day_of(header, chosen, first)
    unit = unit_of(chosen.time_in(first, stamp) or "") or chosen.time_unit
    chosen.unit = chosen.unit or plan.unit
    return Settled(plan, chosen, header, width, trail, decimals_of(rows, chosen.axes), unit)
