"""Paper 000, Table 1: which roll, noise and gains could have given it? The synthesised filter's row is met exactly, by solving for the noise's
variance, the roll's amplitude and the error of the start; the Kalman filter's row is then what it is."""
import math
from dataclasses import dataclass

import numpy as np

from . import batch
from .estimators import kalman, random_walk, steady_gains, steady_kalman, synthesised, white_acceleration, white_rate
from .roll import P0_DEG2, PROFILES, SAMPLES, WINDOWS

COLUMNS = ("0_5", "6_10", "11_15")
SYNTH_ROW, KALMAN_ROW = np.array([0.516, 0.875, 0.348]), np.array([0.489, 1.419, 0.359])
TURNS = tuple(PROFILES)
# a roll, and a start that P(0) = 5 degree^2 knows to three standard deviations
ROLL_DEG, START_KNOWN_DEG, ANY = 90.0, 6.7, math.inf
MODELS = {"kf2_acceleration_steady": (white_acceleration, False), "kf2_acceleration_from_p0": (white_acceleration, True),
          "kf2_rate_steady": (white_rate, False), "kf2_rate_from_p0": (white_rate, True),
          "kf1_walk_steady": (random_walk, False), "kf1_walk_from_p0": (random_walk, True)}
TWO_STATES = tuple(MODELS)[:4]
SMOOTH, STEPS = tuple(turn for turn in TURNS if turn != "steps30"), ("steps30",)
# experiment: models, whether the error is the residual g - x^, turns, limits of the roll and of the start's error
TRIALS = {"table1_smooth": (TWO_STATES, False, SMOOTH, ROLL_DEG, START_KNOWN_DEG),
          "table1_steps": (TWO_STATES, False, STEPS, ROLL_DEG, START_KNOWN_DEG),
          "table1_walk": (tuple(MODELS), False, TURNS, ROLL_DEG, START_KNOWN_DEG),
          "table1_residual": (tuple(MODELS), True, TURNS, ROLL_DEG, START_KNOWN_DEG),
          "table1_any_start": (tuple(MODELS), False, TURNS, ROLL_DEG, ANY),
          "table1_any_roll": (tuple(MODELS), False, TURNS, ANY, ANY),
          "table1_residual_any_roll": (tuple(MODELS), True, TURNS, ANY, ANY)}


def over_columns(values):
    return np.stack([np.mean(values[..., WINDOWS[column]], axis=-1) for column in COLUMNS], axis=-1)


@dataclass
class Parts:
    """Mean square error over the three columns: r noise + a^2 turn + 2 a e cross + e^2 start, of filters x columns or filters x turns x columns."""

    noise: np.ndarray     # per R: of the estimate's error
    residual: np.ndarray  # or of g - x^
    turn: np.ndarray      # amplitude 1 degree
    cross: np.ndarray
    start: np.ndarray     # error of the start of 1 degree

    def of_error(self, residual):
        return self.residual if residual else self.noise


def parts_of(filters):
    """Each filter is a function of x0, at which its past estimates are. It is linear in x0 and in its samples."""
    rows, impulses = [], np.eye(SAMPLES)
    truths = np.array([PROFILES[turn].truth() / PROFILES[turn].amplitude_deg for turn in TURNS])
    for of in filters:
        answers, turns = np.split(of(0.0)(np.vstack([impulses, truths])), [SAMPLES])
        decay, turns = of(1.0)(np.zeros((1, SAMPLES)))[0], turns - truths
        rows.append((over_columns(np.sum(answers * answers, axis=0)), over_columns(np.sum((impulses - answers) ** 2, axis=0)),
                     over_columns(turns * turns), over_columns(turns * decay), over_columns(decay * decay)))
    return Parts(*(np.array(part) for part in zip(*rows)))


def determinant(a, b, c):
    """Of the columns a, b, c: the last axis."""
    a, b, c = (np.moveaxis(v, -1, 0) for v in (a, b, c))
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])


