"""Which sensors a window uses: one function for each rule, from the evidence of a window to a choice.

A choice is runs x sensors of truth values: one sensor, all, or none (the filter coasts on its model)."""
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .observability import constant_observability, ins_channel, pseudo_inverse, window_degree
from .organisation import acceptor, misses, self_organised
from .scenario import NOMINAL_M_S, SENSORS, WINDOW_S

HISTORY_S = 40  # of estimates to which trends are fitted
GATE_TIMES = 4.0  # a sensor whose mean square miss is more than so many times the least is refused
NORMALISED_MOST = 4.0  # mean square innovation by its variance beyond which a sensor is refused
INVERSE = pseudo_inverse(constant_observability(ins_channel(), [1.0, 0.0, 0.0]))


@dataclass
class Evidence:
    """Of one window. measured: runs x samples x sensors; model, variance: the filter's own prediction, runs x samples x 3 and runs x samples;
    history: estimates of dV before the window, runs x any; sensor_error: runs x sensors, which only the oracle may see."""

    measured: np.ndarray
    model: np.ndarray
    variance: np.ndarray
    history: np.ndarray
    sensor_error: np.ndarray

    @cached_property
    def predicted(self):
        """dV by the self-organised trend, runs x samples; by the model in the first window, which has no history."""
        recent = self.history[:, -HISTORY_S:]
        return self_organised(recent, WINDOW_S)[0] if recent.shape[1] >= WINDOW_S else self.model[..., 0]

    @cached_property
    def degree(self):
        """D of dV by each sensor, runs x sensors, x of (15) being the model's prediction."""
        return window_degree(INVERSE, self.model[:, None], np.swapaxes(self.measured, 1, 2))[..., 0]


def one_of(numbers):
    return np.asarray(numbers)[:, None] == np.arange(len(SENSORS))


def fixed(number):
    return lambda evidence: one_of(np.full(len(evidence.measured), number))


def fuse(evidence):
    """All sensors, each with its nominal noise."""
    return np.ones((len(evidence.measured), len(SENSORS)), dtype=bool)


def degree_only(evidence):
    """The sensor by which dV has the greatest degree of observability, (14)."""
    return one_of(np.argmax(evidence.degree, axis=1))


def trend_acceptor(evidence):
    """The sensor that the self-organised prediction misses least, (25)."""
    return one_of(np.argmin(acceptor(evidence.predicted, evidence.measured), axis=1))


def gate_then_degree(evidence):
    """The acceptor refuses what is far from the prediction; of what remains the sensor whose degree of observability is nearest to 1, by ratio."""
    missed = misses(evidence.predicted, evidence.measured)
    passed = missed <= GATE_TIMES * np.min(missed, axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        nearness = np.minimum(evidence.degree, 1.0 / evidence.degree)
    return one_of(np.argmax(np.where(passed, nearness, -1.0), axis=1))


def normalised_innovation(evidence):
    """Of the sensors whose innovations are as large as filter and data sheet say, the one of least nominal noise; none: coast."""
    missed = misses(evidence.model[..., 0], evidence.measured)
    expected = np.square(NOMINAL_M_S) + np.mean(evidence.variance, axis=1)[:, None]
    passed = missed < NORMALISED_MOST * expected
    return one_of(np.argmin(np.where(passed, NOMINAL_M_S, np.inf), axis=1)) & passed


def oracle(evidence):
    """The sensor that is best in truth."""
    return one_of(np.argmin(evidence.sensor_error, axis=1))


RULES = {"fixed_1": fixed(0), "fixed_2": fixed(1), "fixed_3": fixed(2), "fuse": fuse, "degree_only": degree_only, "trend_acceptor": trend_acceptor,
         "gate_then_degree": gate_then_degree, "normalised_innovation": normalised_innovation, "oracle": oracle}
CHOOSING = tuple(name for name in RULES if not name.startswith("fixed") and name != "fuse")
