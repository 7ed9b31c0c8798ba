"""The experiments of paper 000: rows (experiment, filter, arithmetic, metric, value or Interval, runs)."""
import math

import numpy as np
from variable_structure.intervals import Interval

from . import batch
from .estimators import (Shipping, end_point, fading_memory, linear_twin, scheduled, shipped, singer, stationary_lag, stationary_noise_gain,
                         steady_kalman, synthesised, white_acceleration, white_jerk, white_rate)
from .roll import (NORMAL_95, P0_DEG2, PERIOD_S, PROFILES, R_DEG2, SAMPLES, WINDOWS, Noise, exact, mean_of, monte_carlo, runs_of)


def named(what, a1, b0):
    return f"{what}({a1:g}:{b0:.3g})"


def error_rows(experiment, name, arithmetic, errors, runs, prefix="mse"):
    """A row for each window."""
    for window, value in errors.items():
        yield experiment, name, arithmetic, f"{prefix}_{window}", value, runs


# --- the reference table: constant gains from x^ = g(0), in double exactly and by Monte Carlo, and the shipped `synth`

GAINS = ((-0.3, 0.1), (0.0, 0.1), (0.0, 0.3), (-0.1, 0.3), (-0.3, 0.5), (0.0, 2.0 / 3.0))


def reference_table(options):
    runs = max(4000, runs_of(options.runs))  # its bands of 3 % are for these
    double = [synthesised(a1, b0) for a1, b0 in GAINS]
    fixed = [shipped("synth", Shipping(reset_at_first=True, parameters={"a1": a1, "b0": b0})) for a1, b0 in GAINS]
    for turn, profile in PROFILES.items():
        experiment, scores = f"roll_{turn}", monte_carlo([*double, *fixed], profile, Noise(), runs, options.seed)
        for (a1, b0), estimator, of_double, of_fixed in zip(GAINS, double, scores, scores[len(GAINS):]):
            name, found = named("synth", a1, b0), exact(estimator, profile)
            yield from error_rows(experiment, name, "double", found.mse, 1, "exact_mse")
            yield experiment, name, "double", "exact_peak_bias", found.peak, 1
            yield from error_rows(experiment, name, "double", of_double, runs)
            yield from error_rows(experiment, name, "fixed", of_fixed, runs)


# --- every filter of FILTER_LIST as shipped, and some of stated tuning, on all seven rolls

LSB_PER_DEGREE = 256.0 * math.pi / 180.0  # 256 LSB/g near level; R = 0.6 degree^2 is 12 LSB^2


def entries():
    """(title, arithmetic, filter, what its exact error is that of or None, variance of what that is given)."""
    def in_double(title, estimator):
        return title, "double", estimator, estimator, R_DEG2

    def as_shipped(title, name, **parameters):
        shipping = Shipping(lsb_per_unit=LSB_PER_DEGREE, parameters=parameters)
        return title, "fixed", shipped(name, shipping), linear_twin(name, shipping), shipping.rounded_variance(R_DEG2)

    def tuned_kf(drive):
        """With process noise drive x R on the rate per sample: q T^3 = drive x R, in LSB."""
        return as_shipped(f"kf({drive:g})", "kf", q=drive * R_DEG2 * LSB_PER_DEGREE * LSB_PER_DEGREE / (PERIOD_S * PERIOD_S * PERIOD_S))

    return [in_double("kf2_rate(0.01)", steady_kalman(white_rate(0.01))), in_double("kf2_rate(0.1)", steady_kalman(white_rate(0.1))),
            in_double("synth(-0.3:0.1)", synthesised(-0.3, 0.1)), in_double("synth(0:0.3)", synthesised(0.0, 0.3)),
            as_shipped("synth(-0.3:0.1)", "synth", a1=-0.3, b0=0.1), tuned_kf(0.01), tuned_kf(0.1),
            *(as_shipped(name, name) for name in batch.names())]


def all_filters(options):
    every, runs = entries(), runs_of(options.runs)
    for turn, profile in PROFILES.items():
        scores = monte_carlo([estimator for _, _, estimator, _, _ in every], profile, Noise(), runs, options.seed)
        for (title, arithmetic, _, twin, r), score in zip(every, scores):
            if twin:
                yield from error_rows(f"filters_{turn}", title, arithmetic, exact(twin, profile, r).mse, 1, "exact_mse")
            yield from error_rows(f"filters_{turn}", title, arithmetic, score, runs)


