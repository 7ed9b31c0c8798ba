"""Interrupts served where main shares something with their handlers (simrun --race); part of system_tests.py, in length: make race."""
import re

import race  # noqa: E402
from images import filters_of  # noqa: E402
from system_support import BOUNDS, FW, OUT, SIMRUN, STREAMS, run, simrun, test  # noqa: E402

# functions whose every access to what they share with a handler has interrupts off, and those of which a part has
CLOSED = ("hal_time_us", "hal_wake_at", "claim", "adxl345_burst_begun_us")
HAVE_SECTIONS = ("adxl345_burst_read", "adxl345_burst_set_mode", "adxl345_driver_take_bus", "hal_uart_tx_commit")
# what the firmware itself counts when its clock or its bus was spoilt
SPOILT = re.compile(r"(# lost|late|torn|arbitration lost|bus errors|timeouts|not acknowledged|restarts) (\d+)")


def race_run(name, ms, phases, faults):
    """(pairs, notes) of a run with every row right, no reset and no hang."""
    options = race.options_of(ms, phases, filters_of(FW), faults)
    _, notes, _, stats = simrun(name, STREAMS / "outliers-15pct.csv", "--loop", "--max-ms", ms, "--race", OUT / f"{name}.race.csv", *options)
    pairs = race.pairs_of(OUT / f"{name}.race.csv")
    assert not race.faults_of(stats, pairs), race.faults_of(stats, pairs)
    return pairs, notes


def function_of(pair):
    return pair["symbol"].split("+")[0].split(".")[0]


def assert_taken(pairs, vector, *variables):
    """Each of these variables was met by that handler."""
    for variable in variables:
        met = [p for p in pairs if p["vector"] == vector and p["variable"].split("+")[0] == variable]
        assert any(p["taken"] for p in met), f"{variable} and {vector}: {met}"


def assert_guarded(pairs):
    """By the functions' names, of which other compilers put some in line."""
    if not BOUNDS:
        return
    for name in CLOSED + HAVE_SECTIONS:
        states = [p["state"] for p in pairs if function_of(p) == name]
        assert "guarded" in states, f"{name} has no section: {states}"
        assert name not in CLOSED or set(states) == {"guarded"}, f"{name}: {states}"


@test
def race_on_a_sound_bus_leaves_rows_time_and_counters_right():
    pairs, notes = race_run("race-sound", 20000, 4, faults=False)
    assert_taken(pairs, "usart_udre", "tx", "tx_buffer")
    assert_taken(pairs, "timer1_compa", "breadcrumb")
    assert_taken(pairs, "twi", "burst")
    assert_taken(pairs, "int0", "burst")
    assert_guarded(pairs)
    spoilt = [f"{what} {count}" for note in notes for what, count in SPOILT.findall(note) if int(count)]
    faults = [note for note in notes if note.startswith("# fault")]
    assert not spoilt and not faults, (spoilt, faults)


@test
def race_with_faults_of_the_wires_leaves_rows_right():
    pairs, _ = race_run("race-faults", 24000, 5, faults=True)
    assert_taken(pairs, "usart_rx", "rx", "rx_buffer")


@test
def race_that_cannot_be_is_refused():
    arguments = (SIMRUN, "--fw", FW, "--in", STREAMS / "tilt-fast.csv", "--out", OUT / "x.csv")
    done = run(*arguments, "--race", OUT / "x.race.csv", "--pty", expect=2)
    assert "--race goes with neither --gdb nor --pty" in done.stderr, done.stderr
    done = run(*arguments, "--race", OUT / "no-such" / "x.race.csv", expect=2)
    assert "no-such" in done.stderr and "computing" not in done.stderr, done.stderr
