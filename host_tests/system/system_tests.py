#!/usr/bin/env python3
"""The unmodified firmware in the simulator, judged by what the virtual sensor served and by the native build."""
import pathlib
import re
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import system_clock  # noqa: F401  (its tests join the list)
import system_gaps  # noqa: F401
import system_hal  # noqa: F401
import system_injections  # noqa: F401
import system_injections_more  # noqa: F401
import system_losses  # noqa: F401
import system_passes  # noqa: F401
import system_pty  # noqa: F401
import system_race  # noqa: F401
import system_sensors  # noqa: F401
import system_settings  # noqa: F401
import system_store  # noqa: F401
import system_support
import system_transcript  # noqa: F401
import system_wires  # noqa: F401
import system_words  # noqa: F401
from system_support import (FW, OUT, SET_IMAGES, SIMRUN, STREAMS, TESTS, image_with, read_output, run, run_all, simrun, test,
                            triplets, within)
import laws  # noqa: E402
from laws import DEFAULT, LIGHT, PLAIN, ROBUST  # noqa: E402

# --- chip equals PC ---------------------------------------------------------------------------------------------------

def compare_with_native(stream, filter_name):
    name = f"equal-{stream.stem}-{filter_name}"
    rows, _, served, _ = simrun(name, stream, "--filter", filter_name, fw=image_with(filter_name))
    run("build/host/native_replay", "--in", stream, "--out", OUT / f"{name}.native.csv", "--filter", filter_name)
    native, _ = read_output(OUT / f"{name}.native.csv")
    # the end of a run differs: the simulator stops some ms after the stream, the native build 300 ms
    rows = rows[:len(served)]
    native = native[:len(rows)]
    dead = triplets(served).count([-1, -1, -1])  # what a sensor without power reads as is never a row
    assert len(native) >= len(rows) - 1 and len(rows) >= len(served) - dead - 2, f"{len(rows)} and {len(native)} rows, {len(served)} samples"
    for i, (chip, pc) in enumerate(zip(rows, native)):
        if (chip[9] | pc[9]) & 16 and "gaps" in stream.stem:
            # a silence of three samples restarts the sensor, and which sample it meets depends on microseconds
            assert i > 100
            return
        assert chip[1:] == pc[1:], f"row {i}: chip {chip}, PC {pc}"


def make_equality_test(stream, filter_name):
    def check():
        compare_with_native(stream, filter_name)
    check.__name__ = f"chip_equals_pc_{stream.stem}_{filter_name}"
    return check


for path in sorted(STREAMS.glob("*.csv")):
    if "400hz" not in path.stem:
        for filter_kind in (DEFAULT, PLAIN, ROBUST, LIGHT):
            TESTS.append(make_equality_test(path, filter_kind))
for filter_kind in laws.names()[4:]:
    for stream in ("outliers-15pct", "gaps-jitter", "steps-outliers"):
        TESTS.append(make_equality_test(STREAMS / f"{stream}.csv", filter_kind))


def compare_pipeline(name, rate, baud, every_ok, filter_name=DEFAULT):
    """At other rates the cold start after `go` is the anchor: from it on the PC recomputes every column."""
    rows, notes, _, _ = simrun(name, STREAMS / "tilt-400hz.csv", "--cmd", "200:stop", "--cmd", f"300:baud {baud}", "--cmd",
                               f"400:rate {rate}", "--cmd", "500:go", "--max-ms", "6000", "--loop", "--filter", filter_name)
    assert every_ok(notes), notes
    skip = next(i for i in range(1, len(rows)) if rows[i][0] - rows[i - 1][0] > 150000)
    text = (OUT / f"{name}.csv").read_text(encoding="ascii")
    whole = OUT / f"{name}-whole.csv"
    whole.write_text(text[:text.rindex("\n") + 1], encoding="ascii")  # the end of the run cuts a row
    done = run("build/host/pipeline_replay", whole, filter_name, int(rate * 10), 16, skip)
    again = [[int(f) for f in line.split(",")] for line in done.stdout.splitlines()]
    assert len(again) > 50
    shift_us = rows[skip][0] - again[0][0]  # a stream's times count from its first row, and go on at the header after `go`
    for i, (chip, pc) in enumerate(zip(rows[skip:], again)):
        assert chip == [pc[0] + shift_us, *pc[1:]], f"row {i}: chip {chip}, PC {pc}"


