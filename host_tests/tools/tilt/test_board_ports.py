#!/usr/bin/env python3
"""`tilt board` and what it meets: ports, boards, options and terminals that are none; a person at a real terminal; Ctrl-C and a lost port."""
import contextlib
import io
import os
import pathlib
import pty
import signal
import sys
import termios
import threading
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from board_support import ALL, FIRMWARE_SAYS, GONE, CommandCase, Desk, Model, banner, check, raises, rows  # noqa: E402
from fake_board import BANNER, FakeBoard, until  # noqa: E402
from tilt.errors import TiltError  # noqa: E402
from tilt.realboard import owner as owner_module  # noqa: E402
from tilt.realboard import session as session_module  # noqa: E402
from tilt.realboard.bench import Quit  # noqa: E402
from tilt.realboard.owner import Owner  # noqa: E402
from tilt.realboard.record import Record  # noqa: E402
from tilt.realboard.session import meet  # noqa: E402


class Bad(CommandCase):
    """Ports, terminals and options that are none."""

    def board(self, script, **constants):
        """(status, stderr) with a board on a pseudo terminal that says this."""
        with contextlib.ExitStack() as stack:
            for name, value in ({"MEET_S": 1.0, "MEET_STRANGE_S": 1.5, "VERSION_AFTER_S": 0.3} | constants).items():
                stack.enter_context(mock.patch.object(session_module, name, value))
            stack.enter_context(mock.patch.object(owner_module, "Owner", lambda: Desk()))
            board = stack.enter_context(FakeBoard(self.folder, script))
            status, _, err = self.tilt(board.name, "-o", self.path)
        return status, err

    def test_no_port(self):
        status, _, err = self.tilt()
        self.assertEqual(status, 2)
        self.assertIn("tilt board: no port given", err)

    def test_a_port_that_is_not_there(self):
        with mock.patch.object(owner_module, "Owner", lambda: Desk()):
            status, _, err = self.tilt(self.folder / "none", "-o", self.path)
        self.assertEqual(status, 2)
        self.assertIn("none: No such file or directory (", err)
        self.assertFalse(self.path.exists())

    def test_a_port_that_is_no_board_of_ours(self):
        for data, reason in ((b"", "nothing received in 1 s"), (b"X: 0.12 Y: -0.33\n" * 30, "not from this firmware: 'X: 0.12 Y: -0.33'"),
                             (bytes(range(128, 256)) * 8, "nothing received"), (b"\xf5\n" * 200, "no text at any baud rate")):
            status, err = self.board(lambda board, data=data: board.send(data))
            self.assertEqual((status, self.path.exists()), (2, False))
            self.assertIn(reason, err)
            self.assertIn("tilt flash", err)

    def test_a_board_that_says_who_it_is_and_then_nothing(self):
        with mock.patch.object(session_module, "BEGUN_S", 0.1), mock.patch("tilt.realboard.watch.ANSWER_S", 0.3):
            status, err = self.board(lambda board: board.send(BANNER))
        self.assertEqual(status, 2)
        self.assertIn("does not answer: incomplete reply to 'settings'", err)

    def test_another_firmware_than_the_records(self):
        record = self.record()
        record.close()
        self.path.write_text(self.path.read_text().replace("0.1.0", "0.0.9"))
        desk = Desk([(0.5, banner())] + rows(0.6, 60), Model())
        from tilt.commands.board import checks_of
        with self.assertRaisesRegex(TiltError, "0.0.9.*start a new record"):
            checks_of(desk.bench(), Record(self.path, resumed=True), ALL, "port")

    def test_options(self):
        for words, reason in ((("port", "--only", "sda_short,sda"), "--only: no check 'sda': tilt board --list prints them"),
                              (("port", "--baud", "12345"), "--baud 12345: choose from 9600"),
                              (("port", "--resume", "a", "-o", "b"), "-o and --resume")):
            status, _, err = self.tilt(*words)
            self.assertEqual(status, 2)
            self.assertIn(reason, err)

    def test_no_terminal(self):
        read, write = os.pipe()
        with open(read, encoding="ascii") as file, self.assertRaisesRegex(TiltError, "stdin is not a terminal"):
            Owner(file)
        os.close(write)


