"""The meaning of each column: from the header, from --columns, or from the numbers."""
import re
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from tilt.errors import TiltError
from tilt.importing.forms import UNIT_WORDS, is_number

AXIS = re.compile(r"(?:(?P<kind>acc|accel|accelero|acceleration|accelerometer|adxl|adxl345|a|raw|sensor|g(?=-))(?P<first>\d*)[ _.-]?)?(?P<axis>[xyz])"
                  r"(?P<second>\d*)(?P<times>\*multiplier)?"
                  r"(?:[ _.-]?(?P<suffix>lsb|raw|counts|mg|g|ms2|m/s2|m/s\^2|axis|acc|accel|a|out|val|value|norm))?")
BRACKET = re.compile(r"[(\[]([^)\]]*)[)\]]")
TIMES = {"t": None, "time": None, "timestamp": None, "time_stamp": None, "datetime": None, "date_time": None, "epoch": None, "date": None,
         "t_us": "us", "time_us": "us", "micros": "us", "us": "us", "timestamp_us": "us", "t_ms": "ms", "time_ms": "ms", "millis": "ms",
         "ms": "ms", "timestamp_ms": "ms", "t_s": "s", "time_s": "s", "seconds": "s", "secs": "s", "s": "s", "t_ns": "ns", "time_ns": "ns",
         "timestamp_ns": "ns", "ns": "ns", "count": "count", "counter": "count", "sample": "count", "samples": "count", "index": "count",
         "n": "count", "seq": "count", "i": "count", "idx": "count", "nr": "count"}
TIME_UNITS = {"s": "s", "sec": "s", "seconds": "s", "ms": "ms", "us": "us", "µs": "us", "ns": "ns"}
KEPT = ("flags", "roll_true_cdeg", "pitch_true_cdeg")  # columns of our own streams that are copied
PREFERRED = ("lsb", "raw", "counts")
EPOCH = 1e8  # seconds: 1973
DAY_S = 86400.0


@dataclass
class Columns:
    """Positions in a row, from 0."""
    axes: tuple
    time: Optional[int] = None
    day: Optional[int] = None  # of a time that is a clock
    time_unit: Optional[str] = None
    unit: Optional[str] = None
    multiplier: Optional[int] = None
    kept: dict = field(default_factory=dict)
    notes: list = field(default_factory=list)
    other_sensors: bool = False
    own: bool = False  # a stream by docs/protocol.md: its time is kept

    def time_in(self, cells, stamp):
        """The text of a row's time, None without one. stamp: what the serial monitor put before the row."""
        if self.time is None:
            return stamp
        return cells[self.time] if self.day is None else f"{cells[self.day]} {cells[self.time]}"


def plain_name(text):
    """(name in lower case without its unit, the unit in brackets or None)"""
    name = text.strip().strip("\"'").lower()
    bracket = BRACKET.search(name)
    return BRACKET.sub("", name).strip(), bracket.group(1).strip() if bracket else None


def names_of(cells):
    return [plain_name(cell) for cell in cells]


def axis_of(name):
    match = AXIS.fullmatch(name)
    return match.groupdict() if match else None


def is_spectrum(names):
    return any(name.startswith(("freq", "psd_")) for name in names)


def is_header(cells, wanted=frozenset()):
    """Whether this is a line of names that are known, or named by --columns."""
    if any(is_number(cell) for cell in cells) or len(cells) < 3:
        return False
    names = [name for name, _ in names_of(cells)]
    if wanted and wanted <= set(names):
        return True
    return is_spectrum(names) or sum(name in TIMES for name in names) + sum(axis_of(name) is not None for name in names) >= 2 \
        or (names[0] in TIMES and all(re.fullmatch(r"[a-z][\w *./^-]*", name) for name in names if name))


def sensors_of(names):
    """Sets of three columns: [((kind, number, suffix), (x, y, z))], a suffix of raw counts before others of the same sensor."""
    found = {}
    for index, (name, _) in enumerate(names):
        axis = axis_of(name)
        if axis:
            key = (axis["kind"] or "", axis["first"] or axis["second"] or "", axis["suffix"] or "")
            found.setdefault(key, {}).setdefault(axis["axis"], index)
    whole = [(key, tuple(axes[c] for c in "xyz")) for key, axes in found.items() if len(axes) == 3]
    sensors = {}
    for key, axes in sorted(whole, key=lambda item: item[0][2] not in PREFERRED):
        sensors.setdefault(key[:2], (key, axes))
    return sorted(sensors.values(), key=lambda item: item[1])


