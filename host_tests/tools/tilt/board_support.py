"""What the tests of `tilt board` share. For the judges: a line and an owner by a clock of their own (Desk). For the whole command: the firmware in
the simulator, behind a cable that can be pulled out, and hands that do what the program asks for."""
import collections
import contextlib
import json
import os
import pathlib
import pty
import re
import select
import subprocess
import threading
import time
import tty
import unittest
from unittest import mock

from fake_board import until
from laws import DEFAULT
from tilt_case import InFolder, port_of, run_tilt
from tilt.errors import TiltError
from tilt.port import Port
from tilt.realboard.bench import Bench, Failed, Seen, seen_of
from tilt.realboard.checks import CHECKS
from tilt.realboard.record import Record, begin_line

SIMRUN, FIRMWARE = "build/sim/simrun", "build/uno/firmware.elf"
BANNER = ("# tilt-uno 0.1.0: roll and pitch from an ADXL345", "# reset: {cause}",
          f"# filter {DEFAULT}, rate 100 Hz, range 16 g, every 1, baud 115200",
          "# settings: {kept}", "# type help, or mode plot for the Arduino plotter", "# sensor: ADXL345 at 0x53, I2C at 363.6 kHz",
          "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags")
FIRMWARE_SAYS = BANNER[0]
ALL = list(enumerate(CHECKS, 1))
BEGINS = "# fault {}: words: check the wire"
OVER = "# fault {} over: after 1500 ms, 150 lost, sensor at 0x53"
JUDGES = {check.key: check.judge for check in CHECKS}
GONE, BACK = "GONE", "BACK"
HEARD_BYTES = 100_000
START_S = 60  # of a PC that may be busy


def banner(cause="reset button or serial port opened", kept="as saved"):
    return [line.format(cause=cause, kept=kept) for line in BANNER]


def row(at_s, flags=0, lsb=(0, 0, 256), mg=(0, 0, 1000), tilt=(0, 0), fast_ppm=0):
    t_us = round(at_s * 1e6 * (1 + fast_ppm * 1e-6)) % (1 << 32)
    return ",".join(map(str, (t_us, *lsb, *mg, *tilt, flags)))


def rows(begin_s, end_s, period_s=0.01, **more):
    """[(second, line)]"""
    return [(begin_s + n * period_s, row(begin_s + n * period_s, **more)) for n in range(round((end_s - begin_s) / period_s))]


class Desk:
    """wire and owner of a Bench: what `script` [(second, line or list of lines, GONE, BACK)] says comes at its time, `replies` {command: lines or
    function(command, desk)} after what is typed, `answers` are what the owner types at each prompt. No time passes but by waiting."""

    baud = 115200

    def __init__(self, script=(), replies=None, answers=()):
        self.time_s, self.said, self.sent, self.gone = 0.0, [], [], False
        self.script = collections.deque(sorted(script, key=lambda each: each[0]))
        self.replies, self.answers, self.keys = replies or {}, collections.deque(answers), collections.deque()
        self.pending = []

    def bench(self, limit_s=20.0, **settings):
        bench = Bench(self, self)
        bench.begin(limit_s)
        bench.settings = settings
        return bench

    # the wire
    def now(self):
        return self.time_s

    def take(self, timeout_s):
        found, self.pending = self.pending, []
        if not found and not (self.script and self.script[0][0] <= self.time_s):
            self.time_s = min(self.time_s + timeout_s, self.script[0][0] if self.script else float("inf"))
        while self.script and self.script[0][0] <= self.time_s:
            what = self.script.popleft()[1]
            found += [self.event(line) for line in (what if isinstance(what, list) else [what])]
        return found

    def event(self, line):
        if line in (GONE, BACK):
            self.gone = line == GONE
            return Seen(self.time_s, line.lower(), "port")
        return seen_of(self.time_s, line)

    def send(self, text):
        if self.gone:
            raise TiltError("port: not connected")
        self.sent.append(text)
        reply = self.replies.get(text, ())
        lines = reply(text, self) if callable(reply) else reply
        self.pending += [self.event(line) for line in lines]

    def send_piece(self, text):
        self.sent.append(text)

    # the owner
    def typed(self):
        return self.keys.popleft() if self.keys else None

    def say(self, text):
        self.said.append(text)

    def prompt(self, text):
        self.said.append(text)
        self.keys.append(self.answers.popleft())


