#!/usr/bin/env python3
"""Tests of `tilt tune`: recordings made here by the filters' own model with known R and q, whose estimates must lie within intervals that the
theory of the likelihood gives (Whittle), and recordings that the model does not fit, for which it may claim nothing."""
import json
import math
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST  # noqa: E402
from tilt_case import InFolder, run_tilt  # noqa: E402
from tilt import model, native, rest, stream  # noqa: E402
from tilt.commands import tune  # noqa: E402

T_S, REST_S, PART_S, PARTS = 0.01, 20, 8, 8
REST_SAMPLES, PART_SAMPLES = REST_S * 100, PART_S * 100
SIGMAS = 3.3                 # of an interval: one in a thousand lies outside
ROUNDING = 1.0 / 12.0        # variance that whole numbers add


def motion(rng, q, samples=PART_SAMPLES):
    """x += v, v += w with the variance q T^3, as kalman.h has it."""
    rate = np.concatenate(([0.0], np.cumsum(rng.normal(0, math.sqrt(q * T_S ** 3), samples - 1))))
    return np.concatenate(([0.0], np.cumsum(rate[:-1])))


def made(rng, q, sigma, outliers=0.0):
    """(readings, segments): 20 s at rest, then parts of 8 s in motion, each from where it likes."""
    truth = [np.tile([20.0, -30.0, 240.0], (REST_SAMPLES, 1))]
    truth += [np.stack([start + motion(rng, q) for start in (10.0, -40.0, 200.0)], axis=1) for _ in range(PARTS)]
    truth = np.concatenate(truth)
    noise = rng.normal(0, sigma, truth.shape) * np.where(rng.random(truth.shape) < outliers, 20.0, 1.0)
    edges = np.concatenate(([0], REST_SAMPLES + PART_SAMPLES * np.arange(PARTS + 1)))
    return np.clip(np.round(truth + noise), -4095, 4094).astype(int), [slice(a, b) for a, b in zip(edges, edges[1:])]


def sigma_of_log_q(q, r, samples):
    """(standard deviation of log q by three axes, by how much it moves with log R): Whittle. The second difference of the readings has the
    spectrum f = q T^3 + R |1 - e^iw|^4, and Fisher's information is samples / (4 pi) of the integral of (d log f)^2 over -pi..pi."""
    w = np.linspace(-np.pi, np.pi, 400_001)
    of_noise = r * 16.0 * np.sin(w / 2) ** 4
    share = q * T_S ** 3 / (q * T_S ** 3 + of_noise)
    step = w[1] - w[0]
    by_q = samples / (4 * np.pi) * np.sum(share ** 2) * step
    by_both = samples / (4 * np.pi) * np.sum(share * (1 - share)) * step
    return 1.0 / math.sqrt(3.0 * by_q), by_both / by_q


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "made.csv"

    def write(self, lsb, segments=None):
        begins = np.arange(len(lsb)) * 10000
        stream.write(self.path, begins, lsb, segments=segments)

    def tune(self, *words):
        return run_tilt("tune", self.path, *words)

    def answer(self, *words):
        status, out, _ = self.tune("--json", *words)
        return status, json.loads(out)


