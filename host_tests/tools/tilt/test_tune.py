#!/usr/bin/env python3
"""Tests of `tilt tune`: recordings made here, whose truth is known; recordings that cannot tell, of which it may claim nothing; what is typed into
a board; and real recordings (RECORDINGS=folder, else ../shared/streams). Run from the repository root with build/venv/bin/python."""
import dataclasses
import json
import math
import os
import pathlib
import subprocess
import sys
import termios
import unittest
from unittest import mock

import numpy as np
from scipy import signal

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from fake_board import BANNER, HEADER, FakeBoard, rows  # noqa: E402
from laws import DEFAULT, LIGHT, PLAIN, ROBUST  # noqa: E402
from test_compare_recordings import NO_RECORDINGS, beginning, recordings  # noqa: E402
from tilt_case import InFolder, port_of, run_tilt  # noqa: E402
from tilt import fitting, native, smoother, stream  # noqa: E402
from tilt.commands import tune  # noqa: E402

SIMRUN, FIRMWARE, IMAGES = "build/sim/simrun", "build/uno/firmware.elf", "no simulator or firmware: make system_images"
T_S, QUICK = 0.01, (200.0, 0.5)  # LSB, Hz
WORST, BETTER, SHARE = 1.02, 0.95, 1.0 / 3.0


def turned(rng, amplitude_lsb, hertz, seconds=60.0, sigma=2.0):
    """(readings, truth) of a smooth motion between rests of 4 s."""
    t_s = np.arange(0.0, seconds, T_S)
    moving = np.clip((t_s - 4.0) * (seconds - 4.0 - t_s), 0.0, 1.0)
    truth = moving[:, None] * amplitude_lsb * np.column_stack([np.sin(2 * np.pi * hertz * t_s), np.cos(2 * np.pi * 0.7 * hertz * t_s),
                                                               np.sin(2 * np.pi * 0.4 * hertz * t_s)]) + [10.0, -20.0, 230.0]
    return np.round(truth + rng.normal(0, sigma, truth.shape)).astype(int), truth


def same(shown, value):
    """Equal, but that the board cuts after the fourth decimal."""
    try:
        return abs(float(shown) - float(value)) < 0.002
    except ValueError:
        return shown == value


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "made.csv"

    def write(self, lsb):
        stream.write(self.path, np.arange(len(lsb)) * 10000, lsb)

    def tune(self, *words):
        return run_tilt("tune", self.path, *words)

    def answer(self, *words):
        status, out, _ = self.tune("--json", *words)
        self.assertEqual(status, 0)
        return json.loads(out)


