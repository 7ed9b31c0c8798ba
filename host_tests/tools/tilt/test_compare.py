#!/usr/bin/env python3
"""Tests of `tilt compare`: its errors against ones computed here, lags that were put in, choices whose reason is known, and what it says when
filters cannot be told apart."""
import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import scipy.linalg

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import laws  # noqa: E402
from laws import DEFAULT, LIGHT, PLAIN, ROBUST  # noqa: E402
from tilt_case import run_tilt  # noqa: E402
from tilt import angles, judge, native, stream  # noqa: E402
from tilt.commands import compare  # noqa: E402

STREAMS = pathlib.Path("sim/streams")


def run(*words):
    return run_tilt("compare", *words)


def answer_of(stem, names=f"{DEFAULT},{PLAIN},{ROBUST},{LIGHT}", truth=True):
    given = stream.read(STREAMS / f"{stem}.csv")
    if not truth:
        given.roll_true_cdeg = given.pitch_true_cdeg = None
    rate_dhz = native.rate_of(given)
    return compare.judgement(given, native.replay(given, native.chosen(names), rate_dhz), rate_dhz)


def by_name(answer):
    return {row["filter"]: row for row in answer["filters"]}


class Angles(unittest.TestCase):
    def test_directions_are_what_readings_of_that_attitude_point_to(self):
        rng = np.random.default_rng(1)
        vectors = rng.normal(size=(500, 3))
        vectors /= np.linalg.norm(vectors, axis=1)[:, None]
        np.testing.assert_allclose(angles.direction(*angles.of_readings(*vectors.T)), vectors, atol=1e-12)

    def test_angles_between_small_and_opposite_ones(self):
        for turned in (1e-6, 0.5, 90.0, 179.9, 180.0):
            a, b = angles.direction(np.array([10.0]), np.array([0.0])), angles.direction(np.array([10.0 + turned]), np.array([0.0]))
            self.assertAlmostEqual(angles.angle_deg(a, b)[0], turned, delta=1e-5 if turned > 170 else 1e-9)

    def test_wrapped(self):
        self.assertEqual(angles.wrapped_deg(np.array([350.0, -350.0, 10.0])).tolist(), [-10.0, 10.0, 10.0])


class Truth(unittest.TestCase):
    def test_errors_are_those_computed_here(self):
        given = stream.read(STREAMS / "outliers-15pct.csv")
        rows = native.replay(given, [PLAIN], 1000)[PLAIN]
        found = by_name(answer_of("outliers-15pct", PLAIN))[PLAIN]
        late = rows["flags"] & judge.WARMING == 0
        for angle, key in (("roll", "roll_rms_deg"), ("pitch", "pitch_rms_deg")):
            true = getattr(given, f"{angle}_true_cdeg").astype(float)
            total = [((own - right + 18000) % 36000 - 18000) ** 2 for own, right, use in zip(rows[f"{angle}_cdeg"], true, late) if use]
            self.assertAlmostEqual(found[key], 0.01 * math.sqrt(sum(total) / len(total)), delta=1e-9)
        self.assertAlmostEqual(found["roll_rms_deg"], 2.31, delta=0.005)  # README.md, by tools/plot_run.py from the simulator

    def test_across_180_degrees(self):
        found = by_name(answer_of("through-roll-180"))
        self.assertLess(found[DEFAULT]["worst_deg"], 5.0)

    def test_a_delay_is_its_lag(self):
        """Rows that show the truth of 30 ms earlier, and 0.5 degrees of noise."""
        t_us = np.arange(6000) * 10000
        roll = np.stack([30 * np.sin(2 * np.pi * 0.2 * (t_us * 1e-6 - late)) for late in (0.0, 0.03)])
        pitch = np.stack([20 * np.cos(2 * np.pi * 0.3 * (t_us * 1e-6 - late)) for late in (0.0, 0.03)])
        noise = np.random.default_rng(2).normal(0, 0.5, (2, 6000))
        # sum v^2 is 6000 (26.7^2 + 26.7^2) with v = 37.7 / sqrt 2 each; the error of the lag 0.5 / sqrt(8.5e6) s = 0.17 ms
        lag = judge.lag_ms(t_us, [roll[1] - roll[0] + noise[0], pitch[1] - pitch[0] + noise[1]], [roll[0], pitch[0]])
        self.assertAlmostEqual(lag, 30.0, delta=3.3 * 0.17 + 0.02)
        self.assertIsNone(judge.lag_ms(t_us, noise, np.zeros((2, 6000))))                                      # at rest
        self.assertIsNone(judge.lag_ms(t_us, noise * 400, [roll[0], pitch[0]]))                                # errors of 200 degrees

    def test_a_gate_is_worth_it_where_there_are_outliers_and_the_words_say_so(self):
        answer = answer_of("outliers-15pct")
        found = by_name(answer)
        self.assertLess(found[ROBUST]["tilt_rms_deg"], 0.25 * found[PLAIN]["tilt_rms_deg"])
        self.assertTrue(found[PLAIN]["told_from_best"])
        self.assertEqual([row["tilt_rms_deg"] for row in answer["filters"]], sorted(row["tilt_rms_deg"] for row in answer["filters"]))
        # 15 % are 20 times as far: beyond 4 sigmas lie 2 Phi(-0.2) = 84 % of them where sigma is known; the filter's own is up to 1.6 times that
        self.assertTrue(9.0 < answer["outliers_percent"] < 13.0, answer["outliers_percent"])
        self.assertIn("of the readings lie more than 4 sigmas", " ".join(answer["why"]))
        self.assertIn("Certainly worse:", " ".join(answer["why"]))

    def test_without_outliers_nobody_speaks_of_them(self):
        answer = answer_of("rest-2lsb")
        self.assertLess(answer["outliers_percent"], 0.05)
        self.assertIn("hardly any outliers", " ".join(answer["why"]))
        self.assertIn("At rest for 100 % of the time", " ".join(answer["why"]))


