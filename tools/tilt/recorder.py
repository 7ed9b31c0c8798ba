"""Turns the bytes of a serial port into a file that is a stream (docs/protocol.md), whatever arrives.

Only whole lines are written. A line that is no row, header or '#' line is kept as a '#' line with the reason, so that nothing is lost and every
reader accepts the file. Missing rows are found by their times (tilt.gaps). This module knows neither ports nor clocks.
"""
from tilt import protocol
from tilt.gaps import Gaps

LEAP_US = 10_000_000  # such a step, or one back, is accepted if the next row continues from it
NUMBERS_KEPT = 8      # of malformed lines
SAID = "# tilt record: "


class Counts:
    def __init__(self):
        self.rows = self.malformed = self.cut = self.resets = self.outages = self.plotter = 0
        self.span_us = 0  # of contiguous rows, by the board's clock
        self.malformed_at = []  # line numbers in the file, of the first ones
        self.gaps = Gaps()

    def complete(self):
        return not (self.gaps.lost or self.malformed or self.cut or self.resets or self.outages)


def printable(text):
    return all(" " <= letter <= "~" for letter in text)


def escaped(text):
    return "".join(letter if " " <= letter <= "~" and letter != "\\" else f"\\x{ord(letter):02x}" for letter in text)


class Recorder:
    """write(bytes) gets whole lines, from the first that is certainly the board's; said(text) gets the board's '#' lines. Call feed() with the
    input, outage() when the port is gone, join() after a change of the baud rate, finish() at the end.

    last: the newest row; ours: input that only this firmware sends has arrived; understood: number of lines that were not malformed.
    """

    def __init__(self, write, said=lambda text: None):
        self.write, self.said = write, said
        self.counts, self.lines, self.out = Counts(), 0, []
        self.last, self.ours, self.understood = None, False, 0
        self.begin()

    def join(self):
        """Input up to the next line end is a partial line."""
        self.joining = True

    def begin(self):
        """Resets the state, as when the port has just been opened: input may begin anywhere."""
        self.tail, self.joining, self.header, self.suspect, self.spoken, self.banner = b"", True, None, None, False, False

    def feed(self, data):
        *whole, self.tail = (self.tail + data).split(b"\n")
        if len(self.tail) > protocol.LINE_MAX:
            whole, self.tail = whole + [self.tail], b""
        for line in whole:
            self.take(line.rstrip(b"\r").decode("latin-1"))
        self.flush()

    def outage(self):
        self.counts.outages += 1
        self.end_of_run()
        self.put(f"{SAID}the port was gone here")
        self.flush()
        self.begin()

    def finish(self):
        """Drops a partial line at the end."""
        self.end_of_run()
        self.flush()

    def end_of_run(self):
        self.disbelieve()
        self.counts.gaps.cut()

    # --- lines --------------------------------------------------------------------------------------------------------

    def put(self, text):
        self.lines += 1
        self.out.append(text)

    def flush(self):
        if self.out and self.ours:
            self.write(("\n".join(self.out) + "\n").encode("ascii"))
            self.out = []

    def take(self, text):
        joining, self.joining = self.joining, False
        if text == "":
            return
        if printable(text) and text.startswith("#"):
            self.take_saying(text)
        elif protocol.is_header(text) and printable(text):
            self.take_header(text)
        elif joining:  # it began before the port was opened
            if "#" in text:
                self.take(text[text.index("#"):])
        elif "#" in text:
            self.take_cut(*text.split("#", 1))
        elif protocol.PLOTTER_ROW.match(text):
            self.counts.plotter += 1
            self.understood += 1
            self.put(f"{SAID}plotter mode: {escaped(text)}")
        else:
            self.take_row(text)

    def take_saying(self, text):
        if self.banner and text.startswith(protocol.RESET) and self.header is not None:
            self.counts.resets += 1
            self.end_of_run()
            self.header = None
        self.banner = text.startswith(protocol.BANNER)  # alone it answers `version`
        self.ours = self.ours or text.startswith(protocol.BANNER)
        self.spoken = True
        self.understood += 1
        self.put(text)
        self.said(text)

    def take_cut(self, row, rest):
        """A row that a reset of the board, or lost bytes, cut short."""
        self.counts.cut += 1
        self.put(f"{SAID}a row cut short: {escaped(row)}")
        self.take("#" + rest)

    def take_header(self, text):
        self.end_of_run()
        self.header, self.last, self.ours = text, None, True
        self.understood += 1
        self.put(text)

    def malformed(self, text, reason):
        self.counts.malformed += 1
        self.put(f"{SAID}no row, {reason}: {escaped(text)}")
        if len(self.counts.malformed_at) < NUMBERS_KEPT:
            self.counts.malformed_at.append(self.lines)

    # --- rows ---------------------------------------------------------------------------------------------------------

    def take_row(self, text):
        if not printable(text):
            self.malformed(text, "bytes that never occur in a row")
            return
        try:
            row = protocol.row_of(text, self.header or protocol.HEADER)
        except ValueError as why:
            self.malformed(text, escaped(str(why)))
            return
        if self.header is None:
            self.put(f"{SAID}rows without a header: header added")
            self.take_header(protocol.HEADER)
        if self.suspect is not None:
            self.settle(row)
        if self.follows(self.last, row):
            self.accept(row, text)
        else:
            self.suspect = (row, text)

    def settle(self, row):
        """Decides by the next row whether the clock jumped or a digit was lost."""
        held, text = self.suspect
        if self.follows(self.last, row) or not self.follows(held, row):
            self.disbelieve()
            return
        self.suspect = None
        if step_us(self.last, held) < 0:
            self.put(f"{SAID}the board's clock restarted")
            self.counts.resets += 1
            self.take_header(self.header)
        self.accept(held, text)

    def disbelieve(self):
        if self.suspect is not None:
            row, text = self.suspect
            self.suspect = None
            self.malformed(text, f"its time {row.t_us} fits no neighbour")

    def follows(self, before, row):
        return before is None or 0 <= step_us(before, row) <= LEAP_US or (self.spoken and step_us(before, row) >= 0)

    def accept(self, row, text):
        if self.last is not None:
            step = step_us(self.last, row)
            no_sample = (row.flags | self.last.flags) & protocol.NO_SAMPLE
            self.counts.gaps.add(step, bool(row.flags & protocol.DROPPED), bool(no_sample), self.spoken)
            self.counts.span_us += step
        self.counts.rows += 1
        self.understood += 1
        self.last, self.spoken = row, False
        self.put(text)


def step_us(before, row):
    """us from row to row, the counter's wrap removed; negative: a step back."""
    step = row.t_us - before.t_us
    return step + protocol.WRAP_US if step < -protocol.WRAP_STEP_US else step