class Fits(Case):
    def test_the_error_from_the_truth_falls_with_the_values(self):
        """Quick motion asks for a shorter memory than the defaults' (more q), by the truth, which the fit never saw."""
        lsb, truth = turned(np.random.default_rng(1), *QUICK)
        self.write(lsb)
        for name, key in ((PLAIN, "q"), (DEFAULT, "slow")):
            answer = self.answer("--filter", name)
            samples = fitting.samples_of(stream.read(self.path), 1000)

            def error(values, name=name, samples=samples):
                shown = np.stack([axis["x_lsb_q16"] / 65536.0 for axis in fitting.run(samples, name, values)], axis=1)
                return float(np.sqrt(np.mean((shown - truth[:len(shown)])[100:] ** 2)))
            changed = answer["values"][key] / native.parameters(name, 1000)[key].default
            self.assertGreater(changed if key == "q" else 1.0 / changed, 1.5)
            self.assertLess(error(answer["values"]), 0.8 * error({}), name)
            self.assertLess(answer["fitted_lsb"], answer["default_lsb"])
            self.assertLess(answer["held_back"], 1.0)

    def test_with_outliers_and_a_gap_the_error_from_the_truth_falls_too(self):
        """Of each axis 5 % lie 300 LSB off, 3 s are missing. Neither they nor the rows after them are judged."""
        rng = np.random.default_rng(6)
        lsb, truth = turned(rng, *QUICK)
        lsb += 300 * (rng.random(lsb.shape) < 0.05)
        kept = np.r_[0:2500, 2800:len(lsb)]
        stream.write(self.path, kept * 10000, lsb[kept])
        samples = fitting.samples_of(stream.read(self.path), 1000)
        values, there = self.answer("--filter", ROBUST)["values"], np.flatnonzero(samples.state[:, 0] == native.THERE)
        self.assertEqual(len(there), len(kept))
        self.assertFalse(samples.use[there[2500]:there[2520]].any() or samples.use[samples.state[:, 0] == native.MISSING].any())

        def error(values):
            shown = np.stack([axis["x_lsb_q16"] / 65536.0 for axis in fitting.run(samples, ROBUST, values)], axis=1)
            return float(np.sqrt(np.mean((shown[there] - truth[kept])[samples.use[there]] ** 2)))
        self.assertLess(error(values), fitting.WORTH * error({}))

    def test_a_gate_stays_near_its_default(self):
        """No outlier in the recording: nothing speaks for a gate, and it stays closed enough for those to come."""
        lsb, _ = turned(np.random.default_rng(2), 200.0, 1.0)
        self.write(lsb)
        gate = native.parameters(ROBUST, 1000)["gate"].default
        self.assertLessEqual(self.answer("--filter", ROBUST)["values"].get("gate", gate), 1.5 * gate)

    def test_rest_says_nothing_about_motion(self):
        self.write(np.round(np.random.default_rng(3).normal([0, 0, 256], 2.0, (3000, 3))))
        status, out, _ = self.tune()
        self.assertEqual(status, 0)
        self.assertRegex(out, fr"noise [12]\.\d+ [12]\.\d+ [12]\.\d+ LSB rms .*\nkeep the defaults of {DEFAULT}: only 0\.0 s of motion")

    def test_parts_that_disagree_keep_the_defaults(self):
        """What is best on one part serves no other."""
        flat = np.ones((2, fitting.PARTS)) / fitting.PARTS
        found = {(): flat}
        for part in range(fitting.PARTS):
            loss = flat * 1.05
            loss[:, part] *= 0.4
            found[(("q", 1000.0 + part),)] = loss
        every = {"q": dataclasses.replace(native.parameters(PLAIN, 1000)["q"], default=1000.0)}
        values, reason, held_back = fitting.chosen(found, every)
        self.assertEqual((values, reason), ({}, "values that suit one part of the recording do not suit the others"))
        self.assertGreater(held_back, 1.0)

    def test_a_part_that_loses_keeps_the_defaults(self):
        flat = np.ones((2, fitting.PARTS)) / fitting.PARTS
        loss = flat * np.array([0.5, 0.5, 0.5, 1.2])
        values, reason, _ = fitting.chosen({(): flat, (("q", 9.0),): loss}, {"q": native.parameters(PLAIN, 1000)["q"]})
        self.assertEqual((values, reason), ({}, "better values for the whole are worse in a part of it"))


class Words(unittest.TestCase):
    def test_zero_has_no_minus_sign(self):
        self.assertEqual([tune.percent(part) for part in (0.9999, 1.0, 0.658, 1.2)], ["+0.0 %", "+0.0 %", "-34.2 %", "+20.0 %"])