class Hands(CommandCase):
    """A person at a real terminal."""

    def terminal(self):
        master, slave = pty.openpty()
        settings = termios.tcgetattr(slave)
        settings[3] &= ~termios.ECHO
        termios.tcsetattr(slave, termios.TCSANOW, settings)
        self.addCleanup(os.close, slave)
        return master, os.fdopen(os.dup(slave), encoding="utf-8")

    def test_what_is_typed(self):
        master, terminal = self.terminal()
        with terminal:
            owner, got = Owner(terminal, io.StringIO()), []
            self.assertIsNone(owner.typed())
            os.write(master, "s no wire\nr\nnot\u00e9\n".encode())
            until(lambda: [got.append(line) for line in [owner.typed()] if line is not None] and len(got) == 3)
            self.assertEqual(got, ["s no wire", "r", "not\u00e9"])
            os.write(master, b"\x04")  # Ctrl-D
            with self.assertRaises(Quit):
                until(owner.typed)
            with self.assertRaises(Quit):
                owner.typed()
        os.close(master)

    def test_ctrl_c_and_a_lost_port_leave_a_record(self):
        """The whole command: the first check passes, then the port goes, then Ctrl-C."""
        desk = Desk(answers=[])
        # a program started in the background, as a CI may be, ignores Ctrl-C
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        desk.prompt = lambda text: time.sleep(60)  # where the lost port is noticed first: nobody answers before Ctrl-C
        firmware = Model()

        def talk(board):
            number, said = 0, b""
            board.send(("\n".join(banner()) + "\n").encode())
            while board.master is not None:
                board.listen()
                *lines, board.typed = board.typed.split(b"\n")
                for line in lines:
                    board.send("".join(f"{each}\n" for each in firmware.reply(line.decode())).encode())
                    said += line + b"\n"
                board.send(b"".join(line.encode() + b"\n" for _, line in rows(number * 0.01, number * 0.01 + 0.0101)))
                number += 1
                time.sleep(0.01)
                if self.path.exists() and b'"pass"' in self.path.read_bytes():
                    board.unplug()
                    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
                    return

        judge = raises(None)
        checks = [(1, check(judge=judge, alone=True)), (2, check("rate", lambda bench: list(bench.events(60)), alone=True))]
        with mock.patch("tilt.realboard.checks.chosen", lambda _: checks), mock.patch.object(owner_module, "Owner", lambda: desk), \
                FakeBoard(self.folder, talk) as board:
            status, out, err = self.tilt(board.name, "-o", self.path)
        self.assertEqual(status, 130, err)
        self.assertIn("1 passed, 0 failed, 0 skipped, 19 not done", out)
        self.assertIn(f"--resume {self.path}", out)
        self.assertEqual([line["kind"] for line in self.lines()], ["begin", "check"])


class Meeting(unittest.TestCase):
    def test_a_board_that_no_opening_resets_is_asked(self):
        desk = Desk(rows(0, 60), Model())
        firmware, settings = meet(desk.bench(), "port")
        self.assertEqual((firmware, settings["range"], desk.sent[0]), (FIRMWARE_SAYS, "16", "version"))

    def test_a_board_that_says_nothing_is_asked(self):
        desk = Desk([], Model())
        self.assertEqual(meet(desk.bench(), "port")[0], FIRMWARE_SAYS)
        self.assertEqual(desk.sent.count("version"), 3)  # that of `settings` and of `status` too
        with self.assertRaisesRegex(TiltError, "nothing received in 8 s"):
            meet(Desk().bench(), "port")

    def test_what_is_typed_meanwhile_waits(self):
        desk = Desk([(0.5, banner())], Model())
        desk.keys += ["s", "r"]
        self.assertEqual((meet(desk.bench(), "port")[0], list(desk.keys)), (FIRMWARE_SAYS, ["s", "r"]))

    def test_a_port_that_vanishes_is_one_sentence(self):
        with self.assertRaisesRegex(TiltError, "port: the port is gone: check the cable"):
            meet(Desk([(0.5, GONE)], Model()).bench(), "port")

    def test_a_fault_from_the_beginning_is_said(self):
        desk = Desk([(0.5, banner())], Model(fault=1))
        meet(desk.bench(), "port")
        self.assertIn("The board reports fault 1: repair it first", desk.said[-1])


if __name__ == "__main__":
    from unity_line import main
    main()
