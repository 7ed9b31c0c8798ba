"""The flight of campaigns/variable_structure and the rules on it: against second moments worked out without chance, against the order of the issue,
and what a choice may know. The equations: test_variable_structure.py."""
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, run_all, test

needs("papers", "numpy")

import numpy as np  # noqa: E402
from variable_structure import experiments, intervals, moments, observability, scenario, structure  # noqa: E402
from variable_structure.filter import Filter  # noqa: E402
from variable_structure.rules import CHOOSING, RULES, Evidence  # noqa: E402

FLIGHTS, SEED = 120, 7
MADE = {}


def flights(freezing="zero", lasting=1.0):
    """Made once."""
    if (freezing, lasting) not in MADE:
        MADE[freezing, lasting] = scenario.fly(FLIGHTS, SEED, freezing, lasting)
    return MADE[freezing, lasting]


def flown(name, freezing="zero", next_window=False, lasting=1.0):
    key = (name, freezing, next_window, lasting)
    if key not in MADE:
        MADE[key] = structure.fly_by(RULES[name], flights(freezing, lasting), next_window)
    return MADE[key]


def median_rms(name, *how):
    return float(np.median(structure.rms(flown(name, *how), flights(*how[:1]))))


def near(found, wanted, relative=1e-12):
    assert np.allclose(found, wanted, rtol=relative, atol=0.0), (found, wanted)


# --- rules -------------------------------------------------------------------------------------------------------------


def evidence(measured, model=1.0, variance=0.01):
    """One window in which the filter and the trends predict `model`; measured: a level for each sensor."""
    levels = np.broadcast_to(np.asarray(measured, dtype=float), (1, scenario.WINDOW_S, 3))
    states = np.tile([model, 1e-3, 1e-5], (1, scenario.WINDOW_S, 1))
    return Evidence(levels, states, np.full((1, scenario.WINDOW_S), variance), np.full((1, 40), model), np.abs(levels[:, 0] - 1.0))


@test
def each_rule_takes_what_it_should():
    # sensor 1 stuck at zero, 2 sound, 3 off by 3 m/s
    taken = {name: np.flatnonzero(rule(evidence([0.0, 1.1, 4.0]))[0]).tolist() for name, rule in RULES.items()}
    assert taken == {"fixed_1": [0], "fixed_2": [1], "fixed_3": [2], "fuse": [0, 1, 2], "degree_only": [0], "trend_acceptor": [1],
                     "gate_then_degree": [1], "normalised_innovation": [1], "oracle": [1]}, taken
    # no sensor is believed: coast, where the oracle has to take one
    assert not RULES["normalised_innovation"](evidence([9.0, -9.0, 9.0])).any()
    assert RULES["oracle"](evidence([9.0, -9.5, 9.5]))[0].tolist() == [1, 0, 0]
    # within the gate it is the D nearest to 1 by ratio, 1 / 1.1^2 before 1 / 0.9^2, and not what (25) is least for: 1 / 0.91^2 is nearer than
    # 1 / 1.105^2, whose miss of 0.105 is the less by its own energy
    assert RULES["gate_then_degree"](evidence([0.9, 1.1, 5.0]))[0].tolist() == [0, 1, 0]
    apart = evidence([0.91, 1.105, 5.0])
    assert RULES["trend_acceptor"](apart)[0].tolist() == [0, 1, 0] and RULES["gate_then_degree"](apart)[0].tolist() == [1, 0, 0]
    # of the state's energy but of the other sign, D is 1: only the gate keeps it out
    assert RULES["gate_then_degree"](evidence([-1.0, 0.9, 5.0]))[0].tolist() == [0, 1, 0]
    # the quietest that passes: 0.25 (m/s)^2 is more than 4 x (0.15^2 + 0.01), less than 4 x (0.25^2 + 0.01)
    assert RULES["normalised_innovation"](evidence([1.5, 1.5, 1.5]))[0].tolist() == [0, 0, 1]


# --- filter and flight ------------------------------------------------------------------------------------------------


