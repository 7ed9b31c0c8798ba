"""Lines of text to readings: fast for blocks of numbers only, line by line for all others."""
import io
import warnings
from array import array

import numpy as np

from tilt.errors import TiltError, at
from tilt.importing import forms
from tilt.importing.columns import names_in
from tilt.importing.readings import MEND, Readings
from tilt.importing.settle import SAMPLE_LINES, header_cells, number_or_time, settle
from tilt.importing.source import blocks

ABSENT = ("", "nan", "+nan", "-nan", "null", "none", "n/a")
SHOWN = 40
TIME = 3  # position of the time among the wanted columns
SAMPLE_BYTES = 400_000
QUICK_BYTES = 200_000  # less is read line by line sooner than pandas is imported


def decoded(block):
    return block.decode("utf-8", "replace")


class Reader:
    """Reads one file, block by block; the first block settles what a row is."""

    def __init__(self, path, options):
        self.path, self.options, self.settled = path, options, None
        self.names = names_in(options.columns)
        self.parts, self.lines = [], []  # per block: (rows, columns) of the wanted columns, lines
        self.count, self.segments, self.skipped, self.notes = 0, [], [], []

    def take(self, line, block):
        if self.settled is None:
            lines = decoded(block[:SAMPLE_BYTES]).split("\n")
            self.settled = settle(self.path, self.options, lines[:SAMPLE_LINES] if len(block) > SAMPLE_BYTES else lines, line)
            self.wanted = self.columns_wanted()
        plain = self.settled.plan.plain() and not self.settled.trail and len(block) >= QUICK_BYTES
        found = self.quick(line, block) if plain else None
        values, lines = found or self.slow(line, block)
        self.parts.append(values)
        self.lines.append(lines)
        self.count += len(values)

    def columns_wanted(self):
        """Fields to keep, in the order x, y, z, time, multiplier, then those to copy; None: not present."""
        c = self.settled.columns
        return [*c.axes, c.time, c.multiplier, *c.kept.values()]

    def quick(self, line, block):
        """(values, lines) of a block in which every line is a row of numbers; None for any other block."""
        import pandas
        start = 0
        if line == 1 and self.settled.header:
            start = block.find(b"\n") + 1
            if start == 0 or header_cells(decoded(block[:start]), self.names) != self.settled.header:
                return None
        rows = block.count(b"\n", start) + (not block.endswith(b"\n"))
        separators = block.count(self.settled.plan.separator.encode(), start)
        if separators != rows * (self.settled.width - 1) or rows == 0:
            return None
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", pandas.errors.ParserWarning)
                table = pandas.read_csv(io.BytesIO(memoryview(block)[start:]), sep=self.settled.plan.separator, header=None, dtype="float64",
                                        names=range(self.settled.width), index_col=False, skipinitialspace=True, engine="c").to_numpy()
        except (ValueError, pandas.errors.ParserError, pandas.errors.ParserWarning):
            return None
        if len(table) != rows or not np.isfinite(table).all():
            return None
        values = np.column_stack([table[:, column] if column is not None else np.full(rows, np.nan) for column in self.wanted])
        return values, line + (start > 0) + np.arange(rows, dtype=np.int64)

    def slow(self, first_line, block):
        numbers, lines = array("d"), array("q")
        texts = decoded(block).split("\n")
        for line, whole in enumerate(texts, first_line):
            cut_off = line == first_line + len(texts) - 1  # text after the last line end, which exists only at the end of the file
            for text in whole.split("\r") if "\r" in whole.rstrip() else (whole,):
                text = text.strip()
                row = self.row(line, text, len(lines), cut_off) if text and text[0] != "#" else None
                if row:
                    numbers.extend(row)
                    lines.append(line)
        return np.array(numbers).reshape(-1, len(self.wanted)), np.array(lines, dtype=np.int64)

    def row(self, line, text, before, cut_off):
        """The wanted numbers of a line, None if it is not a row. before: rows of this block so far."""
        settled = self.settled
        found = settled.plan.payload(text)
        time, body = found or (None, "")
        cells = settled.plan.fields(body) if body and body[0] != "#" else None
        if cells is None:
            return None if found and (not body or body[0] == "#") else self.other(line, text)
        if settled.trail and len(cells) == settled.width + settled.trail and cells[-1] == "":
            cells = cells[:-settled.trail]
        if not cells or not self.is_row(cells, body, before):
            return None if header_cells(body, self.names) else self.other(line, text)
        if len(cells) < settled.width and cut_off:
            self.notes.append(f"line {line}, the last, is cut off and skipped: '{text[:SHOWN]}'")
            return None
        if len(cells) != settled.width:
            whose = "the header has" if settled.header and len(settled.header) == settled.width else "the other rows have"
            raise at(self.path, line, f"{len(cells)} fields where {whose} {settled.width}{MEND}")
        return self.numbers(line, cells, time)

    def is_row(self, cells, body, before):
        """Whether these are numbers, or meant to be; a repeated header begins a new segment."""
        if forms.is_number(cells[0]) or sum(map(forms.is_number, cells)) >= min(3, len(cells)):
            return True
        if self.settled.header and header_cells(body, self.names) == self.settled.header:
            if self.count + before:
                self.segments.append(self.count + before)
            return False
        time = self.settled.columns.time
        if time is not None and time < len(cells):
            try:
                number_or_time(cells[time])
                return True
            except ValueError:
                pass
        return len(cells) == self.settled.width and any(map(forms.is_number, cells))

    def other(self, line, text):
        """A line that is not a row: text is skipped and reported, unless it holds the numbers of a row."""
        if self.settled.plan.keyword is not None:
            return
        _, body = forms.clocked(text)
        if len(forms.numbers_in(body)) >= 3 and not any(c.isalpha() for c in body.replace("e", "").replace("E", "")):
            raise at(self.path, line, f"not in the form of the other rows: '{text[:SHOWN]}'{MEND}")
        self.skipped.append((line, text))

    def numbers(self, line, cells, clock):
        """The wanted columns of a row. clock: what the serial monitor put before it."""
        texts = [cells[column] if column is not None else None for column in self.wanted]
        texts[TIME] = self.settled.columns.time_in(cells, clock)
        return [np.nan if text is None else self.number(line, place, text) for place, text in enumerate(texts)]

    def number(self, line, place, text):
        """A field; NaN for a missing reading, never for a time."""
        try:
            value = number_or_time(text)[0] if place == TIME else float(text)
        except ValueError:
            value = np.inf if place == TIME or text.lower() not in ABSENT else np.nan
        if abs(value) == np.inf or "_" in text or (place == TIME and value != value):
            raise at(self.path, line, f"not a number: '{text[:SHOWN]}'{MEND}")
        return value


