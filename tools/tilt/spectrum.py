"""The noise spectrum of a recording, and the noise to expect by the sensor's data sheet."""
from dataclasses import dataclass

import numpy as np

LENGTH_MAX, LENGTH_MIN = 1024, 32  # samples per transform
PIECES = 8                         # transforms wanted of a short recording: fewer make the estimate ragged
UNEVEN = 0.5                       # of a step: rows more than 1.5 steps apart are not contiguous
SHEET_LSB, SHEET_HZ = (0.75, 0.75, 1.1), 100.0  # rms of x, y, z at rest up to 100 Hz, times 1.41 per doubling (data sheet, p. 4 and 33)
PARTS_LSB2_HZ = (0.04, 0.04, 0.068)  # of sensors measured at rest: variance 0.02 LSB^2 per Hz of the rate, 1.7 times that on z


@dataclass
class Density:
    """lsb_rthz: (bins, axes) at `hz`; pieces: how many half-overlapping transforms were averaged."""
    hz: np.ndarray
    lsb_rthz: np.ndarray
    pieces: int


def even_stretches(t_us, missing, segments, step_us):
    """Slices of rows that are a step apart, each with a sample."""
    begins = np.ones(len(t_us), bool)
    begins[1:] = (np.abs(np.diff(t_us) - step_us) > UNEVEN * step_us) | missing[1:] | missing[:-1]
    begins[[part.start for part in segments]] = True
    edges = [*np.flatnonzero(begins).tolist(), len(t_us)]
    return [slice(a, b) for a, b in zip(edges, edges[1:]) if not missing[a]]


def density(values, stretches, rate_hz):
    """Density by Welch's method (Hann window, mean of each piece removed) over the stretches that are long enough; None if none is."""
    longest = max((part.stop - part.start for part in stretches), default=0)
    length = LENGTH_MAX
    while length > LENGTH_MIN and length * (PIECES + 1) > 2 * longest:
        length //= 2
    if longest < length or rate_hz <= 0.0:
        return None
    total, pieces = 0.0, 0
    for part in stretches:
        added, count = power_sum(values[part], length)
        total, pieces = total + added, pieces + count
    window = hann(length)
    power = total * (2.0 / (pieces * rate_hz * np.sum(window ** 2)))
    return Density(np.fft.rfftfreq(length, 1.0 / rate_hz)[1:-1], np.sqrt(power[1:-1]), pieces)  # the first and last bin are one-sided


def hann(length):
    return 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(length) / length)


def power_sum(values, length):
    """(sum over pieces of |transform|^2, pieces). scipy.signal.welch takes seconds to import; a test compares this with it."""
    half = length // 2
    starts = range(0, len(values) - length + 1, half)
    total = np.zeros((half + 1, values.shape[1]))
    for start in starts:
        piece = values[start:start + length]
        total += np.abs(np.fft.rfft((piece - piece.mean(axis=0)) * hann(length)[:, None], axis=0)) ** 2
    return total, len(starts)


def sheet_lsb_rthz(rate_hz):
    """x, y and z by the data sheet, white over half the rate."""
    return tuple(lsb * np.sqrt(max(rate_hz, SHEET_HZ) / SHEET_HZ / (rate_hz / 2.0)) for lsb in SHEET_LSB)


def parts_lsb_rthz():
    """x, y and z as measured on quiet sensors."""
    return tuple(np.sqrt(PARTS_LSB2_HZ))
