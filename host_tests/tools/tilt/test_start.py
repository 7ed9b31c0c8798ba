#!/usr/bin/env python3
"""Tests of `tilt start` with the firmware in the simulator, on its pseudo terminal, and a person who answers by a script: one who does as told, one
who skips everything, one who does everything wrong. Run from the repository root with build/venv/bin/python."""
import collections
import contextlib
import io
import math
import os
import pathlib
import re
import subprocess
import sys
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT  # noqa: E402
from tilt_case import InFolder, port_of, run_tilt  # noqa: E402
from tilt import cli, starting, stream  # noqa: E402
from tilt.realboard import owner  # noqa: E402
from tilt.realboard.bench import Quit  # noqa: E402

SIMRUN, FIRMWARE = "build/sim/simrun", "build/uno/firmware.elf"
REST = "sim/streams/rest-2lsb.csv"
STEPS = [name for name, _ in starting.STEPS]


class Person:
    """answers {step: what is typed at its prompts, in turn}; at a prompt without an answer the person quits."""

    def __init__(self, answers):
        self.answers = {step: collections.deque(given) for step, given in answers.items()}
        self.said, self.step, self.keys = [], None, collections.deque()

    def typed(self):
        if self.keys and self.keys[0] is None:
            raise Quit
        if self.keys and self.keys[0] == "^C":
            raise KeyboardInterrupt
        return self.keys.popleft() if self.keys else None

    def say(self, text):
        self.said.append(text)
        found = re.match(r"\n\d/\d ([\w-]+)", text)
        if found:
            self.step = found[1]
            self.keys += self.answers.get(f"{self.step} at once", ())

    def prompt(self, text):
        self.said.append(text)
        given = self.answers.get(self.step)
        if not self.keys:
            self.keys += given.popleft().split("|") if given else [None]


@unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), "no simulator or firmware: make system_images")
class Started(InFolder):
    def led(self, recording, answers, *words, faults=()):
        """(status, what the person saw, stderr) of a guide by the firmware on this stream."""
        person = Person(answers)
        command = [SIMRUN, "--fw", FIRMWARE, "--in", recording, "--out", str(self.folder / "all.csv"), "--eeprom", str(self.folder / "eeprom.bin"),
                   "--pty", "--loop", *(word for fault in faults for word in ("--fault", fault))]
        out, err = io.StringIO(), io.StringIO()
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as board, mock.patch.object(owner, "Owner", lambda: person), \
                mock.patch.object(starting, "RECORD_S", 2.0), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                name = port_of(board)
                status = cli.main(["start", name, "-o", str(self.folder / "first.csv"), *words])
            finally:
                board.terminate()
        return status, "\n".join(person.said) + out.getvalue(), err.getvalue()

    def test_who_does_as_told_ends_with_a_picture_and_saved_values(self):
        answers = {"calibration": ["tare"], "rate": ["200"], "recording": [""], "tune": ["y"], "save": ["y"]}
        status, said, err = self.led(REST, answers)
        self.assertEqual((status, err), (0, ""), said)
        for words in ("The sensor answers: roll 1", "selftest z", "level 0.1", "noise z", "rate 200 Hz", "odr 200", "nothing is missing",
                      f"keep the defaults of {DEFAULT}", "blue is filtered", "saved"):
            self.assertIn(words, said)
        self.assertGreaterEqual(len(stream.read(self.folder / "first.csv")), 200)
        self.assertTrue((self.folder / "first.png").stat().st_size > 10_000)
        self.assertRegex(said, r"wiring: done\nself-test: done\ncalibration: done\nnoise: done\nrate: done\nrecording: done\n")

    def test_every_step_can_be_skipped(self):
        status, said, err = self.led(REST, {f"{step} at once": ["s"] for step in STEPS})
        self.assertEqual((status, err), (0, ""), said)
        self.assertIn("\n".join(f"{step}: skipped" for step in STEPS[:6]), said)
        self.assertFalse((self.folder / "first.csv").exists())

    def test_who_does_everything_wrong_is_led_on(self):
        """The board moves, its sensor was off at first, answers are nonsense, steps are repeated, what needs a recording comes without one."""
        answers = {"wiring": ["what?", *[""] * 400], "self-test": ["s"], "calibration": ["both", "tare", "y", "r", "cal6|s"], "noise": ["", "s"],
                   "rate": ["90", "fast", "100 Hz", "100"], "recording": ["no", "|r", "|s"], "save": ["perhaps", "n"]}
        moving = self.folder / "moving.csv"
        moving.write_text("t_us,x,y,z\n" + "".join(f"{10_000 * i},{round(150 * math.sin(i / 15))},0,{210 + i % 3}\n" for i in range(2000)))
        status, said, err = self.led(moving, answers, faults=["1ms:unplug:4500"])
        self.assertEqual((status, err), (0, ""), said)
        for words in ("Not done: fault 1: ", "'what?' is no answer here: Enter, s to skip", "refused 'tare': moving", "'both' is no answer",
                      "refused 'noise': moving", "'fast' is no answer here", "'perhaps' is no answer here: y n", "tune: skipped: nothing is recorded",
                      "plot: skipped: nothing is recorded", "calibration: skipped"):
            self.assertIn(words, said)
        self.assertNotRegex(said, "Traceback|exists already")

    def test_who_quits_is_told_what_stays(self):
        status, said, _ = self.led(REST, {"wiring at once": ["q"]})
        self.assertEqual(status, 1)
        self.assertIn("what was set stays until the power goes off", said)

    def test_ctrl_c_says_it_too_and_stops_cal6(self):
        answers = {f"{step} at once": ["s"] for step in STEPS[:2]} | {"calibration": ["cal6|^C"]}
        with mock.patch.object(starting.Guided, "type", autospec=True, side_effect=starting.Guided.type) as typed:
            status, said, err = self.led(REST, answers)
        self.assertEqual((status, err, typed.call_args.args[1]), (130, "", "cal6 stop"), said)
        self.assertIn("what was set stays until the power goes off", said)

    def test_what_cannot_be_used_is_one_line(self):
        (self.folder / "first.csv").write_text("mine")
        status, said, err = self.led(REST, {})
        self.assertEqual(status, 2, said)
        self.assertRegex(err, r"\Atilt start: .*first.csv: exists already: give --force[^\n]*\n\Z")
        self.assertIn("stdin is not a terminal", run_tilt("start", "/dev/null", "-o", self.folder / "o.csv")[2])
        self.assertIn("choose from 9600", run_tilt("start", "/dev/null", "--baud", "12345")[2])


if __name__ == "__main__":
    from unity_line import main
    main()
