#!/usr/bin/env python3
"""Tests of when `tilt record` does what: commands and a changing baud rate, --seconds, silence; and of the firmware itself on the simulator's
pseudo terminal."""
import contextlib
import io
import os
import pathlib
import subprocess
import sys
import termios
import unittest
from types import SimpleNamespace
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import test_record  # noqa: E402
from fake_board import BANNER, HEADER, row, rows, until  # noqa: E402
from tilt import cli  # noqa: E402
from tilt import port as port_module  # noqa: E402
from tilt.commands import record  # noqa: E402
from tilt.recorder import Recorder  # noqa: E402
from tilt_case import port_of  # noqa: E402


class Typed(test_record.Case):
    """With a board on a pseudo terminal."""

    def test_another_baud_rate_typed_is_followed(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 50))
            board.heard(b"baud 500000\n")
            board.send(b"# baud 500000\n")
            board.speed = termios.B500000
            until(lambda: termios.tcgetattr(board.slave)[4] == termios.B500000)
            board.send(row(51)[3:] + rows(52, 250))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.4), "--send", "baud 500000", speed=termios.B115200)
        self.assertEqual(status, 0, out + err)
        self.assertIn(row(52).decode(), self.file.read_text())

    def test_nothing_is_typed_into_a_change_of_the_baud_rate(self):
        """Neither a line of the board that is no answer nor the answer itself, which comes at the old speed, lets the next command go; a row
        at the new speed does."""
        typed = []

        def script(board):
            board.send(BANNER + HEADER + rows(0, 50))
            board.heard(b"baud 500000\n")
            board.send(b"# sensor: ADXL345 at 0x53\n" + rows(50, 60))
            self.written(row(59))
            board.send(b"# baud 500000\n")
            board.speed = termios.B500000
            until(lambda: termios.tcgetattr(board.slave)[4] == termios.B500000)
            board.send(row(60)[3:])
            typed.append(board.typed)
            board.send(rows(61, 70))
            board.heard(b"rate 400\n")
            board.send(b"# rate 400 Hz\n" + rows(70, 250))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.4), "--send", "baud 500000", "--send", "rate 400",
                                            speed=termios.B115200, ANSWER_S=120.0, BAUD_ANSWER_S=120.0)
        self.assertEqual((status, typed), (0, [b"baud 500000\n"]), out + err)

    def test_an_unanswered_command_holds_no_other_up(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 50))
            board.heard(b"baud 500000\nrate 400\nevery 1\n")
            board.send(rows(50, 250))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.4), "--send", "baud 500000", "--send", "rate 400", "--send", "every 1",
                                            ANSWER_S=0.1, BAUD_ANSWER_S=0.1)
        self.assertEqual(status, 1, out + err)
        for command in ("baud 500000", "rate 400", "every 1"):
            self.assertIn(f"the board did not answer '{command}'", out)

    def test_a_stopped_board_changes_its_baud_rate_and_hears_the_next_command(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 50))
            board.heard(b"stop\n")
            board.send(b"# stopped\n")
            board.heard(b"baud 500000\n")
            board.send(b"# baud 500000\n")
            board.heard(b"go\n")
            board.send(b"# going\n" + rows(61, 250))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.2), "--send", "stop", "--send", "baud 500000", "--send", "go", ANSWER_S=0.1,
                                            BAUD_ANSWER_S=120.0)
        self.assertEqual(status, 0, out + err)

    def test_seconds_are_the_boards_while_rows_come_and_the_pcs_in_silence(self):
        """A board at half its speed, or a PC that is held up, makes no recording shorter."""
        recorder = Recorder(lambda data: None)
        args = SimpleNamespace(seconds=2.0, baud=115200, send=[])
        with mock.patch.object(record, "time", SimpleNamespace(monotonic=lambda: self.now)):
            self.now = 0.0
            session = record.Session(args, SimpleNamespace(baud=115200, name="port"), recorder, None)
            for self.now in (0.0, 1.0, 2.0, 3.0, 3.9):
                session.take((HEADER if not self.now else b"") + rows(int(self.now * 50), int(self.now * 50) + 2))
                self.assertFalse(session.over(), self.now)
            self.now = 4.8
            self.assertFalse(session.over())
            self.now = 5.0
            self.assertTrue(session.over())  # a second without a row
            session.take(rows(235, 260))
            self.assertTrue(session.over())  # two seconds of the board's

    def test_silence_is_no_wrong_baud_rate_nor_is_a_piece_of_a_line(self):
        """Back to the rate at start after 1.5 s of bytes that give no line, of at least 256 of them."""
        screen, port = SimpleNamespace(say=lambda text: None), SimpleNamespace(baud=500000, name="port")
        with mock.patch.object(record, "time", SimpleNamespace(monotonic=lambda: self.now)), \
                mock.patch.object(port_module, "time", SimpleNamespace(monotonic=lambda: self.now)):
            self.now = 0.0
            recorder = Recorder(lambda data: None)
            session = record.Session(SimpleNamespace(seconds=None, baud=115200, send=[]), port, recorder, screen)
            session.take(HEADER + rows(0, 10))
            for self.now, data in ((100.0, row(10)[:9]), (200.0, row(10)[9:15]), (300.0, row(10)[15:]), (400.0, b"\xf5" * 100),
                                   (401.0, b"\xf5" * 200), (401.4, b"\xf5" * 99)):
                session.take(data)
                self.assertEqual(port.baud, 500000, self.now)
            self.now = 401.6
            session.take(b"\xf5" * 10)
            self.assertEqual(port.baud, 115200)


class Simulated(test_record.Case):
    """The firmware itself, in the simulator, on its pseudo terminal."""

    SIMRUN, FIRMWARE, STREAM = "build/sim/simrun", "build/uno/firmware.elf", "sim/streams/tilt-fast.csv"

    def recorded(self, *words):
        """What `tilt record` says of a second, on stdout and stderr."""
        command = [self.SIMRUN, "--fw", self.FIRMWARE, "--in", self.STREAM, "--out", str(self.folder / "all.csv"), "--pty", "--loop"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as board:
            try:
                name = port_of(board)
                with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
                    status = cli.main(["record", name, "-o", str(self.file), "--seconds", "1", *words])
            finally:
                board.terminate()
                last = board.stderr.read()
        self.assertEqual(status, 0, out.getvalue() + err.getvalue() + last)
        return err.getvalue()

    @unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), "no simulator or firmware: make system_images")
    def test_another_baud_rate_and_then_another_rate_reach_the_firmware(self):
        said = self.recorded("--send", "baud 500000", "--send", "rate 400")
        self.assertNotIn("refused", said)
        self.assertIn("# rate 400 Hz", said)
        times = [int(line.split(",")[0]) for line in self.file.read_text().splitlines() if line[0].isdigit()]
        self.assertLess(abs(times[-1] - times[-2] - 2500), 100)

    @unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), "no simulator or firmware: make system_images")
    def test_the_firmwares_rows(self):
        """A second of them, equal to what left the simulated UART."""
        self.recorded("--send", "every 1")
        sent = (self.folder / "all.csv").read_text().splitlines()
        rows = [line for line in self.file.read_text().splitlines() if line[0].isdigit()]
        first = sent.index(rows[0])
        self.assertGreaterEqual(len(rows), 100)
        self.assertEqual([line for line in sent[first:] if line[:1].isdigit()][:len(rows)], rows)


if __name__ == "__main__":
    from unity_line import main
    main()
