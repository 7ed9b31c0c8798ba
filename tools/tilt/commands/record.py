"""Writes what the board sends to a file that every other command, the simulator and a spreadsheet can read.

Opening the port resets the board (as every serial monitor does), so the file begins with its banner. --no-reset joins a running board.
Rows are written as they arrive. If the port disappears, the command waits for it and continues in the same file, where a repeated header begins
a new segment. It ends after --seconds, by Ctrl-C, or by SIGTERM.

Status: 0 nothing is missing, 1 rows are missing (it prints how many, and why), or the board refused or did not answer a command of --send, 2 the
port or the file cannot be used.
"""
import contextlib
import datetime
import pathlib
import re
import signal
import sys
import time

from tilt import protocol
from tilt.errors import TiltError
from tilt.numbers import real_option, whole_option
from tilt.port import Gone, Port, Unreadable
from tilt.recorder import Recorder

NAME = "record"
SUMMARY = "record what a board sends, and count what is missing"
SILENT_S = 6.0        # the boot loader takes 2 s, the banner at 9600 baud 0.4 s
STRANGE_BYTES, STRANGE_S = 200, 2.0  # without one line of this firmware: probably the wrong port
PRINTABLE_SHARE = 0.95
SEND_AFTER_S, SEND_SILENT_S = 1.0, 3.0  # without a header: the board may be in plotter mode, or stopped
ANSWER_S = 1.0        # a command waits for the answer to the previous one: the board buffers 64 bytes
BAUD_ANSWER_S = 10.0  # and longer for the answer to `baud`: input during the change is lost
LISTEN_S = 0.6        # at each baud rate, when searching for the right one
BACK_AFTER_S = 1.5    # without a readable line, return to the first baud rate
RETRY_S = 0.2
SHOW_S = 0.5
QUIET_S = 1.0         # without a row, --seconds counts by the PC's clock
STOPPED = "# stopped"
BAUD_SET = re.compile(r"# baud (\d+)\Z")


def arguments(parser):
    parser.add_argument("port", metavar="PORT", help="/dev/ttyACM0, /dev/serial/by-id/..., COM3, or simrun's pseudo terminal")
    parser.add_argument("-o", "--output", metavar="FILE", help="file to write (default: tilt-DATE-TIME.csv here)")
    parser.add_argument("--force", action="store_true", help="overwrite FILE")
    parser.add_argument("--seconds", type=real_option, metavar="N", help="end after N seconds by the board's clock (the PC's while no rows arrive)")
    parser.add_argument("--baud", type=whole_option, default=protocol.BAUD_AT_START, metavar="N",
                        help=f"baud rate (default {protocol.BAUD_AT_START})")
    parser.add_argument("--send", action="append", default=[], metavar="COMMAND", help="send this command to the board, such as 'rate 200', "
                        "and again after each reset; repeatable; follows `baud N`")
    parser.add_argument("--no-reset", action="store_true", help="join a running board without resetting it (on Linux the first opening "
                        "after plugging in may reset it anyway)")
    parser.add_argument("--no-reconnect", action="store_true", help="end when the port disappears")


class Output:
    """The output file, created with its first line, so that a port that is not a board leaves no file."""

    def __init__(self, path, force):
        self.path, self.force, self.file, self.size = path, force, None, 0
        if path.exists() and not force:
            raise TiltError(f"{path}: exists already: give --force to overwrite it, or another name with -o")
        if not path.parent.is_dir():
            raise TiltError(f"{path}: no folder {path.parent}")

    def write(self, data):
        """Writes all of it, or nothing and raises TiltError: a full disk leaves no half row."""
        try:
            if self.file is None:
                self.file = open(self.path, "wb" if self.force else "xb", buffering=0)  # pylint: disable=consider-using-with
            rest = memoryview(data)
            while rest:
                rest = rest[self.file.write(rest):]
            self.size += len(data)
        except OSError as why:
            self.cut_back()
            raise TiltError(f"{self.path}: {why.strerror}; the file holds what came before") from why

    def cut_back(self):
        with contextlib.suppress(OSError, AttributeError):
            self.file.truncate(self.size)

    def close(self):
        if self.file is not None:
            self.file.close()


class Screen:
    """The progress shown on stderr: the board's messages, and on a terminal one line that is updated."""

    def __init__(self):
        self.live, self.shown, self.rows = sys.stderr.isatty(), 0.0, (0.0, 0)

    def say(self, text):
        print(("\r\x1b[K" if self.live else "") + text, file=sys.stderr, flush=True)

    def end(self):
        if self.live:
            print(file=sys.stderr)

    def update(self, recorder):
        now = time.monotonic()
        if not self.live or now - self.shown < SHOW_S:
            return
        (then, rows_then), rows = self.rows, recorder.counts.rows
        rate = (rows - rows_then) / (now - then) if rows >= rows_then and then else 0.0
        self.shown, self.rows = now, (now, rows)
        counts, last = recorder.counts, recorder.last
        flags = protocol.flags_in_words(last.flags) if last else "-"
        sys.stderr.write(f"\r\x1b[K{counts.span_us * 1e-6:.1f} s, {rows:,} rows ({rate:.0f}/s), lost {counts.gaps.lost}, "
                         f"malformed {counts.malformed + counts.cut}, flags {flags}")
        sys.stderr.flush()