class Recovers(Case):
    def test_r_and_q_that_were_put_in(self):
        """q from a twentieth of the default to ten times it; 8 recordings. Var R / R^2 is 2 over the samples at rest for each axis."""
        for seed, (q, sigma) in enumerate([(400, 2.0), (400, 2.0), (400, 4.0), (1000, 2.0), (1000, 1.0), (500, 0.8), (2000, 3.0), (100, 1.5)]):
            self.write(*made(np.random.default_rng(seed), q, sigma))
            status, answer = self.answer()
            r = sigma ** 2 + ROUNDING
            for found in answer["r_lsb2"]:
                self.assertLess(abs(found / r - 1.0), SIGMAS * math.sqrt(2.0 / REST_SAMPLES), f"R, seed {seed}")
            spread, by_r = sigma_of_log_q(q, r, PART_SAMPLES * PARTS)
            known_to = math.hypot(spread, by_r * math.sqrt(2.0 / REST_SAMPLES / 3.0))
            self.assertLess(abs(math.log(answer["q"] / q)), SIGMAS * known_to, f"q, seed {seed}: {answer['q']}")
            half = 0.5 * math.log(answer["q_high"] / answer["q_low"])
            self.assertAlmostEqual(half / (1.96 * spread), 1.0, delta=0.12, msg=f"interval, seed {seed}")
            self.assertEqual((status, answer["troubles"]), (0, []), f"seed {seed}")

    def test_with_outliers(self):
        """5 % are 20 times as far: 4 sigmas let 16 % of these in, 0.8 % of all, of at most 16 in the sum: 1.3 sigmas of an eighth. R is 4 %
        larger at most: 3.5 sigmas let 14 % in, whose squares are 4 on average."""
        q, sigma = 400, 2.0
        self.write(*made(np.random.default_rng(20), q, sigma, 0.05))
        status, answer = self.answer()
        r = sigma ** 2 + ROUNDING
        for found in answer["r_lsb2"]:
            self.assertTrue(-SIGMAS * math.sqrt(2.0 / REST_SAMPLES) < found / r - 1.0 < 0.04 + SIGMAS * math.sqrt(2.0 / REST_SAMPLES), found)
        spread, _ = sigma_of_log_q(q, r, PART_SAMPLES * PARTS)
        self.assertLess(abs(math.log(answer["q"] / q)), SIGMAS * spread * 1.5)
        self.assertTrue(3.0 < answer["outliers_percent"] < 5.0)  # 84 % of them are beyond 4 sigmas
        self.assertLessEqual(answer["gate"], 5.0)
        self.assertEqual(status, 0)

    def test_the_boards_own_r_is_made_up_for(self):
        """Its R is 1.5 times the variance (noise.h), the gain depends on q / R: so is the q of the command. Its estimate is of 128 terms: 15 %."""
        self.write(*made(np.random.default_rng(21), 1000, 2.0))
        _, answer = self.answer("--filter", PLAIN)
        self.assertAlmostEqual(answer["board_q"] / answer["q"], 1.5, delta=0.25)
        name, q = answer["commands"]
        self.assertEqual((name, q), (f"filter {PLAIN}", f"q {answer['board_q']:.0f}"))

    def test_the_commands_predict_better_than_what_ships(self):
        """q = 100 where 10000 ships: at 100 Hz and R = 4 the variance of the prediction falls, by the Riccati equation, from 1.19 to 1.06 R."""
        self.write(*made(np.random.default_rng(22), 100, 2.0))
        status, answer = self.answer()
        self.assertEqual((status, answer["better_told"]), (0, True))
        self.assertGreater(answer["better_percent"], 3.0)
        self.assertEqual([line.split()[0] for line in answer["commands"]], ["filter", "q", "gate"])
        said = self.tune()[1]
        self.assertTrue(said.endswith("\n\n" + "\n".join(answer["commands"]) + "\n"), said)

    def test_without_rest_r_is_what_the_innovations_leave(self):
        lsb, segments = made(np.random.default_rng(23), 400, 2.0)
        self.write(lsb[REST_SAMPLES:], [slice(part.start - REST_SAMPLES, part.stop - REST_SAMPLES) for part in segments[1:]])
        status, answer = self.answer()
        self.assertEqual((status, answer["rest_stretches"]), (0, 0))
        for found in answer["r_lsb2"]:  # 6,400 samples; R_SETTLED beside it
            self.assertLess(abs(found / (4.0 + ROUNDING) - 1.0), SIGMAS * math.sqrt(2.0 / 6400) + model.R_SETTLED)
        self.assertIn("no stretch at rest found", self.tune()[1])


