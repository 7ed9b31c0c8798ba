"""How the fault campaign judges one run and a whole campaign: every limit, and which kind of fault has another one (a field of its Kind)."""
import dataclasses
import math

NO_LIMIT = 9999  # ms to a good row: readings that were true and are no longer at the rail; when the filter takes them is its own affair
PASS_CYCLES = 64000  # 4 ms of main loop at 16 MHz
LINE_MS = 8  # a row waits until the line ahead of it is out: 90 characters at 115200 baud
# samples that a filter refuses at most, one after another, before it restarts from them (lib/filters/src/parameters.c: reacquire)
GATED_ROWS = 5
PHASES_AT_LEAST, LONG_PHASES_AT_LEAST, PAIR_PHASES_AT_LEAST, COMMAND_PHASES_AT_LEAST = 50, 8, 5, 6
STANDBY_MS = 100  # a sensor that is to stand still has it from the end of a fault
STOP_MS = 20  # rows of what was under way when `stop` came
STEP_SHARE, MEASURED_SHARE = 0.25, 0.02  # by which two rows' distance and the rate in `status` may be off
LAST_MS = 500  # of a run, in which the command's work is done
END_MS = 60  # of it, in which no rows come behind the last status
HELD_MS = 60  # behind the status before it: rows that are held count as lost in --stats
# what a whole campaign has to have, and the kinds that are it
REQUIRED = {
    "unplug and plug": ("unplug",), "power cycle": ("power",), "SDA low": ("sda",), "SCL low": ("scl",),
    "slave hung inside a byte": ("hang", "hang a byte"), "arbitration lost": ("arb",), "bus error": ("buserr",), "address NACK": ("nack",),
    "data NACK": ("nackdata",), "wrong DEVID": ("devid",), "frozen data": ("frozen",), "missing data-ready": ("noint",),
    "storming data-ready": ("storm",), "torn burst": ("torn",), "single bit flips": ("flip 1",), "double bit flips": ("flip 2",),
    "value noise": ("noise",), "doubled axis": ("double",), "FIFO overrun": ("overrun",), "UART RX garbage flood": ("rxflood",),
    "TX back-pressure": ("txstall",), "watchdog starvation": ("starve",), "ODR +-5 %": ("odr fast", "odr slow"),
}


def row_ms(kinds):
    """From row to row when all is over. Settings are not saved: after a reset they are those of the start, 100 Hz."""
    if kinds[0].row_ms:
        return kinds[0].row_ms
    rate = 100 if any(kind.resets for kind in kinds) else max(kind.rate for kind in kinds)
    every = 2 if rate > 400 else 1  # what 500,000 baud carry
    return 1000 * every / rate


def lost_most(kinds):
    """
    How many samples they may cost together: as many as a kind says, else those of the time that it lasts and of its limit to the first good
    row. None: what somebody types has no limit.
    """
    if any(kind.lost_max is None and kind.limit_ms >= NO_LIMIT for kind in kinds):
        return None
    rate = max(max(kind.rate, kind.command.rate if kind.command else 0) for kind in kinds)
    held_ms = HELD_MS if any(kind.command for kind in kinds) else 0
    return sum(math.ceil((kind.lasts_ms + kind.limit_ms + held_ms) * rate / 1000) if kind.lost_max is None else kind.lost_max for kind in kinds)


def resets_due(kinds, whens):
    """
    How many resets there have to be. Each kind says for itself; of a pair, a reset ends the starvation before the watchdog has seen its
    250 ms of it, when it comes into it: None where that cannot be known, because the reset comes about as late as the watchdog barks.
    """
    due = sum(kind.resets for kind in kinds)
    names = [kind.name for kind in kinds]
    if due < 2 or len(kinds) < 2 or "starve" not in names:
        return due
    begins = names.index("starve")
    later_ms = float(whens[1 - begins][:-2]) - float(whens[begins][:-2])
    return due if later_ms < 0 else due - 1 if later_ms < 200 else None


