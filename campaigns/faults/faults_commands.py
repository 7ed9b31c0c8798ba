"""Faults while a command is carried out: which commands, which faults, and when they come; part of the fault campaign (faults.py)."""
import dataclasses
import random

from faults_judge import END_MS, LAST_MS, NO_LIMIT, Command
from faults_kinds import BEGIN_MS, OF, RUN_MS
from faults_runs import simulate

BEFORE_MS, CHANGE_MS = 1, 8  # a change is over 7 ms after its command
GO_MS = 30  # from `stop` to `go`
CHANGE_SAID_MS = 80  # from the last row ahead of a change, or of a status, to the first behind it more than from row to row
COMMANDS = (
    Command("rate 50", (f"{BEGIN_MS}:rate 50",), rate=50),
    Command("rate 400", (f"{BEGIN_MS - 200}:baud 500000", f"{BEGIN_MS}:rate 400"), rate=400),
    Command("range 8", (f"{BEGIN_MS}:range 8",), range_g=8),
    Command("stop", (f"{BEGIN_MS}:stop",), rate=0),
    Command("stop and go", (f"{BEGIN_MS}:stop", f"{BEGIN_MS + GO_MS}:go")),
)
# rows are held behind a status until the next line
STATUS = (f"{RUN_MS - LAST_MS - 50}:status", f"{RUN_MS - LAST_MS}:every", f"{RUN_MS - END_MS}:status")
# of a single transfer, at each of the change; of the bus, the supply and INT1, and others of the sensor, at so many moments
TRANSFERS = ("hang", "arb", "buserr", "nack", "nackdata", "torn")
LAST_BYTE = {"nack": 1, "nackdata": 2}  # what comes later strikes the next transfer; every other kind: 3, as long as each transfer is
MOMENTS = {"unplug": 10, "power": 10, "sda": 10, "scl": 10, "noint": 10, "inthigh": 10, "devid": 6, "storm": 6, "frozen": 6, "glitch": 6,
           "hang a byte": 6}


def during(kind, command):
    """The kind with a command; a good row may take three periods more below 100 Hz, and comes when there is a `go`."""
    wait_ms = command.given_ms() - BEGIN_MS
    period_ms = 1000 / command.rate if command.rate else 0
    limit_ms = kind.limit_ms + wait_ms + (3 * period_ms if period_ms > 10 else 0) if command.rate else NO_LIMIT
    return dataclasses.replace(kind, name=f"command {command.name}: {kind.name}", base=kind.name, command=command, typed=command.typed + STATUS,
                               limit_ms=limit_ms, lost_max=None, once=kind.name in (*TRANSFERS, "hang a byte"), row_ms=period_ms,
                               said_ms=CHANGE_SAID_MS + wait_ms)


KINDS = [during(OF[name], command) for command in COMMANDS for name in (*TRANSFERS, *MOMENTS)]


def windows(command):
    """(begin, end) in ms of each change of the sensor that the command brings."""
    return [(begin - BEFORE_MS, begin + CHANGE_MS) for begin in dict.fromkeys((BEGIN_MS, command.given_ms()))]


def transfers(firmware, filter_name, kind, memory={}):
    """Numbers of the transfers in these windows."""
    if kind.command not in memory:
        typed = [word for each in kind.command.typed for word in ("--cmd", each)]
        count = [[simulate(firmware, filter_name, *typed, max_ms=ms)[2]["i2c_transfers"] for ms in window] for window in windows(kind.command)]
        memory[kind.command] = [number for first, last in count for number in range(first + 1, last + 1)]
    return memory[kind.command]


def moments(kind, count, source):
    """WHENs in the windows, in turn; every second fault that lasts begins so much earlier that its end is there."""
    whens, places = [], windows(kind.command)
    for n in range(count):
        begin, end = places[n % len(places)]
        ms = begin + (end - begin) * (n // len(places) + source.random()) / -(-count // len(places))
        whens.append(f"{ms - (kind.lasts_ms if n // len(places) % 2 else 0):.3f}ms")
    return whens


def phases(firmware, kind, seed):
    """WHENs of a kind: each transfer of the change at one of its first bytes, or moments."""
    source = random.Random(f"{seed} {kind.name}")
    if kind.base in MOMENTS:
        return moments(kind, MOMENTS[kind.base], source)
    whens = [f"xfer:{number}.{source.randint(1, LAST_BYTE.get(kind.base, 3))}" for number in transfers(firmware, kind.filter_name, kind)]
    return whens + moments(kind, max(0, 10 - len(whens)), source)