class Model:
    """What the firmware answers, for the `replies` of a Desk: settings that can be set and saved, and counters that can be made to grow."""

    UNITS = {"rate": " Hz, I2C at 363.6 kHz", "range": " g", "offset": " LSB: -80 to 80", "level": ": -1.1499 to 1.1499",
             "scale": " LSB/g: 200 to 330"}

    def __init__(self, fault=0, grow=None, **settings):
        self.values = {"filter": DEFAULT, "rate": "100", "range": "16", "every": "1", "baud": "115200", "mode": "csv", "offset": "0 0 0",
                       "scale": "265 265 256", "level": "0 0 1"} | settings
        self.saved, self.fault, self.grow, self.looks = dict(self.values), fault, grow or {}, 0

    def get(self, text, default=()):
        return default if " " in text.strip() and text.split()[0] not in self.values else lambda *_: self.reply(text)

    def reply(self, text):
        name, _, value = text.partition(" ")
        if name in self.values:
            self.values[name] = value or self.values[name]
            return [self.line(name)]
        known = {"version": self.version, "settings": self.settings, "status": self.status, "save": self.save}
        return known[name]() if name in known else ["# refused 1: unknown command (type help)"]

    def line(self, name):
        return f"# {name} {self.values[name]}{self.UNITS.get(name, '')}"

    def version(self):
        return [BANNER[0]]

    def settings(self):
        legal = {"baud": "9600 115200 1000000"}
        return [self.line(name) + ("" if ": " in self.line(name) else f": {legal.get(name, 'any')}") for name in self.values]

    def status(self):
        """Each look finds the counters grown by what a test says."""
        count = {name: self.looks * self.grow.get(name, 0) for name in (
            "samples", "lost", "late", "not acknowledged", "bus errors", "timeouts", "readings torn", "overruns")}
        self.looks += 1
        return [f"# state {'fault' if self.fault else 'streaming'}, fault {self.fault}, rate 100 Hz, measured 98.50 Hz, uptime s 4",
                f"# samples {count['samples']}, gated 0, reacquired 0, clipped 0", f"# lost {count['lost']}, late {count['late']}, drained 0",
                f"# not acknowledged {count['not acknowledged']}, arbitration lost 0, bus errors {count['bus errors']}, "
                f"timeouts {count['timeouts']}", f"# readings torn {count['readings torn']}, empty 0, overruns {count['overruns']}"]

    def save(self):
        self.saved = dict(self.values)
        return ["# saved"]


class JudgeCase(unittest.TestCase):
    def passes(self, key, desk, **settings):
        """What was measured."""
        bench = desk.bench(**settings)
        JUDGES[key](bench)
        return bench.numbers

    def fails(self, key, reason, desk, **settings):
        bench = desk.bench(**settings)
        with self.assertRaises(Failed) as failed:
            JUDGES[key](bench)
        self.assertRegex(str(failed.exception), reason)
        return bench.numbers


class CommandCase(InFolder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "board.jsonl"

    def record(self, resumed=False):
        record = Record(self.path, resumed)
        self.addCleanup(record.close)
        if not resumed:
            record.add(begin_line("port", [9025, 67], FIRMWARE_SAYS, {"every": "1"}))
        return record

    def lines(self):
        return [json.loads(line) for line in self.path.read_text().splitlines()]

    def tilt(self, *words):
        return run_tilt("board", *words)


def check(key="identity", judge=lambda bench: bench.measured(seconds=1.5), alone=False):
    found = next(each for each in CHECKS if each.key == key)
    return found._replace(judge=judge, alone=alone)


def raises(*whys):
    """A judge that raises these in turn (None: it passes)."""
    whys = list(whys)

    def judge(bench):
        bench.measured(tries=len(whys))
        why = whys.pop(0)
        if why is not None:
            raise why
    return judge


class Simulated:
    """simrun on its pseudo terminal. press() is what begins the next fault: `status` is typed, which alone visits the function PRESSED, and rows
    go on at once. So faults are timed by what the test does and not by a clock. As the command begins it types `status` once. BYTE is visited for
    each byte that is typed."""

    PRESSED, BYTE = "adxl345_rate_chz", "__vector_18"

    def __init__(self, folder, stream, *options):
        command = [SIMRUN, "--fw", FIRMWARE, "--in", str(stream), "--out", str(folder / "all.csv"), "--eeprom", str(folder / "eeprom.bin"), "--pty",
                   "--loop", "--expect-resets", "99", *options]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)  # pylint: disable=consider-using-with
        self.fd = os.open(port_of(self.process), os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.fd)
        self.typed = 0
        self.let_it_start()

    def let_it_start(self):
        """Until rows come. Nobody hears its first banner: with the one after a reset, a busy machine would hear two."""
        rest, until_s = b"", time.monotonic() + START_S
        while not re.search(rb"\n\d+,[-0-9,]+\r?\n", rest):
            readable = select.select([self.fd], [], [], max(0.0, until_s - time.monotonic()))[0]
            data = os.read(self.fd, 4096) if readable else b""
            if not data:
                self.end()
                raise AssertionError(f"simrun has ended, or sent no row within {START_S} s: {rest[-200:]}")
            rest = rest[-200:] + data

    def write(self, data):
        self.typed += os.write(self.fd, data)

    def press(self):
        self.write(b"status\n\n")

    def fill(self, count):
        """So many bytes have been typed, at the end empty lines."""
        self.write(b"\n" * (count - self.typed))

    def end(self):
        os.close(self.fd)
        self.process.terminate()
        self.process.wait(60)
        self.process.stderr.close()


