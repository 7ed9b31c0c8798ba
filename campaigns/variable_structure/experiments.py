"""The experiments of paper 004: rows (filter, metric, value or Interval, runs)."""
import numpy as np

from . import intervals, moments
from .filter import Filter
from .observability import constant_observability, ins_channel, noise_gains, pseudo_inverse
from .organisation import self_organised
from .rules import HISTORY_S, RULES
from .scenario import WINDOW_S, fly
from .structure import fly_by, fly_gated, frozen_taken, hits, rms
from .trends import TRENDS, demark_as_printed, linear_matrix, separate_amplitudes

LASTING_WINDOWS = 5.0
TREND_FLIGHT_S, TREND_FROM_S, TREND_SENSOR_M_S = 600, 100, 0.2
SEED_OF_TRENDS = 1000003  # added to the seed: sensor noise that no flight has
RUNS_PER_FLIGHT = 20  # of those that are asked for: a flight is 20 windows
FEWEST = 10  # flights, however few runs are asked for


def observability(_runs, _seed):
    """What (9)-(12) give for the channel with its velocity measured."""
    matrix = constant_observability(ins_channel(), [1.0, 0.0, 0.0])
    for number, gain in enumerate(noise_gains(pseudo_inverse(matrix)), 1):
        yield "channel", f"sum_a2_{number}", float(gain), 1
    yield "channel", "condition", float(np.linalg.cond(matrix)), 1


def estimated(flights, seed):
    """Filter states, runs x samples x 3, from one sound sensor of TREND_SENSOR_M_S."""
    runs, samples, _ = flights.true.shape
    chance, kalman = np.random.default_rng([SEED_OF_TRENDS, seed]), Filter(runs)
    noise, states = TREND_SENSOR_M_S * chance.standard_normal((samples, runs)), np.empty_like(flights.true)
    for k in range(samples):
        kalman.predict()
        kalman.update(flights.true[:, k, 0] + noise[k], np.full(runs, TREND_SENSOR_M_S ** 2))
        states[:, k] = kalman.state
    return states


def predictions(states):
    """{name: dV of the next window, runs x samples} and the number of the self-organised trend, from states up to now (runs x samples x 3)."""
    data, transition = states[:, -HISTORY_S:, 0], ins_channel()
    times, wanted = np.arange(float(HISTORY_S)), HISTORY_S + np.arange(float(WINDOW_S))
    found = {"hold": np.repeat(data[:, -1:], WINDOW_S, axis=1),
             **{name: trend(times, data, wanted) for name, trend in TRENDS.items()},
             "linear_separate": data @ linear_matrix(times, wanted, separate_amplitudes).T,
             "demark_printed": demark_as_printed(times, data, wanted)}
    found["self_organised"], chosen = self_organised(data, WINDOW_S)
    powers = [np.linalg.matrix_power(transition, k + 1)[0] for k in range(WINDOW_S)]
    found["model"] = states[:, -1] @ np.stack(powers, axis=1)
    return found, chosen


def exact_trends(begins):
    """(name, mean square error) of the predictions that are linear in the data."""
    times, wanted = np.arange(float(HISTORY_S)), HISTORY_S + np.arange(float(WINDOW_S))
    last, none = np.zeros((WINDOW_S, HISTORY_S)), np.zeros((WINDOW_S, 3))
    last[:, -1] = 1.0
    powers = [np.linalg.matrix_power(ins_channel(), k + 1)[0] for k in range(WINDOW_S)]
    for name, history, state in (("hold", last, none), ("linear", linear_matrix(times, wanted), none),
                                 ("linear_separate", linear_matrix(times, wanted, separate_amplitudes), none), ("model", 0.0 * last, powers)):
        yield name, moments.prediction_mse(history, state, begins, TREND_SENSOR_M_S ** 2)


def trends(runs, seed):
    """What each trend makes of 40 s for the 20 s that follow: rms error of a window, median over windows and flights."""
    flights = fly(max(FEWEST, runs // RUNS_PER_FLIGHT), seed, seconds=TREND_FLIGHT_S)
    states, errors, picked = estimated(flights, seed), {}, []
    begins = range(TREND_FROM_S, TREND_FLIGHT_S - WINDOW_S, WINDOW_S)
    for begin in begins:
        found, chosen = predictions(states[:, :begin])
        picked.append(chosen)
        for name, values in found.items():
            missed = values - flights.true[:, begin:begin + WINDOW_S, 0]
            errors.setdefault(name, []).append(np.sqrt(np.mean(np.square(missed), axis=1)))
    for name, parts in errors.items():
        by_run = np.stack(parts, axis=1)
        yield name, "error_median", intervals.pooled_median(by_run, seed), len(by_run)
        yield name, "mse", intervals.mean(np.mean(np.square(by_run), axis=1), seed), len(by_run)
    for name, mse in exact_trends(begins):
        yield name, "exact_mse", mse, 1
    chosen = np.stack(picked, axis=1)
    for number, name in enumerate(TRENDS):
        yield name, "picked", intervals.mean(np.mean(chosen == number, axis=1), seed), len(chosen)


def rows_of(name, flown, flights, seed):
    error, runs = rms(flown, flights), len(flights.true)
    yield name, "rms_median", intervals.quantile(error), runs
    yield name, "rms_p95", intervals.quantile(error, 0.95), runs
    yield name, "mse", intervals.mean(np.square(error), seed), runs
    yield name, "rms_tilt_median", intervals.quantile(rms(flown, flights, 1)), runs
    if flown.chosen is not None and name != "fuse":
        for metric, within in (("best_sensor", 1.0), ("within_2x", 2.0)):
            yield name, metric, intervals.mean(hits(flown, flights, within), seed), runs
        yield name, "frozen_taken", intervals.ratio(*frozen_taken(flown, flights), seed), runs


def windows(freezing, next_window=False, lasting=1.0):
    """An experiment: the three-sensor flight under every rule."""
    def experiment(runs, seed):
        flights = fly(max(FEWEST, runs // RUNS_PER_FLIGHT), seed, freezing, lasting)
        for name, rule in RULES.items():
            yield from rows_of(name, fly_by(rule, flights, next_window), flights, seed)
        yield from rows_of("sample_gate", fly_gated(flights), flights, seed)
        if lasting == 1.0 and not next_window:
            for name, sensors in moments.USED.items():
                yield name, "exact_mse", moments.flight_mse(sensors, freezing), 1
    return experiment


# name: (relative work, experiment)
EXPERIMENTS = {
    "observability": (0.1, observability),
    "trends": (4.0, trends),
    "windows_stuck_at_zero": (10.0, windows("zero")),
    "windows_frozen_at_last": (10.0, windows("last")),
    "next_window_stuck_at_zero": (10.0, windows("zero", True)),
    "next_window_frozen_at_last": (10.0, windows("last", True)),
    "windows_lasting": (10.0, windows("last", False, LASTING_WINDOWS)),
    "next_window_lasting": (10.0, windows("last", True, LASTING_WINDOWS)),
}
