"""The three-sensor flight: an inertial channel, three external sensors of its velocity error, and their troubles, drawn anew for each 20 s window.

The paper gives neither noise nor troubles of its sensors; these are the project's. Every run has a generator of its own, so run i of a seed is the
same however many runs are made."""
from dataclasses import dataclass

import numpy as np

from .observability import ins_channel

SENSORS = ("GNSS", "TRNS", "CVNS")
NOMINAL_M_S = np.array([0.15, 0.4, 0.25])  # standard deviations
PROCESS = np.array([1e-3, 1e-6, 2e-7])  # standard deviations a second of dV (m/s), phi (rad), eps (rad/s)
START = np.array([1.0, 3e-4, 1e-5])
WINDOW_S, FLIGHT_S = 20, 400  # one sample a second
SOUND_WINDOWS = 2  # at the beginning, without trouble

SOUND, DEGRADED, FROZEN, BIASED = range(4)
TROUBLES = ("sound", "degraded", "frozen", "biased")
CHANCES = ((DEGRADED, 0.20), (FROZEN, 0.08), (BIASED, 0.08))  # of each sensor in each window
DEGRADED_TIMES = (6.0, 20.0)  # the nominal deviation
BIAS_M_S = 3.0
FREEZINGS = ("zero", "last")  # what a frozen sensor says: nothing, or what it said last


def one_window(number):
    return slice(number * WINDOW_S, (number + 1) * WINDOW_S)


@dataclass
class Flights:
    """true: runs x samples x 3; measured: runs x samples x sensors, m/s; trouble: runs x windows x sensors."""

    true: np.ndarray
    measured: np.ndarray
    trouble: np.ndarray

    @property
    def windows(self):
        return self.trouble.shape[1]

    def sensor_error(self):
        """Rms error of each sensor over each window, runs x windows x sensors."""
        square = np.square(self.measured - self.true[..., :1])
        return np.sqrt(np.mean(square.reshape(len(square), self.windows, WINDOW_S, len(SENSORS)), axis=2))


def troubles(chance, windows, lasting):
    """(kind, factor on the noise, bias in m/s), each windows x sensors, of one run. A trouble, or its absence, lasts `lasting` windows on average."""
    size = (windows, len(SENSORS))
    draw, factor, sign, renewed = (chance.random(size) for _ in range(4))
    kind, below = np.full(size, SOUND), 0.0
    for name, part in CHANCES:
        kind[(draw >= below) & (draw < below + part)] = name
        below += part
    factor = np.where(kind == DEGRADED, DEGRADED_TIMES[0] + (DEGRADED_TIMES[1] - DEGRADED_TIMES[0]) * factor, 1.0)
    bias = np.where(kind == BIASED, np.where(sign < 0.5, -BIAS_M_S, BIAS_M_S), 0.0)
    kind[:SOUND_WINDOWS], factor[:SOUND_WINDOWS], bias[:SOUND_WINDOWS] = SOUND, 1.0, 0.0
    for window in range(SOUND_WINDOWS + 1, windows):
        kept = renewed[window] >= 1.0 / lasting
        for values in (kind, factor, bias):
            values[window, kept] = values[window - 1, kept]
    return kind, factor, bias


def true_states(noise, transition):
    """(1) from START: noise runs x samples x 3, of unit variance."""
    states, state = np.empty_like(noise), np.broadcast_to(START, (len(noise), 3))
    for k in range(noise.shape[1]):
        state = state @ transition.T + PROCESS * noise[:, k]
        states[:, k] = state
    return states


def freeze(measured, frozen, freezing):
    """In place: what a frozen sensor says. measured: runs x samples x sensors; frozen: the same, of truth values, never in the first sample."""
    if freezing == "zero":
        measured[frozen] = 0.0
        return
    for k in range(1, measured.shape[1]):
        measured[:, k] = np.where(frozen[:, k], measured[:, k - 1], measured[:, k])


def fly(runs, seed, freezing="zero", lasting=1.0, seconds=FLIGHT_S):
    """Flights of `seconds`, a whole number of windows."""
    if freezing not in FREEZINGS:
        raise ValueError(f"a frozen sensor says {' or '.join(FREEZINGS)}, not '{freezing}'")
    windows, drawn = seconds // WINDOW_S, []
    for run in range(runs):
        chance = np.random.default_rng([seed, run])
        drawn.append((chance.standard_normal((seconds, 3)), chance.standard_normal((seconds, len(SENSORS))), *troubles(chance, windows, lasting)))
    process, noise, kind, factor, bias = (np.stack(part) for part in zip(*drawn))
    true = true_states(process, ins_channel())
    repeated = [np.repeat(values, WINDOW_S, axis=1) for values in (kind, factor, bias)]
    measured = true[..., :1] + NOMINAL_M_S * repeated[1] * noise + repeated[2]
    freeze(measured, repeated[0] == FROZEN, freezing)
    return Flights(true, measured, kind)
