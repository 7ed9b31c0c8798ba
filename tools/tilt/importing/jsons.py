"""Reads JSON: one reading per line, an array of readings, or Edge Impulse's payload."""
import json
import re

import numpy as np

from tilt.errors import TiltError, at
from tilt.importing.columns import TIMES, axis_of, plain_name
from tilt.importing.forms import UNIT_WORDS
from tilt.importing.readings import MEND, Readings

FREE = None  # decimals of numbers printed with all their digits


BOXED = re.compile(rb"\[[^\[\]{}\r\n]*\]")  # a clock, or Python's print() of three numbers: lines of text


def is_json(head):
    head = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    return head[:1] in (b"{", b"[") and not BOXED.match(head)


def read(path, file, options):
    """The Readings of a JSON file; their lines are those of JSON lines."""
    text = file.read().decode("utf-8", "replace")
    try:
        whole = json.loads(text)
    except ValueError as why:
        return of_lines(path, text, options) if text.lstrip()[0] == "{" else unreadable(path, why)
    if isinstance(whole, dict) and "payload" in whole:
        return of_payload(path, whole["payload"], options)
    if isinstance(whole, list) and whole:
        return of_objects(path, enumerate(whole, 1), options, lines=False)
    return of_lines(path, text, options)


def unreadable(path, why):
    raise at(path, getattr(why, "lineno", 1), f"not JSON: {getattr(why, 'msg', why)}{MEND}")


def of_lines(path, text, options):
    def parsed():
        for line, row in enumerate(text.split("\n"), 1):
            if row.strip():
                try:
                    yield line, json.loads(row)
                except ValueError as why:
                    raise at(path, line, f"not JSON: {getattr(why, 'msg', why)}{MEND}") from None
    return of_objects(path, parsed(), options, lines=True)


def keys_of(path, place, found, options):
    """The keys of x, y, z and of the time (None if there is none), from the first object."""
    if options.columns:
        names = [name.strip() for name in options.columns.split(",")]
        if len(names) in (3, 4) and all(name in found for name in names):
            return names[-3:], names[0] if len(names) == 4 else None
        raise TiltError(f"{path}: --columns {options.columns}: give three or four of {', '.join(found)}")
    axes = {}
    for key in found:
        axis = axis_of(plain_name(key)[0])
        if axis:
            axes.setdefault(axis["axis"], key)
    if len(axes) != 3:
        raise place(f"no x, y, z among {', '.join(map(str, found)) or 'nothing'}: if these are accelerations, name the keys with --columns")
    return [axes[c] for c in "xyz"], next((key for key in found if plain_name(key)[0] in TIMES), None)


def of_objects(path, objects, options, lines):
    values, times, places, keys, time_key = [], [], [], None, None
    for number, found in objects:
        def place(reason, number=number):
            return at(path, number, reason) if lines else TiltError(f"{path}: object {number}: {reason}")
        if not isinstance(found, dict):
            raise place("not an object with x, y, z" + MEND * lines)
        if keys is None:
            keys, time_key = keys_of(path, place, found, options)
        values.append([number_at(found, key, place) for key in keys])
        if time_key is not None:
            times.append(number_at(found, time_key, place))
        places.append(number)
    if not values:
        raise TiltError(f"{path}: no rows: record again")
    return Readings(path, "JSON objects", np.array(values, dtype=np.float64), np.array(places) if lines else None,
                    np.array(times) if time_key is not None else None, TIMES.get(plain_name(time_key)[0]) if time_key is not None else None, FREE)


def number_at(found, key, place):
    if key not in found:
        raise place(f"no {key}: each object needs it, null if it is missing")
    value = found[key]
    if value is None:
        return np.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not np.isfinite(value):
        raise place(f"{key} is not a number: {value!r:.40}: write a number, or null")
    return float(value)


def of_payload(path, payload, options):
    """Edge Impulse's data acquisition format: sensors with names and units, values by row, one row per interval_ms."""
    try:
        names = [str(sensor["name"]) for sensor in payload["sensors"]]
        units = [str(sensor.get("units", "")) for sensor in payload["sensors"]]
        rows, interval_ms = payload["values"], float(payload["interval_ms"])
    except (KeyError, TypeError, ValueError) as why:
        raise TiltError(f"{path}: not an Edge Impulse file: the payload has no {why}: export the sample from its data acquisition page") from None
    if not rows:
        raise TiltError(f"{path}: no rows: record again")

    def fault(reason):
        return TiltError(f"{path}: payload.sensors: {reason}")
    keys, _ = keys_of(path, fault, dict.fromkeys(names), options)
    columns = [names.index(key) for key in keys]
    values = []
    for number, row in enumerate(rows):
        def place(reason, number=number):
            return TiltError(f"{path}: payload.values[{number}]: {reason}")
        if not isinstance(row, list) or len(row) != len(names):
            raise place(f"{len(row) if isinstance(row, list) else 1} values for {len(names)} sensors: correct or delete this row")
        values.append([number_at(dict(enumerate(row)), column, place) for column in columns])
    if not 0.0 < interval_ms < 1e6:
        raise TiltError(f"{path}: payload.interval_ms is {interval_ms:g}: write the time between rows")
    return Readings(path, "Edge Impulse", np.array(values, dtype=np.float64), None, np.arange(len(values)) * interval_ms, "ms", FREE,
                    UNIT_WORDS.get(units[columns[0]].lower()))
