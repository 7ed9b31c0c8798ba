"""Common parts of the judges: commands and their replies, faults that begin and end, stretches of rows, banners."""
import math
import re
import statistics

from tilt import protocol
from tilt.gaps import Gaps
from tilt.realboard.bench import Failed
from tilt.recorder import step_us

ANSWER_S = 5.0         # for the reply to a command, perhaps after a banner at 9600 baud
RATE_HZ = 100          # of all checks but one
RATE_SHARE = 0.05      # a sensor is up to 4 % off, the board's resonator 0.5 %
HEARD_SHARE = 0.8      # of the time, by the board's clock
QUIET_S = 3.0          # without a new fault, at the end of one
STRETCH_S = 2.0        # of good rows, before and after a fault
ROWS_WITHIN_S = 10.0   # until rows return: the boot loader takes 2 s
OPENED_S = 4.0         # for the banner of a board that opening the port resets
EDGE_S = 1.0           # at each end of a stretch, to find the row with the least delay
FAULT = re.compile(r"# fault (\d+): ")
OVER = re.compile(r"# fault (\d+) over: after (\d+) ms, (\d+) lost, sensor at 0x([0-9A-Fa-f]{2})")
REFUSED = re.compile(r"# refused \d+: .*")
CAUSE = re.compile(r"# reset: (.*)")
SUPPLY = ("power on", "supply dropped")  # causes of a reset
KEPT = re.compile(r"# settings: (.*)")
SETTING = re.compile(r"# ([a-z]\w*) ([^:]+)")
NUMBER = re.compile(r"-?\d+(\.\d+)?")


# --- commands ---------------------------------------------------------------------------------------------------------

def reply(bench, command, pattern, limit_s=ANSWER_S):
    """Types the command; the match of its reply's first line."""
    bench.type(command)
    return said(bench, pattern, limit_s, f"reply to '{command}'")[1]


def said(bench, pattern, limit_s, what):
    """(seen, match) of the first matching line; Failed with the reason on a refusal, a lost port or a restart."""
    for seen in bench.events(limit_s):
        match = re.match(pattern, seen.text) if seen.kind == "said" else None
        if match:
            return seen, match
        if seen.kind == "said" and REFUSED.match(seen.text):
            raise Failed(f"{what}: the board replied '{seen.text[2:]}'")
        if seen.kind == "gone" or is_banner(seen):
            bench.put_back(seen)
            raise Failed(f"no {what}: {'the port is gone' if seen.kind == 'gone' else 'the board restarted'}")
    raise Failed(f"no {what} within {limit_s:.0f} s")


def is_banner(seen):
    return seen.kind == "said" and seen.text.startswith(protocol.BANNER)


def value_of(words):
    """'0 0 0 LSB' -> '0 0 0', '100 Hz, I2C at 400 kHz' -> '100', 'xyz' -> 'xyz'."""
    parts = words.split(",")[0].split()
    numbers = []
    for part in parts:
        if not NUMBER.fullmatch(part):
            break
        numbers.append(part)
    return " ".join(numbers) or parts[0]


def setting(bench, name):
    return value_of(reply(bench, name, rf"# {name} ([^:]+)")[1])


def listing(bench, command):
    """The lines of a long reply. The reply to `version` after it marks its end, and lets rows continue."""
    bench.type(command)
    bench.type("version")
    lines = []
    for seen in bench.events(ANSWER_S):
        if is_banner(seen):
            return lines
        lines += [seen.text] if seen.kind == "said" else []
    raise Failed(f"incomplete reply to '{command}' after {ANSWER_S:.0f} s")


def listed(bench):
    """name -> (value, legal range) from the reply to `settings`."""
    matches = [(SETTING.match(line), line) for line in listing(bench, "settings")]
    return {match[1]: (value_of(match[2]), line.partition(": ")[2]) for match, line in matches if match}


def counters(bench):
    """name -> number from the reply to `status`."""
    pairs = [pair for line in listing(bench, "status") for pair in re.findall(r"([a-z][a-z ]*[a-z]) (\d+)(?=,|$)", line[2:])]
    return {name: int(number) for name, number in pairs}


# --- rows -------------------------------------------------------------------------------------------------------------