@dataclasses.dataclass(frozen=True)
class Command:
    """What somebody types while the fault comes, and what has to be in force at the end."""
    name: str
    typed: tuple  # MS:TEXT; with the last one the command is given
    rate: int = 100  # 0: stopped
    range_g: int = 16

    def given_ms(self):
        return float(self.typed[-1].partition(":")[0])


@dataclasses.dataclass(frozen=True)
class Ending:
    """What a run with a command has come to, in its last half second: what the virtual sensor does, the rows, and what `status` says twice."""
    sensor_hz: float  # 0: standby
    range_g: int
    measured_since_ms: float  # from the end of the fault, or from the command, whichever came later, until the sensor measured last
    steps_us: tuple  # from row to row
    coasted: int  # rows that are a prediction
    rows_since: int  # rows stamped later than STOP_MS after the command
    states: tuple  # (state, rate, measured rate) of each status
    lost: tuple  # samples lost, as each status has it
    no_sensor: int  # lines that tell fault 1

    def failures(self, command, once):
        """once: a single transfer failed, of a sensor that was there."""
        said = [f"{self.no_sensor} times told that no sensor answers"] if once and self.no_sensor else []
        return said + (self.streaming_failures(command) if command.rate else self.stopped_failures())

    def stopped_failures(self):
        since = self.measured_since_ms
        said = [f"the sensor still measures, at {self.sensor_hz:g} Hz"] if self.sensor_hz else []
        said += [f"the sensor measured for {since:.0f} ms (limit {STANDBY_MS})"] if not self.sensor_hz and since > STANDBY_MS else []
        said += [f"{self.rows_since} rows of a stopped sensor"] if self.rows_since else []
        return said + self.told_failures("stopped", 0)

    def streaming_failures(self, command):
        due = 1e6 / command.rate
        wrong = [step for step in self.steps_us if abs(step - due) > STEP_SHARE * due]
        few = len(self.steps_us) < (LAST_MS - END_MS) * 1000 / due - 3
        said = [f"the sensor has {self.sensor_hz:g} Hz instead of {command.rate}"] if self.sensor_hz != command.rate else []
        said += [f"the sensor has {self.range_g} g instead of {command.range_g}"] if self.range_g != command.range_g else []
        said += [f"{len(wrong)} rows {wrong[0] / 1000:.1f} ms behind the one ahead instead of {due / 1000:.1f}"] if wrong else []
        said += [f"only {len(self.steps_us) + 1} rows in {LAST_MS - END_MS} ms near the end"] if few and not wrong else []
        said += [f"{self.coasted} rows coasted to the end"] if self.coasted else []
        said += [f"lost goes on growing: {self.lost[0]}, {self.lost[-1]}"] if self.lost and self.lost[-1] > self.lost[0] else []
        return said + self.told_failures("streaming", command.rate)

    def told_failures(self, state, rate):
        """What `status` says."""
        if len(self.states) != 2 or len(self.lost) != 2:
            return [f"{len(self.states)} of 2 status replies are whole"]
        said = [f"status says {told}" for told, _, _ in self.states[-1:] if told != state]
        return said + [f"status says {asked:g} Hz, measured {measured:g} Hz" for _, asked, measured in self.states[-1:]
                       if rate and (asked != rate or abs(measured - rate) > MEASURED_SHARE * rate)]


