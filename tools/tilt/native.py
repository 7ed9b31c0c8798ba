"""The shipped C code on the PC: build/host/libtilt.so (host_tests/tools/libtilt), built by make if missing or older than its sources."""
import ctypes
import functools
import mmap
import os
import pathlib
import re
import shutil
import subprocess
from dataclasses import dataclass

import numpy as np

from tilt.errors import TiltError
from tilt.place import IN_WHEEL, ROOT, VERSION

LIBRARY = pathlib.Path("build/host/libtilt.so")
SOURCES = ("firmware/*/*.[ch]", "lib/*/src/*.[ch]", "hal/*.h", "hal/host/*.[ch]", "sim/*/*.[ch]", "host_tests/tools/libtilt/*.[ch]",
           "host_tests/support/*.[ch]",
           "Makefile", "tools/tilt/tilt.mk")
WHEELS = "libtilt.args"  # in a wheel: what the compiler is called with, from its folder; there make is not needed
RATES_DHZ = tuple(125 << power for power in range(7))  # of the firmware
FORK_FROM_ROWS = 20_000  # a second process takes 20 ms to start and end
MISSING, THERE, AT_RAIL = 0, 1, 2
GATED, REACQUIRED = 1, 4  # flags of probes, as those of rows
REFUSED_FIRST = 3  # filter_init returns this for the first parameter

ROW = np.dtype([("t_us", "<i8"), ("source", "<i4"), ("lsb", "<i2", 3), ("mg", "<i2", 3), ("roll_cdeg", "<i2"), ("pitch_cdeg", "<i2"),
                ("flags", "<u2"), ("unused", "<u2")], align=True)
PROBE = np.dtype([("x_lsb_q16", "<i4"), ("rate_lsb_q16", "<i4"), ("innovation_lsb_q16", "<i4"), ("p_lsb2_q8", "<u4"), ("gate_lsb2_q8", "<u4"),
                  ("r_lsb2_q8", "<u4"), ("gain_uq16", "<u2"), ("flags", "u1"), ("judged", "u1")], align=True)


class _Stream(ctypes.Structure):
    _fields_ = [("count", ctypes.c_int64), ("t_us", ctypes.c_void_p), ("lsb", ctypes.c_void_p), ("missing", ctypes.c_void_p),
                ("step_us", ctypes.c_int64)]


class _Parameter(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char * 16), ("unit", ctypes.c_char * 8), ("min", ctypes.c_int64), ("max", ctypes.c_int64),
                ("value", ctypes.c_int64), ("fraction_bits", ctypes.c_int32), ("zero_means_off", ctypes.c_int32)]


@dataclass(frozen=True)
class Parameter:
    """A filter's parameter: index in its descriptor, legal range and default in its unit, and the smallest step."""
    index: int
    name: str
    unit: str
    low: float
    high: float
    default: float
    step: float
    zero_is_off: bool = False

    def check(self, value: float) -> None:
        """TiltError if the console refuses the value."""
        if not (self.low <= value <= self.high or self.zero_is_off and value == 0):
            raise TiltError(f"{self.name} {value:g}: {'0 or ' if self.zero_is_off else ''}{self.text(self.low)} to {self.text(self.high)}")

    def stored(self, value):
        """The value as the filter stores it, rounded to its step and limited to its range."""
        if value == 0 and self.zero_is_off:
            return 0
        return round(min(max(value, self.low), self.high) / self.step)

    def text(self, value):
        """The value as typed on the console: the nearest step, with no more digits than needed."""
        digits = 0 if self.step >= 1 else 3
        shown = f"{self.stored(value) * self.step:.{digits}f}"
        return shown.rstrip("0").rstrip(".") if digits else shown


# --- the library ------------------------------------------------------------------------------------------------------


def _stale(root):
    library = root / LIBRARY
    if not library.exists():
        return True
    built = library.stat().st_mtime
    return any(source.stat().st_mtime > built for pattern in SOURCES for source in root.glob(pattern))