def solved(parts, residual):
    """(R, amplitude, error of the start) of filters x turns: the world in which each filter has SYNTH_ROW; not numbers where that takes a negative
    square. Linear in R, a^2, e^2 but for the small mixed term, which is put right by repetition."""
    noise, start = (np.broadcast_to(part[:, None], parts.turn.shape) for part in (parts.of_error(residual), parts.start))
    amplitude = off = np.zeros(parts.turn.shape[:2])
    with np.errstate(invalid="ignore"):
        for _ in range(30):
            right = SYNTH_ROW - (2.0 * amplitude * off)[..., None] * parts.cross
            whole = determinant(noise, parts.turn, start)
            r = determinant(right, parts.turn, start) / whole
            amplitude2, off2 = determinant(noise, right, start) / whole, determinant(noise, parts.turn, right) / whole
            good = (r > 0.0) & (amplitude2 >= 0.0) & (off2 >= 0.0)
            r, amplitude, off = (np.where(good, value, np.nan) for value in (r, np.sqrt(amplitude2), np.sqrt(off2)))
        worlds = np.stack([r, amplitude, off])
        missed = np.abs(errors(parts, residual, worlds) - SYNTH_ROW).max(axis=-1)
    return np.where(missed <= 1e-6, worlds, np.nan)


def errors(parts, residual, worlds):
    """Mean square errors in a world for each filter and turn, filters x turns x columns."""
    r, amplitude, off = (part[..., None] for part in worlds)
    return (r * parts.of_error(residual)[:, None] + amplitude * amplitude * parts.turn + 2.0 * amplitude * off * parts.cross
            + off * off * parts.start[:, None])


def rivals_of(name):
    """(alpha, parts) of a model's Kalman filters, 81 of them."""
    model, from_start = MODELS[name]
    spaces = [model(math.pow(10.0, 0.1 * i)) for i in range(-40, 41)]
    filters = [(lambda x0, space=space: kalman(space, P0_DEG2 / 0.6, x0) if from_start else steady_kalman(space, x0)) for space in spaces]
    return [steady_gains(space)[0] for space in spaces], parts_of(filters)


def nearest(worlds, places, residual, parts):
    """(largest relative difference from the Kalman row, its row, number of the place, of the rival), the first of the nearest. places: (gains, turn)
    of the worlds that are possible."""
    turns = places[:, 1]
    r, amplitude, start = (part[places[:, 0], turns][:, None, None] for part in worlds)
    turn, cross = (np.moveaxis(part[:, turns], 0, 1) for part in (parts.turn, parts.cross))  # places x rivals x columns
    values = r * parts.of_error(residual) + amplitude * amplitude * turn + 2.0 * amplitude * start * cross + start * start * parts.start
    off = np.abs(values / KALMAN_ROW - 1.0).max(axis=-1)
    place = np.unravel_index(np.argmin(off), off.shape)
    return off[place], values[place], *place


def table1_search(_options):
    # the grid inside the printed region
    pairs = [(-0.05 * i, 0.025 * j) for i in range(20) for j in range(1, 40) if 0.025 * j > 0.05 * i - 0.3 + 1e-9]
    ours = parts_of([lambda x0, a1=a1, b0=b0: synthesised(a1, b0, x0) for a1, b0 in pairs])
    rivals = {name: rivals_of(name) for name in MODELS}
    for experiment, (models, residual, turns, roll_deg, start_deg) in TRIALS.items():
        worlds = solved(ours, residual)
        possible = (worlds[1] <= roll_deg) & (worlds[2] <= start_deg) & np.isin(TURNS, turns)
        places = np.argwhere(possible)
        if not len(places):
            raise batch.Refused(f"{experiment}: no world gives the synthesised filter its row")
        found = {name: nearest(worlds, places, residual, rivals[name][1]) for name in models}
        name = min(found, key=lambda name: found[name][0])
        off, row, place, rival = found[name]
        gains, turn = places[place]
        r, amplitude, start = worlds[:, gains, turn]
        for metric, value in (*((f"mse_{column}", value) for column, value in zip(COLUMNS, row)), ("largest_difference", off),
                              ("amplitude", amplitude), ("r", r), ("start_error", start), ("a1", pairs[gains][0]), ("b0", pairs[gains][1]),
                              ("kalman_alpha", rivals[name][0][rival])):
            yield experiment, f"{name}/{TURNS[turn]}", "double", metric, value, 1
