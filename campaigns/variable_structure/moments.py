"""What the experiments must give on average where no rule looks at the data: second moments of truth and estimate carried through the flight, without
chance. Troubles are drawn anew for each window, so the moments at its end are the mean over the troubles that it may have."""
import itertools

import numpy as np

from .filter import DRIVE, START_VARIANCE
from .observability import ins_channel
from .rules import HISTORY_S
from .scenario import (BIAS_M_S, BIASED, CHANCES, DEGRADED, DEGRADED_TIMES, FLIGHT_S, FROZEN, NOMINAL_M_S, PROCESS, SENSORS, SOUND,
                       SOUND_WINDOWS, START, WINDOW_S)
from .structure import SETTLED_S

TRUE, ESTIMATE = slice(0, 3), slice(3, 6)
DIFFERENCE = np.array([1.0, 0.0, 0.0, -1.0, 0.0, 0.0])
FACTOR_SQUARE = sum(DEGRADED_TIMES[0] ** i * DEGRADED_TIMES[1] ** (2 - i) for i in range(3)) / 3.0  # mean square of a uniform one

USED = {**{f"fixed_{number + 1}": (number,) for number in range(len(SENSORS))}, "fuse": tuple(range(len(SENSORS)))}  # without a choice


def gains(variances, samples):
    """Of the filter for measurements of dV of these variances, taken in turn: samples x measurements x 3."""
    transition, covariance, found = ins_channel(), np.diag(START_VARIANCE), []
    for _ in range(samples):
        covariance = transition @ covariance @ transition.T + DRIVE * np.diag(np.square(PROCESS))
        for variance in variances:
            found.append(covariance[:, 0] / (covariance[0, 0] + variance))
            covariance = covariance - np.outer(found[-1], covariance[0])
    return np.reshape(found, (samples, len(variances), 3))


def begin(size):
    """Of [truth, estimate, more]: truth at START, everything else zero."""
    moments = np.zeros((size, size))
    moments[TRUE, TRUE] = np.outer(START, START)
    return moments


def predicted(moments):
    step = np.eye(len(moments))
    step[TRUE, TRUE] = step[ESTIMATE, ESTIMATE] = ins_channel()
    moments = step @ moments @ step.T
    moments[TRUE, TRUE] += np.diag(np.square(PROCESS))
    return moments


def measured(moments, gain, reads, variance, memory=None):
    """Truth and estimate after a measurement `reads` (a row) with noise; memory: where what it said is kept."""
    step, noise = np.eye(len(moments)), np.zeros(len(moments))
    step[ESTIMATE] += np.outer(gain, reads - np.eye(len(moments))[ESTIMATE.start])
    noise[ESTIMATE] = gain
    if memory is not None:
        step[memory], noise[memory] = reads, 1.0
    return step @ moments @ step.T + variance * np.outer(noise, noise)


def reading(trouble, number, count, freezing):
    """(row, variance as a multiple of the nominal one) of sensor `number` of those used: [truth, estimate, last values, biases]."""
    reads = np.zeros(6 + 2 * count)
    if trouble == FROZEN:
        reads[6 + number] = 1.0 if freezing == "last" else 0.0
        return reads, 0.0
    reads[0] = 1.0
    if trouble == BIASED:
        reads[6 + count + number] = 1.0
    return reads, FACTOR_SQUARE if trouble == DEGRADED else 1.0


def through_window(moments, troubles, sensors, gain, freezing):
    """(moments at its end, mean squares of the error of dV) of a window with these troubles. gain: samples x sensors x 3."""
    moments, errors, count = moments.copy(), [], len(sensors)
    for bias in range(6 + count, 6 + 2 * count):
        moments[bias], moments[:, bias], moments[bias, bias] = 0.0, 0.0, BIAS_M_S ** 2
    for of_sample in gain:
        moments = predicted(moments)
        for number, (sensor, trouble) in enumerate(zip(sensors, troubles)):
            reads, factor = reading(trouble, number, count, freezing)
            moments = measured(moments, of_sample[number], reads, factor * NOMINAL_M_S[sensor] ** 2, 6 + number)
        errors.append(DIFFERENCE @ moments[:6, :6] @ DIFFERENCE)
    return moments, np.array(errors)


def flight_mse(sensors, freezing):
    """Mean square error of dV in (m/s)^2 from SETTLED_S on, when these sensors are used in every window and troubles last one window."""
    gain = gains(np.square(NOMINAL_M_S[list(sensors)]), FLIGHT_S)
    chances = {SOUND: 1.0 - sum(part for _, part in CHANCES), **dict(CHANCES)}
    moments, errors = begin(6 + 2 * len(sensors)), []
    for window in range(FLIGHT_S // WINDOW_S):
        kinds = chances if window >= SOUND_WINDOWS else {SOUND: 1.0}
        mean, square = np.zeros_like(moments), np.zeros(WINDOW_S)
        for troubles in itertools.product(kinds, repeat=len(sensors)):
            part = np.prod([kinds[trouble] for trouble in troubles])
            after, error = through_window(moments, troubles, sensors, gain[window * WINDOW_S:(window + 1) * WINDOW_S], freezing)
            mean, square = mean + part * after, square + part * error
        moments = mean
        errors.append(square)
    return float(np.mean(np.concatenate(errors)[SETTLED_S:]))


def prediction_mse(weights_of_history, weights_of_state, begins, variance):
    """Mean square error in (m/s)^2 of linear predictions of a window, from the last HISTORY_S estimates of dV (WINDOW_S x HISTORY_S, the latest last)
    and the whole last estimate (WINDOW_S x 3), begun at each of `begins`; one sound sensor of this variance."""
    last, powers = max(begins), [np.linalg.matrix_power(ins_channel(), k + 1) for k in range(WINDOW_S)]
    gain, moments, errors = gains([variance], last), begin(6 + HISTORY_S), []
    reads = np.eye(len(moments))[0]
    shift = np.eye(len(moments))
    shift[6:] = np.vstack([np.eye(HISTORY_S, len(moments), 7)[:-1], np.eye(len(moments))[ESTIMATE.start]])
    for sample in range(last):
        moments = shift @ measured(predicted(moments), gain[sample][0], reads, variance) @ shift.T
        if sample + 1 in begins:
            for ahead in range(WINDOW_S):
                row = np.concatenate([powers[ahead][0], -weights_of_state[ahead], -weights_of_history[ahead]])
                drift = sum((powers[later - 1][0] if later else np.eye(3)[0]) ** 2 @ np.square(PROCESS) for later in range(ahead + 1))
                errors.append(row @ moments @ row + drift)
    return float(np.mean(errors))
