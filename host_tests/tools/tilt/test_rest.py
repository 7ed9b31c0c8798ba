#!/usr/bin/env python3
"""Tests of how rest is found in a recording (tilt.rest). Run from the repository root with build/venv/bin/python."""
import math
import pathlib
import sys
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt import rest  # noqa: E402

SIGMAS = 3.3                 # of an interval: one in a thousand lies outside
ROUNDING = 1.0 / 12.0        # variance that whole numbers add


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


if __name__ == "__main__":
    from unity_line import main
    main()
