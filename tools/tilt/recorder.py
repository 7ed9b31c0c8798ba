"""Turns the bytes of a serial port into a file that is a stream (docs/protocol.md), whatever comes.

Whole lines only. What is no row, header or '#' line is kept as a '#' line that says why, so that nothing is lost and every reader still
takes the file. Rows are missed by their times (tilt.gaps). Nothing here knows of ports or of time.
"""
from tilt import protocol
from tilt.gaps import Gaps

LEAP_US = 10_000_000  # a step so great, or back, is believed when the next row goes on from there
NUMBERS_KEPT = 8      # of the lines that were no rows
SAID = "# tilt record: "


class Counts:
    def __init__(self):
        self.rows = self.malformed = self.cut = self.resets = self.outages = self.plotter = 0
        self.span_us = 0  # of rows that follow each other, by the board's clock
        self.malformed_at = []  # numbers of the first such lines in the file
        self.gaps = Gaps()

    def complete(self):
        return not (self.gaps.lost or self.malformed or self.cut or self.resets or self.outages)


def printable(text):
    return all(" " <= letter <= "~" for letter in text)


def escaped(text):
    return "".join(letter if " " <= letter <= "~" and letter != "\\" else f"\\x{ord(letter):02x}" for letter in text)


class Recorder:
    """write(bytes) gets whole lines, from the first that is surely the board's on; said(text) gets what the board says in '#' lines. feed()
    what comes, outage() when the port is gone, join() when the line has changed its speed, finish() at the end.

    last: the newest row; ours: something came that only this firmware sends; understood: lines that were none of the malformed ones.
    """

    def __init__(self, write, said=lambda text: None):
        self.write, self.said = write, said
        self.counts, self.lines, self.out = Counts(), 0, []
        self.last, self.ours, self.understood = None, False, 0
        self.begin()

    def join(self):
        """What comes up to the next line end is not to be taken for a line."""
        self.joining = True

    def begin(self):
        """As when the port has just been opened: in the middle of anything."""
        self.tail, self.joining, self.header, self.suspect, self.spoken = b"", True, None, None, False

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
        """What has no line end is not written."""
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
        elif joining:  # began before the port was opened
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
        if text.startswith(protocol.BANNER) and self.header is not None:
            self.counts.resets += 1
            self.end_of_run()
            self.header = None
        self.ours = self.ours or text.startswith(protocol.BANNER)
        self.spoken = True
        self.understood += 1
        self.put(text)
        self.said(text)

    def take_cut(self, row, rest):
        """A reset of the board, or bytes lost on the way, ended a row early."""
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
            self.malformed(text, "bytes that no row has")
            return
        try:
            row = protocol.row_of(text, self.header or protocol.HEADER)
        except ValueError as why:
            self.malformed(text, escaped(str(why)))
            return
        if self.header is None:
            self.put(f"{SAID}rows without a header before them: this one is put here")
            self.take_header(protocol.HEADER)
        if self.suspect is not None:
            self.settle(row)
        if self.follows(self.last, row):
            self.accept(row, text)
        else:
            self.suspect = (row, text)

    def settle(self, row):
        """Decides by the row after it whether the clock leapt or a digit was lost."""
        held, text = self.suspect
        if self.follows(self.last, row) or not self.follows(held, row):
            self.disbelieve()
            return
        self.suspect = None
        if step_us(self.last, held) < 0:
            self.put(f"{SAID}the board's clock began anew")
            self.counts.resets += 1
            self.take_header(self.header)
        self.accept(held, text)

    def disbelieve(self):
        if self.suspect is not None:
            row, text = self.suspect
            self.suspect = None
            self.malformed(text, f"its time {row.t_us} follows from nothing")

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
    """us from row to row, the counter's wrap undone; negative: the time went back."""
    step = row.t_us - before.t_us
    return step + protocol.WRAP_US if step < -protocol.WRAP_STEP_US else step
