"""Filters of one measured number as functions of samples, runs x samples, to estimates of the same shape, in the experiment's unit (degrees,
metres). Time is counted in samples. Each begins with the first sample at rest, or where x0 is given with that before the first sample."""
import functools
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from . import batch


# --- the synthesised filter -------------------------------------------------------------------------------------------


def synthesised(a1, b0, x0=None):
    return lambda z: batch.synthesised([a1, b0], x0, z)


def scheduled(gains):
    """With gains (a1, b0) of each step after the first sample, which is taken as it is."""
    return lambda z: batch.synthesised(gains, None, z)


def extrapolation_fed_back(b0):
    """The example of paper 001 to the letter: x_e(n) of x_e(n - 1) .. (n - 3), from zero. The measurement never enters x_e."""
    def estimates(z):
        return b0 * z  # x_e stays zero
    return estimates


# --- linear filters with constant gains -------------------------------------------------------------------------------


class StateSpace(NamedTuple):
    """x = F x + w, cov w = Q, z = x[0] + noise of variance 1."""

    order: int
    f: np.ndarray
    q: np.ndarray


def model(f, drive, scale):
    """Of process noise that is one number of variance `scale` along `drive`; padded to three states."""
    order, f = len(f), np.array(f, dtype=float)
    drive = np.pad(np.array(drive, dtype=float), (0, 3 - order))
    return StateSpace(order, np.pad(f, (0, 3 - order)), scale * drive[:, None] * drive)


def random_walk(scale):
    return model([[1]], [1], scale)


def white_rate(scale):
    """(position, rate): the shipped kf's."""
    return model([[1, 1], [0, 1]], [0, 1], scale)


def white_acceleration(scale):
    return model([[1, 1], [0, 1]], [0.5, 1], scale)


def singer(scale, rho):
    """Acceleration rho a + w."""
    return model([[1, 1, 0.5], [0, 1, 1], [0, 0, rho]], [0, 0, 1], scale)


def white_jerk(scale):
    """The optimal alpha-beta-gamma filter."""
    return model([[1, 1, 0.5], [0, 1, 1], [0, 0, 1]], [0.5, 1, 1], scale)


def white_jerk_as_shipped(scale):
    """kf3.c: a walks, v += a, x += v, so a step of a is in all three at once."""
    return model([[1, 1, 1], [0, 1, 1], [0, 0, 1]], [1, 1, 1], scale)


def steady_gains(space):
    return batch.gains(space.f, space.q, 1.0, 3)


def with_gains(space, gains, x0=None):
    return lambda z: batch.linear(space.f, gains, x0, z)


def steady_kalman(space, x0=None):
    return with_gains(space, steady_gains(space), x0)


def kalman(space, p0, x0):
    """The Kalman filter from the first sample on: P = diag(p0, ...) (variances of samples, by R) about x0."""
    return lambda z: batch.linear(space.f, batch.gains(space.f, space.q, p0, space.order, z.shape[1]), x0, z)


def fading_memory(order, theta):
    """Polynomial filters of order 1 or 2 with all poles at theta."""
    rest = 1.0 - theta
    if order == 1:
        return with_gains(white_rate(0.0), [1.0 - theta * theta, rest * rest, 0.0])
    return with_gains(white_jerk(0.0), [1.0 - theta * theta * theta, 1.5 * rest * rest * (1.0 + theta), rest * rest * rest])


@functools.cache
def end_weights(order, count):
    """Of the end point, oldest first, by the orthogonal polynomials of `count` points up to order 2."""
    middle, second = (count - 1.0) / 2.0, (count * count - 1.0) / 12.0  # second: mean of t^2
    t = np.arange(count) - middle
    weights = np.full(count, 1.0 / count)
    if order >= 1 and count >= 2:
        weights = weights + t * middle / (count * second)
    if order >= 2 and count >= 3:
        weights = weights + (t * t - second) * (middle * middle - second) / np.sum((t * t - second) ** 2)
    return weights


def end_point(order, length):
    """End point of the polynomial of least squares through the last `length` samples (Savitzky-Golay); fewer at the start."""
    def estimates(z):
        x = np.empty_like(z)
        for k in range(z.shape[1]):
            count = min(k + 1, length)
            x[:, k] = z[:, k + 1 - count:k + 1] @ end_weights(order, count)
        return x
    return estimates


