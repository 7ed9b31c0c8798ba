#!/usr/bin/env python3
"""The navigation image in the simulated UNO: bit for bit what the PC computes, in time, within its RAM, and whatever comes down the line.

    test_nav_image.py [--seconds N] [--json FILE]     length of the flights that are compared (default 20; make navcheck: 500, with the load and RAM
                                                      judged); what they came to, for campaigns/pages/page_navigation.py

Run from the repository root with build/venv/bin/python; the images are built by make.
"""
import argparse
import atexit
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt.navigation import boards, exchange, flight, frames, judge  # noqa: E402

SECONDS, EVERY = 20.0, 10
TOLD = []
BUDGETS = dict(line.split()[:2] for line in pathlib.Path("checks/budgets.txt").read_text(encoding="utf-8").splitlines() if line and line[0] != "#")
FOR_COMPILER = subprocess.run(["avr-gcc", "-dumpversion"], capture_output=True, text=True, check=False).stdout.strip() == "5.4.0"
SLOT_US = 10_000
LOAD_LIMIT = 0.60


def flown(seconds, **wishes):
    """A flight with an outage in it, whatever its length."""
    return flight.simulated(flight.Wish(seconds=seconds, without=((0.32 * seconds, 0.8 * seconds),), **wishes))


def simulated(sent, states):
    return boards.simulated(sent, states)


def raw(sent, image, *options, expect=0):
    """Bytes that an image says to these frames, and the statistics."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        (place / "frames").write_text("".join(f"{record.due_us} {record.data.hex()}\n" for record in sent), encoding="ascii")
        done = subprocess.run(["build/sim/simrun", "--fw", image, "--frames", place / "frames", "--out", place / "out", "--stats", place / "stats",
                               *options], capture_output=True, text=True, check=False)
        assert done.returncode == expect, done.stderr
        return (place / "out").read_bytes(), json.loads((place / "stats").read_text(encoding="utf-8"))


class Equal(unittest.TestCase):
    def compare(self, states):
        made = flown(SECONDS, late_us=120_000)
        sent = exchange.records(made, {}, every=EVERY)
        chip, pc = simulated(sent, states), boards.on_pc(sent, states)
        self.assertEqual(len(chip.outcome.answers), len(sent))
        self.assertEqual(len(chip.outcome.states), int(SECONDS * 100) // EVERY)
        for own, other in zip(chip.outcome.states, pc.outcome.states):
            self.assertEqual(np.float32(own.numbers).tobytes(), np.float32(other.numbers).tobytes(), f"at {own.t_us} us")
        self.assertEqual(chip.outcome.variances, pc.outcome.variances)
        self.assertEqual([(a.code, a.waiting) for a in chip.outcome.answers], [(a.code, a.waiting) for a in pc.outcome.answers])
        self.assertEqual(chip.outcome.counts, pc.outcome.counts)
        self.assertTrue(chip.outcome.healthy)
        TOLD.append({"part": "image", "states": states, "seconds": SECONDS, "records": len(sent), "compared": len(chip.outcome.states),
                     **{name: chip.stats[name] for name in ("cpu_load", "pass_max_cycles", "frames_latest_us", "ram_used_bytes", "flash_bytes")}})
        TOLD.extend({"part": "flight", "states": states, **row} for row in judge.largest(made, judge.errors(made, chip.outcome)))
        return chip.stats

    def judge(self, stats, states):
        print(f"    {states} states, {SECONDS:g} s: load {100 * stats['cpu_load']:.1f} %, latest frame {stats['frames_latest_us']:.0f} us, longest "
              f"pass {stats['pass_max_cycles']} cycles, RAM with stack {stats['ram_used_bytes']}, flash {stats['flash_bytes']}")
        self.assertEqual(stats["uart_rx_overruns"], 0)
        if FOR_COMPILER:
            self.assertLessEqual(stats["cpu_load"], LOAD_LIMIT)
            self.assertLess(stats["frames_latest_us"], SLOT_US)
            self.assertLessEqual(stats["pass_max_cycles"], 16 * SLOT_US)
            self.assertLessEqual(stats["ram_used_bytes"], int(BUDGETS["nav_ram_and_stack_bytes"]))
            self.assertLessEqual(stats["flash_bytes"], int(BUDGETS["nav_flash_bytes"]))

    def test_12_states_are_those_of_the_pc_bit_for_bit(self):
        self.judge(self.compare(12), 12)

    def test_9_states_are_those_of_the_pc_bit_for_bit(self):
        self.judge(self.compare(9), 9)


class Line(unittest.TestCase):
    """What comes down the line: at full speed, damaged, interrupted."""

    def test_nothing_is_lost_at_full_speed(self):
        """Everything is due at once: the board's own window sets the pace."""
        sent = [dataclasses.replace(record, due_us=0) for record in exchange.records(flown(3.0), {})]
        out, stats = raw(sent, boards.image(12))
        found = exchange.Outcome()
        found.take(frames.Reader().feed(out))
        self.assertEqual(len(found.answers), len(sent))
        self.assertEqual({answer.code for answer in found.answers} - {0}, set())
        self.assertEqual(stats["uart_rx_overruns"], 0)
        self.assertEqual(found.counts["records missing"], 0)
        self.assertGreater(stats["cpu_load"], 0.95)  # it was the board that was busy

    def test_damaged_frames_are_told_and_the_flight_goes_on(self):
        sent, random = exchange.records(flown(8.0), {}), np.random.default_rng(5)
        spoilt, damaged = [], 0
        for number, record in enumerate(sent):
            data = bytearray(record.data)
            if number > 10 and record.kind == "imu" and random.random() < 0.05:
                data[random.integers(len(data) - 1)] ^= 1 << random.integers(1, 8) if len(data) else 0
                damaged += bytes(data) != record.data
            spoilt.append(dataclasses.replace(record, data=bytes(data)))
        out = raw_answers(spoilt)
        self.assertGreater(damaged, 20)
        self.assertGreaterEqual(out.counts["broken frame"], damaged - out.counts["records missing"])
        self.assertLessEqual(out.counts["records missing"], damaged)
        self.assertGreaterEqual(out.counts["records missing"], damaged - 2)  # a zero in a frame makes two of it, and both are broken
        self.assertTrue(out.healthy)

    def test_a_record_a_second_time_is_refused(self):
        sent = exchange.records(flown(2.0), {})
        place = next(number for number, record in enumerate(sent) if record.kind == "imu") + 20
        out = raw_answers(sent[:place] + [sent[place - 1]] + sent[place:])
        self.assertEqual(out.counts["out of order"], 1)
        self.assertEqual(out.counts["time went backwards"], 0)

    def test_a_reset_in_flight_greets_anew_and_asks_for_a_start(self):
        sent = exchange.records(flown(3.0), {})
        out, _ = raw(sent, boards.image(12), "--fault", "1500ms:reset", "--expect-resets", "1", "--max-ms", "3300")
        found = exchange.Outcome()
        found.take(frames.Reader().feed(out))
        self.assertEqual([hello.reset_cause for hello in found.hellos], [0, 1])
        start = next(place for place, answer in enumerate(found.answers) if frames.answer_text(answer.code) == "not started")
        said = {frames.answer_text(answer.code) for answer in found.answers[start:]}
        self.assertGreater(len(found.answers) - start, 100)
        self.assertLessEqual(said, {"not started", "taken"})  # taken: the counts, at the end