@test
def pipeline_of_chip_equals_pc_at_400_hz():
    compare_pipeline("pipeline-400", 400, 500000, lambda notes: "# rate 400 Hz, I2C at 363.6 kHz" in notes)


@test
def pipeline_of_chip_equals_pc_at_12_5_hz():
    compare_pipeline("pipeline-12", 12.5, 115200, lambda notes: "# rate 12.5 Hz, I2C at 363.6 kHz" in notes)


def compare_twins(name):
    """One line for each primitive of fx*.h with a C twin. Status 8: the program ends by sleeping with interrupts off."""
    twins = {f"PASS {t}" for h in pathlib.Path("lib/filters/src").glob("fx*.h") for t in re.findall(r"\bfx_(\w+)_c\(", h.read_text("utf-8"))}
    out = OUT / f"{name}.txt"
    done = run(SIMRUN, "--fw", f"build/uno/{name}.elf", "--in", STREAMS / "tilt-fast.csv", "--out", out, "--max-ms", "60000", expect=None)
    lines = out.read_text().splitlines()
    assert done.returncode == 8, done.stderr
    assert twins and sorted(lines) == sorted(twins), lines


@test
def assembler_primitives_equal_their_c_twins():
    compare_twins("fx_twins")


@test
def assembler_primitives_equal_their_c_twins_as_the_firmware_is_built():
    compare_twins("fx_twins_firmware")


# --- nothing is lost (more in system_losses.py) ----------------------------------------------------------------------

@test
def clock_wrap_is_crossed():
    rows, _, served, _ = simrun("wrap", STREAMS / "rest-2lsb.csv", "--max-ms", "12000", fw="build/uno/wrap/firmware.elf")
    steps = [(b[0] - a[0]) % 2**32 for a, b in zip(rows, rows[1:])]
    assert rows[0][0] > 4.2e9 and rows[-1][0] < 1e9
    assert all(abs(s - 10000) <= 40 for s in steps), (min(steps), max(steps))
    assert [r[1:4] for r in rows] == triplets(served)[:len(rows)]
    assert not any(r[9] & (2 | 16 | 256) for r in rows)


def make_change_test(command, fw=FW):
    def check():
        for step in range(80):
            at_ms = 500 + step * 0.137
            rows, _, served, _ = simrun("change", STREAMS / "rest-2lsb.csv", "--cmd", f"{at_ms:.2f}:{command}", "--max-ms", "1200", fw=fw)
            wanted = triplets(served)
            got = [r[1:4] for r in rows]
            assert got == wanted[:len(got)] and len(got) >= len(wanted) - 2, f"{command} at {at_ms} ms: {len(got)} of {len(wanted)}"
            assert sum(1 for r in rows if r[9] & 128) == 10, "five rows at the start and five after the change warm up"
    check.__name__ = "no_sample_lost_at_any_phase_by_" + command.replace(" ", "_")
    return check


TESTS.append(make_change_test(f"filter {LIGHT}", image_with(ROBUST)))
for typed in ("rate 50", "range 8"):
    TESTS.append(make_change_test(typed))


# --- budgets ----------------------------------------------------------------------------------------------------------

@test
def memory_budgets():
    lines = [line.split() for line in open("checks/budgets.txt", encoding="utf-8") if line[0] not in "#\n"]
    budget = {words[0]: int(words[1]) for words in lines}
    for image in SET_IMAGES:
        _, _, _, stats = simrun("memory", STREAMS / "outliers-15pct.csv", "--cmd", "1000:help", "--cmd", "2000:status", "--cmd",
                                "3000:mode plot", "--cmd", "5000:mode csv", "--max-ms", "9000", fw=image)
        within(f"{image}: static RAM", stats["ram_static_bytes"], budget["ram_static_bytes"])
        within(f"{image}: static RAM and stack", stats["ram_used_bytes"], budget["ram_and_stack_bytes"])
        within(f"{image}: flash", stats["flash_bytes"], budget["flash_bytes"])


CHUNK_CYCLES = 24  # of sim/run/simrun_machine.c: what the processor does between two steps of the simulator