# --- adaptive without its guard and with several, on clean samples and with outliers

GUARDS = (0.0, 2.0, 2.5, 3.0, 3.5, 4.0, 6.0, 8.0)  # sigmas, 0 for none
DISTURBANCES = {"clean": Noise(), "5_percent": Noise(outliers=0.05), "15_percent": Noise(outliers=0.15),
                "shift_20_sigma": Noise(outliers=0.05, shift_sigma=20.0)}


def adaptive(options):
    estimators, runs = [shipped("adaptive", Shipping(parameters={"guard": guard})) for guard in GUARDS], runs_of(options.runs)
    yield "adaptive_defaults", "adaptive", "fixed", "guard_sigma", Shipping().parameter("adaptive", "guard"), 1
    for turn in ("ramp30", "cos60", "bump30", "sine30"):
        for disturbance, noise in DISTURBANCES.items():
            for guard, score in zip(GUARDS, monte_carlo(estimators, PROFILES[turn], noise, runs, options.seed)):
                yield from error_rows(f"adaptive_{disturbance}_{turn}", f"adaptive(guard={guard:g})", "fixed", score, runs)


# --- R as noise.c identifies it in 10 s from its floor, which is hundreds of times too small here

NOISE_LSB_PER_DEGREE, AFTER_S = 16.0, 10
# name: (turn or none at rest, Hz, share of samples that are 20 degrees off)
CASES = {"rest_10_hz": (None, 10, 0.0), "cos60_10_hz": ("cos60", 10, 0.0), "sine30_10_hz": ("sine30", 10, 0.0),
         "rest_10_hz_1_percent_of_20_deg": (None, 10, 0.01), "rest_100_hz": (None, 100, 0.0), "rest_100_hz_1_percent_of_20_deg": (None, 100, 0.01)}


def relative_deviation(values, mean, sd):
    """Standard deviation by the mean, with the 95 % interval that the fourth moment gives it."""
    spread = np.mean((values - mean) ** 4) - sd ** 4  # of a squared deviation
    error = NORMAL_95 * math.sqrt(max(0.0, spread) / len(values)) / (2.0 * sd)
    return Interval(sd / mean, (sd - error) / mean, (sd + error) / mean)


def noise(options):
    runs, variance = runs_of(options.runs), R_DEG2 * NOISE_LSB_PER_DEGREE * NOISE_LSB_PER_DEGREE + 1.0 / 12.0
    seeds = [batch.run_seed(options.seed, run) for run in range(runs)]
    for case, (turn, rate_hz, bad) in CASES.items():
        count = AFTER_S * rate_hz + 1
        truth = NOISE_LSB_PER_DEGREE * PROFILES[turn].truth(count) if turn else np.zeros(count)
        normal, uniform = batch.draws(seeds, count)
        off = math.sqrt(R_DEG2) * normal + np.where(uniform < bad, 20.0, 0.0)
        ratios = batch.noise_identified(10 * rate_hz, truth + off * NOISE_LSB_PER_DEGREE) / (256.0 * 1.5 * variance)
        mean, sd = mean_of(ratios)
        estimate, weight, again = batch.noise_expected(10 * rate_hz, truth, variance, bad)
        # R in force is anywhere within an eighth of the estimate: by 1 / 192 above it on average, of a variance of 1 / 192
        yield f"noise_{case}", "noise(x)", "fixed", "exact_r_by_true", estimate * (1.0 + 1.0 / 192.0), 1
        # terms of a relative deviation of 1.2, correlated with their neighbours: a sample serves in six
        most = math.sqrt(6.0 * 1.2 * 1.2 * weight / (2.0 * (1.0 - again)) + 1.0 / 192.0)
        yield f"noise_{case}", "noise(x)", "fixed", "exact_r_one_run_sd", most, 1
        yield f"noise_{case}", "noise(x)", "fixed", "r_by_true", mean, runs
        yield f"noise_{case}", "noise(x)", "fixed", "r_one_run_sd", relative_deviation(ratios, mean.value, sd), runs


# --- algorithm (22) without data: its gains are made of P and R alone; then what the filters with these gains do to the roll