class Stretch:
    """Consecutive rows."""

    def __init__(self):
        self.rows, self.at_s, self.silent, self.strange, self.gaps, self.board_us = [], [], 0, 0, Gaps(), [0]

    def add(self, seen):
        if seen.kind == "strange":
            self.strange += 1
        if seen.kind != "row":
            return
        if self.rows:
            step = step_us(self.rows[-1], seen.row)
            flags = seen.row.flags | self.rows[-1].flags
            self.gaps.add(step, bool(seen.row.flags & protocol.DROPPED), bool(flags & protocol.NO_SAMPLE), False)
            self.board_us.append(self.board_us[-1] + step)
        self.silent += bool(seen.row.flags & protocol.NO_SAMPLE)
        self.rows.append(seen.row)
        self.at_s.append(seen.at_s)

    @property
    def board_s(self):
        return self.board_us[-1] * 1e-6

    @property
    def rate_hz(self):
        """By the board's clock."""
        return (len(self.rows) - 1) / self.board_s if self.board_s > 0 else 0.0

    def lost(self):
        self.gaps.cut()
        return self.gaps.lost

    def clock_ppm(self):
        """How fast the board's clock is against the PC's, from the least delayed rows at both ends; None: too short."""
        late = [(board * 1e-6, at - board * 1e-6) for at, board in zip(self.at_s, self.board_us)]
        first = min((delay, board) for board, delay in late if board <= EDGE_S)
        last = min((delay, board) for board, delay in late if board >= self.board_s - EDGE_S)
        passed = last[1] - first[1]
        return None if passed <= EDGE_S else -(last[0] - first[0]) / (passed + last[0] - first[0]) * 1e6


def stretch(bench, seconds):
    """The rows of so many seconds by the PC's clock. Failed on anything else than rows."""
    found = Stretch()
    for seen in bench.events(seconds):
        not_reset(seen)
        if seen.kind == "gone":
            raise Failed(f"the port is gone: {seen.text}")
        if seen.kind == "said" and FAULT.match(seen.text):
            raise Failed(f"the board reported '{seen.text[2:]}'")
        found.add(seen)
    return found


def not_reset(seen):
    if is_banner(seen):
        raise Failed("the board was reset, or lost its supply")


def steady(bench, rate_hz=RATE_HZ, seconds=None):
    """A stretch at the nominal rate, each row with a sample."""
    found = stretch(bench, seconds or STRETCH_S)
    if found.board_s < HEARD_SHARE * (seconds or STRETCH_S):
        raise Failed(f"{len(found.rows)} rows in {seconds or STRETCH_S:.0f} s, {found.board_s:.1f} s by the board's clock")
    if found.silent:
        raise Failed(f"{found.silent} of {len(found.rows)} rows have no sample (flags 2 and 16)")
    if abs(found.rate_hz / rate_hz - 1) > RATE_SHARE:
        raise Failed(f"{found.rate_hz:.2f} rows/s, but {rate_hz:g} are set")
    return found


def row_with_sample(bench, limit_s):
    for seen in bench.events(limit_s):
        if seen.kind == "row" and not seen.row.flags & protocol.NO_SAMPLE:
            return seen
    raise Failed(f"no row with a sample within {limit_s:.0f} s")


def mg(row):
    """The filtered acceleration of a row."""
    return row.values[4:7]


def mean_mg(rows):
    return [statistics.fmean(axis) for axis in zip(*map(mg, rows))]


def angle_deg(a, b):
    """Angle between two directions."""
    dot, lengths = sum(p * q for p, q in zip(a, b)), math.hypot(*a) * math.hypot(*b)
    return math.degrees(math.acos(max(-1.0, min(1.0, dot / lengths)))) if lengths else 180.0


# --- what the owner does ----------------------------------------------------------------------------------------------

def fault_begins(bench, numbers):
    """Waits for a fault with one of these numbers, within the limit."""
    last_good_s = None
    for seen in bench.events(bench.limit_s):
        not_reset(seen)
        if seen.kind == "row" and not seen.row.flags & protocol.NO_SAMPLE:
            last_good_s = seen.at_s
        match = FAULT.match(seen.text) if seen.kind == "said" else None
        if match:
            number = int(match[1])
            bench.measured(fault=number, fault_after_s=round(seen.at_s - last_good_s, 3) if last_good_s is not None else None)
            if number not in numbers:
                raise Failed(f"fault {number} was reported, expected {' or '.join(map(str, numbers))}")
            return
    raise Failed(f"no fault was reported within {bench.limit_s:.0f} s")


