"""Tests of the server's side of `tilt live` (tools/tilt/feed.py, board.py, serving.py, commands/live.py): who gets what, in which order, what
is refused, a board that goes and comes. Run from the repository root with build/venv/bin/python."""
import contextlib
import http.client
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import termios
import time
import unittest
from types import SimpleNamespace
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import PLAIN  # noqa: E402
from tilt import board as board_module  # noqa: E402
from tilt import cli, serving, stream  # noqa: E402
from tilt.commands import live  # noqa: E402
from tilt.board import Board  # noqa: E402
from tilt.errors import TiltError  # noqa: E402
from tilt.feed import Feed, Lines  # noqa: E402
from tilt.port import Port  # noqa: E402
from tilt.whole_page import whole  # noqa: E402
from fake_board import BANNER, DEADLINE_S, HEADER, FakeBoard, row, rows, until  # noqa: E402


class Watched:
    """A board in a feed, as `tilt live` has it."""

    def __init__(self, name, baud=115200, recorder=None):
        self.feed = Feed()
        self.board = Board(Port(name, baud), self.feed, recorder)

    def __enter__(self):
        self.board.start()
        return self

    def __exit__(self, *_):
        self.board.end()

    def got(self, kind):
        return [data for _, each, data in self.feed.after(0, 0)[0] if each == kind]

    def lines(self):
        return b"".join(self.got("lines"))

    def states(self):
        return [json.loads(text) for text in self.got("state")]

    def baud(self):
        """None while nothing is known of the port."""
        states = self.states()
        return states[-1]["baud"] if states else None


class TestFeed(unittest.TestCase):
    def test_each_reader_gets_all_in_order_at_its_own_pace(self):
        feed = Feed()
        feed.put("lines", b"a\n")
        self.assertEqual(feed.after(0, 0), ([(1, "lines", b"a\n")], 0))
        feed.put("sent", "go")
        self.assertEqual(feed.after(1, 0), ([(2, "sent", "go")], 0))
        self.assertEqual([number for number, _, _ in feed.after(0, 0)[0]], [1, 2])
        self.assertEqual(feed.after(2, 0), ([], 0))

    def test_what_is_no_longer_kept_is_told_to_who_was_away_not_to_who_begins(self):
        feed = Feed(kept_bytes=100)
        feed.put("state", "s")
        for number in range(10):
            feed.put("lines", b"%030d" % number)  # three of 30 bytes fit into 100: entries 9, 10 and 11
        entries, missed = feed.after(2, 0)
        self.assertEqual([number for number, _, _ in entries], [9, 10, 11])
        self.assertEqual(missed, 6)  # 3 to 8
        entries, missed = feed.after(0, 0)
        self.assertEqual([number for number, _, _ in entries], [1, 9, 10, 11])  # the state first, which the page must have
        self.assertEqual(missed, 0)
        self.assertEqual(feed.after(8, 0)[1], 0)

    def test_lines_are_whole(self):
        lines = Lines()
        self.assertEqual(lines.cut(b"5,6\n1,2\n3"), b"1,2\n")  # the first is a piece
        self.assertEqual(lines.cut(b",4"), b"")
        self.assertEqual(lines.cut(b"\n"), b"3,4\n")
        self.assertEqual(Lines().cut(b"# a\n1\n"), b"# a\n1\n")
        lines = Lines()
        lines.cut(b"\n" + b"x" * (Lines.LONGEST + 1))
        self.assertEqual(lines.cut(b"\ny\n"), b"\ny\n")  # what never ended has gone