class Session:
    """One recording: the port, the recorder, and the commands typed."""

    def __init__(self, args, port, recorder, screen):
        self.args, self.port, self.recorder, self.screen = args, port, recorder, screen
        self.ends, self.first_row, self.last_row, self.strange, self.answered = False, None, None, b"", False
        self.refusals, self.rows_when_stopped = [], 0
        self.opened()

    def opened(self):
        self.since, self.unreadable = time.monotonic(), Unreadable()
        self.begin_commands()

    def begin_commands(self):
        self.sent, self.to_send, self.typed, self.waiting, self.changed = None, list(self.args.send), 0.0, [], None

    def run(self):
        while not self.over():
            try:
                self.take(self.port.read())
                self.type_commands()
            except Gone:
                if not self.wait_for_port():
                    return
            self.screen.update(self.recorder)

    def over(self):
        if self.ends or self.args.seconds is None or self.first_row is None:
            return self.ends
        now = time.monotonic()
        return (self.recorder.counts.span_us >= self.args.seconds * 1e6 or
                now - self.first_row > self.args.seconds and now - self.last_row > QUIET_S)

    def said(self, text):
        """Handles a '#' line of the board."""
        self.screen.say(text)
        command = next((command for command in self.waiting if protocol.answers(command, text)), None)
        if command is not None:
            self.waiting.remove(command)
            self.answered = not self.waiting
        if text.startswith(protocol.REFUSED) and self.args.send:
            self.refusals.append(f"the board refused{f' {command!r}' if command else ''}: {text.removeprefix('# ')}")
        baud = BAUD_SET.match(text)
        if baud:
            self.port.baud = int(baud.group(1))
            self.recorder.join()
            self.changed, self.typed, self.answered = self.recorder.understood, time.monotonic(), False
        if text == STOPPED:
            self.rows_when_stopped = self.recorder.counts.rows
        if text.startswith(protocol.BANNER) and command is None:
            self.begin_commands()

    def take(self, data):
        now, before, rows, self.answered = time.monotonic(), self.recorder.understood, self.recorder.counts.rows, False
        self.recorder.feed(data)
        if self.changed is not None and self.recorder.understood > self.changed:
            self.changed, self.answered = None, True  # only a line at the new rate shows that the board has changed too
        if self.answered and self.sent is not None:
            self.send_next()
        if self.recorder.counts.rows > rows:
            self.first_row, self.last_row = self.first_row or now, now
        if not self.recorder.ours:
            self.strange += data
            self.judge_strange(now - (self.sent or self.since))
        else:
            self.judge_unreadable(self.unreadable.lasts_s(len(data), self.recorder.understood > before))

    def judge_unreadable(self, lasts_s):
        """Returns to the first baud rate."""
        if lasts_s > BACK_AFTER_S and self.port.baud != self.args.baud:
            self.screen.say(f"tilt record: unreadable at {self.port.baud} baud: back to {self.args.baud}")
            self.port.baud, self.unreadable = self.args.baud, Unreadable()

    def judge_strange(self, waited_s):
        """TiltError if nothing arrives, or input that is not this firmware's."""
        if not self.strange and waited_s > SILENT_S:
            raise TiltError(f"{self.port.name}: nothing received in {waited_s:.0f} s at {self.port.baud} baud: check the port, whether the board has "
                            "this firmware, and whether it was stopped (--send go)")
        if len(self.strange) > STRANGE_BYTES and waited_s > STRANGE_S and (self.sent or not self.args.send):
            raise TiltError(f"{self.port.name}: {what_it_is(self.strange, self.port)}")

    def type_commands(self):
        waited_s = time.monotonic() - self.since
        ready = self.recorder.header is not None or waited_s > (SEND_AFTER_S if self.strange else SEND_SILENT_S)
        if self.sent is None and ready:
            self.sent = time.monotonic()
            self.send_next()
        elif self.sent is not None and self.to_send and time.monotonic() - self.typed > self.patience_s():
            self.send_next()

    def patience_s(self):
        """How long to wait for an answer: input is lost while the baud rate changes, which a board that streams shows by a row."""
        streams = self.recorder.counts.rows > self.rows_when_stopped
        changing = any(command.split()[:1] == ["baud"] for command in self.waiting[-1:]) or (self.changed is not None and streams)
        return BAUD_ANSWER_S if changing else ANSWER_S

    def send_next(self):
        if self.to_send:
            command = self.to_send.pop(0)
            self.typed = time.monotonic()
            self.waiting.append(command)
            self.port.send(command)

    def failed(self):
        """What became of the commands, where it is not what they ask for."""
        open_ones = [f"the board did not answer '{command}'" for command in self.waiting] + [f"not sent: '{command}'" for command in self.to_send]
        return self.refusals + open_ones

    def wait_for_port(self):
        """False: do not wait, or ended while waiting."""
        self.recorder.outage()
        self.port.baud_at_next_opening(self.args.baud)
        if self.args.no_reconnect:
            self.screen.say(f"tilt record: {self.port.name} is gone")
            return False
        self.screen.say(f"tilt record: {self.port.name} is gone: waiting for it (Ctrl-C ends)")
        while not self.over():
            if self.port.come_back():
                self.screen.say(f"tilt record: {self.port.name} is back")
                self.opened()
                return True
            time.sleep(RETRY_S)
        return False


