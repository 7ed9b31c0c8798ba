"""What a judge works with: the board's lines, each with its time of arrival, and the owner, who may skip, repeat or quit at any time. Every
wait has a deadline except for an answer of the owner; the line is read meanwhile."""
import collections
import json
import re
import time
from typing import NamedTuple, Optional

from tilt import protocol
from tilt.errors import TiltError

LOOK_S = 0.1        # longest delay until a key of the owner is seen
LINES_KEPT, ROWS_KEPT = 40, 20  # for the record: rows would fill it within half a second
LETTERS_KEPT = 160  # of each line
SAID_KEPT = 1000    # lines kept while the owner is asked something


class Seen(NamedTuple):
    """kind: row, said (a line that begins with #), header, strange (none of these), gone and back (the port)."""
    at_s: float
    kind: str
    text: str
    row: Optional[protocol.Row] = None


class Failed(Exception):
    """The check has failed; the text is the reason."""


class Skip(Exception):
    """The owner skips the check; the text is the reason."""


class Repeat(Exception):
    """The owner repeats the check from its beginning."""


class Quit(Exception):
    """The owner quits, or is no longer there."""


def seen_of(at_s, text):
    """The Seen of a line without its line end."""
    if text.startswith("#"):
        return Seen(at_s, "said", text)
    if protocol.is_header(text):
        return Seen(at_s, "header", text)
    try:
        return Seen(at_s, "row", text, protocol.row_of(text))
    except ValueError:
        return Seen(at_s, "strange", text)


def matters(seen):
    return seen.kind != "row" or bool(seen.row.flags & protocol.NO_SAMPLE)


class Wire:
    """The line of a tilt.board.Board: take() returns input, send() types."""

    def __init__(self, board):
        self.board, self._number = board, 0

    @staticmethod
    def now():
        return time.monotonic()

    @property
    def baud(self):
        return self.board.port.baud

    def send(self, text):
        self.board.send(text)

    def send_piece(self, text):
        self.board.send_piece(text)

    def take(self, timeout_s):
        entries, _ = self.board.feed.after(self._number, timeout_s)
        at_s, found = self.now(), []
        for self._number, kind, data in entries:
            if kind == "lines":
                found += [seen_of(at_s, line.rstrip("\r")) for line in data.decode("latin-1").split("\n") if line.strip()]
            elif kind == "state":
                state = json.loads(data)
                text = f"port {state['port']}, {state['baud']} baud {state['why']}".strip()
                found.append(Seen(at_s, "back" if state["connected"] else "gone", text))
        return found


class Bench:
    """next() is the only access to input.

    numbers: what the judge has measured so far; lines: the last raw ones of the check; limit_s: time limit of each wait; settings: name -> value
    as the board had them at the beginning; deaf: the owner is not heard, while the board is met and while settings are restored."""

    def __init__(self, wire, owner):
        self.wire, self.owner = wire, owner
        self.now, self.waiting = wire.now, collections.deque()
        self.settings = {}
        self.deaf = False
        self.begin(60.0)

    def begin(self, limit_s):
        """Resets the state at the beginning of a check."""
        self.limit_s, self.numbers, self.count = limit_s, {}, 0
        self.kept = {"row": collections.deque(maxlen=ROWS_KEPT), "other": collections.deque(maxlen=LINES_KEPT)}

    @property
    def lines(self):
        """The last lines seen, in order: some rows and, more of them, other lines."""
        return [text for _, text in sorted([*self.kept["row"], *self.kept["other"]])]

    def measured(self, **numbers):
        self.numbers.update(numbers)

    def next(self, until_s):
        """The next thing seen, None after the timeout. Raises what the owner wants."""
        while True:
            if not self.deaf:
                self.heed(self.owner.typed())
            if self.waiting and self.waiting[0].at_s <= until_s:
                return self.waiting.popleft()
            left_s = until_s - self.now()
            if left_s <= 0:
                return None
            self.fill(min(left_s, LOOK_S))

    def events(self, limit_s):
        """Everything seen within the time."""
        until_s = self.now() + limit_s
        while (seen := self.next(until_s)) is not None:
            yield seen

    def fill(self, timeout_s):
        for seen in self.wire.take(timeout_s):
            self.waiting.append(seen)
            mark = f"[{seen.text}]" if seen.kind in ("gone", "back") else seen.text
            self.count += 1
            kept = self.kept["row" if seen.kind == "row" else "other"]
            kept.append((self.count, re.sub(r"[^ -~]", "?", mark[:LETTERS_KEPT])))

    def put_back(self, seen):
        """Returns the thing seen to the queue, for the next reader."""
        self.waiting.appendleft(seen)

    def forget(self):
        """Drops input that arrived while no judge was reading."""
        self.fill(0.0)
        self.waiting.clear()

    def type(self, text, piece=False):
        """Types text; Failed if no board is connected."""
        try:
            (self.wire.send_piece if piece else self.wire.send)(text)
        except TiltError as why:
            raise Failed(f"'{text.strip()}' could not be typed: {why}") from why

    def say(self, text):
        self.owner.say(text)

    def heed(self, typed):
        """Acts on s, r and q, whenever they are typed."""
        word, _, reason = (typed or "").strip().partition(" ")
        if word == "s":
            raise Skip(reason.strip() or self.reason())
        if word == "r":
            raise Repeat
        if word == "q":
            raise Quit

    def reason(self):
        reason = ""
        while not reason:
            reason = self.line("   Why is it skipped? ").strip()
        return reason

    def line(self, prompt):
        """What the owner types. Meanwhile input is kept, for the owner may act before answering; of the rows only those without a sample are
        kept, for the owner may be away for long."""
        self.owner.prompt(prompt)
        while (typed := self.owner.typed()) is None:
            self.fill(LOOK_S)
            self.waiting = collections.deque(filter(matters, self.waiting), maxlen=SAID_KEPT)
        self.waiting = collections.deque(self.waiting)
        return typed

    def ask(self, question):
        """A yes-or-no question about what only a person can see."""
        while True:
            typed = self.line(f"   {question} (y/n) ")
            self.heed(typed)
            if typed.strip().lower() in ("y", "yes", "n", "no"):
                return typed.strip().lower().startswith("y")
