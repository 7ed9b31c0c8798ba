"""Reads streams, the CSV files of docs/protocol.md, into numpy arrays, and writes them. Rules and error messages are those of sim/model/stream.c,
the simulator's reader.

An hour at 100 Hz is read in a fraction of a second: all lines at once if each is plain, digits and commas alone. A file with anything else
in its rows (blanks, plus signs, a fault) is read line by line, which also finds the line of a fault.
"""
from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from tilt.errors import TiltError, at
from tilt.output import whole_file

COLUMNS_MAX = 64
LSB_MIN, LSB_MAX = -4096, 4095
CDEG_MAX = 18000
TIME_MAX = 10 ** 15
WRAP_US, WRAP_STEP_US = 1 << 32, 1 << 31
COASTED, FAULT = 2, 16
TIME, READING, TRUTH, FLAGS = "t_us", ("x", "y", "z"), ("roll_true_cdeg", "pitch_true_cdeg"), "flags"
WHOLE_MIN, WHOLE_MAX = -(1 << 63), (1 << 63) - 1
RANGES = {TIME: (0, TIME_MAX), FLAGS: (0, 65535)} | {name: (LSB_MIN, LSB_MAX) for name in READING} | {name: (-CDEG_MAX, CDEG_MAX) for name in TRUTH}
BLANKS = b" \t\r"
WHOLE = re.compile(rb"[ \t\n\v\f\r]*[+-]?[0-9]+")
PLAIN_DIGITS = 15           # of the longest number that the quick way reads: TIME_MAX has one more
ROWS_AT_A_TIME = 200_000    # between two reports of progress


@dataclass
class Stream:
    """One recording; all arrays have one element per row.

    t_us: int64, unwrapped, from 0; a segment begins one median step after the end of the previous one.
    lsb: int16 (rows, 3), x y z, about 256 to the g. flags: uint16, 0 without such a column. missing: no sample (flag 2 or 16).
    roll_true_cdeg, pitch_true_cdeg: int16, or None. line: in the file, from 1. segments: slices of rows, one for each header that has rows.
    step_us: the median step within segments, 0 with one row. start_us: the file's first time. columns: int64, those requested by name.
    """
    path: str
    t_us: np.ndarray
    lsb: np.ndarray
    flags: np.ndarray
    missing: np.ndarray
    roll_true_cdeg: np.ndarray | None
    pitch_true_cdeg: np.ndarray | None
    line: np.ndarray
    segments: list
    step_us: int
    start_us: int
    columns: dict = field(default_factory=dict)

    @classmethod
    def read(cls, path, columns=(), progress=None) -> Stream:
        """See the function."""
        return read(path, columns, progress)

    def frame(self):
        """A pandas DataFrame, one row per row."""
        import pandas as pd
        truth = {name: getattr(self, name) for name in TRUTH} if self.has_truth else {}
        return pd.DataFrame({TIME: self.t_us + self.start_us, **dict(zip(("x_lsb", "y_lsb", "z_lsb"), self.lsb.T)), FLAGS: self.flags, **truth})

    def __len__(self):
        return len(self.t_us)

    @property
    def rate_hz(self):
        """From the median step; 0 with one row."""
        return 1e6 / self.step_us if self.step_us else 0.0

    @property
    def has_truth(self):
        return self.roll_true_cdeg is not None

    @property
    def seconds(self):
        """From the first row to one step after the last."""
        return (int(self.t_us[-1]) + self.step_us) * 1e-6


class _NotPlain(Exception):
    """The rows need the line-by-line reader."""


@dataclass
class _Header:
    """A header line and its rows: positions of columns, values {column: int64 array} and line numbers."""
    count: int
    places: dict
    values: dict = field(default_factory=dict)
    line: np.ndarray | None = None

    @property
    def has_truth(self):
        return all(name in self.places for name in TRUTH)

    def wanted(self, extra):
        """The columns to read."""
        truth = TRUTH if self.has_truth else ()
        return list(dict.fromkeys((TIME, *READING, *truth, *((FLAGS,) if FLAGS in self.places else ()), *extra)))