def read(path, file, head, options):
    """The Readings of a text file. options: sensor, columns."""
    reader = Reader(path, options)
    for line, block in blocks(path, file, head):
        reader.take(line, block)
    if not reader.count:
        raise TiltError(f"{path}: no rows: record again")
    settled, columns = reader.settled, reader.settled.columns
    table, lines = np.concatenate(reader.parts), np.concatenate(reader.lines)
    timed = columns.time is not None or settled.plan.clock
    kept = {name: whole(reader, table[:, 5 + place], lines, name) for place, name in enumerate(columns.kept)}
    return Readings(path, words_of(settled), table[:, :3], lines, table[:, 3] if timed else None, settled.time_unit, settled.decimals,
                    columns.unit, table[:, 4] if columns.multiplier is not None else None, kept, reader.segments,
                    columns.notes + reader.notes + skipped_note(reader), columns.other_sensors, own=columns.own)


def whole(reader, column, lines, name):
    """A column of whole numbers."""
    bad = np.flatnonzero(column != np.rint(column))
    if len(bad):
        raise at(reader.path, int(lines[bad[0]]), f"{name} is not a whole number{MEND}")
    return column.astype(np.int64)


def skipped_note(reader):
    if not reader.skipped:
        return []
    line, text = reader.skipped[0]
    return [f"{len(reader.skipped)} lines of text skipped, the first: line {line} '{text[:SHOWN]}'"]


def words_of(settled):
    plan = settled.plan
    if settled.columns.own:
        return "stream"
    kinds = [(plan.clock, "serial monitor"), (plan.keyword, f"'{plan.keyword}:' lines"), (plan.literal, "Python bytes"),
             (plan.names, "NAME = VALUE lines")]
    return next((words for there, words in kinds if there), "columns" if settled.header is None else f"columns {','.join(settled.header[:4])}")
