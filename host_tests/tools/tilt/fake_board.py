"""A board on a pseudo terminal for the tests of the commands that open a port: sends what a script says once the port is open, takes what is
typed, can be unplugged and plugged in again, and talks at one baud rate only."""
import os
import pathlib
import pty
import termios
import threading
import time
import tty
from unittest import mock

from tilt.port import Port

DEADLINE_S = 120  # only reached when something is broken, however busy the machine
HEADER = b"t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags\n"
BANNER = b"\n# tilt-uno 0.1.0: roll and pitch from an ADXL345\n# reset: reset button or serial port opened\n"


def row(number, period_us=10_000, flags=0, start_us=15_000):
    return b"%d,%d,2,256,0,0,1000,45,0,%d\n" % ((start_us + number * period_us) % (1 << 32), number % 100, flags)


def rows(begin, end, **more):
    return b"".join(row(number, **more) for number in range(begin, end))


def until(true):
    end = time.monotonic() + DEADLINE_S
    while not true():
        if time.monotonic() > end:
            raise TimeoutError(f"the other side did not come so far within {DEADLINE_S} s")
        time.sleep(0.002)


class FakeBoard:
    """with FakeBoard(folder, script) as board: ... board.name; script(board) runs in a thread, begun when the port has been opened."""

    def __init__(self, folder, script, speed=None):
        self.name, self.script, self.speed = str(pathlib.Path(folder) / "port"), script, speed
        self.openings, self.typed, self.master, self.slave, self.failed = 0, b"", None, None, None
        self.thread = threading.Thread(target=self.work, daemon=True)

    def __enter__(self):
        real, board = Port.connect, self

        def connect(port):
            real(port)
            board.openings += 1

        self.patch = mock.patch.object(Port, "connect", connect)
        self.patch.start()
        self.plug()
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.patch.stop()
        self.unplug()
        self.thread.join(DEADLINE_S)
        if self.failed is not None:
            raise self.failed

    def work(self):
        try:
            self.opened(1)
            self.script(self)
        except (OSError, TypeError):
            if self.master is not None:  # else it was unplugged at the end of the test
                raise
        except Exception as why:  # noqa: BLE001  told by __exit__
            self.failed = why

    def opened(self, times):
        until(lambda: self.openings >= times)

    def plug(self):
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        pathlib.Path(self.name).symlink_to(os.ttyname(self.slave))

    def unplug(self):
        """What the other side has not read is lost."""
        if self.master is not None:
            master, self.master = self.master, None
            pathlib.Path(self.name).unlink()
            os.close(master)
            os.close(self.slave)

    def send(self, data):
        """At a wrong baud rate all bits come out wrong."""
        while data:
            try:
                wrong = self.speed is not None and termios.tcgetattr(self.slave)[4] != self.speed
                part = bytes(byte ^ 0xF5 | 0x80 for byte in data[:64]) if wrong else data[:64]
                data = data[os.write(self.master, part):]
            except BlockingIOError:
                time.sleep(0.002)
            self.listen()

    def listen(self):
        try:
            self.typed += os.read(self.master, 4096)
        except BlockingIOError:
            pass

    def heard(self, text):
        def there():
            self.listen()
            return text in self.typed
        until(there)