class TestServer(unittest.TestCase):
    def setUp(self):
        self.typed = []
        self.feed = Feed()
        self.server = serving.Server(self.feed, SimpleNamespace(send=self.send))
        self.addCleanup(self.server.close)

    def send(self, text):
        if text == "bad":
            raise TiltError("not connected")
        self.typed.append(text)

    def ask(self, method, path, body=None, **headers):
        link = http.client.HTTPConnection("127.0.0.1", self.server.server_port, timeout=DEADLINE_S)
        self.addCleanup(link.close)
        link.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
        return link.getresponse()

    def post(self, body, token=None, **headers):
        return self.ask("POST", "/send", body, X_Tilt_Token=self.server.token if token is None else token, **headers)

    def test_page_is_the_file_and_may_load_nothing(self):
        answer = self.ask("GET", "/")
        self.assertEqual(answer.status, 200)
        page = answer.read().decode("utf-8")
        self.assertEqual(page, whole(serving.PAGE))
        self.assertEqual(answer.headers["X-Frame-Options"], "DENY")
        self.assertIn("default-src 'none'", page)
        outside = re.findall(r"""(?:https?:)?//[a-z0-9.-]+\.[a-z]+|(?:src|href|url|import)\s*[=(]\s*["']?(?!data:|#)[^"')> ]+""", page)
        self.assertEqual([each for each in outside if each != "url(#round"], [])

    def test_only_this_machine_is_served(self):
        self.assertEqual(self.server.server_address[0], "127.0.0.1")

    def test_command_goes_to_the_board(self):
        self.assertEqual(self.post(f"filter {PLAIN}").status, 204)
        self.assertEqual(self.typed, [f"filter {PLAIN}"])

    def test_others_are_refused_and_type_nothing(self):
        port, token = self.server.server_port, self.server.token
        for answer in (self.post("go", token=""), self.post("go", token="x" * len(token)), self.post("go", token="\u00e9"),
                       self.post("go", Host=f"evil.example:{port}"), self.post("go", Host="127.0.0.1"),
                       self.post("go", Origin="http://evil.example"), self.post("go", Origin="null"),
                       self.ask("GET", "/events"), self.ask("GET", "/events?token=guess"), self.ask("GET", "/", Host="evil.example"),
                       self.ask("POST", "/send?token=" + token, "go")):
            self.assertEqual(answer.status, 403)
        self.assertEqual(self.typed, [])
        self.assertEqual(self.post("go", Origin=f"http://127.0.0.1:{port}").status, 204)
        self.assertEqual(self.post("go", Host=f"localhost:{port}").status, 204)

    def test_what_is_wrong_is_said(self):
        self.assertEqual(self.ask("GET", "/etc/passwd").status, 404)
        self.assertEqual(self.ask("GET", "/../../README.md").status, 404)
        self.assertEqual(self.post("x" * 201).status, 413)
        answer = self.post("bad")
        self.assertEqual((answer.status, answer.read()), (409, b"not connected"))
        self.assertEqual(self.ask("PUT", "/send", "x").status, 501)

    def test_tokens_differ(self):
        other = serving.Server(Feed(), None)
        self.addCleanup(other.close)
        self.assertNotEqual(other.token, self.server.token)
        self.assertGreaterEqual(len(self.server.token), 24)  # 18 random bytes

    def events(self, number=None, count=1):
        headers = {} if number is None else {"Last_Event_ID": str(number)}
        answer = self.ask("GET", f"/events?token={self.server.token}", **headers)
        self.assertEqual((answer.status, answer.headers["Content-Type"]), (200, "text/event-stream"))
        found, end = [], time.monotonic() + DEADLINE_S
        while len(found) < count:
            self.assertLess(time.monotonic(), end, found)
            fields = dict(line.decode().rstrip("\n").split(": ", 1) for line in iter(answer.readline, b"\n") if b": " in line)
            if "data" in fields:
                found.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))
        return found

    def test_events_join_lines_and_go_on_where_the_browser_was(self):
        self.feed.put("state", "up")
        self.feed.put("lines", b"1,2\n")
        self.feed.put("lines", b"\xff\n")  # noise on the line is no reason to stop
        self.feed.put("sent", "go")
        self.assertEqual(self.events(count=3), [(1, "state", "up"), (3, "lines", "1,2\n\u00ff\n"), (4, "sent", "go")])
        self.assertEqual(self.events(number=3), [(4, "sent", "go")])

    def test_who_was_away_too_long_is_told(self):
        self.server.feed = feed = Feed(kept_bytes=10)
        for _ in range(5):
            feed.put("lines", b"12345678\n")
        self.assertEqual(self.events(number=1, count=2), [(5, "missed", 3), (5, "lines", "12345678\n")])

    def test_the_end_is_told(self):
        other = serving.Server(Feed(), None)
        other.close()
        self.assertEqual(other.feed.after(0, 0)[0][-1][1], "ended")

    def test_taken_port_is_said(self):
        with self.assertRaisesRegex(TiltError, f"127.0.0.1:{self.server.server_port}: .*--port-http"):
            serving.Server(Feed(), None, self.server.server_port)
        with self.assertRaisesRegex(TiltError, "--port-http"):
            serving.Server(Feed(), None, 70000)