class Commands(Case):
    def test_what_cannot_be_is_told(self):
        self.write(turned(np.random.default_rng(4), 60.0, 0.2)[0])
        for words, said in ((["--filter", "kx"], "no filter 'kx': choose from"), (["--filter", f"{PLAIN},{ROBUST}"], "give one filter"),
                            (["--rate", "90"], "rate 90: choose from")):
            status, out, err = self.tune(*words)
            self.assertEqual((status, out), (2, ""))
            self.assertIn(said, err)
        stream.write(self.path, [0], np.zeros((1, 3)))
        self.assertIn("so the rate is unknown", self.tune()[2])

    def test_values_that_depend_on_each_other_are_typed_in_an_order_that_is_accepted(self):
        for values in ({"a1": -0.9, "b0": 0.5}, {"a1": 0.6, "b0": 0.5}):
            lines, so_far = tune.typed_in_order(LIGHT, 1000, values), {}
            self.assertEqual(len(lines), 2)
            for line in lines:
                key, value = line.split()
                so_far[key] = float(value)
                self.assertTrue(native.accepts(LIGHT, 1000, so_far), lines)

    @unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), IMAGES)
    def test_the_firmware_takes_the_lines_as_printed(self):
        self.write(turned(np.random.default_rng(5), *QUICK)[0])
        typed = set()
        for name in pathlib.Path("build/uno/filters.txt").read_text(encoding="utf-8").split():
            commands = self.tune("--filter", name)[1].split("\n\n")[1:]
            lines = commands[0].split("\n")[:-1] if commands else []
            typed |= {name} if lines else set()
            words = [word for number, line in enumerate(lines) for word in ("--cmd", f"{200 + 150 * number}:{line}")]
            out = self.folder / "out.csv"
            subprocess.run([SIMRUN, "--fw", FIRMWARE, "--in", "sim/streams/tilt-fast.csv", "--out", out, "--max-ms", "3000", *words],
                           capture_output=True, check=False)
            said = [line for line in out.read_text(encoding="utf-8", errors="replace").splitlines() if line.startswith("#")]
            self.assertFalse([line for line in said if line.startswith("# refused")], (name, lines, said))
            for line in lines:
                key, value = line.split()
                self.assertTrue(any(same(text.split()[2].rstrip(":,"), value) for text in said if text.startswith(f"# {key} ")), (line, said))
        self.assertLessEqual({DEFAULT, PLAIN}, typed)

    @unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), IMAGES)
    def test_apply_reaches_the_firmware(self):
        self.write(turned(np.random.default_rng(1), *QUICK)[0])
        command = [SIMRUN, "--fw", FIRMWARE, "--in", "sim/streams/tilt-fast.csv", "--out", self.folder / "all.csv", "--pty", "--loop"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as board:
            try:
                name = port_of(board)
                answer = self.answer("--filter", PLAIN, "--apply", name)
            finally:
                board.terminate()
        self.assertEqual(list(answer["answers"]), answer["commands"])
        for line, said in answer["answers"].items():
            self.assertTrue(same(said.split()[2].rstrip(":,"), line.split()[1]), (line, said))

    def applied(self, *answers, words=(), speed=None):
        """(status, what was printed) of --apply to a board that answers so, and hears nothing before its header."""
        self.write(turned(np.random.default_rng(1), *QUICK)[0])

        def script(board):
            board.send(rows(0, 500) + BANNER)
            board.typed = b""
            board.send(HEADER + rows(0, 5))
            for heard, answer in answers:
                board.heard(heard)
                board.send(rows(5, 8) + answer + rows(8, 10))
        with FakeBoard(self.folder, script, speed) as board:
            status, out, err = self.tune("--filter", PLAIN, "--apply", board.name, *words)
        self.assertEqual(err, "")
        return status, out

    def test_apply_at_another_baud_rate(self):
        answers = (b"filter ", b"# filter %s\n" % PLAIN.encode()), (b"rate 100\n", b"# rate 100 Hz\n"), (b"q ", b"# q 50000 LSB2/s3: 1 to 1e9\n")
        status, out = self.applied(*answers, words=("--baud", 500000), speed=termios.B500000)
        self.assertEqual(status, 0, out)
        with mock.patch.object(tune, "HEADER_S", 0.1), mock.patch.object(tune, "ANSWER_S", 0.1):
            status, out = self.applied(speed=termios.B500000)
        self.assertEqual(status, 1)
        self.assertIn("no answer at 115200 baud: give --baud N", out)
        status, _, err = self.tune("--baud", 12345)
        self.assertEqual(status, 2)
        self.assertIn("--baud 12345: choose from", err)

    def test_apply_with_json_prints_one_object(self):
        status, out = self.applied((b"filter ", b"# refused 4: filter is one of one two\n"), words=["--json"])
        self.assertEqual(status, 1)
        self.assertEqual(json.loads(out)["answers"], {f"filter {PLAIN}": "# refused 4: filter is one of one two"})

    def test_apply_of_nothing_is_reported(self):
        self.write(np.round(np.random.default_rng(3).normal([0, 0, 256], 2.0, (1000, 3))))
        status, out, _ = self.tune("--apply", self.folder / "no port")
        self.assertEqual(status, 0)
        self.assertTrue(out.endswith("nothing typed: the board keeps the values that it has\n"), out)
        self.assertEqual(self.answer("--apply", self.folder / "no port")["answers"], {})

    def test_apply_types_them_and_reads_the_answers(self):
        status, out = self.applied((b"filter ", b"# filter %s\n" % PLAIN.encode()), (b"rate 100\n", b"# rate 100 Hz\n"),
                                   (b"q ", b"# q 50000 LSB2/s3: 1 to 1e9\n"))
        self.assertEqual(status, 0, out)
        self.assertIn(": # q 50000 LSB2/s3", out)
        self.assertTrue(out.endswith("set; type save to keep them\n"), out)

    def test_apply_stops_at_a_refusal(self):
        status, out = self.applied((b"filter ", b"# refused 4: filter is one of one two\n"))
        self.assertEqual(status, 1)
        self.assertTrue(out.endswith(f"filter {PLAIN}: # refused 4: filter is one of one two\nnot set: filter {PLAIN}\n"), out)


def half(given, rows_of_it):
    """Rows of a stream as a stream of their own, without truth."""
    picked = {name: getattr(given, name)[rows_of_it] for name in ("t_us", "lsb", "flags", "missing", "line")}
    picked["t_us"] = picked["t_us"] - picked["t_us"][0]
    return dataclasses.replace(given, **picked, segments=[slice(0, len(picked["t_us"]))], roll_true_cdeg=None, pitch_true_cdeg=None)


def error_lsb(samples, name, values):
    """From the readings through 5 Hz both ways."""
    rate_hz = samples.rate_dhz / 10
    both = signal.butter(2, 2.0 * min(5.0, smoother.RATE_SHARE * rate_hz) / rate_hz)
    reference = signal.filtfilt(*both, samples.lsb.astype(float), axis=0, padlen=min(len(samples.lsb) - 1, int(rate_hz)))
    shown = np.stack([probes["x_lsb_q16"] / 65536.0 for probes in fitting.run(samples, name, values)], axis=1)
    return math.sqrt(np.mean((shown - reference)[samples.use] ** 2))


@unittest.skipUnless(recordings(), NO_RECORDINGS)
class Recordings(unittest.TestCase):
    def test_fitted_to_the_first_half_it_serves_the_second(self):
        ratios, moving = {}, 0
        for path in recordings():
            given = beginning(path)
            halves = slice(0, len(given) // 2), slice(len(given) // 2, len(given))
            first, second = (fitting.samples_of(half(given, part), native.rate_of(given)) for part in halves)
            moving += second.motion_s >= fitting.MOTION_MIN_S
            values = fitting.fitted(first, DEFAULT).values
            if values:
                ratios[path.stem] = error_lsb(second, DEFAULT, values) / error_lsb(second, DEFAULT, {})
        better = [stem for stem, ratio in ratios.items() if ratio <= BETTER]
        print(f"{len(better)} of {moving} with motion better by 5 %, the worst {max(ratios.values()):.3f}")
        self.assertLessEqual(max(ratios.values()), WORST, ratios)
        self.assertGreaterEqual(len(better), SHARE * moving, ratios)


if __name__ == "__main__":
    from unity_line import main
    main()