def what_it_is(strange, port):
    """Explains bytes without one line of this firmware, and what to do."""
    lines = strange.decode("latin-1").replace("\r", "").split("\n")
    if any(protocol.PLOTTER_ROW.match(line) for line in lines):
        return "the board is in plotter mode: give --send 'mode csv'"
    if sum(32 <= byte < 127 or byte in b"\t\r\n" for byte in strange) > PRINTABLE_SHARE * len(strange):
        return f"received text, but not from this firmware: '{max(lines[:4], key=len)[:80].strip()}'"
    tried = port.baud
    found = find_baud(port)
    if found:
        return f"no text at {tried} baud, but this firmware's at {found} baud: give --baud {found}"
    return f"no text at {tried} baud, nor at {', '.join(str(baud) for baud in protocol.BAUDS if baud != tried)}: check the port"


def find_baud(port):
    """The baud rate at which this firmware's lines are readable, or None."""
    print(f"tilt record: no text at {port.baud} baud, trying others", file=sys.stderr)
    for baud in sorted(protocol.BAUDS, reverse=True):
        if baud == port.baud:
            continue
        port.baud = baud
        recorder, end = Recorder(lambda data: None), time.monotonic() + LISTEN_S
        while time.monotonic() < end:
            recorder.feed(port.read())
            if recorder.ours:
                return baud
    return None


def summary(counts, path):
    lines = [f"{path}: {counts.rows:,} rows, {counts.span_us * 1e-6:.1f} s"]
    gaps = counts.gaps
    found = [(gaps.on_the_way, "rows missing by their times: lost on the way"),
             (gaps.by_the_board, "rows dropped by the board: the line is too slow"), (counts.cut, "rows cut short"),
             (counts.resets, "resets of the board"), (counts.outages, "times the port was gone")]
    lines += [f"{number} {text}" for number, text in found if number]
    if counts.malformed:
        places = ", ".join(map(str, counts.malformed_at)) + (", ..." if counts.malformed > len(counts.malformed_at) else "")
        lines.append(f"{counts.malformed} lines that are not rows, kept as # lines: {path}:{places}")
    if counts.plotter:
        lines.append(f"{counts.plotter} rows of the plotter mode, kept as # lines")
    if gaps.pauses:
        lines.append(f"{gaps.pauses} pauses in which the board had no sample or handled a command, {gaps.pauses_us * 1e-6:.1f} s in all")
    lines.append("nothing is missing" if counts.complete() else "something is missing")
    return "\n".join(lines)


def default_path():
    return pathlib.Path(f"tilt-{datetime.datetime.now():%Y%m%d-%H%M%S}.csv")


def checked(args):
    if args.seconds is not None and not 0 < args.seconds < float("inf"):
        raise TiltError(f"--seconds {args.seconds:g}: give a time above 0")
    protocol.check_baud(args.baud)


@contextlib.contextmanager
def ended_by_signals(session):
    """Ctrl-C and SIGTERM end the recording at the end of a line, never within one."""
    def end(*_):
        session.ends = True
    before = {number: signal.signal(number, end) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run(args):
    checked(args)
    path = pathlib.Path(args.output) if args.output else default_path()
    output, port = Output(path, args.force), Port(args.port, args.baud, reset=not args.no_reset)
    port.open()
    recorder = Recorder(output.write)
    session = Session(args, port, recorder, Screen())
    recorder.said = session.said
    try:
        with ended_by_signals(session):
            session.run()
        recorder.finish()
    finally:
        port.close()
        output.close()
    session.screen.end()
    if not recorder.counts.rows:
        raise TiltError(f"{args.port}: no row received")
    print("\n".join([summary(recorder.counts, path), *session.failed()]))
    return 0 if recorder.counts.complete() and not session.failed() else 1