def _build(root):
    return _compile(root) if (root / WHEELS).exists() else _make(root)


def _compile(root):
    compiler = next((each for each in (os.environ.get("CC"), "cc", "gcc", "clang") if each and shutil.which(each)), None)
    if compiler is None:
        raise TiltError("this command compiles the filters when it is first used, and there is no C compiler: install gcc or clang "
                        "(Debian: apt install gcc libc6-dev; macOS: xcode-select --install)")
    try:
        (root / LIBRARY).parent.mkdir(parents=True, exist_ok=True)
        made = LIBRARY.with_suffix(f".{os.getpid()}")  # another tilt may be compiling it too, or loading it
        done = subprocess.run([compiler, f"@{WHEELS}", "-o", str(made)], cwd=root, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            os.replace(root / made, root / LIBRARY)
    except OSError as error:
        raise TiltError(f"cannot compile the filters in {root}: {error.strerror}") from error
    if done.returncode != 0:
        raise TiltError(f"{compiler} could not compile the filters in {root}: {(done.stderr.strip().splitlines() or ['no reason given'])[0]}")


def _make(root):
    try:
        done = subprocess.run(["make", "-s", str(LIBRARY)], cwd=root, capture_output=True, text=True, check=False)
    except OSError as error:
        raise TiltError(f"cannot run make ({error.strerror}) to build {root / LIBRARY}: install it with sh tools/deps.sh sim") from error
    if done.returncode != 0:
        said = (done.stderr + done.stdout).strip().splitlines() or ["no reason given"]
        hint = ": install the compiler with sh tools/deps.sh sim" if "not found" in done.stderr or "No such file" in done.stderr else ""
        raise TiltError(f"make could not build {root / LIBRARY}: {said[0]}{hint}")


@functools.lru_cache(maxsize=None)
def library(root=ROOT):
    if _stale(root):
        _build(root)
    try:
        loaded = ctypes.CDLL(str(root / LIBRARY))
    except OSError as error:
        raise TiltError(f"{root / LIBRARY}: cannot load it: {error}") from error
    loaded.libtilt_filter_name.restype = ctypes.c_char_p
    loaded.libtilt_filter_published_only.restype = ctypes.c_bool
    loaded.libtilt_parameter.restype = ctypes.c_bool
    loaded.libtilt_parameter.argtypes = [ctypes.c_int, ctypes.c_int, ctypes.c_uint16, ctypes.c_void_p]
    loaded.libtilt_row_per_tick.argtypes = [ctypes.c_void_p, ctypes.c_uint16]
    loaded.libtilt_replay.restype = ctypes.c_int64
    loaded.libtilt_replay.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_uint16, ctypes.c_uint8, ctypes.c_void_p, ctypes.c_void_p,
                                      ctypes.c_void_p, ctypes.c_int64]
    loaded.libtilt_axis.argtypes = [ctypes.c_int, ctypes.c_uint16, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_bool,
                                    ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p]
    return loaded


def filters():
    """Names of all filters, in the firmware's order."""
    return [library().libtilt_filter_name(kind).decode() for kind in range(library().libtilt_filters())]


def chosen(names):
    """The filters of "A,B,C"; None: all. TiltError for an unknown or repeated name."""
    every = filters()
    wanted = every if names is None else [name.strip() for name in names.split(",")]
    for name in wanted:
        if name not in every:
            raise TiltError(f"--filter: no filter '{name}': choose from {' '.join(every)}")
        if wanted.count(name) > 1:
            raise TiltError(f"--filter: {name} is given twice: give it once")
    return wanted


def parameters(name, rate_dhz):
    """{name: Parameter} of a filter at this rate."""
    kind, found = filters().index(name), {}
    raw = _Parameter()
    while library().libtilt_parameter(kind, len(found), rate_dhz, ctypes.byref(raw)):
        step = 2.0 ** -raw.fraction_bits
        found[raw.name.decode()] = Parameter(len(found), raw.name.decode(), raw.unit.decode(), raw.min * step, raw.max * step, raw.value * step, step,
                                                 bool(raw.zero_means_off))
    return found