class Difference(unittest.TestCase):
    def test_noise_is_not_told_and_what_is_more_is(self):
        """White losses of spread s over n samples: the standard error is s / sqrt(n). 0 of it is told in 0.4 % of the cases (t, 14 degrees;
        with more batches in fewer), seven of it always."""
        rng = np.random.default_rng(3)
        told = {0.0: 0, 7.0: 0}
        for shift in told:
            for _ in range(300):
                loss = rng.normal(0, 2.0, 4000)
                told[shift] += judge.difference(loss + shift * 2.0 / math.sqrt(4000), np.zeros(4000), 100.0).significant
        self.assertLessEqual(told[0.0], 6)
        self.assertGreaterEqual(told[7.0], 290)

    def test_correlated_over_a_quarter_of_a_second_it_is_no_more_told(self):
        rng = np.random.default_rng(4)
        kernel = np.ones(25) / 5.0
        told = sum(judge.difference(np.convolve(rng.normal(0, 1, 6024), kernel, "valid"), np.zeros(6000), 100.0).significant for _ in range(200))
        self.assertLessEqual(told, 6)

    def test_a_stretch_that_suits_one_is_no_noise(self):
        loss = np.where(np.arange(6000) < 2000, 1.0, 0.0) + np.random.default_rng(5).normal(0, 0.1, 6000)
        self.assertTrue(judge.difference(loss, np.zeros(6000), 100.0).significant)

    def test_few_samples_and_equal_ones(self):
        self.assertFalse(judge.difference(np.ones(199), np.zeros(199), 100.0).significant)
        self.assertFalse(judge.difference(np.ones(500), np.ones(500), 100.0).significant)
        self.assertTrue(judge.difference(np.ones(500), np.zeros(500), 100.0).significant)