@test
def the_filter_is_kalman_s():
    chance, kalman = np.random.default_rng(10), Filter(2)
    transition, noise = observability.ins_channel(), 4.0 * np.diag([1e-6, 1e-12, 4e-14])
    x, p = np.zeros(3), np.diag([4.0, 1e-6, 1e-9])
    for _ in range(30):
        z, variance = chance.standard_normal(), 0.04
        x, p = transition @ x, transition @ p @ transition.T + noise
        gain = p[:, 0] / (p[0, 0] + variance)
        x, p = x + gain * (z - x[0]), (np.eye(3) - np.outer(gain, [1, 0, 0])) @ p
        kalman.predict()
        kalman.update(np.full(2, z), np.array([variance, np.inf]))
    near(kalman.state[0], x, 1e-7)
    near(kalman.covariance[0], p, 1e-7)
    # a variance without end is no measurement
    alone = Filter(1)
    states, variances = alone.propagated(30)
    near(variances[0, -1], kalman.covariance[1, 0, 0], 1e-9)
    assert (kalman.state[1] == 0.0).all() and (states == 0.0).all() and (alone.covariance[0] == np.diag([4.0, 1e-6, 1e-9])).all()


@test
def troubles_are_drawn_as_often_as_said():
    kind = scenario.fly(400, 1).trouble
    drawn = kind[:, scenario.SOUND_WINDOWS:].ravel()
    for trouble, part in scenario.CHANCES:
        seen, error = np.mean(drawn == trouble), np.sqrt(part * (1 - part) / drawn.size)
        assert abs(seen - part) < 4 * error, (scenario.TROUBLES[trouble], seen)
    assert (kind[:, :scenario.SOUND_WINDOWS] == scenario.SOUND).all()
    # a trouble that lasts five windows on average is redrawn in a fifth of them, and comes out the same by chance
    lasting = scenario.fly(400, 1, "last", 5.0).trouble[:, scenario.SOUND_WINDOWS:]
    parts = np.array([1.0 - 0.36, *(part for _, part in scenario.CHANCES)])
    wanted, count = 0.8 + 0.2 * np.sum(parts ** 2), lasting[:, 1:].size
    assert abs(np.mean(lasting[:, 1:] == lasting[:, :-1]) - wanted) < 4 * np.sqrt(wanted * (1 - wanted) / count)


@test
def frozen_and_biased_sensors_say_what_they_should():
    for freezing in scenario.FREEZINGS:
        made = flights(freezing)
        run, window, sensor = (part[0] for part in np.nonzero(made.trouble == scenario.FROZEN))
        said = made.measured[run, scenario.one_window(window), sensor]
        before = made.measured[run, window * scenario.WINDOW_S - 1, sensor]
        assert (said == (0.0 if freezing == "zero" else before)).all() and before != 0.0
    made = flights()
    error = made.measured - made.true[..., :1]
    mean = error.reshape(FLIGHTS, made.windows, scenario.WINDOW_S, 3).mean(axis=2)
    assert (np.abs(np.abs(mean[made.trouble == scenario.BIASED]) - 3.0) < 0.6).all()
    assert (np.abs(mean[made.trouble == scenario.SOUND]) < 0.6).all()


@test
def a_run_is_the_same_however_many_are_made():
    few, more, other = scenario.fly(3, 5), scenario.fly(6, 5), scenario.fly(3, 6)
    assert (few.measured == more.measured[:3]).all() and not (few.measured == other.measured).any(axis=1).all()
    assert (flown("oracle").estimates[:40] == structure.fly_by(RULES["oracle"], scenario.fly(40, SEED)).estimates).all()


@test
def without_a_choice_errors_are_those_of_the_second_moments():
    near(moments.FACTOR_SQUARE, (36 + 120 + 400) / 3)
    for freezing in scenario.FREEZINGS:
        for name, sensors in moments.USED.items():
            if (name, freezing) == ("fixed_2", "last"):  # a tail that so few flights do not tell
                continue
            found = intervals.mean(np.square(structure.rms(flown(name, freezing), flights(freezing))), SEED)
            exact, error = moments.flight_mse(sensors, freezing), (found.high - found.low) / 3.92
            assert abs(found.value - exact) < 4 * error, (name, freezing, found, exact)
            # the twin: a third more noise of degraded sensors would be seen
            assert abs(found.value - 1.5 * exact) > 4 * error, (name, freezing, found, exact)