def fault_state(seen):
    """True: the line reports a fault as over; False: it reports a new one; None: any other line."""
    if seen.kind != "said" or not seen.text.startswith("# fault"):
        return None
    return OVER.match(seen.text) is not None


class Recovery:
    """From the beginning of a fault until it is over for good."""

    def __init__(self, bench, is_over):
        self.bench, self.over_s, self.first_s = bench, bench.now() if is_over else None, None
        self.times = self.lost = self.lasted_ms = self.silent = 0

    def add(self, seen):
        match = OVER.match(seen.text) if fault_state(seen) else None
        if match:
            self.over_s, self.first_s = seen.at_s, None
            self.times, self.lasted_ms, self.lost = self.times + 1, self.lasted_ms + int(match[2]), self.lost + int(match[3])
            self.bench.measured(times=self.times, fault_lasted_ms=self.lasted_ms, samples_lost=self.lost, sensor=f"0x{match[4]}")
        elif fault_state(seen) is False:
            self.over_s = None
        if seen.kind == "row":
            self.silent += bool(seen.row.flags & protocol.SILENCE)
            if self.over_s is not None and self.first_s is None and not seen.row.flags & protocol.NO_SAMPLE:
                self.first_s = seen.at_s
                self.bench.measured(rows_back_s=round(seen.at_s - self.over_s, 3))

    def is_done(self, seen):
        return self.over_s is not None and seen.at_s - self.over_s > QUIET_S


def well_again(bench, is_over=False):
    """Waits until no fault has begun for a while: a wire reconnected by hand makes and breaks contact several times. Then checks for rows at the
    nominal rate. Returns how many rows had no sample meanwhile."""
    recovery = Recovery(bench, is_over)
    for seen in bench.events(bench.limit_s):
        not_reset(seen)
        recovery.add(seen)
        if recovery.is_done(seen):
            bench.measured(rows_without_sample=recovery.silent, rate_hz=round(steady(bench).rate_hz, 2))
            return recovery.silent
    raise Failed(f"the fault was not over within {bench.limit_s:.0f} s")


class Start:
    """What the board reported when it started. since_s: the last row before; port_gone_s: how long the port was away, None: never."""

    def __init__(self, banner, cause, kept, since_s, port_gone_s):
        self.banner, self.cause, self.kept, self.since_s, self.port_gone_s = banner, cause, kept, since_s, port_gone_s


def restart(bench, needs_gone=False):
    """The restart that the owner causes within the limit. A returning port may reset the board once more: the last banner counts.
    needs_gone: by its supply, which takes a UNO's port away."""
    last_row_s, gone_s, back_s, away_s, parts = bench.now(), None, 0.0, None, {}
    until_s = bench.now() + bench.limit_s
    while (seen := bench.next(until_s)) is not None:
        if seen.kind == "gone":
            gone_s, parts = seen.at_s, {}
        elif seen.kind == "back" and gone_s is not None:
            away_s, back_s, gone_s = seen.at_s - gone_s, seen.at_s, None
            until_s = max(until_s, seen.at_s + ROWS_WITHIN_S)
        elif seen.kind == "said":
            hear_start(seen, parts)
        elif seen.kind == "row" and gone_s is None:
            if "kept" in parts and (away_s is not None or not needs_gone or parts["cause"] in SUPPLY):
                bench.put_back(seen)
                return Start(parts["banner"], parts["cause"], parts["kept"], last_row_s, away_s)
            if away_s is not None and not parts and seen.at_s - back_s > OPENED_S:  # opening the port did not reset it
                return Start(None, None, None, last_row_s, away_s)
            if away_s is None and not parts:
                last_row_s = seen.at_s
    raise Failed(f"the board did not restart within {bench.limit_s:.0f} s" + (" (the port is gone)" if gone_s is not None else ""))


def hear_start(seen, parts):
    if is_banner(seen):
        parts.clear()
        parts["banner"] = seen
    for name, pattern in (("cause", CAUSE), ("kept", KEPT)):
        match = pattern.match(seen.text)
        if match and "banner" in parts:
            parts[name] = match[1]
