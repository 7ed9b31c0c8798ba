"""The measurement system as a whole: a filter, a rule, a structure for each 20 s window."""
from dataclasses import dataclass

import numpy as np

from .filter import Filter
from .rules import Evidence
from .scenario import FROZEN, NOMINAL_M_S, SENSORS, WINDOW_S, one_window

SETTLED_S = 40  # from when on errors count
GATE_SIGMA = 3.0  # of fly_gated


@dataclass
class Flown:
    """estimates: runs x samples x 3; chosen: runs x windows x sensors, of truth values; None where no structure holds for a window."""

    estimates: np.ndarray
    chosen: np.ndarray


def evidence_of(flights, window, kalman, estimates, sensor_error):
    """What is known at the end of a window."""
    span = one_window(window)
    model, variance = kalman.propagated(WINDOW_S)
    return Evidence(flights.measured[:, span], model, variance, estimates[:, :span.start, 0], sensor_error[:, window])


def run_window(kalman, measured, chosen, estimates):
    """One window with its structure; estimates is written. measured: runs x samples x sensors; chosen: runs x sensors."""
    variances = np.where(chosen, np.square(NOMINAL_M_S), np.inf)
    used = [sensor for sensor in range(len(SENSORS)) if chosen[:, sensor].any()]
    for k in range(WINDOW_S):
        kalman.predict()
        for sensor in used:
            kalman.update(measured[:, k, sensor], variances[:, sensor])
        estimates[:, k] = kalman.state


def fly_by(rule, flights, next_window=False):
    """The flights under a rule. A window's structure is chosen from its own data, as the paper's Fig. 6 appears to do; with next_window a window's
    data choose the structure of the next one (the first has the rule's choice of its own), which is all that a system in flight can do."""
    runs, samples, _ = flights.true.shape
    kalman, error = Filter(runs), flights.sensor_error()
    estimates, chosen, decided = np.empty((runs, samples, 3)), np.empty(flights.trouble.shape, dtype=bool), None
    for window in range(flights.windows):
        span = one_window(window)
        now = rule(evidence_of(flights, window, kalman, estimates, error))
        chosen[:, window] = decided if next_window and decided is not None else now
        decided = now
        run_window(kalman, flights.measured[:, span], chosen[:, window], estimates[:, span])
    return Flown(estimates, chosen)


def fly_gated(flights):
    """What needs no window: at each sample the filter takes every sensor whose innovation is within GATE_SIGMA of what filter and data sheet say,
    the quietest first. It knows no more than a system in flight does."""
    kalman, estimates = Filter(len(flights.true)), np.empty_like(flights.true)
    order = np.argsort(NOMINAL_M_S)
    for k in range(estimates.shape[1]):
        kalman.predict()
        for sensor in order:
            measured, variance = flights.measured[:, k, sensor], NOMINAL_M_S[sensor] ** 2
            expected = kalman.covariance[:, 0, 0] + variance
            passed = np.square(measured - kalman.state[:, 0]) <= GATE_SIGMA ** 2 * expected
            kalman.update(measured, np.where(passed, variance, np.inf))
        estimates[:, k] = kalman.state
    return Flown(estimates, None)


def rms(flown, flights, state=0):
    """Of each run from SETTLED_S on, of dV (m/s) or another state."""
    error = flown.estimates[:, SETTLED_S:, state] - flights.true[:, SETTLED_S:, state]
    return np.sqrt(np.mean(np.square(error), axis=1))


def hits(flown, flights, within=1.0):
    """Share of the windows of each run whose sensor has no more than `within` times the best one's error; coasting is no hit when the best is
    asked for, and one otherwise."""
    error = flights.sensor_error()
    best = np.min(error, axis=2, keepdims=True)
    good = np.any(flown.chosen & (error <= within * best), axis=2)
    return np.mean(good | (~np.any(flown.chosen, axis=2) & (within > 1.0)), axis=1)


def frozen_taken(flown, flights):
    """(windows in which a frozen sensor is used, windows in which there is one) of each run."""
    frozen = flights.trouble == FROZEN
    return np.sum(np.any(frozen & flown.chosen, axis=2), axis=1), np.sum(np.any(frozen, axis=2), axis=1)