def rate_of(stream, asked_hz=None):
    """The output data rate in 0.1 Hz: the one asked for, else the firmware's rate nearest to the recording's."""
    if asked_hz is not None:
        if asked_hz * 10 not in RATES_DHZ:
            raise TiltError(f"rate {asked_hz:g}: choose from {' '.join(f'{rate / 10:g}' for rate in RATES_DHZ)}")
        return round(asked_hz * 10)
    if not stream.rate_hz:
        raise TiltError(f"{stream.path}: all rows have the same time, so the rate is unknown: give --rate HZ, in Python rate_hz=HZ")
    return min(RATES_DHZ, key=lambda rate: abs(np.log(rate / 10 / stream.rate_hz)))


# --- the sample path --------------------------------------------------------------------------------------------------


def _arrays(every, values):
    """(stored values, which are given) by the parameters' indices."""
    stored, changed = np.zeros(32, np.int64), np.zeros(32, np.uint8)
    for key, value in values.items():
        stored[every[key].index], changed[every[key].index] = every[key].stored(value), 1
    return stored, changed


class _Input:
    """The arrays of a stream as C has them; they live as long as this object."""

    def __init__(self, stream):
        self.kept = [np.ascontiguousarray(part, kind) for part, kind in ((stream.t_us, np.int64), (stream.lsb, np.int16), (stream.missing, np.uint8))]
        t_us, lsb, missing = (part.ctypes.data for part in self.kept)
        self.c = _Stream(len(stream), t_us, lsb, missing, stream.step_us)


def row_per_tick(stream, rate_dhz):
    """Whether each tick of the virtual sensor takes a row; else it samples the row in force."""
    return bool(library().libtilt_row_per_tick(ctypes.byref(_Input(stream).c), rate_dhz))


def _room(stream, rate_dhz):
    """Upper limit of rows: one per tick, and ten a second in a silence longer than a second and a tick."""
    gaps_us = np.diff(stream.t_us, append=stream.t_us[-1] + stream.step_us).astype(float)
    hz = max(rate_dhz / 10, stream.rate_hz)
    ticks = np.minimum(gaps_us * 1e-6 * hz, 1.2 * hz + gaps_us * 1e-6 * 10.0) + 2.0
    return int(np.sum(ticks)) + 16


def _replay_one(given, name, rate_dhz, range_g, out, values=None):
    stored, changed = _arrays(parameters(name, rate_dhz) if values else {}, values or {})
    rows = library().libtilt_replay(ctypes.byref(given.c), filters().index(name), rate_dhz, range_g, stored.ctypes.data, changed.ctypes.data,
                                    out.ctypes.data, len(out))
    if rows == -3:
        typed = ", ".join(f"{key} {value:g}" for key, value in values.items())
        raise TiltError(f"{name} refuses {typed}: docs/protocol.md lists the legal values; legal ones that do not go together are refused too")
    if rows < 0:
        raise MemoryError("libtilt_replay: " + ("no memory" if rows == -2 else f"more rows than {len(out)}"))
    return rows


def replay(stream, names, rate_dhz, range_g=16, report=None, values=None):
    """{filter: rows (ROW)} of the firmware's sample path over the recording, each from a cold start. report(done, all) as filters end. values:
    {parameter: in its unit}, the others at their defaults.

    Two processes share the filters of a long recording, because the sample path keeps its state in static variables.
    """
    given, room = _Input(stream), _room(stream, rate_dhz)
    memory = mmap.mmap(-1, max(1, len(names)) * (room * ROW.itemsize + 8))
    counts = np.frombuffer(memory, np.int64, len(names))
    tables = np.frombuffer(memory, ROW, len(names) * room, len(names) * 8).reshape(len(names), room)
    library()
    mine, other = list(range(len(names))), []
    if len(stream) >= FORK_FROM_ROWS and len(names) > 1 and (os.cpu_count() or 1) > 1 and hasattr(os, "fork"):
        mine, other = _shares(names)
    child = _in_child(lambda: [_into(given, names, i, rate_dhz, range_g, tables, counts, values) for i in other]) if other else None
    for done, i in enumerate(mine, 1):
        _into(given, names, i, rate_dhz, range_g, tables, counts, values)
        if report:
            report(done * len(names) // len(mine), len(names))
    if child is not None and os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) != 0:
        raise MemoryError("the second process of the replay ended early")
    return {name: tables[i, :counts[i]] for i, name in enumerate(names)}


