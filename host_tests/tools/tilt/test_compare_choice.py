#!/usr/bin/env python3
"""What `tilt compare` recommends and what it says of it: the choice without truth against the one with it, filters that are published only,
intervals, and the price. Run from the repository root with build/venv/bin/python."""
import dataclasses
import json
import pathlib
import re
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST  # noqa: E402
from tilt_case import run_tilt  # noqa: E402
from tilt import fitting, judge, native, smoother, stream  # noqa: E402
from tilt.commands import compare  # noqa: E402

STREAMS = pathlib.Path("sim/streams")
SMOOTH = ("tilt-slow", "tilt-fast", "outliers-15pct", "rest-2lsb", "rest-8lsb", "bad-reads", "through-pitch-90", "through-roll-180", "vibration",
          "gaps-jitter", "clipping")
JUMPS = ("steps", "steps-outliers")  # a low pass rounds them


def run(*words):
    return run_tilt("compare", *words)


def both(stem):
    """Answers with and without truth, of all filters."""
    given = stream.read(STREAMS / f"{stem}.csv")
    rate_dhz = native.rate_of(given)
    tables = native.replay(given, native.filters(), rate_dhz)
    blind = dataclasses.replace(given, roll_true_cdeg=None, pitch_true_cdeg=None)
    return compare.judgement(given, tables, rate_dhz), compare.judgement(blind, tables, rate_dhz)


class Choice(unittest.TestCase):
    def test_without_truth_it_is_nearly_the_best_by_the_truth(self):
        for stem in SMOOTH + JUMPS:
            with self.subTest(stem):
                known, blind = both(stem)
                errors = {row["filter"]: row["tilt_rms_deg"] for row in known["filters"] if not row["published_only"]}
                self.assertEqual(errors[known["best"]], min(errors.values()))
                self.assertLessEqual(errors[blind["best"]], (1.1 if stem in SMOOTH else 1.2) * errors[known["best"]], blind["best"])

    def test_published_filters_are_those_that_the_page_gives_to_compare(self):
        row = re.search(r"^\| the papers' filters, to compare \|(.*)\|$", pathlib.Path("docs/choosing-a-filter.md").read_text(encoding="utf-8"), re.M)
        with mock.patch.object(native, "ROOT", pathlib.Path("no/checkout")):  # the library knows them, no source is read
            self.assertEqual(native.published_only(), set(re.findall(r"`(\w+)`", row[1])))

    def test_a_published_filter_is_shown_and_never_recommended(self):
        published = ",".join(sorted(native.published_only()))
        out = run(STREAMS / "outliers-15pct.csv", "--filter", f"{published},{PLAIN}")[1]
        self.assertIn(f"Best: {PLAIN},", out)
        self.assertEqual(len(re.findall(r" published$", out, re.M)), len(native.published_only()))
        self.assertIn("to compare with its paper: add another filter", run(STREAMS / "steps.csv", "--filter", published)[1])


