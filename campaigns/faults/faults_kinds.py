"""The kinds of faults that the campaign of campaigns/faults/faults.py knows, with their limits."""
import dataclasses

from faults_judge import GATED_ROWS, LINE_MS, NO_LIMIT, PASS_CYCLES, Command
from laws import DEFAULT, LIGHT, PLAIN, ROBUST

REST, MOVING = "sim/streams/rest-2lsb.csv", "sim/streams/tilt-slow.csv"
SIX_SIDES = "six sides"  # made for the campaign
BEGIN_MS, RUN_MS = 1000, 2600  # streaming and warmed up; the fault and the second after it
BUS_MS, POWER_MS, RESET_MS = 50, 150, 600  # limits until the first good row


def later(when, what):
    """WHEN of one of a kind's faults: "@MS fault" comes so much later than the first."""
    return f"{float(when[:-2]) + float(what.partition(' ')[0][1:]):.3f}ms" if what.startswith("@") else when


@dataclasses.dataclass(frozen=True)
class Kind:
    name: str
    what: tuple  # KIND[:PARAM] of simrun, of faults that begin together, or so many ms later: "@MS KIND"
    lasts_ms: float = 0  # the first of them, if it is a state
    limit_ms: float = BUS_MS
    lost_max: int = None  # samples that it may cost, where it is not for the time that it lasts
    resets: int = 0
    rate: int = 100
    detectable: bool = True
    typed: tuple = ()  # MS:TEXT, commands that come meanwhile
    more_ms: int = 0  # that its run takes longer
    stream: str = None  # where it is not that of the rate
    base: str = ""  # of one at another rate: the kind's name at its own
    filter_name: str = DEFAULT  # where the campaign has it in one only; None: nobody asks for one
    pass_cycles: int = PASS_CYCLES  # the longest pass of the main loop
    row_ms: float = 0  # from row to row at the end, where it is not that of the rate
    said_ms: float = LINE_MS  # what the firmware says at once ahead of a row, as long as it takes
    gated_rows: int = GATED_ROWS  # that a filter may refuse, one after another
    command: Command = None  # that is carried out while the fault comes
    prints: str = ""  # how a line begins that its run has to print
    once: bool = False  # of such a kind: it strikes a single transfer
    taken: bool = False  # it gives a value near those before it, which a filter takes; then it refuses true ones until it begins anew

    def stops(self):
        return self.command is not None and not self.command.rate

    def faults(self, when):
        return [f"{later(when, what)}:{what.rpartition(' ')[2]}" for what in self.what]


def state(name, lasts_ms, limit_ms=BUS_MS, **more):
    return Kind(name, (f"{more.pop('what', name)}:{lasts_ms}",), lasts_ms, limit_ms, **more)


def once(name, what=None, **more):
    return Kind(name, (what or name,), **more)


UNSEEN = {"detectable": False, "lost_max": 2}
KINDS = [
    state("unplug", 200, POWER_MS), state("power", 50, POWER_MS), state("sda", 40), state("scl", 40),
    once("hang", "hang:5", lost_max=2), once("hang a byte", "hang:9", lost_max=2), once("arb", lost_max=2), once("buserr", lost_max=2),
    once("nack", lost_max=2), once("nackdata", lost_max=2), once("torn", lost_max=2),
    Kind("devid", ("power:20", "devid:0:200"), 200, POWER_MS), state("noint", 200), state("inthigh", 200), once("glitch", lost_max=2),
    state("storm", 200, what="storm:1000"), state("frozen", 300, POWER_MS), state("clip", 200, NO_LIMIT, what="clip:z", lost_max=2),
    state("odr fast", 400, what="odr:50000"), state("odr slow", 400, what="odr:-50000"), state("rxflood", 200), state("txstall", 150),
    Kind("overrun", ("overrun:3:150",), 100, BUS_MS, rate=400), Kind("starve", ("starve:2000",), 250, RESET_MS, resets=1),
    once("reset", resets=1, limit_ms=RESET_MS), once("mcupower", resets=1, limit_ms=RESET_MS), once("brownout", resets=1, limit_ms=RESET_MS),
    once("flip 1", "flip:1", **UNSEEN), once("flip 2", "flip:2", **UNSEEN),
    once("noise", "noise:60", **UNSEEN), once("double", "double:z", **UNSEEN), once("mixed", taken=True, **UNSEEN),
]


# rows are held behind these until the next line
HELD_BEHIND, HELD_MS = {"help", "status", "settings"}, 200


def typed(name, what, *lines, begin_ms=BEGIN_MS - 20, every_ms=45, **more):
    """A fault while somebody types: what is judged is that nothing hangs and that no row is wrong."""
    at = [(begin_ms + every_ms * n, line) for n, line in enumerate(lines)]
    if HELD_BEHIND.intersection(lines):
        at.append((at[-1][0] + HELD_MS, "every"))
    commands = tuple(f"{ms}:{line}" for ms, line in at)
    return Kind(name, (what,) if isinstance(what, str) else what, limit_ms=NO_LIMIT, typed=commands, **more)