def steps_for_work(name, stream, seconds, *options):
    """Steps of the simulator over those that the firmware's cycles awake come to, which no machine and no load changes."""
    with mock.patch.object(system_support, "PROFILES", None):
        _, _, _, stats = simrun(name, stream, *options, "--max-ms", str(seconds * 1000))
    share = stats["simulator_steps"] / (stats["cpu_load"] * 16e6 * seconds / CHUNK_CYCLES)
    print(f"    {name}: {stats['simulator_steps'] / seconds:.0f} steps in a simulated second, {share:.2f} of those for its work")
    return share


# an event cuts a chunk short and wakes the processor for another: with as many events as chunks there are twice as many steps
STEPS_FOR_WORK = 2.0
AT_400_HZ = ("--baud", "500000", "--rate", "400", "--loop")


@test
def simulator_is_fast():
    """At two rates, and where INT1 never comes: simavr takes a pin that is low from the start for a level, and looks at it in each cycle."""
    for name, stream, seconds, options in (("speed-100", "tilt-slow", 20, ()), ("speed-400", "tilt-400hz", 10, AT_400_HZ),
                                           ("speed-noint", "tilt-slow", 5, ("--fault", "0ms:noint"))):
        assert steps_for_work(name, STREAMS / f"{stream}.csv", seconds, *options) <= STEPS_FOR_WORK, name


@test
def a_slow_simulator_is_noticed():
    """A profile wants a step for each branch."""
    slow = steps_for_work("speed-slow", STREAMS / "tilt-400hz.csv", 5, *AT_400_HZ, "--profile", OUT / "speed-slow.prof")
    assert slow > STEPS_FOR_WORK, slow


@test
def two_runs_are_identical_and_a_changed_input_is_not():
    for name in ("twin-a", "twin-b"):
        simrun(name, STREAMS / "bad-reads.csv", "--max-ms", "15000")
    for suffix in (".csv", ".served.csv", ".json"):
        assert (OUT / f"twin-a{suffix}").read_bytes() == (OUT / f"twin-b{suffix}").read_bytes(), suffix
    changed = OUT / "changed.csv"
    changed.write_text(re.sub(r"\n1000000,-?\d+,", "\n1000000,77,", (STREAMS / "bad-reads.csv").read_text(), count=1))
    simrun("twin-c", changed, "--max-ms", "15000")
    assert (OUT / "twin-a.csv").read_bytes() != (OUT / "twin-c.csv").read_bytes()


@test
def output_is_a_valid_stream():
    rows, _, _, _ = simrun("first", STREAMS / "tilt-fast.csv")
    again, _, served, _ = simrun("second", OUT / "first.csv")
    assert triplets(served) == [r[1:4] for r in rows if not r[9] & 2]


# --- faults and resets ------------------------------------------------------------------------------------------------

def fault_run(name, *faults, options=()):
    arguments = []
    for fault in faults:
        arguments += ["--fault", fault]
    return simrun(name, STREAMS / "rest-2lsb.csv", "--max-ms", "3000", *arguments, *options)


def assert_told(notes, rows, words):
    told = [n for n in notes if words in n]
    assert len(told) == 1, notes
    assert any(r[9] & 16 for r in rows), "no row with flag 16"


@test
def no_sensor_is_told():
    rows, notes, _, stats = fault_run("fault-unplug", "0ms:unplug")
    assert_told(notes, rows, "no sensor at 0x53 or 0x1D")
    assert stats["resets"] == 0


@test
def wrong_identity_is_told():
    rows, notes, _, stats = fault_run("fault-devid", "0ms:devid:0")
    assert_told(notes, rows, "DEVID 0x00, not 0xE5")
    assert stats["resets"] == 0


@test
def silent_int1_is_told():
    """Samples are read by the clock then: rows go on, none of them wrong (the judge), and the time when INT1 is back is told.
    Rows are counted in a second in which INT1 is silent, or is back."""
    for rate, lasts_ms in [(rate, ms) for rate in (12.5, 100, 400, 800) for ms in (1500, 270)]:
        rows, notes, _, stats = fault_run(f"fault-noint-{rate}", f"1000ms:noint:{lasts_ms}", options=("--rate", str(rate), "--baud", "500000"))
        begins, ends = [n for n in notes if "fault 5" in n]
        assert begins == "# fault 5: INT1 stays low: check INT1 to D2", notes
        assert ends.startswith("# fault 5 over: after "), notes
        assert stats["resets"] == 0 and stats["rows_wrong"] == 0
        came = [r for r in rows if 1_400_000 <= r[0] < 2_400_000 and not r[9] & (2 | 16)]
        assert len(came) * stats["every"] >= 0.95 * rate, f"{len(came)} rows in a second at {rate} Hz, every {stats['every']}"


