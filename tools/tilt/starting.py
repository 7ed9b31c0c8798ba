"""The steps of `tilt start`, from wiring to a picture, over the bench of `tilt board`. Each step prints what to do, can be skipped, and is repeated
as often as the owner wants."""
import collections
import contextlib
import re
from types import SimpleNamespace

from tilt import native, protocol
from tilt.commands import plot, record, tune
from tilt.errors import TiltError
from tilt.realboard import watch
from tilt.realboard.bench import Bench, Failed, Quit, Repeat, Skip
from tilt.recorder import Recorder
from tilt.stream import Stream

ANSWER_S, ROWS_S, ODR_S = 5.0, 6.0, 3.0  # the board measures its rate each second
IN_FORCE = "# in force now"
BUSY, BUSY_S, BUSY_MOST = "# refused 10", 1.0, 20
TARE_S, SELFTEST_S, SIDES_S = 25.0, 30.0, 130.0  # the board gives up by itself before
RECORD_S, RECORD_LATE_S = 30.0, 15.0             # by the board's clock, and so much later by the PC's
RATES = [f"{rate / 10:g}" for rate in native.RATES_DHZ]
OF_THE_BUS = ("not acknowledged", "arbitration lost", "bus errors", "timeouts", "torn", "empty")


class Guided(Bench):
    """Asks for no reason when a step is skipped; faults {number: words} are those that the board has reported."""

    def __init__(self, wire, owner):
        self.faults = {}
        super().__init__(wire, owner)

    def reason(self):
        return "skipped"

    def fill(self, timeout_s):
        had = len(self.waiting)
        super().fill(timeout_s)
        for seen in list(self.waiting)[had:]:
            if seen.kind == "said" and (match := watch.FAULT.match(seen.text)):
                self.faults[int(match[1])] = seen.text[match.end():]


def choice(bench, question, answers):
    """What the owner types, of the answers; s, r and q act, anything else is asked again."""
    while True:
        typed = bench.line(f"   {question}: ").strip().lower()
        bench.heed(typed)
        if typed in answers:
            return typed
        bench.say(f"   '{typed}' is no answer here: {' '.join(answer or 'Enter' for answer in answers)}, s to skip, r to repeat, q to quit")


def answered(bench, command, last, limit_s=ANSWER_S):
    """Types the command and prints what the board says, to a line that begins with `last`, which is the result; Failed as in watch.said."""
    bench.type(command)
    busy = 0
    while True:
        seen, _ = watch.said(bench, "# ", limit_s, f"reply to '{command}'")
        if seen.text.startswith(BUSY) and busy < BUSY_MOST:  # with the measurement of a step that was skipped
            collections.deque(bench.events(BUSY_S), 0)
            bench.type(command)
            busy += 1
            continue
        if seen.text.startswith(protocol.REFUSED):
            raise Failed(f"the board refused '{command}': {seen.text.partition(': ')[2]}")
        bench.say(f"   {seen.text[2:]}")
        if seen.text.startswith(last):
            return seen.text


# --- the steps --------------------------------------------------------------------------------------------------------


def wiring(bench, _):
    """`status` in words; Failed with what to check."""
    lines = watch.listing(bench, "status")
    state = re.match(r"# state (\w+)", " ".join(lines[:1]))
    found = {name: int(number) for line in lines for name, number in re.findall(r"([a-z][a-z ]*[a-z]) (\d+)", line)}
    if found.get("fault"):
        raise Failed(f"fault {found['fault']}: {bench.faults.get(found['fault'], 'docs/faults.md lists what to check')}")
    if state and state[1] != "streaming":
        answered(bench, "go", "# going")
    if bench.settings.get("mode") == "plot":
        answered(bench, "mode csv", "# mode")
    roll, pitch = watch.row_with_sample(bench, ROWS_S).row.values[7:9]
    bench.say(f"   The sensor answers: roll {roll / 100:.1f}, pitch {pitch / 100:.1f} degrees, no fault.")
    failed = sum(number for name, number in found.items() if name in OF_THE_BUS)
    if failed:
        bench.say(f"   {failed} transfers on SDA and SCL failed since the start: shorten the wires and check their plugs.")


def selftest(bench, _):
    """The sensor's own force, on each axis."""
    bench.say("   The board must lie still.")
    last = answered(bench, "selftest", "# selftest z", SELFTEST_S)
    if any("FAIL" in line for line in [*bench.lines, last] if line.startswith("# selftest")):
        raise Failed("an axis is out of the data sheet's limits: feed the sensor 3.3 V, and hold it still; else it is broken")