TYPED = [
    typed("typed: filters", "scl:40", f"filter {PLAIN}", f"filter {ROBUST}", f"filter {LIGHT}", f"filter {DEFAULT}", "filter",
          "filter none", "status",
          filter_name=None, said_ms=300),
    typed("typed: settings", "noint:300", "rate 200", "rate", "rate 3", "rate 99999999", "range 4", "range 3", "range", "every 3", "every 0", "every",
          "rate 800", "status", "baud 250000", "baud 1", "baud 9600", "baud", "rate 800", "every",
          row_ms=75, said_ms=300),  # every 60 at 800 Hz, and five replies, 250 characters at 9600 baud
    typed("typed: words", "unplug:300", "help", "status", "st\x07atus", "x" * 90, "HELP 3", "go now", "stop", "go", "mode plot", "mode", "mode csv",
          "mode x", "status", "help", said_ms=300),
    typed("typed: spoilt bytes", ("rxspoil:0", "@50 rxspoil:1", "@100 rxspoil:0"), "help", "status", "rate", "every 1", said_ms=300),
    typed("typed: stop", "power:50", "stop", "status", "go", "stop", "go", "stop", "stop", "range 2", "go", every_ms=11),
    typed("typed: plot", "sda:60", "mode plot", "status", "mode csv", every_ms=400, filter_name=ROBUST),
    typed(f"typed: {LIGHT}", "frozen:200", f"filter {LIGHT}", f"filter {ROBUST}", every_ms=300, filter_name=ROBUST),
    typed("typed: what is settled", "noint:300", "settings", "offset 10 -10 3.5", "scale 260 260 250", "level 0 0.1 0.99", "axes -yxz", "address 53",
          "settings", "offset 99 0 0", "scale 1 1 1", "level 9 9 9", "axes xxy", "address 12", "offset 1", "save", "status", "defaults", "settings",
          every_ms=120, more_ms=1000, said_ms=320),
    # 0.3 s for each save that finds every byte another; 100 ms for a start
    typed("typed: what is kept", "unplug:100", "stop", "every 2", "offset 5 5 5", "save", "load", "defaults", "load", "save", "go", every_ms=400,
          more_ms=3000, row_ms=20, said_ms=1700),
    typed("typed: measures", "nackdata", "odr", "noise", "tare", "settings", every_ms=2900, more_ms=8500, said_ms=320),
    typed("typed: what the sensor's force adds", "sda:40", "selftest", "odr", every_ms=2900, more_ms=3000, said_ms=1500),
    typed("typed: calibrations", "torn", "cal6", "noise", "cal6 stop", "cal", "go", every_ms=2900, more_ms=11600,
          said_ms=20),  # two lines ahead of a row
    # one on each side, none of which loses a sample: that would end the measurement
    typed("typed: cal6 to its end", ("torn", "@7000 nack", "@14000 arb", "@21000 nackdata", "@28000 buserr", "@35000 glitch"), "cal6",
          stream=SIX_SIDES, more_ms=42000, said_ms=80, prints="# cal6: residual "),
    typed("upside down", "nack", stream="sim/streams/through-roll-180.csv"), typed("upright", "nackdata", stream="sim/streams/through-pitch-90.csv"),
    # what these streams do to one axis, the filter sees on the others at another time
    *(typed(f"outliers, {name}", "nack", stream="sim/streams/steps-outliers.csv", filter_name=name, gated_rows=3 * GATED_ROWS)
      for name in (DEFAULT, ROBUST, LIGHT)),
    *(typed(f"vibration, {name}", "buserr", stream="sim/streams/vibration.csv", filter_name=name, gated_rows=3 * GATED_ROWS)
      for name in (ROBUST, LIGHT)),
    # a byte every 160 cycles, and its handler takes 66 of them
    typed("flood at 1000000 baud", "rxflood:200", "baud 1000000", begin_ms=900),
    # behind one another; the fourth start in a row by the watchdog is with safe settings
    typed("starve again", ("starve:2000", "@450 starve:2000", "@900 starve:2000", "@1350 starve:2000"), "status", begin_ms=3300, resets=4,
          row_ms=80, said_ms=300),
]
OF = {kind.name: kind for kind in KINDS}


def longer(name, lasts_ms):
    """A kind whose state lasts as many seconds as somebody needs to pull a plug and put it in again: the limits are those of the short one."""
    kind = OF[name]
    first, last = kind.what[:-1], kind.what[-1].rpartition(":")[0]
    return dataclasses.replace(kind, name=f"{name}, {lasts_ms / 1000:g} s", what=(*first, f"{last}:{lasts_ms}"), lasts_ms=lasts_ms)


# what counts tries or doubles a time from try to try shows only here
LONG = [longer(name, ms) for name in ("unplug", "power", "sda", "scl", "devid", "noint", "inthigh") for ms in (3000, 10000)]
LONG += [longer("frozen", ms) for ms in (1500, 10000)]
# the same at other rates; below 100 Hz the first good row may take three periods more, behind a value that a filter took those of the
# samples that it refuses and the one from which it begins anew
OTHER_RATES = (12.5, 400, 800)


def at_rate(kind, rate):
    longer = 1000 * (GATED_ROWS + 1 if kind.taken else 3) / rate if rate < 100 else 0
    return dataclasses.replace(kind, name=f"{kind.name}, {rate:g} Hz", base=kind.name, rate=rate, limit_ms=kind.limit_ms + longer)


def rated():
    """Every kind at each of the other rates but its own; at 12.5 Hz no sensor's FIFO runs over before the watchdog barks."""
    return [at_rate(kind, rate) for kind in KINDS for rate in OTHER_RATES if kind.rate != rate and not (kind.name == "overrun" and rate < 100)]