def _header(path, number, text, extra, before):
    """The header in this line; before: those above it."""
    names = [_short(name.strip(BLANKS)) for name in text.split(b",")]
    if len(names) > COLUMNS_MAX:
        raise at(path, number, f"more than {COLUMNS_MAX} columns")
    places = {}
    for place, name in enumerate(names):
        places.setdefault(name.decode("utf-8", "replace"), place)
    for name in (TIME, *READING, *extra):
        if name not in places:
            hint = "" if before else " (a header with t_us and x,y,z or x_lsb,y_lsb,z_lsb comes first): tilt import FILE converts other recordings"
            raise at(path, number, f"missing column {name}{hint if name not in extra else ''}")
    found = _Header(len(names), places)
    if any(len(other.line) for other in before) and found.has_truth != before[-1].has_truth:
        raise at(path, number, "the truth columns come or go in the middle of the file")
    return found


def _short(name):
    return name[:1] if name in (b"x_lsb", b"y_lsb", b"z_lsb") else name


def _is_header(text):
    return text.startswith(b"t_us,") or b",t_us" in text


# --- all lines at once ------------------------------------------------------------------------------------------------


def _special_lines(data, octets, starts):
    """Numbers of the lines that may not be rows: they do not begin with a digit, or contain the name of the time column."""
    first = octets[starts]
    odd = np.flatnonzero((first < ord("0")) | (first > ord("9")))
    named = [match.start() for match in re.finditer(b"t_us", data)]
    return np.union1d(odd, np.searchsorted(starts, named, side="right") - 1).astype(np.int64)


def _plain_numbers(path, name, octets, begins, ends):
    """int64 of the texts octets[begins:ends]: digits, with or without a minus sign."""
    negative = octets[begins] == ord("-")
    length = ends - begins - negative
    if length.min() < 1 or length.max() > PLAIN_DIGITS:
        raise _NotPlain
    value = np.zeros(len(begins), np.int64)
    for place in range(int(length.max())):
        there = np.flatnonzero(length > place) if place >= length.min() else slice(None)
        digit = octets[ends[there] - 1 - place] - np.uint8(ord("0"))
        if digit.max() > 9:
            raise _NotPlain
        value[there] += digit.astype(np.int64) * 10 ** place
    np.negative(value, out=value, where=negative)
    low, high = RANGES.get(name, (WHOLE_MIN, WHOLE_MAX))
    if value.min() < low or value.max() > high:
        raise _NotPlain
    return value


class _Table:
    """The bytes of a file as lines."""

    def __init__(self, data):
        self.data = data if data.endswith(b"\n") else data + b"\n"
        self.octets = np.frombuffer(self.data, np.uint8)
        self.ends = np.flatnonzero(self.octets == ord("\n"))
        self.starts = np.concatenate(([0], self.ends[:-1] + 1))
        self.commas = np.flatnonzero(self.octets == ord(","))
        self.comma = np.searchsorted(self.commas, np.concatenate((self.starts, [len(self.data)])))  # index of each line's first comma

    def text(self, line):
        return self.data[self.starts[line]:self.ends[line]].strip(BLANKS)

    def fields(self, path, head, names, lines):
        """{column: int64} of these lines."""
        if np.any(self.comma[lines + 1] - self.comma[lines] != head.count - 1):
            raise _NotPlain
        found = {}
        for name in names:
            place = head.places[name]
            begins = self.starts[lines] if place == 0 else self.commas[self.comma[lines] + place - 1] + 1
            ends = self.ends[lines] if place == head.count - 1 else self.commas[self.comma[lines] + place]
            found[name] = _plain_numbers(path, name, self.octets, begins, ends)
        return found


def _plain(path, data, extra, progress):
    """The headers with their rows; _NotPlain if a line needs the line-by-line reader."""
    data = data.replace(b"\r\n", b"\n")
    if b"\r" in data or b"\0" in data or not data:
        raise _NotPlain
    table = _Table(data)
    is_row = np.ones(len(table.starts), bool)
    heads = []
    for line in _special_lines(data, table.octets, table.starts).tolist():
        text = table.text(line)
        if not text or text.startswith(b"#"):
            is_row[line] = False
        elif not heads or _is_header(text):
            is_row[line] = False
            heads.append((line, text))
    if not heads or np.any(is_row[:heads[0][0]]):
        raise _NotPlain
    found = []
    for (line, text), end in zip(heads, [line for line, _ in heads[1:]] + [len(is_row)]):
        head = _header(path, line + 1, text, extra, found)
        _fill(path, table, head, line + np.flatnonzero(is_row[line:end]), extra, progress)
        found.append(head)
    return found