class ClaimsNothing(Case):
    def refused(self, *words):
        status, out, _ = self.tune()
        self.assertEqual(status, 1, out)
        self.assertNotIn("the model fits", out)
        for word in words:
            self.assertIn(word, out)

    def test_coloured_noise_in_motion(self):
        rng = np.random.default_rng(30)
        lsb, segments = made(rng, 400, 0.0)
        white = rng.normal(0, 2.0, lsb.shape)
        for i in range(1, len(lsb)):
            white[i] += 0.9 * white[i - 1]
        still = np.arange(len(lsb))[:, None] < REST_SAMPLES
        self.write(lsb + np.round(np.where(still, rng.normal(0, 2.0, lsb.shape), white)).astype(int), segments)
        self.refused("the model does not fit")

    def test_more_noise_in_motion_than_at_rest(self):
        """Twice the sigma: a q that makes up for it predicts as badly, and neighbours show it, or the squares do."""
        lsb, segments = made(np.random.default_rng(31), 400, 2.0)
        lsb[REST_SAMPLES:] += np.round(np.random.default_rng(32).normal(0, 4.0, (len(lsb) - REST_SAMPLES, 3))).astype(int)
        self.write(lsb, segments)
        self.refused("the model does not fit")

    def test_jumps(self):
        """Every 0.8 s to another place, 100 LSB apart."""
        rng = np.random.default_rng(33)
        lsb = np.round(rng.normal(0, 2.0, (6000, 3))).astype(int)
        lsb[1000:] += 100 * ((np.arange(5000) // 80) % 2)[:, None]
        self.write(lsb)
        self.refused("the model does not fit")

    def test_shaking(self):
        self.path = pathlib.Path("sim/streams/vibration.csv")
        self.refused("the model does not fit")

    def test_no_motion(self):
        rng = np.random.default_rng(34)
        self.write(np.round(rng.normal([10, 20, 250], 2.0, (3000, 3))).astype(int))
        self.refused("too little motion to estimate q", "no commands: keep the filter's defaults")
        self.assertNotIn(f"filter {ROBUST}", self.tune()[1])

    def test_the_shipped_values_stay_where_they_predict_better(self):
        """tilt-fast moves for a third of the time: its q costs more at rest than it gains."""
        self.path = pathlib.Path("sim/streams/tilt-fast.csv")
        status, answer = self.answer()
        self.assertEqual((status, answer["commands"], answer["better_told"]), (0, [f"filter {ROBUST}"], True))
        self.assertLess(answer["better_percent"], 0.0)
        self.assertIn(f"worse than with the defaults of {ROBUST}: keep them", self.tune()[1])


class Rest(unittest.TestCase):
    def found(self, lsb, there=None):
        return rest.find(np.round(lsb).astype(np.int16), np.ones(len(lsb), bool) if there is None else there, 100.0)

    def test_variances_of_any_noise(self):
        """99 of 100 degrees a second; the level between two codes or on one. Below 0.5 LSB whole numbers are no longer noise."""
        for seed, sigma in enumerate((0.7, 1.0, 2.0, 8.0, 25.0)):
            lsb = np.random.default_rng(seed).normal([0.0, 30.5, 250.3], sigma, (6000, 3))
            found = self.found(lsb)
            self.assertGreater(found.seconds, 50.0, sigma)
            for r in found.r_lsb2:
                self.assertLess(abs(r / (sigma ** 2 + ROUNDING) - 1.0), SIGMAS * math.sqrt(2.0 / found.degrees) + 0.005, sigma)

    def test_stretches_begin_and_end_with_the_motion(self):
        rng = np.random.default_rng(10)
        level = np.zeros(3000)
        level[1000:2000] = 100 * np.sin(np.arange(1000) * 0.02)
        level[2000:] = level[1999]
        lsb = rng.normal(0, 2.0, (3000, 3)) + level[:, None]
        found = self.found(lsb)
        self.assertEqual([(part.start, part.stop) for part in found.stretches], [(0, 1000), (2000, 3000)])

    def test_slow_motion_is_none(self):
        """6 LSB a second widen the scatter of 2 LSB to sqrt(4 + 36 / 12) = 2.6, which passes; but medians of 100 samples of it may differ by
        4 * 2 * 1.25 * sqrt(2 / 100) + 0.5 = 1.9."""
        lsb = np.random.default_rng(11).normal(0, 2.0, (3000, 3)) + 0.06 * np.arange(3000)[:, None]
        self.assertEqual(self.found(lsb).stretches, [])

    def test_shaking_about_one_level_is_none(self):
        """2 Hz, 20 LSB: a scatter of 14, of which differences over two samples see 14 * 0.25^2 / sqrt(6) = 0.4 beside the noise of 2."""
        shaken = 20 * np.sin(2 * np.pi * 2 * 0.01 * np.arange(3000))
        lsb = np.random.default_rng(14).normal(0, 2.0, (3000, 3)) + shaken[:, None]
        self.assertEqual(self.found(lsb).stretches, [])

    def test_a_missing_sample_ends_a_stretch(self):
        lsb, there = np.random.default_rng(12).normal(0, 2.0, (1000, 3)), np.ones(1000, bool)
        there[450] = False
        self.assertEqual([(part.start, part.stop) for part in self.found(lsb, there).stretches], [(0, 400), (500, 1000)])

    def test_outliers_are_cut_off(self):
        """Those that stay: 2 Phi(3.5 / 20) - 1 = 14 % of 10 %, 1.4 % with squares of 4.1 on average: 4.4 %, more as they widen the cut."""
        rng = np.random.default_rng(13)
        lsb = rng.normal(0, 2.0, (6000, 3)) * np.where(rng.random((6000, 3)) < 0.1, 20.0, 1.0)
        for r in self.found(lsb).r_lsb2:
            self.assertTrue(0.94 < r / (4.0 + ROUNDING) < 1.12, r)


class Command(Case):
    def test_what_cannot_be_is_told(self):
        self.write(*made(np.random.default_rng(40), 400, 2.0))
        for words, said in ((["--filter", DEFAULT], f"--filter: {DEFAULT} has no q in LSB2/s3; choose from {PLAIN} {ROBUST}"),
                            (["--filter", "kx"], "no filter 'kx': choose from"),
                            (["--filter", f"{PLAIN},{ROBUST}"], f"--filter {PLAIN},{ROBUST}: give one filter")):
            status, out, err = self.tune(*words)
            self.assertEqual((status, out), (2, ""))
            self.assertIn(said, err)
        stream.write(self.path, [0], np.zeros((1, 3)))
        self.assertIn("so the rate is unknown", self.tune()[2])

    def test_gaps_are_on_the_grid(self):
        keep = np.delete(np.arange(1000), [*range(100, 103), *range(500, 900)])
        stream.write(self.path, keep * 10000, np.tile([0, 0, 256], (len(keep), 1)) + keep[:, None] % 2)
        samples = model.gridded(stream.read(self.path), 1000)
        missing = np.flatnonzero(samples.state[:, 0] == native.MISSING)
        self.assertEqual(missing.tolist(), [100, 101, 102, *range(500, 529)])  # 400 missing are as 29: the filter begins anew
        self.assertEqual(len(samples.lsb), 1000 - 400 + 29)

    def test_values_are_typed_as_the_board_takes_them(self):
        every = tune.tunable(ROBUST, 1000)
        self.assertEqual((every["q"].text(1234.56), every["gate"].text(2.5), every["gate"].text(99.0)), ("1235", "2.5", "16"))


if __name__ == "__main__":
    from unity_line import main
    main()