def _into(given, names, i, rate_dhz, range_g, tables, counts, values):
    counts[i] = _replay_one(given, names[i], rate_dhz, range_g, tables[i], values)


def _shares(names):
    """Two lists of indices of about equal work, weighed by the cycles on the chip."""
    cost = {name: 2000 + library().libtilt_filter_cycles(kind) for kind, name in enumerate(filters())}
    shares, loads = ([], []), [0, 0]
    for i in sorted(range(len(names)), key=lambda i: -cost[names[i]]):
        least = loads.index(min(loads))
        shares[least].append(i)
        loads[least] += cost[names[i]]
    return shares


def _in_child(work):
    """Runs the work in its own process; what it writes into shared memory stays. Returns the process id."""
    child = os.fork()
    if child == 0:
        status = 1
        try:
            work()
            status = 0
        finally:
            os._exit(status)
    return child


# --- one axis ---------------------------------------------------------------------------------------------------------


def published_only():
    """Names of the filters that are there to compare with the papers; no tool recommends one."""
    return {name for kind, name in enumerate(filters()) if library().libtilt_filter_published_only(kind)}


def cycles(name):
    """Worst case of an update on the chip, per axis."""
    return library().libtilt_filter_cycles(filters().index(name))


def flashed_by(name):
    """The command that writes the first image with this filter to a board (mk/images.mk)."""
    text = (ROOT / "mk/images.mk").read_text(encoding="utf-8")
    names = re.search(r"^FILTER_SETS *:= *(.*)$", text, re.M).group(1).split()
    holds = dict(re.findall(r"^FILTERS_(\w+) *:= *(.*)$", text, re.M))
    holding = [each for each in names if name in holds[each].split()]
    if not holding:
        return f"make flash FILTERS={name}"
    if IN_WHEEL:
        return "tilt flash PORT" if holding[0] == names[0] else f"tilt flash PORT --image tilt-uno-{VERSION}-{holding[0]}-16mhz.hex"
    return "make flash" if holding[0] == names[0] else f"make flash FILTERS={holding[0]}"


def accepts(name, rate_dhz, values):
    """Whether the filter takes these values, the others at their defaults."""
    try:
        axis(name, rate_dhz, np.zeros(1, np.int16), np.full(1, THERE), values)
    except TiltError:
        return False
    return True


def axis(name, rate_dhz, z_lsb, state, values=None, r_lsb2=None, noisy_axis=False):
    """Probes (PROBE) of one axis after a filter. values: {parameter: in its unit}, the others at their defaults; R fixed, or None: estimated
    as the firmware does. TiltError if the filter rejects its parameters."""
    every = parameters(name, rate_dhz)
    stored, changed = _arrays(every, values or {})
    z_lsb, state = np.ascontiguousarray(z_lsb, np.int16), np.ascontiguousarray(state, np.uint8)
    out = np.zeros(len(z_lsb), PROBE)
    r_q8 = 0 if r_lsb2 is None else every["r"].stored(r_lsb2)
    refused = library().libtilt_axis(filters().index(name), rate_dhz, stored.ctypes.data, changed.ctypes.data, r_q8, noisy_axis,
                                     z_lsb.ctypes.data, state.ctypes.data, len(z_lsb), out.ctypes.data)
    if refused:
        which = [key for key, parameter in every.items() if parameter.index == refused - REFUSED_FIRST]
        raise TiltError(f"{name} rejects its parameters: {which[0] if which else 'the values contradict each other'}")
    return out
