"""A board on a serial port, read by a thread of its own for as long as it takes: unplugged, it is waited for."""
import json
import re
import threading

import serial
from serial.tools import list_ports

from tilt.errors import TiltError
from tilt.feed import Lines

READ_S, AGAIN_S, WRITE_S = 0.1, 0.5, 1.0
GATHER_S = 0.004  # fewer and longer pieces: 400 bytes at 1000000 baud, a tenth of what a terminal holds
BAUD_REPLY = re.compile(rb"^# baud (\d+)$", re.M)  # the board's last line at the old rate
LONGEST_COMMAND = 32


def reason_of(error):
    """What an operating system said, without what pyserial wraps around it."""
    words = str(error)
    named = re.search(r"\[Errno \d+\] ([^:'\"]+)", words)
    return named.group(1).strip() if named else words


def ports_there():
    return ", ".join(sorted(port.device for port in list_ports.comports())) or "none"


def identity(device):
    """(vid, pid, serial number) of a USB port, None of another one."""
    for port in list_ports.comports():
        if port.device == device and port.vid is not None:
            return port.vid, port.pid, port.serial_number
    return None


class Board:
    """Reads `device` into `feed`: entries `lines` (whole lines), `state` (JSON: connected, port, baud, why) and `sent` (what was typed).

    `watch(lines)` is called with the same lines, in the reader's thread. The line rate follows the board's own reply to `baud N`, and
    goes back to the first one where the port comes back, since the board has been reset by then.
    """

    def __init__(self, device, baud, feed, watch=None):
        self.device, self.first_baud, self.feed = device, baud, feed
        self._watch = watch or (lambda lines: None)
        self._port, self._writing = None, threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._read, name="board", daemon=True)
        self._identity = None

    def start(self):
        """Opens the port; TiltError when that does not work the first time."""
        try:
            self._open(self.device)
        except (serial.SerialException, OSError, ValueError) as error:
            raise TiltError(f"{self.device}: {reason_of(error)} (ports here: {ports_there()})") from error
        self._identity = identity(self.device)
        self._thread.start()

    def end(self):
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join(2.0)
        self._close()

    def send(self, text):
        """Types a command. TiltError when it cannot be one, or when there is no board."""
        if not 0 < len(text) <= LONGEST_COMMAND or not all(" " <= c <= "~" for c in text):
            raise TiltError(f"a command has 1 to {LONGEST_COMMAND} printable characters")
        with self._writing:
            if self._port is None:
                raise TiltError(f"{self.device}: not connected")
            try:
                self._port.write(text.encode("ascii") + b"\n")
            except (serial.SerialException, OSError) as error:
                raise TiltError(f"{self.device}: {reason_of(error)}") from error
        self.feed.put("sent", text)

    def _open(self, device):
        port = serial.Serial(device, self.first_baud, timeout=READ_S, write_timeout=WRITE_S)
        with self._writing:
            self.device, self._port = device, port
        self._tell(True)

    def _close(self):
        with self._writing:
            port, self._port = self._port, None
        if port is not None:
            try:
                port.close()
            except (serial.SerialException, OSError):
                pass  # it has gone by itself

    def _tell(self, connected, why=""):
        baud = self._port.baudrate if self._port is not None else self.first_baud
        self.feed.put("state", json.dumps({"connected": connected, "port": self.device, "baud": baud, "why": why}))

    def _read(self):
        while not self._ending.is_set():
            try:
                self._read_port()
            except (serial.SerialException, OSError, TypeError, AttributeError) as error:  # pyserial on a port closed under it
                if self._ending.is_set():
                    return
                self._close()
                self._tell(False, reason_of(error))
                self._wait_for_it()

    def _read_port(self):
        lines = Lines()
        while not self._ending.is_set():
            data = self._port.read(1)
            if not data:
                continue
            self._ending.wait(GATHER_S)
            data += self._port.read(self._port.in_waiting)
            whole = lines.cut(data)
            if whole:
                self.feed.put("lines", whole)
                self._watch(whole)
                self._follow_baud(whole)

    def _follow_baud(self, whole):
        told = BAUD_REPLY.findall(whole.replace(b"\r", b""))
        if told and int(told[-1]) != self._port.baudrate:
            self._port.baudrate = int(told[-1])
            self._tell(True)

    def _wait_for_it(self):
        while not self._ending.wait(AGAIN_S):
            try:
                return self._open(self._where_now())
            except (serial.SerialException, OSError, ValueError):
                continue
        return None

    def _where_now(self):
        """The same place, or where the same USB device has come back: the kernel may number it anew."""
        if self._identity is None or identity(self.device) == self._identity:
            return self.device
        return next((port.device for port in list_ports.comports() if identity(port.device) == self._identity), self.device)


class Recorder:
    """Writes lines to a new file, at once, so that it is a stream (docs/protocol.md): joined late, it begins with the header that the
    board had sent before; a line that is none of the protocol's is kept as a comment."""

    HEADER = b"t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags"
    ROW = re.compile(rb"-?\d+(,-?\d+)*$")

    def __init__(self, path):
        try:
            self._file = open(path, "xb", buffering=0)
        except OSError as error:
            raise TiltError(f"{path}: {error.strerror}") from error
        self.path, self.rows, self.kept_aside = path, 0, 0
        self._fields = None
        self.failed = None

    def take(self, lines):
        """Never raises: a full disk ends the recording, not the view; `failed` says why."""
        if self.failed is not None:
            return
        try:
            self._file.write(b"".join(self._line(line.rstrip(b"\r")) for line in lines.splitlines()))
        except OSError as error:
            self.failed = f"{self.path}: {error.strerror}: recording ended after {self.rows} rows"

    def _line(self, line):
        if line.startswith(b"t_us,"):
            self._fields = line.count(b",")
        elif self.ROW.match(line):
            head = b"" if self._fields is not None else self.HEADER + b"\n"
            self._fields = self.HEADER.count(b",") if self._fields is None else self._fields
            if line.count(b",") == self._fields:
                self.rows += 1
                return head + line + b"\n"
            self.kept_aside += 1
            return head + b"# not a row: " + line + b"\n"
        elif line and not line.startswith(b"#"):
            self.kept_aside += 1
            return b"# not a row: " + line + b"\n"
        return line + b"\n"

    def close(self):
        self._file.close()