@dataclasses.dataclass
class Result:
    kinds: tuple
    when: str
    filter_name: str
    hang: str  # what went wrong with the whole run, empty: nothing
    injected: bool
    recovered: bool
    ms_to_good: float
    lost: int  # None: not known
    wrong: int  # rows: wrong, stale, or the second with a sample
    steps_back: int  # rows stamped before the one ahead of them
    altered: int  # samples whose values a fault changed on their way
    resets: int
    resets_due: int  # None: not known
    pass_cycles: int
    waits: tuple  # (interrupt, its longest wait, limit) in cycles, of those that have a deadline
    calm_gap_ms: float  # longest time between two rows that show a sample, when every fault was over
    since_good_ms: float  # from the last good row to the end of the run; None: there was none
    command: str
    ending: Ending = None  # of a run with a command
    missing: tuple = ()  # lines that it had to print

    def failures(self):
        """Each as a few words."""
        said = [self.hang] if self.hang else []
        stops = self.kinds[0].stops()
        said += ["no good row any more"] if self.injected and not self.recovered and not self.hang and not stops else []
        said += self.ending.failures(self.kinds[0].command, self.kinds[0].once) if self.ending and self.injected and not self.hang else []
        said += [f"no line {line!r}" for line in self.missing] if not self.hang else []
        return said + self.beyond_limits() + (self.stream_ends() if self.recovered and not stops else [])

    def beyond_limits(self):
        limit = max(kind.limit_ms for kind in self.kinds)
        # a value that changed inside a well-formed transfer makes one row wrong
        wrong_most = 0 if all(kind.detectable for kind in self.kinds) else self.altered
        lost_max = lost_most(self.kinds) if self.lost is not None else None
        cycles = max(kind.pass_cycles for kind in self.kinds)
        said = [f"{self.ms_to_good:.0f} ms to the first good row (limit {limit:.0f})"] if self.recovered and self.ms_to_good > limit else []
        said += [f"{self.wrong} wrong rows" + f" of {wrong_most} samples altered" * (wrong_most > 0)] if self.wrong > wrong_most else []
        said += [f"{self.steps_back} steps back in time"] if self.steps_back else []
        said += [f"{self.resets} resets instead of {self.resets_due}"] if self.wrong_resets() else []
        said += [f"{self.lost} samples lost (limit {lost_max})"] if lost_max is not None and self.lost > lost_max else []
        said += [f"a pass of {self.pass_cycles} cycles (limit {cycles})"] if self.pass_cycles > cycles else []
        return said + [f"{name} waited {cycles} cycles (limit {most})" for name, cycles, most in self.waits if cycles > most]

    def wrong_resets(self):
        return 0 if self.resets_due is None or self.hang else abs(self.resets - self.resets_due)

    def stream_ends(self):
        """
        What says that rows do not go on. Behind a row the next one that shows a sample comes a row's time later, when the line that may be
        ahead of it is out. A good one may be later still, by the samples that the filter refuses.
        """
        said_ms, gated = (max(getattr(kind, field) for kind in self.kinds) for field in ("said_ms", "gated_rows"))
        gap_ms, end_ms = row_ms(self.kinds) + said_ms, (gated + 1) * row_ms(self.kinds) + said_ms
        said = [f"{self.calm_gap_ms:.0f} ms without a sample's row when all was over (limit {gap_ms:.0f})"] if self.calm_gap_ms > gap_ms else []
        since = "no good row" if self.since_good_ms is None else f"last good row {self.since_good_ms:.0f} ms before the end (limit {end_ms:.0f})"
        return said + ([since] if self.since_good_ms is None or self.since_good_ms > end_ms else [])


def shortfalls(rows, kinds, long=(), commands=()):
    """What a whole campaign has to have and these rows of build/faults.json have not, each as one sentence."""
    judged = {(row["group"], row["fault"]): row["phases"] for row in rows}
    said = [f"the required {item!r} is in no run: there is no kind {name!r}" for item, names in REQUIRED.items() for name in names
            if ("single", name) not in judged]
    for group, name, least in ([("single", kind.name, PHASES_AT_LEAST) for kind in kinds]
                               + [("long", kind.name, LONG_PHASES_AT_LEAST) for kind in long]
                               + [("pair", f"{a.name} + {b.name}", PAIR_PHASES_AT_LEAST) for n, a in enumerate(kinds) for b in kinds[n + 1:]]
                               + [("command", kind.name, COMMAND_PHASES_AT_LEAST) for kind in commands]):
        count = judged.get((group, name), 0)
        said += [f"{name}: {count} phases were judged of at least {least}"] if count < least else []
    return said
