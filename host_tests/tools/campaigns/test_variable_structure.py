"""campaigns/variable_structure, the reference of paper 004: each equation against what was worked out by hand, each erratum with the printed form as
the twin that must fail; intervals and command line. The flight and its rules: test_variable_structure_flight.py."""
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, refused, run_all, test

needs("papers", "numpy")

import numpy as np  # noqa: E402
from variable_structure import experiments, intervals, observability, organisation, scenario, trends  # noqa: E402
from variable_structure.rules import INVERSE  # noqa: E402

G, RE = 9.81, 6.371e6


def near(found, wanted, relative=1e-12):
    assert np.allclose(found, wanted, rtol=relative, atol=0.0), (found, wanted)


# --- observability ----------------------------------------------------------------------------------------------------


def channel():
    return observability.constant_observability(observability.ins_channel(), [1.0, 0.0, 0.0])


@test
def the_channel_is_observable_as_worked_out_by_hand():
    # H F = [1, -g, 0]; H F^2 = [1 - g / Re, -2 g, -g]. Solved: x2 = (z1 - z2) / g, x3 = (2 z2 - z3 - (1 + g / Re) z1) / g
    near(channel(), [[1, 0, 0], [1, -G, 0], [1 - G / RE, -2 * G, -G]])
    inverse = observability.pseudo_inverse(channel())
    assert np.allclose(inverse, [[1, 0, 0], [1 / G, -1 / G, 0], [-(1 + G / RE) / G, 2 / G, -1 / G]], rtol=0, atol=1e-12), inverse
    gains = observability.noise_gains(inverse)
    near(gains, [1.0, 2 / G ** 2, ((1 + G / RE) ** 2 + 5) / G ** 2], 1e-10)
    assert [f"{gain:.6g}" for gain in gains] == ["1", "0.0207822", "0.0623467"]
    # the condition from the roots of the characteristic polynomial of O O'
    squares = np.sort(np.roots(np.poly(channel() @ channel().T)))
    condition = np.sqrt(squares[-1] / squares[0])
    assert f"{condition:.4g}" == "23.98", condition
    near(np.linalg.cond(channel()), condition, 1e-8)


@test
def a_changing_system_is_told_from_n_samples():
    chance = np.random.default_rng(3)
    steps, outputs, state = chance.standard_normal((3, 4, 4)), chance.standard_normal((4, 4)), chance.standard_normal(4)
    states = [state]
    for step in steps:
        states.append(step @ states[-1])
    measured = np.array([output @ x for output, x in zip(outputs, states)])
    matrix = observability.local_observability(steps, outputs)
    near(matrix @ state, measured, 1e-9)
    near(observability.pseudo_inverse(matrix) @ measured, state, 1e-7)
    # the twin: in the other order the products tell another state
    assert not np.allclose(np.linalg.pinv(observability.local_observability(steps[::-1], outputs)) @ measured, state, rtol=0.01)
    assert observability.is_observable(matrix) and not observability.is_observable(observability.constant_observability(np.eye(3), [1, 0, 0]))
    refused(ValueError, lambda: observability.local_observability(steps[:2], outputs),
            "4 states takes as many outputs and one transition fewer, not 4 and 2")
    refused(ValueError, lambda: observability.local_observability(steps, outputs[:2]), "not 2 and 3")


@test
def the_noise_of_a_sensor_cancels_in_the_degree_of_observability():
    chance = np.random.default_rng(4)
    states, measured = chance.standard_normal((20, 3)) * [1.0, 1e-3, 1e-5], chance.standard_normal(20)
    inverse = observability.pseudo_inverse(channel())
    x, y = observability.mean_square(states), observability.mean_square(observability.equivalent_measurements(inverse, measured))
    short = observability.degree(x, y, observability.noise_gains(inverse))
    for variance in (1e-9, 0.0225, 1.0, 1e9):
        near(observability.degree_by_variances(x, y, variance, observability.noise_variances(inverse, variance)), short)
    # the twin: were R* of another sensor, it would not cancel
    assert not np.allclose(observability.degree_by_variances(x, y, 1.0, observability.noise_variances(inverse, 2.0)), short, rtol=0.4)
    # (15), (16) by hand, over the same samples
    equivalent = [[z[0], (z[0] - z[1]) / G, (2 * z[1] - z[2] - (1 + G / RE) * z[0]) / G] for z in (measured[k:k + 3] for k in range(18))]
    by_hand = np.mean(np.square(states[:18]), axis=0) / np.mean(np.square(equivalent), axis=0) / observability.noise_gains(inverse)
    near(observability.window_degree(inverse, states, measured), by_hand, 1e-9)


@test
def the_degree_of_a_measured_state_ranks_by_energy_alone():
    states = np.tile([2.0, 1e-3, 1e-5], (20, 1))
    for level in (0.1, 1.0, 40.0):
        near(observability.window_degree(INVERSE, states, np.full(20, level))[0], 4.0 / level ** 2, 1e-9)
    # nothing but noise of the same energy as the signal is as observable as the signal
    noise = np.random.default_rng(5).choice((-2.0, 2.0), 20)
    near(observability.window_degree(INVERSE, states, noise)[0], 1.0, 1e-9)
    assert observability.window_degree(INVERSE, states, np.zeros(20))[0] == np.inf


