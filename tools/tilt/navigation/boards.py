"""Where the filter runs: in the simulated UNO, natively on the PC, or on a board at a serial port. Each takes frames and returns an Outcome."""
import contextlib
import json
import pathlib
import subprocess
import tempfile
import time
from dataclasses import dataclass

from tilt.errors import TiltError
from tilt.navigation import frames
from tilt.navigation.exchange import Outcome
from tilt.place import IN_WHEEL, ROOT, VERSION
from tilt.port import Gone, Port

LOOK_S = 0.2
GREETING_S = 4.0   # the boot loader takes 2 s
SILENT_S = 1.0
NAVFLASH = f"tilt flash PORT --image tilt-uno-{VERSION}-nav-16mhz.hex" if IN_WHEEL else "make navflash"
MAKE_FIRST = "install what is missing with sh tools/deps.sh sim"


@dataclass
class Run:
    """The outcome, the duration of the flight itself (without building) and, from the simulator, its statistics."""
    outcome: Outcome
    took_s: float
    stats: dict = None


def image(states):
    return pathlib.Path("build/uno") / ("nav" if states == 12 else f"nav{states}") / "firmware.elf"


def native(states):
    return pathlib.Path("build/host") / f"nav_replay_{states}"


def made(*targets):
    done = subprocess.run(["make", "-s", *map(str, targets)], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = (done.stderr + done.stdout).strip().splitlines() or ["no reason given"]
        raise TiltError(f"make could not build {targets[0]}: {said[-1]} ({MAKE_FIRST})")


def _decoded(data, outcome):
    reader = frames.Reader()
    outcome.take(reader.feed(data))
    outcome.damaged = reader.damaged
    return outcome


def simulated(sent, states, report=lambda done, whole: None):
    """Through simrun: records arrive when they are due, as from sensors in flight."""
    made(image(states), "build/sim/simrun")
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        with open(place / "frames", "w", encoding="ascii") as file:
            for record in sent:
                file.write(f"{record.due_us} {record.data.hex()}\n")
        with open(place / "said", "w+", encoding="utf-8") as said:
            with subprocess.Popen([ROOT / "build/sim/simrun", "--fw", ROOT / image(states), "--frames", place / "frames", "--out", place / "out",
                                   "--stats", place / "stats"], stdout=subprocess.DEVNULL, stderr=said) as process:
                _watched(process, place / "out", sent, report)
            said.seek(0)
            words = said.read().strip().splitlines()
        if process.returncode != 0:
            raise TiltError(f"the simulator ended with status {process.returncode}: {words[-1] if words else 'no reason given'}")
        took_s = time.perf_counter() - began
        return Run(_decoded((place / "out").read_bytes(), Outcome()), took_s, json.loads((place / "stats").read_text(encoding="utf-8")))


def _watched(process, out, sent, report):
    """Shows progress by the answers already in the file."""
    reader, done, at = frames.Reader(), 0, 0
    while process.poll() is None:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(LOOK_S)
        if out.exists():
            with open(out, "rb") as file:
                file.seek(at)
                data = file.read()
            at += len(data)
            done += sum(isinstance(item, frames.Answer) for item in reader.feed(data))
            report(done, len(sent))


def on_pc(sent, states, report=lambda done, whole: None):
    """The same C code built for the PC."""
    made(native(states))
    began = time.perf_counter()
    done = subprocess.run([ROOT / native(states)], input=b"".join(record.data for record in sent), capture_output=True, check=False)
    if done.returncode != 0:
        raise TiltError(f"{native(states)} ended with status {done.returncode}: {done.stderr.decode(errors='replace').strip()}")
    took_s = time.perf_counter() - began
    report(len(sent), len(sent))
    return Run(_decoded(done.stdout, Outcome()), took_s)


class Line:
    """A board at a port: never more bytes under way than it has reported room for."""

    def __init__(self, name, states, reset=True):
        self.port, self.states = Port(name, frames.BAUD, reset), states
        self.reader, self.outcome, self.window, self.sent, self.taken = frames.Reader(), Outcome(), 0, 0, 0

    def listen(self):
        found = self.reader.feed(self.port.read())
        self.outcome.take(found)
        for item in found:
            if isinstance(item, frames.Answer):
                self.taken = item.taken
        return found

    def greet(self):
        """Reads the window from its greeting; asks for it if the board was already running."""
        self.port.open()
        end, asked = time.monotonic() + GREETING_S, 0.0
        while not self.outcome.hellos or not self.outcome.answers:
            if time.monotonic() > end:
                raise TiltError(f"{self.port.name}: no answer at {frames.BAUD} baud: write the navigation image with {NAVFLASH}")
            if time.monotonic() > asked + SILENT_S:
                asked = time.monotonic()
                self.write(b"\0" + frames.frame(frames.bare_record(255, "hello")))
            self.listen()
        hello = self.outcome.hellos[-1]
        if (hello.version, hello.states) != (frames.VERSION, self.states):
            raise TiltError(f"{self.port.name}: the board's image is version {hello.version} with {hello.states} states, "
                            f"not {frames.VERSION} with {self.states}: {NAVFLASH}, or --states {hello.states}")
        self.window, self.sent = hello.window, self.taken
        self.outcome = Outcome(hellos=[hello])

    def write(self, data):
        self.port.send_bytes(data)

    def room(self):
        return self.window - ((self.sent - self.taken) & 0xFFFF)

    def ask_where(self):
        """Lost bytes would count as under way for ever: the next greeting of the board shows what it has taken. TiltError if it does not
        answer either."""
        greetings, end = len(self.outcome.hellos), time.monotonic() + SILENT_S
        self.write(b"\0" + frames.frame(frames.bare_record(self.next_number(), "hello")))
        while len(self.outcome.hellos) == greetings or not self.outcome.answers or self.outcome.answers[-1].kind != "H":
            if time.monotonic() > end:
                raise TiltError(f"{self.port.name}: the board has stopped answering after {len(self.outcome.answers)} records")
            self.listen()
        self.outcome.hellos.pop()
        self.outcome.answers.pop()
        self.sent = self.taken

    def next_number(self):
        return (self.outcome.answers[-1].sequence + 1) & 0xFF if self.outcome.answers else 0

    def send(self, record):
        """Waits for room, then sends; TiltError if the board reports none."""
        heard = time.monotonic()
        while self.room() < len(record.data):
            if self.listen():
                heard = time.monotonic()
            elif time.monotonic() > heard + SILENT_S:
                self.ask_where()
                heard = time.monotonic()
            if len(self.outcome.hellos) > 1:
                raise TiltError(f"{self.port.name}: the board restarted after {len(self.outcome.answers)} records")
        self.sent = (self.sent + len(record.data)) & 0xFFFF
        self.write(record.data)

    def finish(self, wanted):
        heard = time.monotonic()
        while len(self.outcome.answers) < wanted:
            if self.listen():
                heard = time.monotonic()
            elif time.monotonic() > heard + SILENT_S:
                break
        self.outcome.damaged = self.reader.damaged
        return self.outcome


def at_port(name, sent, states, fast=False, report=lambda done, whole: None):
    """On a board; each record when it is due by the PC's clock, or (fast) as soon as there is room."""
    line = Line(name, states)
    try:
        line.greet()
        began = time.monotonic()
        for number, record in enumerate(sent):
            wait_s = 0.0 if fast else began + record.due_us * 1e-6 - time.monotonic()
            if wait_s > 0:
                time.sleep(wait_s)
            line.send(record)
            if number % 16 == 0:
                report(number, len(sent))
                if line.port.serial.in_waiting:
                    line.listen()
        return Run(line.finish(len(sent)), time.monotonic() - began)
    except Gone as why:
        raise TiltError(f"{name}: the port was lost after {len(line.outcome.answers)} records: {why}") from why
    finally:
        line.port.close()
