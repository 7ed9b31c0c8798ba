#!/usr/bin/env python3
"""Tests of `tilt nav` at a serial port: a pseudo terminal behind which the navigation image runs natively (build/host/nav_replay_12, made here
when it is missing)."""
import contextlib
import dataclasses
import os
import pathlib
import pty
import re
import subprocess
import sys
import tempfile
import threading
import time
import tty
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import run_tilt  # noqa: E402
from tilt.errors import TiltError  # noqa: E402
from tilt.navigation import boards, exchange, flight, frames  # noqa: E402

RING = 127


class Board:
    """The image behind a pseudo terminal; it holds no more than its ring: bytes beyond are lost and counted. `after`: what to do with the
    running number of each piece of its answers before it goes out."""

    def __init__(self, after=lambda number, data: data):
        self.master, slave = pty.openpty()
        tty.setraw(self.master)
        self.name, self.slave = os.ttyname(slave), slave
        self.after, self.overrun, self.typed, self.taken = after, 0, 0, 0
        self.process = subprocess.Popen([boards.ROOT / boards.native(12)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        self.threads = [threading.Thread(target=work, daemon=True) for work in (self.to_board, self.from_board)]
        for thread in self.threads:
            thread.start()

    def to_board(self):
        with contextlib.suppress(OSError, ValueError):
            while data := os.read(self.master, 4096):
                self.typed += len(data)
                if self.typed - self.taken > RING:
                    self.overrun += 1
                self.process.stdin.write(data)

    def from_board(self):
        reader, number = frames.Reader(), 0
        with contextlib.suppress(OSError, ValueError):
            while data := self.process.stdout.read(256):
                for item in reader.feed(data):
                    if isinstance(item, frames.Answer):
                        self.taken += (item.taken - self.taken) & 0xFFFF
                data, number = self.after(number, data), number + 1
                if data is None:
                    return
                os.write(self.master, data)

    def close(self):
        self.process.kill()
        self.process.wait()
        for end in (self.master, self.slave):
            with contextlib.suppress(OSError):
                os.close(end)
        self.process.stdin.close()
        self.process.stdout.close()


@contextlib.contextmanager
def board(after=lambda number, data: data):
    own = Board(after)
    try:
        yield own
    finally:
        own.close()


def sent(seconds=3.0):
    return exchange.records(flight.simulated(flight.Wish(seconds=seconds)), {})


def patient():
    """A machine that is busy elsewhere is no silent board."""
    return mock.patch.multiple(boards, SILENT_S=120.0, GREETING_S=120.0)


class Port(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        boards.made(boards.native(12))

    def test_comes_to_what_the_pc_alone_does_and_keeps_to_the_window(self):
        records = sent()
        alone = boards.on_pc(records, 12).outcome
        with board() as own, patient():
            found = boards.at_port(own.name, records, 12, fast=True).outcome
        self.assertEqual(found.states, alone.states)
        self.assertEqual(found.variances, alone.variances)
        self.assertEqual([answer.code for answer in found.answers], [answer.code for answer in alone.answers])
        self.assertEqual(own.overrun, 0)

    def test_records_go_when_they_are_due(self):
        with board() as own, patient():
            began = time.monotonic()
            boards.at_port(own.name, sent(2.0), 12)
            self.assertGreaterEqual(time.monotonic() - began, 1.98)

    def test_another_image_is_told(self):
        with board() as own, patient():
            with self.assertRaisesRegex(TiltError, "version 1 with 12 states, not 1 with 9"):
                boards.at_port(own.name, sent(), 9, fast=True)

    def test_a_port_without_the_image_is_told(self):
        with board(lambda number, data: b"# tilt-uno 1.0\r\n") as own, mock.patch.object(boards, "GREETING_S", 0.5):
            with self.assertRaisesRegex(TiltError, "no answer at 1000000 baud: write the navigation image with make navflash"):
                boards.at_port(own.name, sent(), 12, fast=True)

    def test_a_board_that_falls_silent_is_told_with_the_place(self):
        with board(lambda number, data: data if number < 50 else None) as own, mock.patch.object(boards, "SILENT_S", 0.4):
            with self.assertRaisesRegex(TiltError, r"stopped answering after \d+ records"):
                boards.at_port(own.name, sent(), 12, fast=True)

    def test_a_board_that_starts_anew_is_told(self):
        greeting = frames.frame(b"h" + bytes([1, 12, 127, 0, 3]))
        with board(lambda number, data: greeting if number == 60 else data) as own, patient():
            with self.assertRaisesRegex(TiltError, r"the board restarted after \d+ records"):
                boards.at_port(own.name, sent(), 12, fast=True)

    def test_a_port_that_is_not_there_is_told(self):
        status, _, said = run_tilt("nav", "--board", "/dev/no-such-port")
        self.assertEqual(status, 2)
        self.assertIn("/dev/no-such-port", said)


class Losses(unittest.TestCase):
    """The image's own answers where the line lost what was sent: each names its record."""

    @classmethod
    def setUpClass(cls):
        boards.made(boards.native(12))

    def refused(self, lose):
        """Rows whose refusal is told; the third field is one without length."""
        made = flight.simulated(flight.Wish(seconds=3.0))
        fields = [row for row, entry in enumerate(made.rows) if entry[0] == "field"]
        made.rows[fields[2]] = ("field", made.rows[fields[2]][1], (0.0, 0.0, 0.0))
        records = exchange.records(made, {})
        bad = next(number for number, record in enumerate(records) if record.row == fields[2])
        data = lose(records, bad)
        outcome = boards.on_pc([dataclasses.replace(record, data=data.get(number, record.data)) for number, record in enumerate(records)], 12).outcome
        told = exchange.refusals(records, outcome)
        self.assertIn((fields[2], "no length"), [(record and record.row, frames.answer_text(answer.code)) for record, answer in told])
        return [record for record, _ in told if record is None or record.row != fields[2]], outcome

    def test_lost_frame(self):
        others, outcome = self.refused(lambda records, bad: {bad - 3: b""})
        self.assertEqual(others, [])
        self.assertEqual(outcome.counts["records missing"], 1)

    def test_lost_zero_byte(self):
        others, outcome = self.refused(lambda records, bad: {bad - 3: records[bad - 3].data[:-1]})
        self.assertEqual(others, [None])
        self.assertEqual(outcome.counts["broken frame"], 1)

    def test_lost_parameters(self):
        records = sent()
        lost = [dataclasses.replace(record, data=b"") if number == 2 else record for number, record in enumerate(records)]
        with self.assertRaisesRegex(TiltError, "the board answered 5 of .* start frames, the others were lost on the line"):
            exchange.check_start(records, boards.on_pc(lost, 12).outcome)


class Command(unittest.TestCase):
    def test_writes_states_and_picture_and_names_what_was_refused(self):
        made = flight.simulated(flight.Wish(seconds=12.0, without=((4.0, 9.0),)))
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            flight.write(place / "flight.csv", made)
            lines = (place / "flight.csv").read_text(encoding="utf-8").splitlines()
            number = next(n for n, line in enumerate(lines) if line.startswith("field,5000000"))
            lines[number] = "field,5000000,0,0,0"
            (place / "flight.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
            status, said, _ = run_tilt("nav", place / "flight.csv", "--board", "pc", "-o", place / "states.csv", "--plot", place / "f.png")
            self.assertEqual(status, 0, said)
            self.assertIn(f"flight.csv:{number + 1}: field: no length", said)
            self.assertIn("board's counts: no length 1", said)
            rows = (place / "states.csv").read_text(encoding="utf-8").splitlines()
            self.assertEqual(len(rows), 1 + 120)
            self.assertEqual((place / "f.png").read_bytes()[:4], b"\x89PNG")

    def test_the_seconds_told_are_those_of_the_flight_and_not_of_building(self):
        """By a clock that building sets forward by an hour: less than which the flight takes on any machine."""
        made, clock, hour_s = boards.made, {"forward_s": 0.0}, 3600.0

        def slowly(*targets):
            clock["forward_s"] += hour_s
            made(*targets)
        moved = mock.Mock(wraps=time, perf_counter=lambda: time.perf_counter() + clock["forward_s"])
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(boards, "made", slowly), mock.patch.object(boards, "time", moved):
            path = pathlib.Path(folder) / "flight.csv"
            flight.write(path, flight.simulated(flight.Wish(seconds=5.0)))
            said = run_tilt("nav", path, "--board", "pc", "--plot", path.with_suffix(".png"))[1]
        self.assertGreaterEqual(clock["forward_s"], hour_s)
        self.assertLess(float(re.search(r"s of flight in ([\d.]+) s", said)[1]), hour_s)

    def test_a_start_that_the_filter_refuses_is_said(self):
        status, _, said = run_tilt("nav", "--board", "pc", "--set", "gravity_mps2=0")
        self.assertEqual(status, 2)
        self.assertIn("start refused", said)


if __name__ == "__main__":
    from unity_line import main
    main()