@test
def noise_of_the_system_is_missing_in_12():
    # v* of (3): white noise R and, with g = [[0, 0, 0], [H, 0], [H F, H]], what w adds; exact variance of O^+ v*
    transition, output = observability.ins_channel(), np.array([[1.0, 0.0, 0.0]])
    spread = np.zeros((3, 6))
    spread[1, :3], spread[2, :3], spread[2, 3:] = output, output @ transition, output
    def missed(process, variance):
        cover = variance * np.eye(3) + spread @ np.diag(np.tile(process, 2)) @ spread.T
        return 1.0 - observability.noise_variances(INVERSE, variance) / np.diag(INVERSE @ cover @ INVERSE.T)

    # on this channel next to nothing. With w of dV as large as v, v* has the variances 1, 2, 3 and a covariance of 1 between the last two, so
    # y2 = (z1 - z2) / g has 3 / g^2 in place of 2 / g^2, and y3 = (2 z2 - z3 - z1) / g has 8 / g^2 in place of 6 / g^2
    assert (np.abs(missed(np.square(scenario.PROCESS), 0.15 ** 2)) < 1e-3).all()
    assert np.allclose(missed(np.array([1.0, 0.0, 0.0]), 1.0), [0.0, 1 / 3, 1 / 4], rtol=0, atol=1e-5)


# --- trends -----------------------------------------------------------------------------------------------------------

PAST, AHEAD = np.arange(40.0), 40.0 + np.arange(20.0)


@test
def trends_go_on_with_what_they_are_made_for():
    line = 3.0 - 0.25 * PAST
    near(trends.linear(PAST, line, AHEAD), 3.0 - 0.25 * AHEAD, 1e-9)
    for period in trends.PERIODS_S[:4]:
        wave = lambda t: 0.7 * np.sin(2 * np.pi * t / period + 0.4) + 0.2
        near(trends.harmonic(PAST, wave(PAST), AHEAD), wave(AHEAD), 1e-6)
    # many at once as each alone
    both = np.stack([line, np.cos(PAST / 10.0)])
    for trend in trends.TRENDS.values():
        near(trend(PAST, both, AHEAD), [trend(PAST, one, AHEAD) for one in both], 1e-9)


@test
def demark_goes_on_with_increments_and_not_with_values():
    # both trends of a constant are the constant: their increments are none, their values add up to k + 1 times itself
    constant = np.full(40, 1.0)
    near(trends.demark(PAST, constant, AHEAD), np.ones(20), 1e-9)
    near(trends.demark_as_printed(PAST, constant, AHEAD), 2.0 + np.arange(20.0), 1e-9)
    # half the slope of each trend, from the mean of the last three at the middle one
    data = np.random.default_rng(6).standard_normal(40)
    begin = np.concatenate(([38.0], AHEAD))
    grown = 0.5 * sum(np.array([trend(PAST, data, begin)[1:] - trend(PAST, data, begin)[0]]) for trend in (trends.linear, trends.harmonic))[0]
    near(trends.demark(PAST, data, AHEAD), np.mean(data[-3:]) + grown, 1e-8)


@test
def amplitudes_one_by_one_are_right_for_orthogonal_functions_only():
    # of 1 over t = 0 .. n-1: the constant takes it all, and t takes sum t / sum t^2 = 3 / (2 n - 1) once more
    ones, count = np.ones(40), len(PAST)
    separate = trends.separate_amplitudes(trends.linear_basis(PAST)) @ ones
    near(separate, [3.0 / (2 * count - 1), 1.0])
    near(trends.joint_amplitudes(trends.linear_basis(PAST)) @ ones + [1.0, 0.0], [1.0, 1.0], 1e-12)
    near((trends.linear_matrix(PAST, AHEAD, trends.separate_amplitudes) @ ones)[0], 1.0 + 40 * 3.0 / 79, 1e-12)
    # centred, t and 1 are orthogonal and both ways are one
    centred = trends.linear_basis(PAST - 19.5)
    near(trends.separate_amplitudes(centred), trends.joint_amplitudes(centred), 1e-9)
    # (22) is the derivative of the sum of (chi - a mu)^2, set to zero: each amplitude alone fulfils it
    data = np.random.default_rng(8).standard_normal(40)
    for function, amplitude in zip(trends.linear_basis(PAST).T, trends.separate_amplitudes(trends.linear_basis(PAST)) @ data):
        assert abs(np.sum(-2 * data * function + 2 * amplitude * function ** 2)) < 1e-9