SCHEDULES = ("printed", "square", "corrected", "uncorrelated", "uncorrelated_optimum")  # as reference_schedule_kind_t
HELD = 3  # those from here on are held in the safe region by themselves
STARTS, STEPS, LONG_AFTER = 400, SAMPLES - 1, 8000
SCHEDULE_SEED = 22  # no run of another seed: a fact about the equations


def starts():
    """Each P of the start anywhere from 0.05 R to 50 R on a logarithmic scale."""
    uniform = batch.draws([SCHEDULE_SEED], 5 * STARTS, normal=False)[1][0]
    return np.array([0.05 * math.pow(1000.0, u) for u in uniform]).reshape(STARTS, 5)


def period_of(gains):
    """Of the cycle in which gains end; 0: none to 64."""
    return next((period for period in range(1, 65) if np.all(np.abs(gains[period:] - gains[:-period]) < 1e-9)), 0)


def fact_rows(experiment, name, kind, clamped, before):
    facts = np.array([batch.schedule(kind, clamped, 1.0, p, before, STEPS) for p in starts()])
    _, a1, b0, variance, pe, p, growth = np.moveaxis(facts, 2, 0)
    inside = (b0 > 0.0) & (b0 <= 1.0) & (a1 > -1.0) & (a1 < 0.0) & (b0 > -a1 - 0.3)  # the region that the paper prints
    for metric, values in (("in_region", inside), ("pe_negative", pe < 0.0), ("p_negative", p < 0.0), ("growth", growth)):
        yield experiment, name, "double", metric, mean_of(np.mean(values, axis=1))[0], 1
    of_starts = np.mean(variance, axis=1)
    yield experiment, name, "double", "true_variance_median", float(np.quantile(of_starts, 0.5)), 1
    yield experiment, name, "double", "true_variance_mean", float(np.mean(of_starts)), 1
    periods = {period_of(gains) for gains in b0}
    yield experiment, name, "double", "period", periods.pop() if len(periods) == 1 else 0, 1


def gains_of(kind, clamped, r=R_DEG2):
    """(a1, b0) of each step; not a number once (21) divides by zero."""
    facts = batch.schedule(kind, clamped, r, [P0_DEG2] * 5, 0, STEPS)
    solved = np.logical_and.accumulate(facts[:, :1] != 0.0)
    return np.where(solved, facts[:, 1:3], np.nan)


def roll_rows(name, estimator):
    for turn in ("ramp30", "cos60", "bump30"):
        found = exact(estimator, PROFILES[turn]).mse
        finite = {window: value if math.isfinite(value) else math.inf for window, value in found.items()}
        yield from error_rows(f"algorithm_22_{turn}", name, "double", finite, 1)


