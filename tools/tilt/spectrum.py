"""The noise of a recording over frequency, and what the sensor's data sheet lets one expect."""
from dataclasses import dataclass

import numpy as np

LENGTH_MAX, LENGTH_MIN = 1024, 32  # samples that are transformed at a time
PIECES = 8                         # wanted of a short recording: fewer make the estimate ragged
UNEVEN = 0.5                       # of a step: rows further apart than 1.5 steps do not follow each other
SHEET_LSB, SHEET_HZ = (0.75, 0.75, 1.1), 100.0  # rms of x, y, z at rest up to 100 Hz, 1.41 times for each doubling (data sheet, p. 4 and 33)
PARTS_LSB2_HZ = (0.04, 0.04, 0.068)  # of parts that were measured at rest: variance 0.02 LSB^2 for each Hz of the rate, 1.7 times on z


@dataclass
class Density:
    """lsb_rthz: (bins, axes) at `hz`; pieces: how many transforms were averaged, half overlapping."""
    hz: np.ndarray
    lsb_rthz: np.ndarray
    pieces: int


def even_stretches(t_us, missing, segments, step_us):
    """Slices of rows a step apart with a sample in each."""
    begins = np.ones(len(t_us), bool)
    begins[1:] = (np.abs(np.diff(t_us) - step_us) > UNEVEN * step_us) | missing[1:] | missing[:-1]
    begins[[part.start for part in segments]] = True
    edges = [*np.flatnonzero(begins).tolist(), len(t_us)]
    return [slice(a, b) for a, b in zip(edges, edges[1:]) if not missing[a]]


def density(values, stretches, rate_hz):
    """Density by Welch's method (Hann window, the mean of each piece taken off), over the stretches that are long enough; None if none is."""
    from scipy import signal
    longest = max((part.stop - part.start for part in stretches), default=0)
    length = LENGTH_MAX
    while length > LENGTH_MIN and length * (PIECES + 1) > 2 * longest:
        length //= 2
    if longest < length or rate_hz <= 0.0:
        return None
    total, pieces = 0.0, 0
    for part in stretches:
        count = (part.stop - part.start) // (length // 2) - 1
        if count < 1:
            continue
        hz, power = signal.welch(values[part], rate_hz, window="hann", nperseg=length, noverlap=length // 2, detrend="constant", axis=0)
        total, pieces = total + power * count, pieces + count
    return Density(hz[1:-1], np.sqrt(total[1:-1] / pieces), pieces)  # the mean is taken off, and half the rate has half the width


def sheet_lsb_rthz(rate_hz):
    """Of x, y and z by the data sheet, white over half the rate."""
    return tuple(lsb * np.sqrt(max(rate_hz, SHEET_HZ) / SHEET_HZ / (rate_hz / 2.0)) for lsb in SHEET_LSB)


def parts_lsb_rthz():
    """Of x, y and z as measured on quiet parts."""
    return tuple(np.sqrt(PARTS_LSB2_HZ))