@test
def two_phases_of_the_harmonic_trend_are_one_too_many():
    # (19) with one frequency: phases turn A and B into other A and B of the same curve
    near(0.3 * np.sin(0.1 * PAST + 0.5) + 0.4 * np.cos(0.1 * PAST - 0.2),
         trends.harmonic_basis(PAST, 20 * np.pi) @ [0.3 * np.cos(0.5) + 0.4 * np.sin(0.2), 0.3 * np.sin(0.5) + 0.4 * np.cos(0.2), 0.0], 1e-9)


# --- self-organisation and acceptor -----------------------------------------------------------------------------------


@test
def criteria_are_zero_for_agreement_and_one_for_nothing():
    data = np.array([[1.0, -2.0, 2.0], [3.0, 0.0, 4.0]])
    near(organisation.regularity(data, data) + 1.0, [1.0, 1.0])
    near(organisation.regularity(0.0 * data, data), [1.0, 1.0])
    near(organisation.regularity(data + [[1.0, 0.0, 0.0], [0.0, 5.0, 0.0]], data), [1 / 9, 1.0])
    near(organisation.minimum_deviation(data, data + 1.0, data), [3 / 9, 3 / 25])


@test
def self_organisation_takes_the_trend_that_goes_on():
    noise = 1e-3 * np.random.default_rng(9).standard_normal((2, 40))
    data = np.stack([5.0 - 0.2 * PAST, np.sin(2 * np.pi * PAST / 60.0)]) + noise
    predicted, chosen = organisation.self_organised(data, 20)
    assert [list(trends.TRENDS)[number] for number in chosen] == ["linear", "harmonic"], chosen
    near(predicted[0], trends.linear(PAST, data[0], AHEAD), 1e-12)
    near(predicted[1], trends.harmonic(PAST, data[1], AHEAD), 1e-12)
    # (24) between the even and the odd samples, (25) of the second half: by hand for the line
    halves = [trends.linear(PAST[part::2], data[:1, part::2], PAST) for part in (0, 1)]
    later = trends.linear(PAST[:20], data[:1, :20], PAST[20:])
    by_hand = np.sum((halves[0] - halves[1]) ** 2) / np.sum(data[0] ** 2) + np.sum((later - data[0, 20:]) ** 2) / np.sum(data[0, 20:] ** 2)
    near(organisation.score(trends.linear, data[:1]), [by_hand], 1e-9)


# --- intervals and the command line -----------------------------------------------------------------------------------


@test
def intervals_are_those_of_the_tables():
    # the 40th and the 61st of 100 hold the median with 95 % (tables of the sign test); of five none do
    found = intervals.quantile(np.arange(1.0, 101.0))
    assert tuple(found) == (50.5, 40.0, 61.0), found
    assert intervals.quantile(np.arange(5.0)) == (2.0, None, None) and intervals.quantile(np.arange(6.0)).low == 0.0
    # of a mean: 1.96 sd / sqrt(n)
    values = np.random.default_rng(12).standard_normal((400, 1))[:, 0]
    found = intervals.mean(values, 1)
    near((found.high - found.low) / (2 * 1.96 * np.std(values) / 20.0), 1.0, 0.1)
    assert intervals.mean(values, 1) == found != intervals.mean(values, 2)
    assert intervals.ratio(np.ones(9), np.full(9, 4.0), 1) == (0.25, 0.25, 0.25)
    assert intervals.pooled_median(np.tile(np.arange(5.0), (7, 1)), 1) == (2.0, 2.0, 2.0)


@test
def a_seed_gives_the_same_numbers_again():
    first, again, other = (list(experiments.EXPERIMENTS["next_window_stuck_at_zero"][1](200, seed)) for seed in (3, 3, 4))
    assert first == again != other
    refused(ValueError, lambda: scenario.fly(1, 1, "half"), "zero or last, not 'half'")


@test
def the_program_prints_rows_and_refuses_a_number_of_runs_that_is_none():
    for words, status, count in ((["observability"], 0, 4), (["--list"], 0, 8), (["observability", "--runs", "0"], 2, 0), (["nothing"], 2, 0)):
        done = subprocess.run([sys.executable, "campaigns/variable_structure", *words], capture_output=True, text=True, check=False)
        assert (done.returncode, len(done.stdout.splitlines())) == (status, count), done
    done = subprocess.run([sys.executable, "campaigns/variable_structure", "observability"], capture_output=True, text=True, check=False)
    assert "row\tobservability\tchannel\tdouble\tsum_a2_1\t1\t\t\t1\n" in done.stdout, done


@test
def a_package_that_is_missing_is_named_with_what_installs_it():
    for folder, packages in (("campaigns/variable_structure", "papers"), ("tools/design", "design")):
        done = subprocess.run([sys.executable, "-B", "-S", folder, "--help"], capture_output=True, text=True, check=False)
        assert done.returncode == 1 and not done.stdout, done
        installs = f"sh tools/deps.sh {packages}, then build/venv/bin/python {folder}\n"
        assert done.stderr.startswith(f"{pathlib.PurePath(folder).name}: ") and done.stderr.endswith(installs), done


if __name__ == "__main__":
    raise SystemExit(run_all())
