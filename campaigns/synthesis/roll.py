"""Paper 000's experiment: 15 s of a UAV's roll at 10 Hz, at rest for 5 s, turning from 6 to 10 s, at rest again, seen with noise of variance R.
Mean square errors over the paper's intervals: exactly, and by Monte Carlo."""
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from variable_structure.intervals import Interval

from . import batch

SAMPLES, PERIOD_S = 151, 0.1
R_DEG2, P0_DEG2 = 0.6, 5.0  # near the paper's Table 1, which gives none; the paper's P(0)
BEGIN, LENGTH = 60, 40  # of the turn, in samples
WINDOWS = {"0_5": slice(0, 51), "2_5": slice(20, 51), "6_10": slice(60, 101), "11_15": slice(110, 151)}
NORMAL_95 = 1.959964


class Profile(NamedTuple):
    amplitude_deg: float
    shape: object  # of the turn's part s, 0..1; 0 before, shape(1) after

    def truth_deg(self, k):
        into = min(max(k - BEGIN, 0), LENGTH)
        return self.amplitude_deg * self.shape(into / LENGTH) if into else 0.0

    def truth(self, samples=SAMPLES):
        return np.array([self.truth_deg(k) for k in range(samples)])


# bump, sine and triangle return; half of the steps is at 7 s and half at 9 s
PROFILES = {
    "ramp30": Profile(30.0, lambda s: s),
    "cos60": Profile(60.0, lambda s: 0.5 - 0.5 * math.cos(math.pi * s)),
    "minjerk60": Profile(60.0, lambda s: s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)),
    "bump30": Profile(30.0, lambda s: 0.5 - 0.5 * math.cos(2.0 * math.pi * s)),
    "sine30": Profile(30.0, lambda s: math.sin(2.0 * math.pi * s)),
    "triangle30": Profile(30.0, lambda s: 1.0 - abs(2.0 * s - 1.0)),
    "steps30": Profile(30.0, lambda s: (0.5 if s >= 0.25 else 0.0) + (0.5 if s >= 0.75 else 0.0)),
}


def runs_of(runs):
    """10,000 runs of paper 002 count as 4,000 here."""
    return max(1, runs * 2 // 5)


def over_windows(values):
    """{window: mean}, of the last axis."""
    return {name: np.mean(values[..., window], axis=-1) for name, window in WINDOWS.items()}


def mean_of(values):
    """(mean with its 95 % interval, normal: for thousands of runs; standard deviation of one)."""
    mean, sd = float(np.mean(values)), float(np.std(values, ddof=1)) if len(values) > 1 else 0.0
    half = NORMAL_95 * sd / math.sqrt(len(values))
    return Interval(mean, mean - half, mean + half), sd


# --- exact: for estimators that are linear in their samples (their gains may depend on time, not on data)


def noise_gain(estimator, count=SAMPLES):
    """What white noise of variance 1 becomes, sample by sample: (variance of x^, variance of g - x^)."""
    impulses = np.eye(count)
    answers = estimator(impulses)
    return np.sum(np.square(answers), axis=0), np.sum(np.square(impulses - answers), axis=0)


def bias(estimator, truth):
    """Estimate less truth when there is no noise."""
    return estimator(truth[None])[0] - truth


class Exact(NamedTuple):
    mse: dict     # {window: bias^2 + variance}
    bias2: dict   # {window: bias^2 alone}
    peak: float   # largest |bias|


def exact(estimator, profile, r=R_DEG2):
    off = bias(estimator, profile.truth())
    bias2, variance = over_windows(np.square(off)), over_windows(noise_gain(estimator)[0])
    return Exact({name: bias2[name] + r * variance[name] for name in WINDOWS}, bias2, float(np.max(np.abs(off))))


# --- Monte Carlo: for any estimator


@dataclass
class Noise:
    r: float = R_DEG2
    outliers: float = 0.0     # their probability
    ratio: float = 20.0       # an outlier's noise is so many times the usual
    shift_sigma: float = 0.0  # not 0: an outlier is the usual noise and +-shift_sigma standard deviations instead


def measured(profile, noise, seed, runs):
    """Realisations, runs x samples: the same for a seed and a run, whatever looks at them."""
    normal, uniform = batch.draws([batch.run_seed(seed, run) for run in range(runs)], SAMPLES)
    sigma = math.sqrt(noise.r)
    off, bad = sigma * normal, uniform < noise.outliers  # both are drawn always: clean samples do not depend on the outliers
    if noise.shift_sigma:
        off = off + np.where(bad, np.where(uniform < 0.5 * noise.outliers, -1.0, 1.0) * noise.shift_sigma * sigma, 0.0)
    else:
        off = off * np.where(bad, noise.ratio, 1.0)
    return profile.truth() + off


def monte_carlo(estimators, profile, noise, runs, seed):
    """Of each estimator {window: mean square error with its interval}."""
    samples, truth = measured(profile, noise, seed, runs), profile.truth()
    squares = (over_windows(np.square(estimator(samples) - truth)) for estimator in estimators)
    return [{name: mean_of(values)[0] for name, values in found.items()} for found in squares]