class TestBoard(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_all_lines_come_and_commands_go(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 200))
            board.heard(f"filter {PLAIN}\n".encode())
            board.send(f"# filter {PLAIN}\n".encode())

        with FakeBoard(self.folder, script) as fake, Watched(fake.name) as watched:
            until(lambda: watched.lines().count(b"\n") >= 200)
            watched.board.send(f"filter {PLAIN}")
            until(lambda: f"# filter {PLAIN}".encode() in watched.lines())
            self.assertEqual(watched.lines().lstrip(), (BANNER + HEADER + rows(0, 200) + f"# filter {PLAIN}\n".encode()).lstrip())
            self.assertEqual(watched.got("sent"), [f"filter {PLAIN}"])
            for wrong in ("", "x" * 41, "a\nb", "gr\u00fcn"):
                with self.assertRaisesRegex(TiltError, "1 to 40 characters"):
                    watched.board.send(wrong)

    def test_unplugged_is_told_and_waited_for(self):
        def script(board):
            board.send(HEADER + rows(0, 20) + b"123,")
            until(lambda: rows(19, 20) in self.watched.lines())
            board.unplug()
            until(lambda: not self.watched.states()[-1]["connected"])
            board.plug()
            board.opened(2)
            board.send(BANNER + HEADER + rows(0, 3))

        with FakeBoard(self.folder, script) as fake:
            self.watched = Watched(fake.name)
            with self.watched as watched:
                until(lambda: watched.lines().endswith(rows(0, 3)))
                self.assertEqual([state["connected"] for state in watched.states()], [True, False, True])
                self.assertTrue(watched.states()[1]["why"])
                self.assertNotIn(b"123,#", watched.lines().replace(b"\n", b""))  # half a row does not run into what came later

    def test_not_connected_is_an_answer(self):
        def script(board):
            board.send(HEADER + rows(0, 2))
            board.unplug()

        with FakeBoard(self.folder, script) as fake, Watched(fake.name) as watched:
            until(lambda: not watched.states()[-1]["connected"])
            with self.assertRaisesRegex(TiltError, "not connected"):
                watched.board.send("go")
            self.assertEqual(watched.got("sent"), [])

    def test_rate_of_the_line_follows_and_goes_back(self):
        def script(board):
            board.send(HEADER + rows(0, 5))
            board.heard(b"baud 500000\n")
            board.send(b"# baud 500000\n")
            board.speed = termios.B500000
            until(lambda: self.watched.baud() == 500000)
            board.send(row(5)[3:] + rows(6, 40))
            until(lambda: rows(39, 40) in self.watched.lines())
            board.speed = termios.B115200  # it was reset
            while self.watched.baud() != 115200:
                board.send(rows(0, 5))
                time.sleep(0.02)
            board.send(b"\n" + BANNER + HEADER + rows(0, 3))

        with FakeBoard(self.folder, script, termios.B115200) as fake:
            self.watched = Watched(fake.name)
            with self.watched as watched, mock.patch.object(board_module, "UNREADABLE_S", 0.1):
                until(lambda: rows(4, 5) in watched.lines())
                watched.board.send("baud 500000")
                until(lambda: watched.lines().endswith(HEADER + rows(0, 3)))
                self.assertIn(b"# baud 500000\n" + rows(6, 40), watched.lines())  # the first line after the change is a piece
                self.assertEqual([state["baud"] for state in watched.states()], [115200, 500000, 115200])

    def test_rate_that_the_board_has_saved_is_found(self):
        def script(board):
            while self.watched.baud() != 9600:
                board.send(rows(0, 5))
                time.sleep(0.01)
            board.send(b"\n" + HEADER + rows(0, 3))

        with FakeBoard(self.folder, script, termios.B9600) as fake, mock.patch.object(board_module, "UNREADABLE_S", 0.2):
            self.watched = Watched(fake.name)
            with self.watched as watched:
                until(lambda: watched.lines().endswith(HEADER + rows(0, 3)))
                self.assertEqual([state["baud"] for state in watched.states()], [115200, 1000000, 500000, 250000, 57600, 38400, 19200, 9600])

    def test_board_that_comes_back_under_another_name_is_found(self):
        def usb(device, serial_number):
            return SimpleNamespace(device=device, vid=0x2341, pid=0x43, serial_number=serial_number)

        board = Board(Port("/dev/ttyACM0", 115200), Feed())
        here = [usb("/dev/ttyACM0", "mine")]
        with mock.patch.object(board_module.list_ports, "comports", lambda: here):
            board._identity = board_module.identity("/dev/ttyACM0")
            self.assertEqual(board._where_now(), "/dev/ttyACM0")
            here[:] = [usb("/dev/ttyACM0", "another's"), usb("/dev/ttyACM1", "mine")]
            self.assertEqual(board._where_now(), "/dev/ttyACM1")
            here[:] = [usb("/dev/ttyACM0", "another's")]
            self.assertEqual(board._where_now(), "/dev/ttyACM0")  # nowhere yet: asked for again in a while

    def test_port_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(TiltError, r"/dev/no_such_port: .*No such file"):
            Watched("/dev/no_such_port").board.start()


class TestCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def live(self, *words):
        program = subprocess.Popen([sys.executable, "-m", "tilt", "live", *map(str, words), "--no-browser"], stdout=subprocess.PIPE, text=True,
                                   stderr=subprocess.PIPE, env={**os.environ, "PYTHONPATH": "tools", "PYTHONDONTWRITEBYTECODE": "1"})
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        return program

    def test_records_what_comes_until_it_is_ended(self):
        path = self.folder / "recorded.csv"
        for number in (signal.SIGINT, signal.SIGTERM):
            path.unlink(missing_ok=True)
            with FakeBoard(self.folder, lambda board: None) as fake:
                program = self.live(fake.name, "--record", path)
                self.assertRegex(program.stdout.readline(), r"^http://127\.0\.0\.1:\d+/#[\w-]{24}\n$")
                fake.openings = 1
                fake.send(BANNER + HEADER + rows(0, 300) + row(300)[:9])
                until(lambda: path.exists() and rows(299, 300) in path.read_bytes())
                program.send_signal(number)
                _, said = program.communicate(timeout=DEADLINE_S)
                self.assertEqual(program.returncode, 0, said)
            self.assertIn("300 rows", said)
            recorded = stream.read(str(path))
            self.assertEqual(len(recorded.t_us), 300)  # half a row is none
            self.assertEqual(recorded.lsb[:3].tolist(), [[0, 2, 256], [1, 2, 256], [2, 2, 256]])

    def test_what_cannot_be_is_refused_with_the_place_and_leaves_nothing(self):
        there = self.folder / "there.csv"
        there.write_text("mine", encoding="ascii")
        for words, said in (([self.folder / "port", "--record", there], "there.csv: exists already"),
                            ([self.folder / "no_port", "--record", self.folder / "new.csv"], "no_port: No such file"),
                            ([self.folder / "no_port", "--record", self.folder / "no" / "new.csv"], "no folder")):
            program = self.live(*words)
            self.assertIn(said, program.communicate(timeout=DEADLINE_S)[1])
            self.assertEqual(program.returncode, 2)
        self.assertEqual(there.read_text(encoding="ascii"), "mine")
        self.assertFalse((self.folder / "new.csv").exists())

    def test_full_disk_ends_the_recording_not_the_view(self):
        class Full:
            counts = None

            def feed(self, _):
                raise TiltError("full.csv: No space left on device")

            def finish(self):
                raise AssertionError("asked again")

        with FakeBoard(self.folder, lambda board: board.send(HEADER + rows(0, 50))) as fake:
            with Watched(fake.name, recorder=Full()) as watched:
                until(lambda: rows(49, 50) in watched.lines())
                self.assertEqual(watched.got("problem"), ["the recording has ended: full.csv: No space left on device"])
        self.assertIn("No space", watched.board.failed)

    def test_browser_is_opened_unless_told_not_to(self):
        with mock.patch.object(live.webbrowser, "open", return_value=True) as opened, contextlib.redirect_stdout(io.StringIO()) as out:
            live.show("http://127.0.0.1:1/#a", True)
            opened.assert_not_called()
            live.show("http://127.0.0.1:1/#a", False)
            opened.assert_called_once_with("http://127.0.0.1:1/#a")
        self.assertEqual(out.getvalue(), "http://127.0.0.1:1/#a\n" * 2)

    def test_command_is_found(self):
        self.assertIn("live", cli.modules())


if __name__ == "__main__":
    from unity_line import main
    main()
