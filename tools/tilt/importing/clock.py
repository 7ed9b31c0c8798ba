"""Converts a file's times to microseconds from the first row; they never step back."""
import numpy as np

from tilt.errors import TiltError

PER_SECOND = {"s": 1.0, "clock": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}
DAY_S, WRAP, WRAP_STEP = 86400.0, 2.0 ** 32, 2.0 ** 31
RATE_LOW, RATE_HIGH = 4.0, 4000.0  # Hz; a factor of 1,000, so only one of s, ms, us, ns fits
GAP = 2.5  # periods


def to_us(readings, rate, notes):
    """int64 microseconds. rate: Hz if given, or None. TiltError, with the line, if time steps back or cannot be determined."""
    count = len(readings.values)
    if rate is not None and readings.time_unit == "count" and readings.time is not None:
        return of_count(readings, rate, notes)
    if rate is not None:
        if readings.time is not None:
            notes.append(f"times of the file ignored: --rate {rate:g}")
        return np.rint(np.arange(count) * (1e6 / rate)).astype(np.int64)
    if readings.time is None:
        raise TiltError(f"{readings.path}: no column of times: give the rate with --rate HZ")
    if readings.time_unit == "count":
        raise TiltError(f"{readings.path}: a sample counter, but no times: give the rate with --rate HZ")
    unit = readings.time_unit or unit_by_steps(readings)
    if unit == "days":
        readings.time, unit = nearest_days(readings.time), "s"
    time = segments_joined(readings, unwrapped(readings, unit))
    if readings.own:
        return time.astype(np.int64)
    first = time[0]
    if first != 0.0:
        notes.append(f"first time {first:.6f} s" if unit == "s" else f"first time {first:g} {'s of the day' if unit == 'clock' else unit}")
    return np.rint((time - first) * (1e6 / PER_SECOND[unit])).astype(np.int64)


def nearest_days(time):
    """Seconds since 1970 with day and month as they are or, where that brings the rows nearer together, the other way round."""
    days = (time // DAY_S).astype("datetime64[D]")
    months, years = days.astype("datetime64[M]"), days.astype("datetime64[Y]")
    month, date = (months - years).astype(int), (days - months).astype(int)  # from 0
    turned = (years.astype("datetime64[M]") + date).astype("datetime64[D]") + month
    other = np.where(date < 12, turned, days).astype(float) * DAY_S + time % DAY_S
    return other if np.ptp(other) < np.ptp(time) else time


def of_count(readings, rate, notes):
    steps = np.diff(readings.time)
    back = np.flatnonzero(steps <= 0)
    if len(back):
        before, after = readings.time[back[0]:back[0] + 2]
        raise readings.fault(int(back[0]) + 1, f"the counter goes from {before:g} to {after:g}: split the file here")
    if (steps > 1).any():
        notes.append(f"the counter skips {int((steps - 1).sum())} samples")
    return np.rint((readings.time - readings.time[0]) * (1e6 / rate)).astype(np.int64)


def unit_by_steps(readings):
    """s, ms, us or ns: the one that makes the usual step a sensor's period."""
    steps = np.diff(readings.time)
    steps = steps[steps > 0]
    if len(steps) == 0:
        raise TiltError(f"{readings.path}: the times are constant: give the rate with --rate HZ")
    step = float(np.median(steps))
    for unit in ("s", "ms", "us", "ns"):
        if RATE_LOW <= PER_SECOND[unit] / step < RATE_HIGH:
            return unit
    for unit in ("s", "ms", "us", "ns"):  # a slow logger
        if 1.0 <= PER_SECOND[unit] / step < RATE_HIGH:
            return unit
    raise TiltError(f"{readings.path}: time steps of {step:g} fit no sensor in s, ms, us or ns: give the rate with --rate HZ")


def unwrapped(readings, unit):
    """Removes the midnight of a wall clock and the wrap of a 32-bit counter; any other step back is a fault."""
    time = readings.time
    steps = np.diff(time)
    back = steps < 0
    for row in readings.segments:
        back[row - 1] = False
    if not back.any():
        return time
    turn, least = (DAY_S, DAY_S / 2) if unit == "clock" else (WRAP, WRAP_STEP)
    wraps = back & (steps < -least) & (unit in ("clock", "ms", "us")) & (time[:-1] < turn)
    if (back & ~wraps).any():
        row = int(np.flatnonzero(back & ~wraps)[0]) + 1
        raise readings.fault(row, f"time goes backwards: {time[row]:.10g} after {time[row - 1]:.10g}: split the file here, or give --rate HZ")
    marks = np.concatenate([[0], np.cumsum(wraps)])
    for row in readings.segments:
        marks[row:] -= marks[row]
    return time + turn * marks


def segments_joined(readings, time):
    """A repeated header means that the board restarted. Its time continues one period later (docs/protocol.md)."""
    if not readings.segments:
        return time
    inside = np.ones(len(time) - 1, dtype=bool)
    inside[np.array(readings.segments) - 1] = False
    steps = np.sort(np.diff(time)[inside])
    period = steps[len(steps) // 2] if len(steps) else 0.0
    time = time.copy()
    for row in readings.segments:
        time[row:] += time[row - 1] + period - time[row]
    return time


def seen(t_us):
    """(rate in Hz or None, gaps, longest step in us, share of equal times)"""
    steps = np.diff(t_us)
    moving = steps[steps > 0]
    if len(moving) == 0:
        return None, 0, 0, 0.0
    usual = float(np.median(moving))
    whole = steps <= GAP * usual
    span = float(steps[whole].sum())
    return whole.sum() * 1e6 / span if span else None, int((~whole).sum()), int(steps.max()), float((steps == 0).mean())
