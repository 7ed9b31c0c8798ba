"""The experiments of paper 001: 70 s of a UAV's altitude at 10 Hz, straight to 20 s, accelerated by 5 m/s^2 to 35 s and by -5 m/s^2 to 50 s, straight
again, seen with noise of 0.5 m. Sigma on straight legs and the lag under acceleration, beside 0.37 m / 0.9 m of the synthesised filter, 0.3 m / 1.4 m
and 0.45 m / 0 of the Kalman filters of first and second order."""
import math

import numpy as np
from variable_structure.intervals import Interval

from . import batch
from .estimators import (Shipping, extrapolation_fed_back, linear_twin, shipped, stationary_lag, stationary_noise_gain, steady_gains, steady_kalman,
                         synthesised, white_acceleration, white_jerk)
from .roll import mean_of, noise_gain

SAMPLES, PERIOD_S, SIGMA_M, ACCELERATION_M_S2 = 701, 0.1, 0.5, 5.0
UP, DOWN, STRAIGHT = 200, 350, 500  # samples at which the legs begin
# the paper's "polynomial of second order" is x = a t^2 / 2 or, to the letter of a polynomial, x = a t^2
FACTORS = {"altitude_half_a_t2": 1.0, "altitude_a_t2": 2.0}
KF1_LAG_M, KF1_SIGMA_M, KF2_SIGMA_M = 1.4, 0.3, 0.45  # published, solved for
LAG_M, SIGMA_OWN_M = 0.9, 0.37  # published, of the synthesised filter
SETTLE = 200  # samples of run-in for the filters on the chip: 20 s
LAGS = {"lag_20_35": slice(UP, DOWN), "lag_35_50": slice(DOWN, STRAIGHT), "lag_settled": slice(300, DOWN)}
STATIONARY = slice(100, UP)