def of_header(cells, path, sensor):
    """The columns by their names. TiltError if they are not accelerations."""
    names = names_of(cells)
    words = [name for name, _ in names]
    if is_spectrum(words):
        raise TiltError(f"{path}: a spectrum ({', '.join(words[:4])}), not accelerations over time: import the raw data it was made from")
    sensors = sensors_of(names)
    if not sensors:
        raise TiltError(f"{path}: no columns x, y, z among {', '.join(words)}: if these are accelerations, name the columns with --columns")
    if not 1 <= sensor <= len(sensors):
        raise TiltError(f"{path}: --sensor {sensor}: the file has {len(sensors)}: count from 1")
    (_, number, suffix), axes = sensors[sensor - 1]
    times = [index for index, name in enumerate(words) if name in TIMES]
    times.sort(key=lambda index: (TIMES[words[index]] == "count", words[index] == "date"))  # a time before a counter or the day
    chosen = Columns(axes, times[0] if times else None)
    if times:
        chosen.time_unit = TIMES[words[times[0]]] or TIME_UNITS.get(names[times[0]][1])
    chosen.unit = UNIT_WORDS.get(suffix) or UNIT_WORDS.get(names[axes[0]][1] or "")
    chosen.multiplier = next((index for index, name in enumerate(words) if name in ("multiplier", "scale")), None)
    chosen.kept = {name: words.index(name) for name in KEPT if name in words} if "t_us" in words else {}
    chosen.own = "t_us" in words and suffix in ("", "lsb")
    chosen.unit = "raw" if chosen.own else chosen.unit
    if len(sensors) > 1:
        chosen.other_sensors = True
        chosen.notes.append(f"sensor {sensor} of {len(sensors)} used (--sensor N for another)")
    return chosen


def names_in(option):
    """The names in --columns, in lower case."""
    return frozenset(word.strip().lower() for word in (option or "").split(",") if word.strip() and not word.strip().isdigit())


def of_option(text, cells, path):
    """--columns: three (x, y, z) or four (time first) names or numbers from 1."""
    wanted = [word.strip() for word in text.split(",")]
    if len(wanted) not in (3, 4):
        raise TiltError(f"--columns {text}: give three (x,y,z) or four (time,x,y,z) names or numbers")
    names = names_of(cells) if cells else []
    words = [name for name, _ in names]
    found = []
    for word in wanted:
        if word.isdigit() and int(word) >= 1:
            found.append(int(word) - 1)
        elif word.lower() in words:
            found.append(words.index(word.lower()))
        else:
            remedy = f"choose from {', '.join(words)}" if words else "give numbers, there is no header"
            raise TiltError(f"{path}: --columns: no column '{word}': {remedy}")
    if len(wanted) == 3:
        return Columns(tuple(found))
    named = names[found[0]] if found[0] < len(names) else ("", None)
    return Columns(tuple(found[1:]), found[0], TIMES.get(named[0]) or TIME_UNITS.get(named[1]))


def is_time(column):
    """Whether it never steps back, but at midnight or at the wrap of a counter, and moves."""
    steps = np.diff(column)
    steps = steps[steps > -DAY_S / 2] if (steps < -DAY_S / 2).sum() == 1 else steps
    return len(steps) > 0 and (steps >= 0).all() and (steps > 0).sum() > len(steps) // 2


def of_numbers(sample, path):
    """The columns of a file without a header, from its first rows ((n, m) of numbers)."""
    width = sample.shape[1]
    if width < 3:
        raise TiltError(f"{path}: only {width} columns of numbers: record x, y and z")
    if width == 3:
        return Columns((0, 1, 2))
    magnitude = np.sqrt((sample[:, :3] ** 2).sum(axis=1))
    if width == 4 and (np.abs(sample[:, 3] - magnitude) <= 0.01 * magnitude + 0.02).mean() > 0.9:
        return Columns((0, 1, 2), notes=["column 4, the magnitude, ignored"])
    if len(sample) > 1 and is_time(sample[:, 0]):
        counts = len(sample) > 2 and (np.diff(sample[:, 0]) == 1).all()
        return Columns((1, 2, 3), 0, "count" if counts else None, notes=left_out(width, (0, 1, 2, 3)))
    if is_time(sample[:, -1]) and sample[0, -1] > EPOCH:
        return Columns((0, 1, 2), width - 1, None, notes=left_out(width, (0, 1, 2, width - 1)))
    return Columns((0, 1, 2), notes=left_out(width, (0, 1, 2)))


def left_out(width, used):
    others = [str(index + 1) for index in range(width) if index not in used]
    return [f"no header: columns {', '.join(str(u + 1) for u in used)} used, {', '.join(others)} ignored"] if others else []
