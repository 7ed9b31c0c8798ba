"""Watches a board on a serial port for as long as needed and waits for it while it is unplugged."""
import json
import re
import threading

from serial.tools import list_ports

from tilt import protocol
from tilt.errors import TiltError
from tilt.feed import Lines
from tilt.port import Gone, Unreadable

AGAIN_S = 0.5
GATHER_S = 0.004  # fewer, longer reads: 400 bytes at 1000000 baud, a tenth of a terminal's buffer
BAUD_REPLY = re.compile(rb"^# baud (\d+)\r?$", re.M)  # the board's last line at the old rate
TEXT = re.compile(rb"[ -~\r\n]{8,}$")  # bytes read at a wrong rate may match a shorter pattern by chance
UNREADABLE_S = 1.5  # of bytes without one line of text
LONGEST_COMMAND = 40


def identity(device):
    """(vid, pid, serial number) of a USB port; None for any other port."""
    for port in list_ports.comports():
        if port.device == device and port.vid is not None:
            return port.vid, port.pid, port.serial_number
    return None


class Board:
    """Reads a tilt.port.Port into a tilt.feed.Feed, in its own thread: entries `lines` (bytes, whole lines), `state` (JSON: connected, port,
    baud, why) and `sent` (what was typed).

    recorder: a tilt.recorder.Recorder that gets the same bytes; if it can no longer write, `failed` says why and the view continues.
    The baud rate follows the board's reply to `baud N`. If the input is not text, because the board was reset or loaded its saved settings,
    the first rate is tried again, then the others. A port that returns starts at the first rate.
    """

    def __init__(self, port, feed, recorder=None):
        self.port, self.feed, self.recorder, self.failed = port, feed, recorder, None
        self._first_baud, self._identity = port.baud, None
        self._connected, self._writing, self._ending = False, threading.Lock(), threading.Event()
        self._lines, self._unreadable, self._to_try = Lines(), Unreadable(), self._all_bauds()
        self._thread = threading.Thread(target=self._run, name="board", daemon=True)

    def start(self):
        """Opens the port; TiltError if the first attempt fails."""
        self.port.open()
        self._identity = identity(self.port.name)
        self._report_state(True)
        self._thread.start()

    def end(self):
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join(3.0)
        self.port.close()
        self._record("finish")

    def send(self, text):
        """Types a command. TiltError if it cannot be a command or no board is connected."""
        if not 0 < len(text) <= LONGEST_COMMAND or not all(" " <= letter <= "~" for letter in text):
            raise TiltError(f"a command has 1 to {LONGEST_COMMAND} characters without accents")
        self._type(text + "\n")
        self.feed.put("sent", text)

    def send_piece(self, text):
        """Types part of a command, without a line end. TiltError if no board is connected."""
        self._type(text)

    def _type(self, text):
        with self._writing:
            if not self._connected:
                raise TiltError(f"{self.port.name}: not connected")
            try:
                self.port.send_bytes(text.encode("ascii", "replace"))
            except Gone as why:
                raise TiltError(f"{self.port.name}: {why}") from why

    def _report_state(self, connected, why=""):
        self._connected = connected
        self.feed.put("state", json.dumps({"connected": connected, "port": self.port.name, "baud": self.port.baud, "why": why}))

    def _record(self, action, *data):
        if self.recorder is None or self.failed is not None:
            return
        try:
            getattr(self.recorder, action)(*data)
        except TiltError as why:
            self.failed = str(why)
            self.feed.put("problem", f"the recording has ended: {why}")

    def _run(self):
        while not self._ending.is_set():
            try:
                self._read()
            except Gone as why:
                with self._writing:
                    self.port.baud_at_next_opening(self._first_baud)
                    self._report_state(False, str(why))
                self._record("outage")
                self._wait_for_it()

    def _read(self):
        """Reads until end() or Gone."""
        self._begin()
        while not self._ending.is_set():
            data = self.port.read()
            if not data:
                continue
            self._record("feed", data)
            whole = self._lines.cut(data)
            if whole:
                self.feed.put("lines", whole)
            self._follow_baud(whole, len(data))
            self._ending.wait(GATHER_S)

    def _begin(self):
        """Resets the line state, as when the port has just been opened: the first line may be partial."""
        self._lines, self._unreadable = Lines(), Unreadable()

    def _follow_baud(self, whole, count):
        rates, readable = BAUD_REPLY.findall(whole), TEXT.match(whole) is not None
        lasts_s = self._unreadable.lasts_s(count, readable)
        if readable:
            self._to_try = self._all_bauds()
        if rates:
            self._change_baud(int(rates[-1]))
        elif lasts_s > UNREADABLE_S:
            self._to_try = self._to_try or self._all_bauds()
            self._change_baud(self._to_try.pop(0))

    def _all_bauds(self):
        return [self._first_baud] + sorted(set(protocol.BAUDS) - {self._first_baud}, reverse=True)

    def _change_baud(self, baud):
        if baud != self.port.baud:
            self.port.baud = baud
            self._record("join")
            self._report_state(True)
            self._begin()

    def _wait_for_it(self):
        while not self._ending.wait(AGAIN_S):
            with self._writing:
                self.port.name = self._where_now()
                if self.port.come_back():
                    self._report_state(True)
                    return

    def _where_now(self):
        """The same port, or the one where the same USB device returned: the kernel may renumber it."""
        if self._identity is None or identity(self.port.name) == self._identity:
            return self.port.name
        return next((port.device for port in list_ports.comports() if identity(port.device) == self._identity), self.port.name)
