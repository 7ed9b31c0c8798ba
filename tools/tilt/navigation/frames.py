"""Records and frames of the navigation image (docs/navigation-link.md)."""
import binascii
import struct
from dataclasses import dataclass

from tilt.navigation import settings

BAUD = 1_000_000
VERSION = 1
STATE_NUMBERS = 13
PARAMETERS_AT_ONCE = 6
# nav_answer_t (nav/lib/nav.h), then link_answer_t (nav/image/nav_link.h)
NAV_ANSWERS = ("taken", "gated", "time went backwards", "too late", "not finite", "no length", "out of range", "queue full", "gap")
LINK_FIRST = 32
LINK_ANSWERS = ("broken frame", "unknown type", "wrong length", "out of order", "not started", "start refused")
MISSING = "records missing"
IMU_WITHOUT_STATE, IMU_WITH_STATE = b"\0", b"\1"
TYPES = {"parameters": "P", "start": "S", "imu": "I", "gps": "G", "down": "A", "field": "M", "variances": "V", "counts": "C", "hello": "H"}


def answer_text(code):
    for first, names in ((0, NAV_ANSWERS), (LINK_FIRST, LINK_ANSWERS)):
        if first <= code < first + len(names):
            return names[code - first]
    return f"answer {code}"


def stuffed(data):
    """COBS encoding: contains no zero."""
    out = bytearray()
    for run in data.split(b"\0"):
        while len(run) >= 254:
            out += b"\xff" + run[:254]
            run = run[254:]
        out += bytes([len(run) + 1]) + run
    return bytes(out)


def unstuffed(data):
    """Decodes COBS; None if it is not COBS."""
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        if code == 0 or at + code > len(data):
            return None
        out += data[at + 1:at + code]
        at += code
        if code < 255 and at < len(data):
            out.append(0)
    return bytes(out)


def crc(data):
    """CRC-16/CCITT, start 0xFFFF, in transmission order."""
    return struct.pack("<H", binascii.crc_hqx(data, 0xFFFF))


def frame(record):
    return stuffed(record + crc(record)) + b"\0"


def record_of(data):
    """The record in one frame without its zero; None if it is damaged."""
    whole = unstuffed(data)
    if whole is None or len(whole) < 3 or crc(whole[:-2]) != whole[-2:]:
        return None
    return whole[:-2]


def _head(kind, sequence):
    return TYPES[kind].encode() + bytes([sequence & 0xFF])


def single(number):
    """The number in single precision; beyond its range the infinity of that sign."""
    try:
        return struct.pack("<f", number)
    except OverflowError:
        return struct.pack("<f", float("inf") if number > 0 else float("-inf"))


def start_records(sequence, chosen):
    """The parameters in groups, then the start."""
    values = [chosen[name] for name in settings.DEFAULTS]
    numbers = [number for value in values[:-1] for number in (value if isinstance(value, tuple) else (value,))]
    groups = range(0, len(numbers), PARAMETERS_AT_ONCE)
    records = [_head("parameters", sequence + place) + bytes([first]) + b"".join(map(single, numbers[first:first + PARAMETERS_AT_ONCE]))
               for place, first in enumerate(groups)]
    return [*records, _head("start", sequence + len(groups)) + struct.pack("<I", values[-1])]


def row_record(sequence, kind, t_us, values, with_state=False):
    body = struct.pack("<I", t_us) + b"".join(map(single, values))
    return _head(kind, sequence) + body + ((IMU_WITH_STATE if with_state else IMU_WITHOUT_STATE) if kind == "imu" else b"")


def bare_record(sequence, kind):
    return _head(kind, sequence)


@dataclass(frozen=True)
class Hello:
    version: int
    states: int
    window: int
    reset_cause: int


@dataclass(frozen=True)
class Answer:
    sequence: int
    kind: str
    code: int
    waiting: int
    taken: int


@dataclass(frozen=True)
class State:
    t_us: int
    numbers: tuple


@dataclass(frozen=True)
class Variances:
    healthy: bool
    numbers: tuple


@dataclass(frozen=True)
class Counts:
    """{what: how often}"""
    counted: dict


def _hello(body):
    return Hello(*struct.unpack("<BBHB", body))


def _answer(body):
    sequence, kind, code, waiting, taken = struct.unpack("<BBBBH", body)
    return Answer(sequence, chr(kind) if kind else "", code, waiting, taken)


def _state(body):
    t_us, *numbers = struct.unpack(f"<I{STATE_NUMBERS}f", body)
    return State(t_us, tuple(numbers))


def _variances(body):
    healthy, *numbers = struct.unpack(f"<B{(len(body) - 1) // 4}f", body)
    return Variances(bool(healthy), tuple(numbers))


def _counts(body):
    names = (*NAV_ANSWERS, *LINK_ANSWERS, MISSING)
    return Counts(dict(zip(names, struct.unpack(f"<{len(names)}H", body))))


READERS = {b"h": _hello, b"k": _answer, b"s": _state, b"v": _variances, b"c": _counts}


class Reader:
    """Bytes from the board in, its records out; `damaged` counts invalid ones."""

    def __init__(self):
        self.kept, self.damaged = b"", 0

    def feed(self, data):
        *ended, self.kept = (self.kept + data).split(b"\0")
        found = []
        for piece in ended:
            if not piece:
                continue
            record = record_of(piece)
            try:
                found.append(READERS[record[:1]](record[1:]))
            except (KeyError, TypeError, struct.error):
                self.damaged += 1
        return found