class Smoother(unittest.TestCase):
    def test_outliers_and_missing_readings_leave_no_trace(self):
        rng, t_s = np.random.default_rng(1), np.arange(3000) / 100
        truth = np.column_stack([100 * np.sin(2 * np.pi * 0.3 * t_s), 80 * np.cos(2 * np.pi * 0.2 * t_s), 200 + 0 * t_s])
        lsb, there = np.round(truth + rng.normal(0, 2, truth.shape)), np.ones(truth.shape, bool)
        lsb[rng.random(truth.shape) < 0.1] += 300
        there[500:505], lsb[500:505] = False, -4096
        # white noise of 2 LSB through 1.25 Hz both ways: 2 sqrt(1.25 x 2 / 100), some of the motion, and more for the share left out
        self.assertLess(np.sqrt(np.mean((smoother.smoothed(lsb, there, 100.0) - truth)[100:-100] ** 2)), 0.5)

    def test_an_axis_without_a_reading_is_left_out_and_the_others_are_judged_as_without_it(self):
        lsb = np.round(np.random.default_rng(4).normal([0, 30, 256], 2, (3000, 3)))
        lsb[:, 1] += np.round(100 * np.sin(np.arange(3000) / 50))
        there = np.ones(lsb.shape, bool)
        whole = smoother.smoothed(lsb, there, 100.0, smoother.CUTS_HZ[:1])
        there[:, 0], lsb[:, 0] = False, 4095
        np.testing.assert_array_equal(smoother.smoothed(lsb, there, 100.0, smoother.CUTS_HZ[:1])[:, 1:], whole[:, 1:])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "clipped.csv"
            stream.write(path, np.arange(3000) * 10000, lsb)
            status, out, err = run(path, "--filter", f"{DEFAULT},{PLAIN}", "--json")
            self.assertEqual((status, err), (0, ""))
            self.assertTrue(all(0.2 < row["error_lsb"] < 20.0 for row in json.loads(out)["filters"]), out)
            self.assertGreater(fitting.samples_of(stream.read(path), 1000).motion_s, fitting.MOTION_MIN_S)

    def test_no_row_near_a_gap_is_judged(self):
        t_us = np.concatenate([np.arange(300), np.arange(400, 700)]) * 10000
        self.assertEqual(np.flatnonzero(~smoother.fair(t_us, 100.0)).tolist(), [*range(100), *range(279, 321)])
        self.assertTrue(smoother.fair(t_us[:50], 100.0).all())


class Words(unittest.TestCase):
    def test_nothing_is_called_worse_where_only_a_published_filter_differs_and_is_better(self):
        row = {"tilt_rms_deg": 1.0, "lag_ms": None, "wander_deg": None, "cycles": 900, "gated_percent": 0.0}
        rows = [row | {"filter": "paper", "worse_percent": -20.0, "published_only": True, "told_from_best": True},
                row | {"filter": PLAIN, "worse_percent": 0.0, "published_only": False, "told_from_best": False}]
        answer = {"filters": rows, "best": PLAIN, "enough": True, "same_as_best": [], "outliers_percent": 0.0, "still_share": 0.0}
        self.assertNotIn("worse", " ".join(compare.why(answer)))
        rows[0]["worse_percent"] = 20.0
        self.assertIn("Certainly worse: paper +20.0 %.", compare.why(answer))

    def test_nothing_lags_by_minus_zero_or_is_worse_by_thousands_of_percent(self):
        for stem in ("tilt-fast", "outliers-15pct"):
            out = run(STREAMS / f"{stem}.csv")[1]
            self.assertNotRegex(out, r"(?<![\d.])-0(?![\d.])|\d{3,}[.\d]* %")
            self.assertRegex(out, r"[\d.]+ times")

    def test_the_price_and_the_image(self):
        out = run(STREAMS / "tilt-fast.csv", "--filter", f"{DEFAULT},{PLAIN}")[1]
        self.assertRegex(out, fr"{DEFAULT} costs a lag of -?\d+ ms, [\d.]+ degrees rms at rest, and at most {native.cycles(DEFAULT)} cycles")
        self.assertEqual(out.splitlines()[-1], f"flash: {native.flashed_by(DEFAULT)}")

    def test_the_interval_holds_the_difference(self):
        rng = np.random.default_rng(2)
        held = sum(low <= 0.1 <= high for low, high in (judge.difference(0.1 + rng.normal(0, 1, 4000), np.zeros(4000), 100.0).interval
                                                       for _ in range(400)))
        self.assertGreaterEqual(held, 362)  # of 400: 380 expected, four deviations of 4.4 less
        shown = re.search(r"\+([\d.]+) % +\((\d+)\.\.(\d+)\)", run(STREAMS / "outliers-15pct.csv", "--filter", f"{DEFAULT},{ROBUST}")[1])
        self.assertTrue(int(shown[2]) <= float(shown[1]) <= int(shown[3]))


if __name__ == "__main__":
    from unity_line import main
    main()
