"""The response of a filter over time and frequency, in numbers."""
import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_discrete_lyapunov
from scipy.signal import lfilter

from .structure import matrices

HORIZON_MAX = 2_000_000  # limit of samples for a response to die out
BAND = 0.02


class Endless(Exception):
    """One sentence: the response is too long to compute."""


def numbers(p):
    return np.array([float(x) for x in p])


def pole_radius(f):
    roots = np.roots(numbers(f.characteristic))
    return float(max(abs(roots))) if roots.size else 0.0


def impulse(f, samples):
    wave = np.zeros(samples)
    wave[0] = 1.0
    return lfilter(numbers(f.b), numbers(f.characteristic), wave)


def horizon(f, left=1e-9):
    """Samples after which less than `left` of the response remains."""
    radius = pole_radius(f)
    needed = 50 * (f.v + f.k + f.l) + (math.ceil(math.log(left) / math.log(radius)) if radius > 0 else 0)
    if radius >= 1 or needed > HORIZON_MAX:
        raise Endless(f"the response does not die out within {HORIZON_MAX:,} samples (pole radius {radius:.9g})")
    return needed


def moving_error(f, samples):
    """x - x^ from the start of a constant v-th difference of 1: A (1 - b0) / C applied to it, so that no large numbers are subtracted."""
    left = (1 - float(f.b[0])) * numbers(f.shape)
    return lfilter(left, numbers(f.characteristic), np.ones(samples))


@dataclass(frozen=True)
class Step:
    """The response to a step at n = 0."""

    peak: float
    peak_at: int
    settled_at: int  # the first n after which it stays within 2 %

    @property
    def overshoot(self):
        return max(0.0, self.peak - 1.0)


def step(f):
    wave = np.cumsum(impulse(f, horizon(f)))
    outside = np.flatnonzero(np.abs(wave - 1.0) > BAND)
    peak_at = int(np.argmax(wave))
    return Step(float(wave[peak_at]), peak_at, int(outside[-1]) + 1 if outside.size else 0)


def settling_by_radius(f):
    """ceil(ln 0.02 / ln rho): the settling time of the slowest pole alone."""
    radius = pole_radius(f)
    return math.ceil(math.log(BAND) / math.log(radius)) if radius > 0 else 0


def lyapunov_noise_gain(f):
    """The variance from P = F P F' + G G', as a check of the closed form."""
    rows, inputs = matrices(f)
    moves, enters = np.array(rows, float), np.array(inputs, float)
    return float(solve_discrete_lyapunov(moves, np.outer(enters, enters))[0, 0])


def frequency(f, per_sample):
    """B / C at frequencies in cycles per sample."""
    turn = np.exp(-2j * np.pi * np.asarray(per_sample))
    return np.polyval(numbers(f.b)[::-1], turn) / np.polyval(numbers(f.characteristic)[::-1], turn)


def bandwidth(f, points=20001):
    """(-3 dB frequency in cycles per sample, 0.5 if never; largest gain; its frequency)."""
    grid = np.linspace(0.0, 0.5, points)
    gain = np.abs(frequency(f, grid))
    below = np.flatnonzero(gain < math.sqrt(0.5))
    top = int(np.argmax(gain))
    return (float(grid[below[0]]) if below.size else 0.5), float(gain[top]), float(grid[top])