class Innovations(unittest.TestCase):
    def test_variance_is_that_of_the_riccati_equation(self):
        """The plain Kalman filter at 100 Hz, R = 4, q = 10000: x += v, v += w with the variance q T^3 = 0.01."""
        rng = np.random.default_rng(6)
        z = np.round(rng.normal(100, 2, 3000)).astype(np.int16)
        probes = native.axis(PLAIN, 1000, z, np.full(3000, native.THERE), r_lsb2=4.0)
        phi, drive = np.array([[1.0, 1.0], [0.0, 1.0]]), np.diag([0.0, 0.01])
        predicted = scipy.linalg.solve_discrete_are(phi.T, np.array([[1.0], [0.0]]), drive, np.array([[4.0]]))
        self.assertAlmostEqual(judge.variance_of(probes)[-1], predicted[0, 0] + 4.0, delta=0.01)
        self.assertEqual(np.count_nonzero(probes["judged"]), 2995)  # five begin the filter

    def test_a_refused_sample_has_the_variance_of_the_one_before(self):
        z = np.full(300, 100, np.int16)
        z[200] = 900
        probes = native.axis(ROBUST, 1000, z, np.full(300, native.THERE), r_lsb2=4.0)
        self.assertEqual(probes["gain_uq16"][200], 0)
        self.assertAlmostEqual(judge.variance_of(probes)[200], judge.variance_of(probes)[199], delta=1e-9)
        self.assertAlmostEqual(judge.innovations(probes)[200], 800.0, delta=1.0)

    def test_missing_and_clipped_samples_are_not_judged(self):
        state = np.full(300, native.THERE)
        state[100:104], state[150] = native.MISSING, native.AT_RAIL
        state[200:230] = native.MISSING  # 300 ms: it starts anew, with five samples
        probes = native.axis(ROBUST, 1000, np.full(300, 7, np.int16), state, r_lsb2=4.0)
        self.assertEqual(np.flatnonzero(probes["judged"] == 0).tolist(), [0, 1, 2, 3, 4, 100, 101, 102, 103, 150, *range(200, 235)])


class Blind(unittest.TestCase):
    def test_a_healthy_sensor_at_rest_has_two_thirds(self):
        """NIS: the board's R is 1.5 times the variance, and nearly all of S. 6,000 samples of the median: 3 %; of R: 5 %."""
        found = by_name(answer_of("rest-4lsb", f"{PLAIN},{ROBUST}", truth=False))
        for row in found.values():
            self.assertAlmostEqual(row["nis"], 1 / 1.5, delta=0.08)


class Command(unittest.TestCase):
    def test_the_table_and_the_words(self):
        status, out, _ = run(STREAMS / "outliers-15pct.csv", "--filter", f"{PLAIN},{ROBUST}")
        self.assertEqual(status, 0)
        lines = out.splitlines()
        self.assertRegex(lines[0], r"outliers-15pct.csv: 5995 rows judged by angle from the truth \(degrees\)")  # five rows are warming up
        self.assertRegex(lines[2], fr"^{ROBUST} .* best$")
        self.assertRegex(lines[3], fr"^{PLAIN} .* [0-9.]+ times$")
        self.assertIn(f"Best: {ROBUST}", lines[5])

    def test_equals_are_called_so(self):
        # whose gate takes a part of what is beyond it, or which learn what is normal: no outliers, so they do nothing else
        others = set(laws.kalman()) - {ROBUST} - native.published_only()
        names = [PLAIN, *(name for name in others if "GATED" in laws.laws()[name].traits)]
        answer = answer_of("tilt-fast", ",".join(names))  # no outliers: their gates do nothing
        self.assertEqual(len(answer["same_as_best"]), len(names) - 1)
        self.assertIn("keep the one you know", " ".join(answer["why"]))

    def test_json(self):
        status, out, _ = run(STREAMS / "steps.csv", "--filter", f"{PLAIN},{ROBUST}", "--json")
        answer = json.loads(out)
        self.assertEqual((status, answer["rate_hz"], answer["rows_judged"]), (0, 100.0, 5095))
        self.assertEqual({row["filter"] for row in answer["filters"]}, {PLAIN, ROBUST})
        self.assertEqual(answer["best"], answer["filters"][0]["filter"])

    def test_one_filter_and_a_short_recording(self):
        self.assertIn("nothing to compare with", run(STREAMS / "steps.csv", "--filter", PLAIN)[1])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "short.csv"
            lsb = np.round(np.random.default_rng(8).normal([0, 0, 256], 2, (100, 3)))
            stream.write(path, np.arange(100) * 10000, lsb)
            self.assertIn("are too few to distinguish filters", run(path)[1])
            stream.write(path, np.arange(3) * 10000, lsb[:3])
            status, out, err = run(path)
            self.assertEqual((status, out), (2, ""))
            self.assertIn("short.csv: no row to judge by", err)


if __name__ == "__main__":
    from unity_line import main
    main()