def _fill(path, table, head, lines, extra, progress):
    names = head.wanted(extra)
    head.line = lines + 1
    parts = [{name: np.zeros(0, np.int64) for name in names}]
    for begin in range(0, len(lines), ROWS_AT_A_TIME):
        part = lines[begin:begin + ROWS_AT_A_TIME]
        parts.append(table.fields(path, head, names, part))
        progress(int(table.ends[part[-1]]), len(table.data))
    head.values = {name: np.concatenate([part[name] for part in parts]) for name in names}


# --- line by line -----------------------------------------------------------------------------------------------------


def _number(path, number, name, text):
    value = int(text) if WHOLE.fullmatch(text) and len(text) < 64 else None
    if value is None or not WHOLE_MIN <= value <= WHOLE_MAX:
        hint = ": tilt import FILE converts other units" if b"." in text else ""
        raise at(path, number, f"{name} is not a whole number: '{text[:40].decode('utf-8', 'replace')}'{hint}")
    low, high = RANGES.get(name, (WHOLE_MIN, WHOLE_MAX))
    if not low <= value <= high:
        raise at(path, number, f"{name} is outside {low}..{high}: {value}")
    return value


class _Clock:
    """Raises for a time that goes backwards, with its line."""

    def __init__(self):
        self.last_us = 0

    def look(self, path, number, t_us):
        if t_us < self.last_us and (self.last_us - t_us <= WRAP_STEP_US or self.last_us >= WRAP_US):
            raise at(path, number, f"time goes backwards: {t_us} after {self.last_us}")
        self.last_us = t_us


def _row(path, number, text, head, names, clock):
    fields = [part.strip(BLANKS) for part in text.split(b",")]
    if len(fields) != head.count:
        count = f"{COLUMNS_MAX + 1} or more" if len(fields) > COLUMNS_MAX else len(fields)
        raise at(path, number, f"{count} fields where the header has {head.count}")
    values = []
    for name in names:
        values.append(_number(path, number, name, fields[head.places[name]]))
        if name == TIME:
            clock.look(path, number, values[0])
    return values


def _careful(path, data, extra, progress):
    """The headers with their rows; raises for the first fault, with its line."""
    found, rows, lines, names, clock = [], [], [], [], None
    if not data:
        raise at(path, 1, "the file is empty")
    pieces = (data[:-1] if data.endswith(b"\n") else data).split(b"\n")
    for number, raw in enumerate(pieces, 1):
        if b"\0" in raw:
            raise at(path, number, "a NUL byte: no text, or UTF-16, which tilt import FILE converts")
        text = raw.strip(BLANKS)
        if not text or text.startswith(b"#"):
            continue
        if not found or _is_header(text):
            _keep(found, names, rows, lines)
            found.append(_header(path, number, text, extra, found))
            rows, lines, names, clock = [], [], found[-1].wanted(extra), _Clock()
        else:
            rows.append(_row(path, number, text, found[-1], names, clock))
            lines.append(number)
        if number % ROWS_AT_A_TIME == 0:
            progress(number, len(pieces))
    if not found:
        raise at(path, len(pieces), "no header")
    _keep(found, names, rows, lines)
    if not any(len(head.line) for head in found):
        raise at(path, len(pieces), "no rows after the header")
    return found


def _keep(found, names, rows, lines):
    """Stores the rows of the last header."""
    if found:
        table = np.array(rows, np.int64).reshape(len(rows), len(names))
        found[-1].values = {name: table[:, i] for i, name in enumerate(names)}
        found[-1].line = np.array(lines, np.int64)


# --- the whole --------------------------------------------------------------------------------------------------------


def _unwrapped(raw_us):
    """Times from 0; _NotPlain for a step back that is not a wrap of the 32-bit counter."""
    steps = np.diff(raw_us)
    back = steps < 0
    if np.any(back & ((steps >= -WRAP_STEP_US) | (raw_us[:-1] >= WRAP_US))):
        raise _NotPlain
    return raw_us - raw_us[0] + WRAP_US * np.concatenate(([0], np.cumsum(back)))


def _median_step(times):
    steps = np.concatenate([np.diff(t_us) for t_us in times])
    middle = len(steps) // 2
    return int(np.partition(steps, middle)[middle]) if len(steps) else 0