def faults(*kinds):
    """Options for a Simulated: a reset as the port is opened, then a fault for each press()."""
    visits = enumerate(("reset", None, *kinds), 1)  # the second visit is the command's own
    return [word for n, kind in visits for each in (kind or "").split() for word in ("--fault", f"pc:{Simulated.PRESSED}#{n}:{each}")]


class Cable:
    """`name` is a port that leads to a Simulated, which may be changed for another one; unplug() takes the port away. Whoever opens the port resets
    the board, as on a UNO: the fault that is begun by a press() then is `reset`."""

    def __init__(self, folder):
        self.name, self.board, self.master, self.slave = str(pathlib.Path(folder) / "port"), None, None, None
        self.heard, self.rest, self.lock, self.ending, self.cut_on = b"", b"", threading.RLock(), False, None
        self.thread = threading.Thread(target=self.work, daemon=True)

    def __enter__(self):
        real, cable = Port.connect, self

        def connect(port):
            real(port)
            cable.board.press()

        self.patch = mock.patch.object(Port, "connect", connect)
        self.patch.start()
        self.plug()
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.patch.stop()
        self.ending = True
        self.thread.join(60)
        self.unplug()
        self.lead_to(None)

    def lead_to(self, board):
        with self.lock:
            if self.board is not None:
                self.board.end()
            self.board = board

    def plug(self):
        with self.lock:
            self.master, self.slave = pty.openpty()
            tty.setraw(self.slave)
            os.set_blocking(self.master, False)
            self.rest = b""
            pathlib.Path(self.name).symlink_to(os.ttyname(self.slave))

    def unplug(self):
        with self.lock:
            if self.master is not None:
                pathlib.Path(self.name).unlink()
                os.close(self.master)
                os.close(self.slave)
                self.master = None

    def work(self):
        while not self.ending:
            with self.lock:
                ends = [end for end in (self.master, self.board and self.board.fd) if end is not None]
                for end in select.select(ends, [], [], 0.005)[0]:
                    self.pass_on(end)
            time.sleep(0.001)

    def pass_on(self, end):
        data = os.read(end, 4096)
        if end == self.master:
            self.board.write(data)
            return
        self.heard = (self.heard + data)[-HEARD_BYTES:]
        if self.cut_on is not None and self.cut_on in self.heard:
            self.cut_on = None
            self.unplug()
        if self.master is not None:
            self.rest = (self.rest + data)[-HEARD_BYTES:]  # what nobody reads goes at last
            with contextlib.suppress(BlockingIOError):
                self.rest = self.rest[os.write(self.master, self.rest):]

    def unplug_on(self, text):
        """As soon as the board says this: nobody at the other end hears it."""
        with self.lock:
            self.heard, self.cut_on = b"", text

    def unplugged(self):
        until(lambda: self.master is None)


class Hands:
    """The owner in the tests of the command: deeds {key of the check: [function, ...]}, one for each prompt or order in it, in turn. Those of the
    checks in `first` are done before Enter is pressed, the others meanwhile."""

    def __init__(self, deeds, first=()):
        self.deeds, self.first, self.key, self.said, self.keys = deeds, first, None, [], collections.deque()

    def typed(self):
        return self.keys.popleft() if self.keys else None

    def say(self, text):
        self.said.append(text)
        found = re.search(r"\d+/20 (\w+)", text)
        if found:
            self.key = found[1]
        elif text.startswith("   Now "):
            self.do()

    def prompt(self, text):
        self.said.append(text)
        if "(y/n)" in text:
            self.keys.append("y")
            return
        if "Enter starts" in text:
            self.do()
        self.keys.append("")

    def do(self):
        deeds = self.deeds.get(self.key, [])
        if deeds:
            thread = threading.Thread(target=deeds.pop(0), daemon=True)
            thread.start()
            thread.join(60 if self.key in self.first else 0)
