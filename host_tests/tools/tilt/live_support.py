"""What the tests of the page of `tilt live` share: a board that talks as the firmware does, and the page that shows it."""
import contextlib
import pathlib
import tempfile
import threading
import time
import unittest

from laws import DEFAULT, LIGHT, PLAIN, ROBUST
from tilt import serving
from tilt.board import Board
from tilt.feed import Feed
from tilt.port import Port
from tilt.whole_page import WEB
from browser import Browser
from fake_board import BANNER, HEADER, FakeBoard, row

FILTERS = (DEFAULT, PLAIN, ROBUST, LIGHT)
PAGE_FILE = (WEB / serving.PAGE).as_uri()


class Talk:
    """A script for FakeBoard: banner, header, then `count` rows (None: no end) at rate_hz by their own times, `faster` times that by the
    clock, those of `left_out` not sent; answers `filter` and `help`. say(text) puts a line among the rows. After the first `first` rows
    it waits for `go_on`. `sent`: rows on the line so far; `over`: all are."""

    def __init__(self, rate_hz=100, count=None, left_out=frozenset(), flags=lambda number: 0, faster=1, first=None):
        self.faster, self.first, self.go_on = faster, first, threading.Event()
        self.rate_hz, self.count, self.left_out, self.flags = rate_hz, count, left_out, flags
        self.sent, self.said, self.filter, self.over = 0, [], DEFAULT, threading.Event()
        self.commands = []

    def say(self, text):
        self.said.append(text.encode("ascii") + b"\n")

    def __call__(self, board):
        board.send(BANNER + f"# filter {DEFAULT}, rate 100 Hz, range 16 g, every 1, baud 115200\n# settings: as saved\n".encode() + HEADER)
        began, number = time.monotonic(), 0
        while True:
            held = self.first is not None and not self.go_on.is_set()
            due = int((time.monotonic() - began) * self.rate_hz * self.faster)
            due = min(due, *(each for each in (self.count, self.first if held else None) if each is not None), 1 << 60)
            chosen = [each for each in range(number, due) if each not in self.left_out]
            board.send(b"".join(row(each, round(1e6 / self.rate_hz), self.flags(each)) for each in chosen))
            number, self.sent = due, self.sent + len(chosen)
            self.answer(board)
            if number == self.count:
                self.over.set()
            time.sleep(0.01)

    def answer(self, board):
        board.listen()
        *lines, board.typed = board.typed.split(b"\n")
        for line in lines:
            self.commands.append(line.decode("ascii"))
            board.send(self.reply(self.commands[-1]))
        while self.said:
            board.send(self.said.pop(0))

    def reply(self, command):
        name, _, value = command.partition(" ")
        if name == "filter" and value and value not in FILTERS:
            return f"# refused 4: filter is one of {' '.join(FILTERS)}; make flash FILTERS=NAME: elsewhere\n".encode("ascii")
        if name == "filter":
            self.filter = value or self.filter
            return f"# filter {self.filter}\n".encode("ascii")
        return b"# refused 1: unknown command (type help)\n"


@contextlib.contextmanager
def watched(talk):
    """(address of the page, fake board) of a talking board that is served."""
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        fake = stack.enter_context(FakeBoard(pathlib.Path(folder), talk))
        board = Board(Port(fake.name, 115200), Feed())
        server = serving.Server(board.feed, board)
        stack.callback(board.end)
        stack.callback(server.close)
        board.start()
        yield server, fake


class Case(unittest.TestCase):
    """One browser for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def opened(self, address, before=None, size=(1280, 900)):
        page = self.browser.open(address, before, size)
        self.addCleanup(self.browser.call, "Target.closeTarget", targetId=page.target)
        page.until("true")
        self.addCleanup(lambda: self.assertEqual(page.errors(), [], page.console()))
        return page