def any_r_rows():
    """The paper gives no R, and the schedule's course hangs on P(0) / R: any of 0.20, 0.21 .. 1.00."""
    found = [exact(scheduled(gains_of(0, False, hundredth / 100.0)), PROFILES["cos60"], hundredth / 100.0).mse for hundredth in range(20, 101)]
    for window in WINDOWS:
        values = sorted(errors[window] for errors in found)
        yield "algorithm_22_any_r", "printed", "double", f"mse_{window}_least", values[0], 1
        yield "algorithm_22_any_r", "printed", "double", f"mse_{window}_median", values[len(values) // 2], 1


def schedules(_options):
    for clamped in (False, True):
        for kind, word in enumerate(SCHEDULES[:HELD] if clamped else SCHEDULES):
            name = word + "_clamped" * clamped
            yield from fact_rows("schedule_15_s", name, kind, clamped, 0)
            yield from fact_rows("schedule_later", name, kind, clamped, LONG_AFTER)
            yield from roll_rows(name, scheduled(gains_of(kind, clamped)))
    yield from roll_rows("exact_covariance", scheduled(batch.exact_schedule(R_DEG2, -1.0 / 3.0, P0_DEG2, STEPS)))
    yield from any_r_rows()


# --- the synthesised filter against others that pass as much noise: what they lose while the roll turns

# the paper's point, what the paper's region has of least noise, the shipped preset, and one outside the region
LEVELS = ((-0.3, 0.1), (0.0, 0.1), (0.0, 0.3), (-0.1, 0.3), (0.9, 0.3))
LAG_PAIRS = ((-0.3, 0.1), (-0.1, 0.3), (0.0, 0.3), (-0.3, 0.5), (0.0, 2.0 / 3.0), (-1.0 / 6.0, 11.0 / 13.0))
# a family, the ends of its parameter, whether between them it is logarithmic; the noise gain rises from the first to the second
FAMILIES = {"kf2_rate": (lambda drive: steady_kalman(white_rate(drive)), 1e-6, 1e4, True),
            "kf2_acceleration": (lambda drive: steady_kalman(white_acceleration(drive)), 1e-6, 1e4, True),
            "kf3_singer": (lambda drive: steady_kalman(singer(drive, 0.9)), 1e-8, 1e4, True),
            "alpha_beta_gamma": (lambda drive: steady_kalman(white_jerk(drive)), 1e-8, 1e4, True),
            "fading_memory_1": (lambda theta: fading_memory(1, theta), 0.98, 0.01, False),
            "fading_memory_2": (lambda theta: fading_memory(2, theta), 0.98, 0.01, False)}


def with_noise_gain(name, wanted):
    """The member of a family with this noise gain, by halving."""
    make, quiet, loud, logarithmic = FAMILIES[name]
    at = lambda part: quiet * math.pow(loud / quiet, part) if logarithmic else quiet + part * (loud - quiet)
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stationary_noise_gain(make(at(middle))) < wanted else (low, middle)
    return make(at(0.5 * (low + high)))


def end_point_near(order, wanted):
    """The nearest by ratio: a length is a whole number, and the row noise_gain says what it passes."""
    length = order + 1
    while stationary_noise_gain(end_point(order, length)) > wanted:
        length += 1
    below, above = (stationary_noise_gain(end_point(order, count)) / wanted for count in (length, length - 1))
    return end_point(order, length - 1 if above * below < 1.0 else length)


def rivals_at(wanted):
    return {**{name: with_noise_gain(name, wanted) for name in FAMILIES}, "end_point_1": end_point_near(1, wanted),
            "end_point_2": end_point_near(2, wanted)}


def bias_rows(experiment, name, found):
    for turn, value in found.items():
        yield experiment, name, "double", f"bias2_{turn}", value.bias2["6_10"], 1
        yield experiment, name, "double", f"peak_{turn}", value.peak, 1


def lag_rows():
    """Lag under a constant acceleration of the two Kalman filters of two states by that of the synthesised one, at equal noise gain. Table 1 takes
    sqrt((1.419 - 0.359) / (0.875 - 0.348)) = 1.418 of it."""
    for pair in LAG_PAIRS:
        for rival in ("kf2_rate", "kf2_acceleration"):
            lag = stationary_lag(with_noise_gain(rival, batch.closed_noise_gain(*pair)))
            yield "equal_noise_lag", named("synth", *pair), "double", rival, lag / batch.closed_lag(*pair), 1


def all_rows(compared):
    """compared: {rival: [(its bias^2 of the synthesised filter by the rival's, whether its largest error is the larger)]}"""
    for name, cells in sorted(compared.items()):
        ratios = [ratio for ratio, _ in cells]
        for metric, value in (("cells", len(cells)), ("synth_loses", sum(ratio > 1.0 for ratio in ratios)),
                              ("synth_loses_peak", sum(lost for _, lost in cells)), ("bias2_ratio_least", min(ratios)),
                              ("bias2_ratio_most", max(ratios))):
            yield "equal_noise_all", name, "double", metric, value, 1


def equal_noise(_options):
    compared = {}
    for level in LEVELS:
        experiment, synth = named("equal_noise", *level), synthesised(*level)
        ours = {turn: exact(synth, profile, 0.0) for turn, profile in PROFILES.items()}
        yield experiment, "synth", "double", "noise_gain", stationary_noise_gain(synth), 1
        yield from bias_rows(experiment, "synth", ours)
        for name, rival in rivals_at(batch.closed_noise_gain(*level)).items():
            found = {turn: exact(rival, profile, 0.0) for turn, profile in PROFILES.items()}
            yield experiment, name, "double", "noise_gain", stationary_noise_gain(rival), 1
            yield from bias_rows(experiment, name, found)
            compared.setdefault(name, []).extend((ours[turn].bias2["6_10"] / found[turn].bias2["6_10"], ours[turn].peak > found[turn].peak)
                                                 for turn in PROFILES)
    yield from lag_rows()
    yield from all_rows(compared)
