"""Paper 002's y and H(k): one gate over three components against a gate for each, on three realisations of Table 1 at a time. Beside them (11),
which is told how the runs are made. In double; the gate of the components is that of 3 sigma, with the same false alarms of chi-square with three
degrees of freedom."""
import numpy as np
from figures_traces import joint, realisations, reference

from .filters import CLEAN, ENTRIES, GATED, IN_RUNS, MERGED, PLAIN, RATIO, SAMPLES, STAY, Scenario, ratios, steady_sigma_deg

AXES, STEADY = 3, 200
GATE, JOINT_LIMIT, JOINT = 3.0, 14.156, f"{GATED}(one_gate)"
CHAIN = next(name for name in IN_RUNS if name.startswith(MERGED))
NAMES = (PLAIN, GATED, JOINT, MERGED, CHAIN)
SHARES = {"apart": (False, 0.0), "together": (True, 0.0), "apart_in_runs": (False, STAY), "together_in_runs": (True, STAY)}  # in common; (11)
BURSTS = {"burst_on_one": 1, "burst_on_all": AXES}  # axes hit
BURST_AT, BURST_LENGTH, WATCHED = 150, 10, 100
FEWER = 5  # runs are a fifth of the others': each is of three axes


def chain(random, shape, stay):
    """15 % outliers, in runs where one follows another with stay; the first sample none."""
    share, bad = 1.0 - CLEAN, np.zeros(shape, dtype=bool)
    begins = share * (1.0 - stay) / (1.0 - share) if stay else share
    for k in range(1, shape[-1]):
        bad[..., k] = random.random(shape[:-1]) < (np.where(bad[..., k - 1], stay, begins) if stay else share)
    return bad


def made(options, runs, bad):
    """(truth, y), axes x runs x samples."""
    true, y, _ = realisations(options.seed + 6, 0, AXES * runs, SAMPLES, Scenario(outliers=0.0))
    true, y = (of.reshape(AXES, runs, SAMPLES) for of in (true, y))
    return true, true + (y - true) * np.where(bad, RATIO, 1.0)


def errors(name, true, y):
    if name == JOINT:
        return joint(GATED, y, JOINT_LIMIT) - true
    entry, flat = ENTRIES[name], y.reshape(-1, SAMPLES)
    found = reference(entry.reference, flat, np.zeros(flat.shape), GATE, bool(entry.reacquire), entry.stay)["x"]
    return found.reshape(y.shape) - true


def of_shares(experiment, options, runs):
    """K_ef pooled over the three axes; a run is one of three axes."""
    common, stay = SHARES[experiment]
    random = np.random.default_rng([options.seed, list(SHARES).index(experiment)])
    true, y = made(options, runs, chain(random, (1 if common else AXES, runs, SAMPLES), stay))
    squares = np.array([np.sum(np.square(errors(name, true, y)[..., STEADY:]), axis=(0, 2)) for name in NAMES])
    for name, ratio in list(zip(NAMES, ratios(np.tile(squares[0], (len(NAMES), 1)), squares, options.seed)))[1:]:
        yield name, "k_ef_steady", tuple(ratio)


def of_burst(experiment, options, runs):
    """The largest error of any axis from a burst's first sample on, in steady sigmas of the Kalman filter."""
    bad = np.zeros((AXES, 1, SAMPLES), dtype=bool)
    bad[:BURSTS[experiment], :, BURST_AT:BURST_AT + BURST_LENGTH] = True
    true, y = made(options, runs, bad)
    for name in NAMES:
        peak = np.max(np.abs(errors(name, true, y)[..., BURST_AT:BURST_AT + WATCHED]), axis=(0, 2)) / steady_sigma_deg(PLAIN)
        for metric, part in (("peak_error_sigma_median", 0.5), ("peak_error_sigma_p95", 0.95)):
            yield name, metric, float(np.quantile(peak, part))


def rows(options):
    runs = max(2, options.runs // FEWER)
    for experiment in (*SHARES, *BURSTS):
        for name, metric, value in (of_shares if experiment in SHARES else of_burst)(experiment, options, runs):
            yield f"three_axes_{experiment}", name, "double", metric, value, runs