def _joined(path, found, extra):
    found = [head for head in found if len(head.line)]
    if not found:
        raise _NotPlain
    times = [_unwrapped(head.values[TIME]) for head in found]
    step_us = _median_step(times)
    sizes = np.cumsum([0, *map(len, times)])
    for i in range(1, len(times)):
        times[i] += times[i - 1][-1] + step_us

    def whole(name, kind):
        return np.concatenate([head.values.get(name, np.zeros(len(head.line), np.int64)) for head in found]).astype(kind)

    flags = whole(FLAGS, np.uint16)
    truth = [whole(name, np.int16) if found[0].has_truth else None for name in TRUTH]
    return Stream(path=str(path), t_us=np.concatenate(times), lsb=np.stack([whole(name, np.int16) for name in READING], axis=1), flags=flags,
                  missing=(flags & (COASTED | FAULT)) != 0, roll_true_cdeg=truth[0], pitch_true_cdeg=truth[1],
                  line=np.concatenate([head.line for head in found]), segments=[slice(int(a), int(b)) for a, b in zip(sizes, sizes[1:])],
                  step_us=step_us, start_us=int(found[0].values[TIME][0]), columns={name: whole(name, np.int64) for name in extra})


def _bytes(path):
    try:
        with open(path, "rb") as file:
            return file.read().removeprefix(b"\xef\xbb\xbf")
    except OSError as error:
        raise TiltError(f"{path}: cannot be read: {error.strerror}") from error


def read(path, columns=(), progress=None):
    """The Stream in a file; TiltError "FILE:LINE: reason" if it is not one.

    columns: names of further columns of whole numbers, all required. progress(done, whole): called now and then.
    """
    data, extra, progress = _bytes(path), tuple(columns), progress or (lambda done, whole: None)
    try:
        return _joined(path, _plain(path, data, extra, progress), extra)
    except (_NotPlain, TiltError):  # a row above a faulty header may have a fault too
        return _joined(path, _careful(path, data, extra, progress), extra)


# --- writing ----------------------------------------------------------------------------------------------------------


def _checked(t_us, lsb, segments, columns):
    if len(t_us) == 0 or len(lsb) != len(t_us) or any(len(column) != len(t_us) for column in columns.values()):
        raise ValueError("a stream has rows, and all its columns have as many")
    if np.any((lsb < LSB_MIN) | (lsb > LSB_MAX)) or np.any((t_us < 0) | (t_us > TIME_MAX)):
        raise ValueError("a reading or a time is out of its range")
    if any(np.any(np.diff(t_us[part]) < 0) for part in segments):
        raise ValueError("time goes backwards")
    for name, column in columns.items():
        low, high = RANGES.get(name, (WHOLE_MIN, WHOLE_MAX))
        if np.any((column < low) | (column > high)):
            raise ValueError(f"{name} is out of its range")


def write(path, t_us, lsb, *, flags=None, roll_true_cdeg=None, pitch_true_cdeg=None, columns=None, comments=(), segments=None,
          progress=None):
    """Writes a stream that read() returns unchanged: times in us that do not go backwards (they may exceed 32 bits), readings (rows, 3) in LSB,
    further columns {name: whole numbers}, comments (lines, without the `#`), segments (slices; one header each), progress(rows done, all).

    ValueError: values that no stream may have; TiltError: the file cannot be written. The file gets its name only when complete.
    """
    t_us, lsb = np.asarray(t_us, np.int64), np.asarray(lsb, np.int64).reshape(-1, 3)
    segments, progress = segments or [slice(0, len(t_us))], progress or (lambda done, whole: None)
    known = {FLAGS: flags, TRUTH[0]: roll_true_cdeg, TRUTH[1]: pitch_true_cdeg}
    optional = dict(columns or {}) | {name: column for name, column in known.items() if column is not None}
    optional = {name: np.asarray(column, np.int64) for name, column in optional.items()}
    _checked(t_us, lsb, segments, optional)
    head = ",".join([TIME, "x_lsb", "y_lsb", "z_lsb", *optional]) + "\n"
    form = ",".join(["%d"] * (4 + len(optional))) + "\n"
    with whole_file(path) as file:
        file.writelines(f"# {text}\n" for text in comments)
        for part in segments:
            file.write(head)
            for begin in range(part.start, part.stop, ROWS_AT_A_TIME // 10):  # Python's numbers take five times the memory
                piece = slice(begin, min(begin + ROWS_AT_A_TIME // 10, part.stop))
                table = (t_us[piece], *lsb[piece].T, *(column[piece] for column in optional.values()))
                file.writelines(form % row for row in zip(*(column.tolist() for column in table)))
                progress(piece.stop, len(t_us))
