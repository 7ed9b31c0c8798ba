"""A buffer of what a board sends, for its viewers: whole lines, connection changes and typed commands, in one order."""
import collections
import itertools
import threading

KEPT_BYTES = 1 << 20  # 39 s of the longest rows at 400/s: a page that was away catches up; one that opens late loads at once


class Feed:
    """Entries (number, kind, data), numbered from 1. One thread writes; any number of threads read, each at its own pace."""

    def __init__(self, kept_bytes=KEPT_BYTES):
        self._entries = collections.deque()
        self._bytes, self._kept_bytes = 0, kept_bytes
        self._number = 0
        self._state = None
        self._changed = threading.Condition()

    def put(self, kind, data):
        """Adds an entry; drops the oldest above kept_bytes. The newest entry of kind `state` is always kept."""
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
        """(entries later than `number`, how many of those were dropped); waits for one until the timeout. A new reader (number 0) that
        missed the newest `state` gets it first; entries older than that state do not count as missed."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > number, timeout_s)
            first = self._entries[0][0] if self._entries else 1
            entries = list(itertools.takewhile(lambda entry: entry[0] > number, reversed(self._entries)))[::-1]
            missed = max(0, first - 1 - number)
            if missed and self._state is not None and number < self._state[0] < first:
                entries.insert(0, self._state)
            return entries, missed if number else 0


class Lines:
    """Bytes from a port -> whole lines. Text before the first line end is a partial line and dropped, unless it begins as a banner
    line does; so is a line that never ends."""

    LONGEST = 4096

    def __init__(self):
        self._rest, self._joined = b"", False

    def cut(self, data):
        """The whole lines in the rest and these bytes, line ends (LF) included."""
        whole, end, rest = (self._rest + data).rpartition(b"\n")
        self._rest = rest if len(rest) <= self.LONGEST else b""
        lines = whole + end
        if lines and not self._joined:
            self._joined = True
            first, end, others = lines.partition(b"\n")
            lines = lines if first.startswith(b"#") else others
        return lines