def calibrate(bench, _):
    """cal6 or tare, as the owner wants."""
    bench.say("   cal6: lay the board on its six sides in turn (2 minutes). tare: it lies level now, and roll and pitch become 0.")
    kind = choice(bench, "cal6 or tare", ("cal6", "tare"))
    if kind == "tare":
        bench.say("   Do not touch it.")
        answered(bench, "tare", IN_FORCE, TARE_S)
    else:
        bench.say("   Lay it on any side, wait for its line, then on the next one.")
        try:
            answered(bench, "cal6", IN_FORCE, SIDES_S)
        except (Failed, KeyboardInterrupt, Quit, Repeat, Skip):
            with contextlib.suppress(Failed):  # the port is gone
                bench.type("cal6 stop")
            raise


def noise(bench, _):
    """The sensor's noise, at rest."""
    bench.say("   The board must lie still.")
    answered(bench, "noise", "# noise z", TARE_S)
    bench.say("   A sensor at rest has about 1 LSB rms up to 100 Hz, 3 at 800 Hz; far more is vibration, a loose wire or a bad supply. The filters "
              "measure it themselves.")


def rate(bench, state):
    """The output data rate."""
    now = watch.setting(bench, "rate")
    typed = choice(bench, f"Samples per second, of {' '.join(RATES)} (Enter keeps {now})", ("", *RATES))
    if typed and typed != now:
        answered(bench, f"rate {typed}", "# rate")
        bench.say("   Rows that the line cannot carry are left out; `baud 500000` carries all of 400 Hz.")
        collections.deque(bench.events(ODR_S), 0)
    state.rate_hz = float(typed or now)
    answered(bench, "odr", "# odr")


def recording(bench, state):
    """30 s into the file, as `tilt record` writes it."""
    bench.say(f"   Move the sensor as it will move in use, for {RECORD_S:.0f} s, into {state.path}.")
    choice(bench, "Enter starts the recording", ("",))
    output = record.Output(state.path, state.force)
    recorder = Recorder(output.write)
    bench.forget()
    recorder.feed(b"\n" + protocol.HEADER.encode() + b"\n")
    try:
        for seen in bench.events(RECORD_S + RECORD_LATE_S):
            if seen.kind == "gone":
                recorder.outage()
            elif seen.kind != "back":
                recorder.feed(seen.text.encode("latin-1") + b"\n")
            if recorder.counts.span_us >= RECORD_S * 1e6:
                break
        recorder.finish()
    finally:
        output.close()
        state.force = state.force or output.file is not None  # to repeat the step
        state.recorded = recorder.counts.rows > 0
    if not recorder.counts.rows:
        raise Failed("no row arrived: check the wiring, and type r to repeat")
    bench.say("   " + record.summary(recorder.counts, state.path).replace("\n", "\n   "))


def tuned(bench, state):
    """The parameters that suit the recording, typed if the owner wants them."""
    if not state.recorded:
        raise Skip("nothing is recorded")
    name = watch.setting(bench, "filter")
    bench.say(f"   Fitting {name} to {state.path}; the first time it builds the filters, which takes a minute.")
    stream = Stream.read(state.path)
    answer = tune.measured(stream, name, native.rate_of(stream, state.rate_hz))
    bench.say("   " + "\n".join(tune.lines(answer)).replace("\n", "\n   "))
    if answer["commands"] and choice(bench, "Type these into the board? y or n", ("y", "n")) == "y":
        for command in answer["commands"]:
            answered(bench, command, f"# {command.split()[0]}")


def plotted(bench, state):
    """The picture of the recording."""
    if not state.recorded:
        raise Skip("nothing is recorded")
    picture = state.path.with_suffix(".png")
    plot.run(SimpleNamespace(files=[str(state.path)], output=str(picture), columns=",".join(plot.USUAL), from_s=None, to_s=None, stack=False,
                             title=None))
    bench.say(f"   Look at {picture}: grey is raw, blue is filtered.")


def save(bench, _):
    """Everything set above, into the EEPROM."""
    if choice(bench, "Keep the calibration and the values when the power is off? y or n", ("y", "n")) == "y":
        answered(bench, "save", "# saved")


STEPS = (("wiring", wiring), ("self-test", selftest), ("calibration", calibrate), ("noise", noise), ("rate", rate), ("recording", recording),
         ("tune", tuned), ("plot", plotted), ("save", save))


# --- the guide --------------------------------------------------------------------------------------------------------


def guide(bench, state):
    """Leads through all steps; {step: done, skipped, or why not}."""
    results = {}
    for number, (name, step) in enumerate(STEPS, 1):
        bench.say(f"\n{number}/{len(STEPS)} {name}")
        results[name] = until_done(bench, step, state)
        bench.say(f"   {results[name]}")
    return results


def until_done(bench, step, state):
    while True:
        bench.begin(SIDES_S)
        try:
            bench.forget()
            step(bench, state)
            return "done"
        except (Failed, TiltError) as why:
            bench.say(f"   Not done: {why}")
        except Skip as why:
            return "skipped" if str(why) == "skipped" else f"skipped: {why}"
        except Repeat:
            continue
        try:
            choice(bench, "Enter tries again, s skips this step, q quits", ("",))
        except Skip:
            return "skipped"
        except Repeat:
            pass