def raw_answers(sent):
    out, _ = raw(sent, boards.image(12))
    found = exchange.Outcome()
    found.take(frames.Reader().feed(out))
    return found


class FramesFile(unittest.TestCase):
    """What simrun --frames refuses, by file and line, in place of waiting for an answer that cannot come."""

    def run_of(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "frames"
            path.write_text("".join(f"{line}\n" for line in lines), encoding="ascii")
            done = subprocess.run(["build/sim/simrun", "--fw", boards.image(12), "--frames", path, "--out", path.with_name("out")],
                                  capture_output=True, text=True, check=False, timeout=600)
            return done.returncode, done.stderr.replace(str(path), "F")

    def test_refusals_name_the_line(self):
        good = f"0 {frames.frame(frames.bare_record(0, 'hello')).hex()}"
        for bad, told in (("0 " + "01" * 128, "a frame has 1 to 127 bytes"), ("0 " + "01" * 300, "a frame has 1 to 127 bytes"),
                          ("0 00", "an empty frame"), ("0 000000", "an empty frame"), ("0 0", "a frame is bytes of two hexadecimal digits"),
                          ("0 ", "no bytes"), ("x 01", "a frame is 'DUE_US HEX'"), ("0 " + "01" * 1000, "the line is too long")):
            status, said = self.run_of("# a comment", good, bad)
            self.assertNotEqual(status, 0)
            self.assertIn(f"simrun: F:3: {told}", said)

    def test_the_longest_frame_is_sent(self):
        """The twin: as much as the window holds is taken, and answered as broken."""
        self.assertEqual(self.run_of("0 " + "7f" * 126 + "00")[0], 0)


class BadInput(unittest.TestCase):
    """Through the whole chain on the PC: refused or gated, counted, the filter recovers."""

    def fly(self, spoil, seconds=60.0, states=12):
        made = flight.simulated(flight.Wish(seconds=seconds, without=()))
        spoil(made)
        sent = exchange.records(made, {}, every=1)
        run = boards.on_pc(sent, states)
        self.assertEqual(len(run.outcome.answers), len(sent))
        self.assertTrue(run.outcome.healthy)
        found = judge.errors(made, run.outcome)
        last = found.t_s > seconds - 10.0
        self.assertLess(np.abs(found.euler_deg[last]).max(), 3.0)
        self.assertLess(np.linalg.norm(found.position_m[last], axis=1).max(), 12.0)
        return run.outcome.counts, found

    @staticmethod
    def change(made, kind, place, values=None, t_us=None):
        row = [number for number, entry in enumerate(made.rows) if entry[0] == kind][place]
        made.rows[row] = (kind, made.rows[row][1] if t_us is None else t_us, made.rows[row][2] if values is None else values)

    def test_not_finite(self):
        def spoil(made):
            self.change(made, "imu", 1000, (np.nan, 0, 0, 0, 0, 0))
            self.change(made, "gps", 20, (0, 0, 0, np.inf, 0, 0))
            self.change(made, "field", 100, (0, -np.inf, 0))
            self.change(made, "down", 10, (np.nan,))
        counts, _ = self.fly(spoil)
        self.assertEqual(counts["not finite"], 4)

    def test_field_without_length(self):
        counts, _ = self.fly(lambda made: self.change(made, "field", 100, (0.0, 0.0, 0.0)))
        self.assertEqual(counts["no length"], 1)

    def test_gps_jump_of_a_kilometre_does_not_move_the_state(self):
        def spoil(made):
            values = [entry for entry in made.rows if entry[0] == "gps"][30][2]
            self.change(made, "gps", 30, (*values[:3], values[3] + 1000.0, *values[4:]))
        counts, found = self.fly(spoil)
        self.assertEqual(counts["gated"], 1)
        after = (found.t_s > 31.0) & (found.t_s < 36.0)
        self.assertLess(np.linalg.norm(found.position_m[after], axis=1).max(), 12.0)

    def test_time_going_backwards(self):
        def spoil(made):
            for kind, place in (("imu", 2000), ("gps", 20), ("down", 20), ("field", 200)):
                self.change(made, kind, place, t_us=5_000)
        counts, _ = self.fly(spoil)
        self.assertEqual(counts["time went backwards"] + counts["too late"], 4)

    def test_a_stamp_that_leaps_ahead_does_not_move_the_state(self):
        """As much as one record that is missing; a leap of 10 s was 66 m."""
        plain = self.fly(lambda made: None)[1]
        counts, found = self.fly(lambda made: self.change(made, "imu", 3000, t_us=1_030_010_000))
        self.assertEqual((counts["out of range"], counts["gap"], counts["time went backwards"]), (1, 0, 0))
        self.assertLess(self.farthest(plain, found), 0.1)

    def test_two_stamps_that_go_on_from_one_another_are_a_gap(self):
        """The twin: what the above measures sees a leap."""
        plain = self.fly(lambda made: None)[1]

        def spoil(made):
            for number in range(2):
                self.change(made, "imu", 3000 + number, t_us=1_030_010_000 + 10_000 * number)
        counts, found = self.fly(spoil)
        self.assertGreaterEqual(counts["gap"], 1)
        self.assertGreater(self.farthest(plain, found), 40.0)

    @staticmethod
    def farthest(plain, found):
        """Largest difference of the position error between two flights at the times that both have a state of."""
        of_plain = dict(zip(np.round(plain.t_s * 100), plain.position_m))
        return max(np.linalg.norm(position - of_plain[t]) for t, position in zip(np.round(found.t_s * 100), found.position_m) if t in of_plain)

    def test_out_of_range(self):
        def spoil(made):
            self.change(made, "imu", 1500, (41.0, 0, 0, 0, 0, -9.81))
            self.change(made, "imu", 1600, (0.0, 0, 0, 0, 401.0, 0))
            self.change(made, "gps", 25, (0, 0, 0, 2e6, 0, 0))
        counts, _ = self.fly(spoil)
        self.assertEqual(counts["out of range"], 3)

    def test_imu_records_that_never_came_are_bridged(self):
        def spoil(made):
            imu = [number for number, entry in enumerate(made.rows) if entry[0] == "imu"]
            for number in reversed(imu[2000:2008]):
                del made.rows[number]
        counts, _ = self.fly(spoil)
        self.assertEqual(counts["gap"], 0)

    def test_a_second_without_imu_is_a_gap(self):
        def spoil(made):
            made.rows = [entry for entry in made.rows if not 20_000_000 < entry[1] <= 21_000_000]
        counts, _ = self.fly(spoil)
        self.assertGreaterEqual(counts["gap"], 1)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--json", type=pathlib.Path)
    args, rest = parser.parse_known_args()
    SECONDS = args.seconds
    sys.argv = [sys.argv[0], *rest]
    print(f"flights of {SECONDS:g} s")
    if args.json:
        atexit.register(lambda: args.json.write_text(json.dumps(TOLD, indent=1) + "\n", encoding="ascii"))
    from unity_line import main
    main()