@test
def linear_predictions_miss_by_their_second_moments():
    rows = {(name, metric): (value, made) for name, metric, value, made in experiments.trends(20 * FLIGHTS, SEED)}
    for name in ("hold", "linear", "linear_separate", "model"):
        found, exact = rows[name, "mse"][0], rows[name, "exact_mse"][0]
        assert abs(found.value - exact) < 4 * (found.high - found.low) / 3.92, (name, found, exact)
    # the issue's medians, of 60 flights, within 10 % and four standard errors of these
    for name, median in (("hold", 0.245), ("linear", 0.042), ("harmonic", 0.079), ("demark", 0.055), ("self_organised", 0.050),
                         ("model", 0.038), ("demark_printed", 45.0)):
        found = rows[name, "error_median"][0]
        assert abs(found.value - median) < 0.1 * median + 2 * (found.high - found.low), (name, found)
    # and the printed one is no slip of this reference: it is eight hundred times as far off
    assert rows["demark_printed", "error_median"][0].low > 500 * rows["demark", "error_median"][0].high


@test
def rules_come_in_the_order_of_the_issue():
    found = {name: median_rms(name) for name in RULES}
    fixed = [found[f"fixed_{number}"] for number in (1, 2, 3)]
    assert found["degree_only"] >= 0.85 and min(fixed) >= 0.7 and found["degree_only"] > max(fixed), found
    assert min(fixed) > found["fuse"] > found["trend_acceptor"] > found["gate_then_degree"], found
    assert found["gate_then_degree"] <= 0.12 and found["normalised_innovation"] <= 0.08, found
    assert np.mean(structure.hits(flown("trend_acceptor"), flights())) >= 0.75
    # frozen at its last value a sensor does not fool D alone so much: better than any fixed one
    last = {name: median_rms(name, "last") for name in RULES}
    assert last["degree_only"] < min(last[f"fixed_{number}"] for number in (1, 2, 3)), last


@test
def a_sensor_stuck_at_zero_is_always_the_choice_of_the_degree_alone():
    taken, there = structure.frozen_taken(flown("degree_only"), flights())
    assert (taken == there).all() and there.sum() > 400
    # the twins: with prediction first it is not, and at its last value it is in more than half of the windows
    taken, there = structure.frozen_taken(flown("gate_then_degree"), flights())
    assert taken.sum() < 0.2 * there.sum()
    taken, there = structure.frozen_taken(flown("degree_only", "last"), flights("last"))
    assert 0.5 * there.sum() < taken.sum() < 0.8 * there.sum(), taken.sum() / there.sum()


@test
def a_choice_for_the_next_window_knows_nothing_of_it():
    made = scenario.fly(4, 11)
    changed = scenario.Flights(made.true, made.measured.copy(), made.trouble)
    changed.measured[:, scenario.one_window(7)] += [27.0, 18.0, 9.0]
    for name in CHOOSING:
        if name == "oracle":
            continue
        before, after = (structure.fly_by(RULES[name], of, True).chosen for of in (made, changed))
        assert (before[:, :8] == after[:, :8]).all(), name
        assert not (before[:, 8:] == after[:, 8:]).all(), name
    # the twin: chosen from the window itself it changes there
    before, after = (structure.fly_by(RULES["gate_then_degree"], of).chosen for of in (made, changed))
    assert not (before[:, 7] == after[:, 7]).all()


@test
def in_flight_a_gate_at_each_sample_is_what_works():
    # troubles drawn anew for each window: who knows the best sensor of the window before knows nothing
    assert median_rms("oracle", "zero", True) > median_rms("fixed_1") and median_rms("gate_then_degree", "zero", True) > 0.7
    for freezing in scenario.FREEZINGS:
        gated = float(np.median(structure.rms(structure.fly_gated(flights(freezing)), flights(freezing))))
        assert gated < 0.12, gated


if __name__ == "__main__":
    raise SystemExit(run_all())