FORGOTTEN, TAIL = 200, 3000  # samples after which none of these filters is in its start; and long after that


def stationary_noise_gain(estimator):
    """Sum of the squared impulse response, long after the start."""
    impulse = np.zeros((1, FORGOTTEN + TAIL))
    impulse[0, FORGOTTEN] = 1.0
    return float(np.sum(np.square(estimator(impulse))))


def stationary_lag(estimator):
    """Error by second difference of the truth, long after the start: 0 for filters of third order."""
    k = np.arange(float(TAIL))
    truth = 0.5 * k * (k - 1.0)
    return float(truth[-1] - estimator(truth[None])[0, -1])


# --- the shipped filters ----------------------------------------------------------------------------------------------


@dataclass
class Shipping:
    """How a shipped filter is fed and set."""

    rate_hz: float = 10.0
    lsb_per_unit: float = 16.0  # counts per degree or metre: what rounding costs is 1 / 12 of a count squared
    zero: float = 0.0           # the measurement that is count 0
    r: float = 0.6              # variance of the measurement in units squared, for the filter's r
    reset_at_first: bool = False  # begun by a reset with the first sample, not by the median of five
    parameters: dict = field(default_factory=dict)  # further ones by the descriptor's names and units (LSB)

    @property
    def rate_dhz(self):
        return round(10.0 * self.rate_hz)

    def r_lsb2(self):
        return self.r * self.lsb_per_unit * self.lsb_per_unit

    def parameter(self, name, parameter):
        """As a filter has it: given, or its default at this rate."""
        if parameter in self.parameters:
            return self.parameters[parameter]
        return self.r_lsb2() if parameter == "r" else batch.default_of(name, self.rate_dhz, parameter)

    def rounded_variance(self, r):
        """Of what a shipped filter is given when the measurement's variance is r."""
        return r + 1.0 / (12.0 * self.lsb_per_unit * self.lsb_per_unit)


AS_PUBLISHED = {"ratemax": 1e6}  # of synth and synth_opt: the papers have no limit of the rate, this one is out of reach


def shipped(name, shipping):
    r_lsb2 = min(shipping.r_lsb2(), batch.largest_r_lsb2())
    parameters = {"r": r_lsb2, **(AS_PUBLISHED if name in ("synth", "synth_opt") else {}), **shipping.parameters}

    def estimates(z):
        counts = (z - shipping.zero) * shipping.lsb_per_unit
        found = batch.shipped(name, shipping.rate_dhz, parameters, r_lsb2, shipping.reset_at_first, counts)
        return found / (65536.0 * shipping.lsb_per_unit) + shipping.zero
    return estimates


def linear_twin(name, shipping):
    """The steady twin in double of a shipped filter that is linear, from its stored parameters and its model's Riccati equation; None for one whose
    gain depends on its data."""
    def of(parameter):
        return shipping.parameter(name, parameter)

    def drive(power, factor, limit):
        """In units of R and per sample, for a process noise of power density q and `factor` times the R given."""
        return min(limit, of("q") / (shipping.rate_hz ** power * (factor * of("r"))))

    if name == "kf":
        return steady_kalman(white_rate(drive(3, 1.0, batch.largest_rate_drive())))
    if name == "lrf":  # (8): one R for both kinds of samples
        pooled = of("clean") + (1.0 - of("clean")) * of("ratio") ** 2
        return steady_kalman(white_rate(drive(3, pooled, batch.largest_rate_drive())))
    if name == "kf3":
        return steady_kalman(white_jerk_as_shipped(drive(5, 1.0, 1.0)))
    if name == "synth":
        return synthesised(of("a1"), of("b0"))
    if name == "synth_opt":
        return synthesised(0.0, 2.0 / 3.0)  # the limit of the exact covariance's schedule
    if name == "synth_plus":  # with a1 = 0 and b2 = 0 it is alpha-beta: alpha = b0, beta = b0 + b1
        if of("k") != 0.0 or of("b2") != 0.0:
            raise batch.Refused("synth_plus: its twin here is alpha-beta, k = 0 and b2 = 0")
        return with_gains(white_rate(0.0), [of("b0"), of("b0") + of("b1"), 0.0])
    return None
