"""make comparison in small: what it measures is what theory says of the simplest filters."""
import math
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, run_all, test

needs("papers", "numpy", "matplotlib")

import numpy as np  # noqa: E402
import comparison_runs as made  # noqa: E402
from comparison_classes import of_recordings  # noqa: E402
from comparison_filters import NAMES, filtered, roll_of  # noqa: E402
from default_score import CLASSES  # noqa: E402
from laws import PLAIN  # noqa: E402
from resilience.filters import MERGED  # noqa: E402


@test
def the_raw_samples_have_neither_lag_nor_overshoot():
    for move, (times, roll) in made.MOVES.items():
        x = np.array([roll])
        if move == "step":
            assert made.of_step(times, x) == (0.0, 0.0)
        elif move == "ramp":
            behind, beyond = made.of_ramp(times, roll, x)
            assert abs(behind) < 1e-9 and beyond < 1e-9
        else:
            behind, gain = made.of_sine(times, x)
            assert abs(behind) < 1e-6 and abs(gain - 1.0) < 1e-6, (behind, gain)


@test
def the_ema_lags_as_its_weight_says():
    """Weight w at 100 Hz: a ramp is followed (1 - w) / w samples late, and 90 % of a step are reached after ln 0.1 / ln(1 - w) samples."""
    w = 1.0 - math.exp(-2.0 * math.pi * 4.0 / 100.0)
    z = np.array([np.arange(400.0)])
    assert abs((z - filtered("ema", 100.0, 1, z))[0, -1] - (1.0 - w) / w) < 1e-6
    step = np.array([[0.0] * 10 + [1000.0] * 40])
    reached = int(np.argmax(filtered("ema", 100.0, 1, step)[0] >= 900.0)) - 9
    assert reached == math.ceil(math.log(0.1) / math.log(1.0 - w)), reached


@test
def a_still_board_is_level_for_all():
    level = np.full((1, 400), 0.0), np.full((1, 400), 256.0)
    for name in NAMES:
        assert abs(roll_of(name, 100.0, *level)[0, -1]) < 1e-3, name


@test
def the_share_and_the_runs_of_outliers_are_those_that_are_stated():
    chance = np.random.default_rng(1)
    bad = made.outliers_of(made.SCENARIOS[1], chance, (2000, 400))
    follow = np.sum(bad[:, 1:] & bad[:, :-1]) / np.sum(bad[:, :-1])
    assert abs(np.mean(bad) - made.SHARE) < 0.005 and abs(follow - made.STAY) < 0.01, (np.mean(bad), follow)
    assert abs(np.mean(made.outliers_of(made.SCENARIOS[0], chance, (500, 400))) - made.SHARE) < 0.005


@test
def gates_are_worth_what_paper_002_says():
    """The pseudo-Bayesian filter has 38 in the steady state, the Kalman filter 1 by definition."""
    found = made.k_ef(300)
    assert found["15 % outliers"][PLAIN] == 1.0 and 30.0 < found["15 % outliers"][MERGED] < 46.0, found["15 % outliers"]
    assert found["no outliers"]["huber"] < 1.0 < found["15 % outliers"]["huber"], found


@test
def recordings_alone_are_those_that_nobody_made():
    """Two rates, one with errors of 2 and 8 (4 in the middle), one with 9: the root of 36. A made stream and a tuning recording do not count."""
    row = {"level": "stream", "class": CLASSES[0], "filter": "f", "made": False}
    rows = [{**row, "rate_hz": rate, "rmse_lsb_5Hz": error} for rate, error in ((100, 2.0), (100, 8.0), (200, 9.0))]
    other = [{**rows[0], "made": True}, {**rows[0], "class": f"tuning, {CLASSES[0]}"}, {"level": "class"}]
    found = of_recordings(rows + other)
    assert list(found) == [CLASSES[0]] and abs(found[CLASSES[0]]["f"] - 6.0) < 1e-12, found


if __name__ == "__main__":
    raise SystemExit(run_all())
