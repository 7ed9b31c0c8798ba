"""What comes from a board, kept for a while for those who watch: whole lines, changes of the connection, what was typed, in one order."""
import collections
import itertools
import threading

KEPT_BYTES = 1 << 20  # 39 s of 400 of the longest rows a second: a page that was away gets them all, one that opens late in an instant


class Feed:
    """Entries (number, kind, data), numbered from 1. Written by one thread, read by any number, each at its own pace."""

    def __init__(self, kept_bytes=KEPT_BYTES):
        self._entries = collections.deque()
        self._bytes, self._kept_bytes = 0, kept_bytes
        self._number = 0
        self._state = None
        self._changed = threading.Condition()

    def put(self, kind, data):
        """Adds an entry; the oldest go when more than kept_bytes would be kept. The newest entry of kind `state` never goes."""
        with self._changed:
            self._number += 1
            entry = (self._number, kind, data)
            if kind == "state":
                self._state = entry
            self._entries.append(entry)
            self._bytes += len(data)
            while self._bytes > self._kept_bytes and len(self._entries) > 1:
                self._bytes -= len(self._entries.popleft()[2])
            self._changed.notify_all()

    def after(self, number, timeout_s):
        """(entries later than `number`, how many of them are no longer kept); waits for one until the time is over. Whoever begins (number
        0) and is too late for the newest `state` gets it first, and what was before that one's time is not called missed."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > number, timeout_s)
            first = self._entries[0][0] if self._entries else 1
            entries = list(itertools.takewhile(lambda entry: entry[0] > number, reversed(self._entries)))[::-1]
            missed = max(0, first - 1 - number)
            if missed and self._state is not None and number < self._state[0] < first:
                entries.insert(0, self._state)
            return entries, missed if number else 0


class Lines:
    """Bytes as they come from a port -> whole lines. What stands before the first line end is a piece of a line, and dropped, unless it
    begins as a line of a banner does; so is a line that never ends."""

    LONGEST = 4096

    def __init__(self):
        self._rest, self._joined = b"", False

    def cut(self, data):
        """The whole lines in what was left and these bytes, line ends (LF) included."""
        whole, end, rest = (self._rest + data).rpartition(b"\n")
        self._rest = rest if len(rest) <= self.LONGEST else b""
        lines = whole + end
        if lines and not self._joined:
            self._joined = True
            first, end, others = lines.partition(b"\n")
            lines = lines if first.startswith(b"#") else others
        return lines