@test
def unplugged_and_plugged_again():
    rows, notes, _, _ = fault_run("fault-replug", "1000ms:unplug", "2000ms:plug")
    assert sum("over: after" in n for n in notes) == 1, notes
    assert not rows[-1][9] & 16


@test
def external_reset_with_the_sensor_running():
    """INT1 is high already when the UNO starts again, so no edge will come."""
    rows, notes, _, stats = fault_run("reset-external", "1000ms:reset", options=("--expect-resets", "1"))
    assert sum(n.startswith("# tilt-uno") for n in notes) == 2
    assert "# reset: reset button or serial port opened" in notes
    assert stats["resets"] == 1 and len(rows) > 250


@test
def reset_at_every_byte_of_a_read_recovers():
    """A sensor that was driving SDA low goes on doing so until somebody clocks it through its byte."""
    for byte in range(1, 10):
        rows, notes, _, _ = simrun("reset-byte", STREAMS / "tilt-400hz.csv", "--fault", f"xfer:60.{byte}:reset", "--expect-resets", "1",
                                   "--max-ms", "1000", "--loop")
        assert not any(n.startswith("# fault") for n in notes), f"reset at byte {byte}: {notes}"
        assert not rows[-1][9] & 16 and rows[-1][0] > 300000, f"reset at byte {byte}: {rows[-1]}"


@test
def slave_hung_in_a_byte_is_clocked_free():
    rows, notes, _, _ = fault_run("fault-hang", "1000ms:hang:5")
    assert not rows[-1][9] & 16 and rows[-1][0] > 2900000, notes


@test
def hung_loop_is_reset_and_told():
    rows, notes, _, stats = simrun("hang", STREAMS / "rest-2lsb.csv", "--max-ms", "3000", "--fault", "1000ms:poke:hang_stages=0x80",
                                   "--expect-resets", "1", fw="build/uno/hang/firmware.elf")
    assert any(n.startswith("# reset: watchdog") for n in notes), notes
    assert stats["resets"] == 1
    # the clock starts anew: the last row's stamp tells when, and the hang began at 1000 ms
    assert 1200 < 3000 - rows[-1][0] / 1000 <= 1300, rows[-1]


@test
def hung_filtering_is_reset_within_300_ms():
    rows, notes, _, stats = simrun("hang-filtering", STREAMS / "rest-2lsb.csv", "--max-ms", "3000", "--fault",
                                "1000ms:poke:hang_stages=2", "--expect-resets", "1", fw="build/uno/hang/firmware.elf")
    assert any(n.endswith("stage mask 2") for n in notes), notes
    assert stats["resets"] == 1 and 1200 < 3000 - rows[-1][0] / 1000 <= 1310, rows[-1]


@test
def hung_sampling_is_reset_within_300_ms():
    # INT1 is back when the reset has come and the sensor has no sample yet: one that waited would be stamped with the edge
    rows, notes, _, stats = simrun("hang-sampling", STREAMS / "rest-2lsb.csv", "--max-ms", "3000", "--fault", "1000ms:noint:270",
                                   "--fault", "1000ms:poke:hang_stages=1", "--expect-resets", "1", fw="build/uno/hang/firmware.elf")
    assert any(n.endswith("stage mask 1") for n in notes), notes
    assert stats["resets"] == 1 and 1200 < 3000 - rows[-1][0] / 1000 <= 1310, rows[-1]


# --- bad input --------------------------------------------------------------------------------------------------------

BAD = {
    "missing-column": ("t_us,x_lsb,y_lsb\n0,1,2\n", ":1: "),
    "text-in-a-number": ("t_us,x,y,z\n0,1,2,3\n10000,1,two,3\n", ":3: "),
    "field-count": ("t_us,x,y,z\n0,1,2,3\n10000,1,2\n", ":3: "),
    "empty": ("", "empty"),
    "header-only": ("t_us,x,y,z\n", "row"),
    "time-backwards": ("t_us,x,y,z\n20000,1,2,3\n10000,1,2,3\n", ":3: "),
    "value-range": ("t_us,x,y,z\n0,1,2,5000\n", ":2: "),
}


