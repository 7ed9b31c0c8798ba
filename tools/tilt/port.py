"""A serial port that may vanish and return."""
import errno
import os
import time

import serial
from serial.tools import list_ports

from tilt.errors import TiltError

READ_WAIT_S = 0.1
DTR_LOW_S = 0.1  # lets the capacitor between DTR and the UNO's reset discharge


class Gone(Exception):
    """The port has vanished."""


class Unreadable:
    """A run of bytes without readable text: a wrong baud rate. Silence or a partial line does not count, however late the rest arrives."""

    LEAST_BYTES = 256  # more than three rows

    def __init__(self):
        self.since, self.count = None, 0

    def lasts_s(self, count, understood):
        """Seconds of unreadable bytes so far, these included; 0 while there are too few to judge."""
        if understood:
            self.since, self.count = None, 0
        elif count:
            self.since = self.since if self.count else time.monotonic()
            self.count += count
        return time.monotonic() - self.since if self.count >= self.LEAST_BYTES else 0.0


class Port:
    """open() or TiltError; then read(), send(text), baud. Each raises Gone after the plug was pulled."""

    def __init__(self, name, baud, reset=True):
        self.name, self.reset, self.serial, self._baud = name, reset, None, baud

    def open(self):
        try:
            self.connect()
        except (serial.SerialException, OSError, ValueError) as why:
            self.close()
            raise TiltError(f"{self.name}: {reason_of(why)}{hint_of(why)}") from why

    def connect(self):
        self.serial = serial.Serial(timeout=READ_WAIT_S, exclusive=True)
        self.serial.port, self.serial.baudrate = self.name, self._baud
        if not self.reset and os.name == "nt":
            self.serial.dtr = False
        self.serial.open()
        if self.reset:
            self.pulse_dtr()
        elif os.name == "posix":
            self.keep_dtr()

    def pulse_dtr(self):
        """Resets an UNO, even if DTR is still up from an earlier program."""
        try:
            self.serial.dtr = False
            time.sleep(DTR_LOW_S)
            self.serial.reset_input_buffer()
            self.serial.dtr = True
        except OSError as why:
            if why.errno not in (errno.EINVAL, errno.ENOTTY):  # a pseudo terminal has no DTR
                raise

    def keep_dtr(self):
        """Leaves DTR up when the port is closed: the edge at the next opening would reset an UNO."""
        import termios
        settings = termios.tcgetattr(self.serial.fd)
        settings[2] &= ~termios.HUPCL
        termios.tcsetattr(self.serial.fd, termios.TCSANOW, settings)

    def close(self):
        port, self.serial = self.serial, None
        if port is not None:
            try:
                port.close()
            except OSError:
                pass  # already gone

    def come_back(self):
        """True if the port has returned and could be opened."""
        self.close()
        try:
            self.connect()
        except (serial.SerialException, OSError):
            self.close()
            return False
        return True

    def read(self):
        """Received bytes; b"" after READ_WAIT_S without any."""
        try:
            first = self.serial.read(1)
            return first + self.serial.read(self.serial.in_waiting) if first else first
        except (serial.SerialException, OSError, TypeError) as why:  # TypeError: pyserial's fd, closed by another thread
            raise Gone(str(why)) from why

    def send(self, text):
        self.send_bytes(text.encode("ascii", "replace") + b"\n")

    def send_bytes(self, data):
        try:
            self.serial.write(data)
            self.serial.flush()
        except (serial.SerialException, OSError) as why:
            raise Gone(str(why)) from why

    def baud_at_next_opening(self, baud):
        self._baud = baud

    @property
    def baud(self):
        return self._baud

    @baud.setter
    def baud(self, baud):
        self._baud = baud
        try:
            self.serial.baudrate = baud
        except (serial.SerialException, OSError) as why:
            raise Gone(str(why)) from why


def reason_of(why):
    number = getattr(why, "errno", None)
    if number == errno.ENOTTY or os.strerror(errno.ENOTTY) in str(why):
        return "not a serial port: give one, such as /dev/ttyACM0 or COM3"
    if number is None:
        return str(why)
    return "in use by another program" if number == errno.EWOULDBLOCK else os.strerror(number)


def hint_of(why):
    number = getattr(why, "errno", None)
    if number == errno.EACCES:
        return " (on Linux: sudo usermod -a -G dialout $USER, then log out and in again)"
    if number == errno.ENOENT:
        names = ", ".join(port.device for port in list_ports.comports())
        return f" (ports: {names})" if names else " (no serial port found: plug the board in)"
    return ""
