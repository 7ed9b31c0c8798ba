"""Checks in which the board lies untouched: identity, clocks, the sensor's self-test, the bus and the line at their fastest."""
import re

from tilt import protocol
from tilt.realboard import watch
from tilt.realboard.bench import Failed

STATE = re.compile(r"# state (\w+), fault (\d+), rate ([\d.]+) Hz, measured ([\d.]+) Hz, uptime s \d+")
NEEDED = {"filter", "rate", "range", "every", "baud", "offset", "scale", "level"}
RATE_S = 30.0
CLOCK_PPM = 5500      # a UNO's resonator is within 0.5 %; 500 more for USB delays
FAST_HZ, FAST_S = 800, 20.0
BUS_ERRORS_SHARE = 1e-3  # of the samples: a single repeated read is not a fault, many point to a cable
BUS_COUNTERS = ("not acknowledged", "arbitration lost", "bus errors", "timeouts", "readings torn", "overruns")
LOST_COUNTERS = ("lost", "late")
SELFTEST_S = 15.0
BAUD_S, BAUD_ROWS = 3.0, 10
BAUD_FOUND_S = 5.0    # for the first row at another rate; the slowest sends 16 rows/s


def identity(bench):
    """Version, settings and state are reported, and there is no fault."""
    version = watch.reply(bench, "version", protocol.BANNER + "(.*)")
    settings = watch.listed(bench)
    state = next((match for match in map(STATE.match, watch.listing(bench, "status")) if match), None)
    if state is None:
        raise Failed("the reply to 'status' has no state")
    bench.measured(version=version[1], filter=settings.get("filter", ("?",))[0], fault=int(state[2]), measured_hz=float(state[4]))
    if state[1] != "streaming" or state[2] != "0":
        raise Failed(f"the board is in state '{state[1]}' with fault {state[2]}")
    missing = NEEDED - set(settings)
    if missing:
        raise Failed(f"'settings' does not list {', '.join(sorted(missing))}")


def rate(bench):
    """Half a minute of rows against the PC's clock."""
    found = watch.steady(bench, seconds=RATE_S)
    ppm, lost = found.clock_ppm(), found.lost()
    bench.measured(rows=len(found.rows), rate_hz=round(found.rate_hz, 3), rows_lost=lost, lines_spoilt=found.strange,
                   clock_ppm=None if ppm is None else round(ppm))
    if lost or found.strange:
        raise Failed(f"{lost} rows missing, {found.strange} bad lines")
    if ppm is None or abs(ppm) > CLOCK_PPM:
        raise Failed(f"the board's clock is off by {'an unknown amount' if ppm is None else f'{ppm:.0f} ppm'}, more than {CLOCK_PPM} ppm")


def selftest(bench):
    """The sensor's self-test, with the limits of its data sheet."""
    bench.type("selftest")
    verdicts = {}
    for axis in "xyz":
        _, match = watch.said(bench, rf"# selftest {axis} (-?[\d.]+) LSB, .*: (\w+)", SELFTEST_S, "result of 'selftest'")
        verdicts[axis] = match[2]
        bench.measured(**{f"{axis}_lsb": float(match[1]), f"{axis}_says": match[2]})
    failed = [axis for axis, verdict in verdicts.items() if verdict == "FAIL"]
    if failed:
        raise Failed(f"the sensor's self-test failed on {', '.join(failed)}")


def fast_bus(bench):
    """The bus at its fastest: its counters before and after."""
    reply = watch.reply(bench, f"rate {FAST_HZ}", rf"# rate {FAST_HZ} Hz(, I2C at ([\d.]+) kHz)?")
    try:
        watch.row_with_sample(bench, watch.ROWS_WITHIN_S)
        before = watch.counters(bench)
        found = watch.stretch(bench, FAST_S)
        after = watch.counters(bench)
    finally:
        bench.type(f"rate {watch.RATE_HZ}")
    grown = {name: after.get(name, 0) - before.get(name, 0) for name in BUS_COUNTERS + LOST_COUNTERS}
    samples = after.get("samples", 0) - before.get("samples", 0)
    bench.measured(khz=float(reply[2] or 0), samples=samples, seconds=round(found.board_s, 2),
                   **{name.replace(" ", "_"): number for name, number in grown.items()})
    if samples < FAST_HZ * found.board_s * (1 - watch.RATE_SHARE) or not samples:
        raise Failed(f"{samples} samples in {found.board_s:.1f} s, expected {FAST_HZ * found.board_s:.0f}")
    lost = sum(grown[name] for name in LOST_COUNTERS)
    if lost:
        raise Failed(f"{lost} samples lost")
    errors = sum(grown[name] for name in BUS_COUNTERS)
    if errors > BUS_ERRORS_SHARE * samples:
        raise Failed(f"{errors} bus errors in {samples} samples")


def baud_rates(bench):
    """At each rate that the board lists, rows arrive and no line is bad."""
    rates = [int(word) for word in watch.listed(bench).get("baud", ("", ""))[1].split()]
    if not rates:
        raise Failed("'settings' lists no baud rate")
    first, wrong = bench.wire.baud, []
    for baud in [each for each in rates if each != first] + [first]:
        why = one_baud(bench, baud)
        if why:
            wrong.append(f"{baud} ({why})")
            find_again(bench)
    if wrong:
        raise Failed(f"fails at {', '.join(wrong)}")


def find_again(bench):
    """Reconnects to an unreadable board: at the next rate that both know, or after a reset."""
    if not any(seen.kind == "row" for seen in bench.events(BAUD_FOUND_S)):
        bench.say("   The board is unreadable at this rate: press its reset button.")
        watch.restart(bench)


def one_baud(bench, baud):
    """Why this rate fails; None: it works."""
    try:
        watch.reply(bench, f"baud {baud}", rf"# baud {baud}$")
        first = next((seen for seen in bench.events(BAUD_FOUND_S) if seen.kind == "row" and bench.wire.baud == baud), None)
        if first is None:
            return f"no row within {BAUD_FOUND_S:.0f} s"
        found = watch.stretch(bench, BAUD_S)
    except Failed as why:
        return str(why)
    bench.measured(**{f"rows_at_{baud}": len(found.rows), f"spoilt_at_{baud}": found.strange})
    return f"{found.strange} bad lines, {len(found.rows)} rows" if found.strange or len(found.rows) < BAUD_ROWS else None