def make_bad_input_test(name, text, where):
    def check():
        path = OUT / f"bad-{name}.csv"
        path.write_text(text)
        done = run(SIMRUN, "--fw", FW, "--in", path, "--out", OUT / "bad-out.csv", expect=None)
        assert done.returncode == 2, done.returncode
        assert path.name in done.stderr and where in done.stderr, done.stderr
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    check.__name__ = "bad_stream_" + name.replace("-", "_")
    return check


for bad_name, (bad_text, bad_where) in BAD.items():
    TESTS.append(make_bad_input_test(bad_name, bad_text, bad_where))


@test
def refused_settings_end_the_run():
    for option, value in (("--filter", "kalman"), ("--rate", "123"), ("--range", "5"), ("--every", "0"), ("--baud", "1234")):
        done = run(SIMRUN, "--fw", FW, "--in", STREAMS / "tilt-fast.csv", "--out", OUT / "x.csv", option, value, expect=2)
        assert f"{option} {value}: the firmware refused it" in done.stderr, done.stderr


MISBEHAVIOURS = {1: (3, "jump out of the program"), 2: (3, "access beyond RAM"), 3: (4, "illegal opcode"), 4: (5, "stack overrun"),
                 5: (6, "UART overrun"), 6: (7, "watchdog reset nobody expects"), 7: (8, "sleep with interrupts off"),
                 8: (11, "START ahead of a STOP"), 9: (11, "two-wire interrupt that is never answered")}


@test
def each_misbehaviour_has_its_exit_status():
    for case, (status, what) in MISBEHAVIOURS.items():
        elf = OUT / f"misbehave{case}.elf"
        run("avr-gcc", "-mmcu=atmega328p", "-Os", f"-DCASE={case}", "host_tests/chip/misbehave.c", "-o", elf)
        done = run(SIMRUN, "--fw", elf, "--in", STREAMS / "tilt-fast.csv", "--out", OUT / "x.csv", "--max-ms", "200", expect=None)
        assert done.returncode == status, f"{what}: status {done.returncode}, {done.stderr}"


@test
def missing_files_are_named():
    for option, path in (("--in", "build/no-such.csv"), ("--fw", "build/no-such.elf")):
        arguments = {"--fw": FW, "--in": STREAMS / "tilt-fast.csv", "--out": OUT / "x.csv", option: path}
        done = run(SIMRUN, *[a for pair in arguments.items() for a in pair], expect=None)
        assert done.returncode == 2 and "no-such" in done.stderr, done.stderr


@test
def over_long_and_garbage_serial_input_costs_no_row():
    long_line = "rate " + "4" * 60
    rows, notes, served, _ = simrun("garbage", STREAMS / "rest-2lsb.csv", "--cmd", f"500:{long_line}", "--cmd", "700:\x01\x02garbage",
                                    "--cmd", "900:nonsense", "--cmd", "2950:status", "--max-ms", "3100")
    assert "# refused 2: line too long" in notes and "# refused 1: unknown command (type help)" in notes, notes
    assert any("lines refused 3" in n for n in notes), notes
    assert [r[1:4] for r in rows] == triplets(served)[:len(rows)] and len(rows) >= 290


@test
def lines_typed_behind_a_change_of_baud_are_obeyed():
    """One text, so that simrun goes on typing while the line still drains at the old speed."""
    _, notes, _, _ = simrun("typed-ahead", STREAMS / "rest-2lsb.csv", "--cmd", "500:baud 500000\nevery 3\nrange 4", "--max-ms", "1500")
    assert notes[-3:] == ["# baud 500000", "# every 3", "# range 4 g"], notes


# --- the trace ----------------------------------------------------------------------------

@test
def vcd_and_profile_are_written():
    simrun("trace", STREAMS / "tilt-fast.csv", "--max-ms", "300", "--vcd", OUT / "trace.vcd", "--profile", OUT / "trace.prof")
    assert "$var" in (OUT / "trace.vcd").read_text()
    assert len((OUT / "trace.prof").read_text().splitlines()) > 100


if __name__ == "__main__":
    sys.exit(run_all())
