"""The person at the terminal."""
import os
import queue
import sys
import threading

from tilt.errors import TiltError
from tilt.realboard.bench import Quit


class Owner:
    """typed() is a line, or None while there is none; Quit when the terminal is gone. A thread reads it, because no other way to wait for a key
    with a deadline works on Windows too; by file number, because a thread that waits in sys.stdin holds a lock that Python needs when it
    exits."""

    def __init__(self, terminal=None, out=None):
        terminal, self.out = terminal or sys.stdin, out or sys.stdout
        if not terminal.isatty():
            raise TiltError("stdin is not a terminal: run it by hand, without a pipe or < FILE")
        self.lines = queue.Queue()
        threading.Thread(target=self.read, args=(terminal.fileno(),), name="owner", daemon=True).start()

    def read(self, number):
        rest = b""
        try:
            while data := os.read(number, 1024):
                *whole, rest = (rest + data).split(b"\n")
                for line in whole:
                    self.lines.put(line.decode("utf-8", "replace").rstrip("\r"))
        except OSError:
            pass  # the terminal was closed
        self.lines.put(None)

    def typed(self):
        try:
            line = self.lines.get_nowait()
        except queue.Empty:
            return None
        if line is None:
            self.lines.put(None)  # for the next call
            raise Quit
        return line

    def say(self, text):
        print(text, file=self.out, flush=True)

    def prompt(self, text):
        print(text, end="", file=self.out, flush=True)