def runs_of(runs):
    """10,000 runs of paper 002 count as 2,000 here."""
    return max(1, runs // 5)


def truth(reading, run_in=0):
    """Altitude above the straight line on which it begins: every filter here follows a line without error, so a line more or less changes nothing,
    and without it the start is exact when the past estimates are 0."""
    def rise(k, begin, end):
        """Half a t^2 of a push from one sample to another: a parabola, then a line."""
        into, after = PERIOD_S * min(max(k - begin, 0), end - begin), PERIOD_S * max(0, k - end)
        return ACCELERATION_M_S2 * into * (0.5 * into + after)
    return np.array([FACTORS[reading] * (rise(k, UP, DOWN) - rise(k, DOWN, STRAIGHT)) for k in range(-run_in, SAMPLES)])


def straight(values):
    """Mean over both straight legs, 0-20 and 50-70 s, of the last axis."""
    return (np.sum(values[..., :UP], axis=-1) + np.sum(values[..., STRAIGHT:], axis=-1)) / (UP + SAMPLES - STRAIGHT)


def root(square):
    return Interval(math.sqrt(square.value), math.sqrt(max(0.0, square.low)), math.sqrt(square.high))


def monte_carlo_rows(reading, name, arithmetic, estimator, run_in, options):
    runs, true = runs_of(options.runs), truth(reading, run_in)
    normal, _ = batch.draws([batch.run_seed(options.seed, run) for run in range(runs)], len(true), uniform=False)
    errors = (true - estimator(true + SIGMA_M * normal))[:, run_in:]
    square = straight(np.square(errors))
    found = {"sigma": root(mean_of(square)[0]), "sigma_one_run_sd": mean_of(np.sqrt(square))[1],
             "sigma_stationary": root(mean_of(np.mean(np.square(errors[:, STATIONARY]), axis=1))[0]),
             **{metric: mean_of(np.mean(errors[:, leg], axis=1))[0] for metric, leg in LAGS.items()}}
    for metric, value in found.items():
        yield reading, name, arithmetic, metric, value, runs


def exact_rows(reading, name, arithmetic, estimator, run_in, r):
    """The same without chance, for a filter that is linear in its samples; r: variance of their noise."""
    true = truth(reading, run_in)
    errors = (true - estimator(true[None])[0])[run_in:]
    square = np.square(errors) + r * noise_gain(estimator, len(true))[0][run_in:]
    found = {"sigma": math.sqrt(straight(square)), "sigma_stationary": math.sqrt(np.mean(square[STATIONARY])),
             **{metric: np.mean(errors[leg]) for metric, leg in LAGS.items()}}
    for metric, value in found.items():
        yield reading, name, arithmetic, f"exact_{metric}", value, 1


# --- the synthesised filter and both Kalman filters, in double, by every reading of what the paper leaves open


def solved(of, wanted, rises):
    """The drive at which a quantity that falls with it (or rises) takes a value, by halving on a logarithmic scale."""
    low, high = -6.0, 6.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (of(math.pow(10.0, middle)) < wanted) == rises else (low, middle)
    return math.pow(10.0, 0.5 * (low + high))


def kalman_rows(name, space, drive):
    """q of the process noise in the paper's units: drive x R / T^4, an acceleration squared."""
    for metric, gain in zip(("alpha", "beta", "gamma")[:space.order], steady_gains(space)):
        yield "altitude_kalman", name, "double", metric, gain, 1
    yield "altitude_kalman", name, "double", "q", drive * SIGMA_M * SIGMA_M / PERIOD_S ** 4, 1


def noise_of(space):
    return stationary_noise_gain(steady_kalman(space))


def drives_of(reading):
    """Of the Kalman filters: by the lag, by sigma, and of the second one by sigma."""
    lag_samples = KF1_LAG_M / (FACTORS[reading] * ACCELERATION_M_S2 * PERIOD_S * PERIOD_S)
    return (solved(lambda drive: stationary_lag(steady_kalman(white_acceleration(drive))), lag_samples, False),
            solved(lambda drive: noise_of(white_acceleration(drive)), (KF1_SIGMA_M / SIGMA_M) ** 2, True),
            solved(lambda drive: noise_of(white_jerk(drive)), (KF2_SIGMA_M / SIGMA_M) ** 2, True))


def readings(options):
    for reading in FACTORS:
        by_lag, by_sigma, second = drives_of(reading)
        yield from kalman_rows(reading.replace("altitude", "kf1_by_lag"), white_acceleration(by_lag), by_lag)
        if reading == "altitude_a_t2":
            yield from kalman_rows("kf1_by_sigma", white_acceleration(by_sigma), by_sigma)
            yield from kalman_rows("kf2_by_sigma", white_jerk(second), second)
        every = {"synth(-0.3:0.1)": synthesised(-0.3, 0.1, 0.0), "synth(0:0.1)": synthesised(0.0, 0.1, 0.0),
                 "synth_as_printed(-0.3:0.1)": extrapolation_fed_back(0.1), "kf1_by_lag": steady_kalman(white_acceleration(by_lag), 0.0),
                 "kf1_by_sigma": steady_kalman(white_acceleration(by_sigma), 0.0), "kf2_by_sigma": steady_kalman(white_jerk(second), 0.0)}
        true = truth(reading)
        for name, estimator in every.items():
            yield from monte_carlo_rows(reading, name, "double", estimator, 0, options)
            yield from exact_rows(reading, name, "double", estimator, 0, SIGMA_M * SIGMA_M)
            errors = true - estimator(true[None])[0]
            yield reading, name, "double", "peak_bias", np.max(np.abs(errors)), 1
            yield reading, name, "double", "lag_noise_free", errors[DOWN - 1], 1


def printed_ratio(above, below):
    """Of two numbers as printed; the interval is what rounding to their digits leaves open."""
    (a, a_half), (b, b_half) = ((float(text), 0.5 * 10.0 ** -len(text.partition(".")[2])) for text in (above, below))
    return Interval(a / b, (a - a_half) / (b + b_half), (a + a_half) / (b - b_half))


def ratios(_options):
    """Of what the paper prints: the first Kalman filter's lag by its own filter's, its own sigma by the first one's, the second one's by its own."""
    for metric, above, below in (("lag_kf1_by_own", KF1_LAG_M, LAG_M), ("sigma_own_by_kf1", SIGMA_OWN_M, KF1_SIGMA_M),
                                 ("sigma_kf2_by_own", KF2_SIGMA_M, SIGMA_OWN_M)):
        yield "ratios", "printed", "double", metric, printed_ratio(f"{above}", f"{below}"), 1


# --- every filter of FILTER_LIST on the same altitude


def shipped_filters(options):
    entries = [("synth(-0.3:0.1)", "synth", {"a1": -0.3, "b0": 0.1}), ("synth(0:0.1)", "synth", {"a1": 0.0, "b0": 0.1}),
               *((name, name, {}) for name in batch.names())]
    for reading, factor in FACTORS.items():
        for title, name, parameters in entries:
            # counts per metre such that the range fits into 13 bits about its middle
            shipping = Shipping(lsb_per_unit=7.0 / factor, zero=0.5 * truth(reading)[-1], r=SIGMA_M * SIGMA_M, parameters=parameters)
            yield from monte_carlo_rows(reading, title, "fixed", shipped(name, shipping), SETTLE, options)
            twin = linear_twin(name, shipping)
            if twin:
                yield from exact_rows(reading, title, "fixed", twin, SETTLE, shipping.rounded_variance(SIGMA_M * SIGMA_M))
