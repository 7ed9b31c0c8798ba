"""More faults of the simulator: what the bus, the MCU and the UART suffer; part of system_tests.py."""
import functools
import math
import re

from system_injections import REST, altered, bus_probe, injected
from system_support import SIMRUN, FW, OUT, run, simrun, test, triplets


@test
def slave_that_lets_go_reads_as_ones_to_the_end_of_the_read():
    assert bus_probe("--fault", "xfer:5.4:torn")[0][4] == "FFFFFF"
    assert bus_probe("--fault", "xfer:5.5:torn")[0][4] == "E5FFFF"
    # in a write it waits for the next byte that the slave sends
    assert bus_probe("--fault", "xfer:5.2:torn")[0][4] == "FFFFFF"


def begins_mixed(arrived, true, before):
    """The byte from which on a burst has those of the sample before; None when it has not."""
    arrived, true, before = [b"".join(v.to_bytes(2, "little", signed=True) for v in lsb) for lsb in (arrived, true, before)]
    return next((i for i in range(6) if arrived == true[:i] + before[i:]), None)


@test
def mixed_burst_has_the_sample_before_from_some_byte_on():
    _, _, served, stats = injected("mixed", "p:0.1:mixed")
    sent = triplets(served)
    found = set()
    for arrived, true in altered("mixed"):
        places = {begins_mixed(arrived, true, before) for before, same in zip(sent, sent[1:]) if same == true} - {None}
        assert places, f"{arrived} for {true}"
        found.add(min(places))
    # at rest the high bytes do not change: from 1 and from 2 on is the same, and from 5 on is no change
    assert stats["fault_1_injected"] >= 80 and found == {0, 1, 3}, found
    assert stats["fault_1_detectable"] is False and 40 < stats["samples_altered"] == len(altered("mixed")) <= stats["fault_1_injected"]


@test
def glitch_on_int1_is_one_edge_more():
    edges = injected("calm", judge=True, max_ms=3000)[3]["isr_int0_n"]
    # INT1 is low then: a sample comes every 10 ms and is read within 1 ms
    _, _, served, stats = injected("glitch", *[f"{1000 + 37 * i}.3ms:glitch" for i in range(20)], max_ms=3000)
    near = sum(min(abs(1000300 + 37000 * i - int(s["t_us"])) for s in served) < 1000 for i in range(20))
    assert 20 - near <= stats["isr_int0_n"] - edges <= 20, (edges, near, stats["isr_int0_n"])


@test
def glitch_on_int1_that_is_over_when_its_handler_runs_is_no_data_ready():
    """Only INT1 that stays high without a new sample counts as empty (docs/faults.md)."""
    for cycles, counted in ((16, range(1)), (64, range(15, 21))):
        faults = [f"{1000 + 37 * i}.3ms:glitch:{cycles}" for i in range(20)]
        _, notes, _, _ = injected("short-glitch", *faults, max_ms=2600, options=("--cmd", "2500:status"))
        empty = [int(count) for count in re.findall(r"^# readings torn 0, empty (\d+),", "\n".join(notes), re.M)]
        assert len(empty) == 1 and empty[0] in counted, (cycles, notes)


@test
def held_high_int1_gives_no_edge_and_is_told():
    calm = injected("calm", judge=True, max_ms=3000)[3]
    rows, notes, served, stats = injected("inthigh", "1000.3ms:inthigh:500", judge=True, max_ms=3000)
    # fifty samples in that time: none of them has an edge of its own
    assert 45 <= calm["isr_int0_n"] - stats["isr_int0_n"] <= 51, (calm["isr_int0_n"], stats["isr_int0_n"])
    assert any(note.startswith("# fault 9: ") for note in notes) and len(rows) >= len(served) - 2, notes


@test
def fault_that_waits_for_a_byte_is_over_when_it_has_struck():
    # SCL is low until 1075 ms: what comes at 1041 ms finds no byte, and the sensor no data, before the master has tried again
    for what in ("arb", "buserr", "nack", "nackdata", "torn", "flip:1", "noise:60", "double:z", "mixed"):
        stats = injected("struck", "1035ms:scl:40", f"1041ms:{what}", max_ms=2000)[3]
        assert abs(stats["fault_2_first_ms"] - 1041) < 0.1 and 1075 < stats["fault_2_last_end_ms"] < 1130, (what, stats["fault_2_last_end_ms"])
        assert stats["fault_2_recovered"] == stats["fault_2_injected"] == 1, what
    for what in ("arb", "torn", "flip:1", "noise:60", "double:z"):
        stats = injected("struck", f"xfer:60.8:{what}", max_ms=2000)[3]
        assert stats["fault_1_last_end_ms"] - stats["fault_1_first_ms"] < 11, what


@test
def clipped_axis_is_at_its_rail_in_what_the_sensor_latched():
    for axis, letter in enumerate("xyz"):
        rows, _, served, _ = injected("clip", f"2000ms:clip:{letter}:500", judge=True, max_ms=4000)
        inside = [lsb for s, lsb in zip(served, triplets(served)) if 2000000 < int(s["t_us"]) <= 2500000]
        outside = [lsb for s, lsb in zip(served, triplets(served)) if not 2000000 < int(s["t_us"]) <= 2500000]
        assert len(inside) == 50 and all(lsb[axis] in (-4096, 4095) for lsb in inside), inside[:3]
        assert all(abs(v) < 300 for lsb in outside for v in lsb) and all(abs(v) < 300 for lsb in inside for v in lsb[:axis] + lsb[axis + 1:])
        assert sum((row[9] & 8) != 0 for row in rows) >= 49, "no flag 8"


@test
def stalled_transmitter_sends_nothing_and_rows_are_dropped_and_told():
    _, _, _, calm = injected("calm", judge=True, max_ms=3000)
    rows, _, served, stats = injected("txstall", "1000ms:txstall:200", judge=True, max_ms=3000)
    step_us = max(b[0] - a[0] for a, b in zip(rows, rows[1:]))
    assert 150000 <= step_us <= 220000, step_us
    # 20 rows belong into that time; six of 40 bytes or more wait in the ring of 255
    assert any(row[9] & 256 for row in rows) and 14 <= calm["rows"] - stats["rows"] <= 22, (calm["rows"], stats["rows"])
    assert stats["fault_1_recovered"] == 1 and stats["fault_1_worst_recovery_ms"] < 50


@test
def stall_of_the_transmitter_ends_for_a_byte_that_began_in_it():
    # the main loop sends nothing from 1050 to 1130 ms, in which the transmitter comes to stand until 1250 ms
    rows, _, _, stats = injected("txstall-late", "1050ms:starve:80", "1060ms:txstall:190", max_ms=2000)
    assert stats["fault_2_recovered"] == 1 and stats["fault_2_worst_recovery_ms"] < 50, stats["fault_2_worst_recovery_ms"]


@test
def starved_main_loop_stands_still_while_interrupts_go_on():
    rows, notes, _, stats = injected("starve", "1000ms:starve:200", max_ms=3000)
    assert stats["resets"] == 0 and stats["fault_1_recovered"] == 1, stats
    # the rows on their way are sent, no other until the main loop goes on
    times = [row[0] / 1000 for row in rows]
    assert any(1150 < t for t in times) and len(rows) > 250
    edges = injected("calm", judge=True, max_ms=3000)[3]["isr_int0_n"]
    assert edges - 21 < stats["isr_int0_n"] < edges, "interrupts do not go on"


@test
def interrupts_of_a_starved_main_loop_wait_no_longer_than_others():
    for seed in (1, 2, 3):
        rows, _, _, stats = injected("starve-800", "p:0.1:starve:1.3", max_ms=4000,
                                     options=("--rate", 800, "--baud", 500000, "--loop", "--seed", seed))
        waits = {name: stats[f"isr_{name}_worst_latency"] for name in ("int0", "timer1_compa", "twi")}
        assert max(waits.values()) <= 248, waits
        assert len(rows) > 1000 and not [row for row in rows if row[-1] & 2], "a sample was called missing"


@test
def main_loop_starved_for_longer_than_the_watchdog_is_reset_once():
    rows, notes, _, stats = simrun("inject-starved", REST, "--fault", "1000ms:starve:2000", "--expect-resets", "1", "--max-ms", "3000")
    assert stats["resets"] == 1 and sum(n.startswith("# reset: watchdog") for n in notes) == 1, notes
    assert stats["fault_1_recovered"] == 1 and 1200 < 3000 - rows[-1][0] / 1000 <= 1300, rows[-1]


@test
def starved_until_the_fifo_has_run_over():
    for lost in (1, 20):
        _, _, _, stats = simrun("inject-overrun", REST, "--baud", 500000, "--rate", 400, "--loop", "--fault", f"1000ms:overrun:{lost}",
                                "--max-ms", "2000", judge=False)
        assert stats["sensor_overruns"] == lost and stats["resets"] == 0 and stats["fault_1_recovered"] == 1, stats


@test
def brown_out_keeps_the_ram_and_says_so():
    rows, notes, _, stats = simrun("inject-brownout", REST, "--fault", "1000ms:brownout", "--expect-resets", "1", "--max-ms", "3000")
    assert "# reset: supply dropped" in notes and stats["fault_1_recovered"] == 1 and len(rows) > 280, notes


@test
def function_is_found_without_the_suffix_of_the_compiler():
    names = run("avr-nm", FW).stdout
    assert " slope_of\n" in names
    name = next(word.partition(".")[0] for word in names.split() if word.startswith("calibration_prepare."))
    for call in (f"{name}#1", "slope_of#3"):
        stats = injected("suffix", f"pc:{call}:odr:1", judge=True, max_ms=400)[3]
        assert stats["fault_1_injected"] == 1, stats
    for wrong in ("keep_estimat", "calibration_prepare.lto", "lope_of"):
        done = run(SIMRUN, "--fw", FW, "--in", REST, "--out", OUT / "x.csv", "--fault", f"pc:{wrong}:glitch", expect=2)
        assert "no such function in the firmware" in done.stderr, done.stderr


@test
def judge_looks_back_over_what_is_kept_of_a_long_run():
    """40,000 samples: what simrun keeps of them is thrown away several times; the judge goes on and what is lost is counted."""
    stats = injected("long", "390000ms:txstall:200", "xfer:39500.8:flip:2", max_ms=400000, options=("--loop",))[3]
    assert stats["samples_served"] > 39900 and 14 <= stats["lost"] <= 22, stats
    assert stats["rows"] - 2 <= stats["rows_judged"] <= stats["rows"] and stats["rows_wrong"] == 1 and stats["rows_stale"] == 0, stats


FLICKERS = "# fault 13: INT1 flickers: check INT1 to D2"


def options_at(rate):
    return "--rate", rate, "--every", 4 if rate == 800 else 1, "--baud", 500000


@functools.cache
def calm_at(rate):
    """Statistics of six seconds without a fault."""
    return injected(f"calm-{rate}", max_ms=6000, options=options_at(rate))[3]


def flickering(name, fault, rate):
    """What a fault at 2000 ms that lasts 2 s does: rows, lines about faults, load and moments of the lines, against a run without it."""
    calm = calm_at(rate)
    _, notes, served, stats = injected(name, fault, judge=True, max_ms=6000, options=options_at(rate))
    assert stats["resets"] == 0 and stats["rows_wrong"] == 0, (name, stats["resets"], stats["rows_wrong"])
    assert calm["rows"] - 2 <= stats["rows"] <= calm["rows"] + 1, f"{name}: {stats['rows']} rows, {calm['rows']} without the fault"
    assert stats["rows_stale"] == 0 and stats["sensor_overruns"] == 0, (name, stats["rows_stale"], stats["sensor_overruns"])
    if ":storm:" in fault:  # 8 or 9 edges, then none for 31 ticks (hal_drdy.h)
        assert stats["isr_int0_n"] - calm["isr_int0_n"] <= 9 + 8 * math.ceil(2_000_000 / (32 * 8192)), (name, stats["isr_int0_n"])
    # over 6 s, of which the fault lasts 2
    assert (stats["cpu_load"] - calm["cpu_load"]) * 3 < 0.2, f"{name}: load {calm['cpu_load']} to {stats['cpu_load']}"
    return [note for note in notes if note.startswith("# fault")]


def assert_told(name, lines):
    """Begun within a second, by its name, and over within a second: the numbers of the end say so; 9 may be told with it, nothing else."""
    assert FLICKERS in lines and len(lines) <= 6, (name, lines)
    over = re.fullmatch(r"# fault (9|13) over: after (\d+) ms, \d+ lost, sensor at 0x53", lines[-1])
    assert over and 1000 < int(over[2]) < 3000, (name, lines)


@test
def int1_that_flickers_is_not_heard_and_told():
    for rate in (100, 800):
        for hz in (1000, 10000, 50000, 100000, 200000, 500000):
            name = f"flickers-{rate}-{hz}"
            assert_told(name, flickering(name, f"2000ms:storm:{hz}:2000", rate))


@test
def storm_has_one_number_whatever_its_phase():
    for tenth in range(10):
        options = ("--rate", 400, "--every", 8, "--baud", 500000, "--cmd", "3000:status")
        notes = injected("storm-phase", f"1500.{tenth}ms:storm:200000:300", max_ms=3500, options=options)[1]
        lines = [note.split(":")[0] for note in notes if note.startswith("# fault")]
        assert lines == ["# fault 13", "# fault 13 over"] and any(note.endswith(", storms 1") for note in notes), (tenth, notes)


def by_the_clock(name, rate, ppm, *faults):
    """A sensor that is read without INT1: no sample is lost, none is stale, whatever its clock."""
    options = (*options_at(rate), "--ppm", ppm)
    every = options[options.index("--every") + 1]
    _, notes, served, stats = injected(name, *faults, judge=True, max_ms=6000, options=options)
    what = (name, stats["resets"], stats["rows"], stats["rows_wrong"], stats["rows_stale"], stats["sensor_overruns"])
    assert stats["resets"] == stats["rows_wrong"] == stats["rows_stale"] == stats["sensor_overruns"] == 0, what
    assert stats["rows"] >= len(served) / every * 0.99 - 3, (*what, len(served))
    assert not any(re.search(r" [1-9]\d* lost", note) for note in notes if note.startswith("# fault")), (name, notes)


@test
def sensor_without_int1_is_followed_whatever_its_clock():
    for rate in (12.5, 100, 400, 800):
        for ppm in (-40000, 2000, 40000):
            by_the_clock(f"no-int1-{rate}-{ppm}", rate, ppm, "0ms:noint")
    by_the_clock("no-int1-flickers", 800, 20000, "0ms:storm:200000")
    by_the_clock("no-int1-drifts", 800, 0, "2000ms:noint", "2500ms:odr:2000")
    by_the_clock("no-int1-hums", 800, 0, "1000ms:noint:4000", "1000ms:storm:53:4000")


@test
def main_that_stalls_without_int1_catches_up():
    for rate, ms in ((800, 5), (800, 15), (400, 35), (100, 40)):
        for fault in ("1000ms:noint", "1000ms:storm:200000"):
            by_the_clock(f"stalled-{rate}-{ms}", rate, 0, fault, f"2000ms:starve:{ms}")


@test
def random_bursts_of_edges_cost_no_sample():
    for rate in (12.5, 100, 400, 800):
        bursts = [f"{1000 + 317.7 * i:.1f}ms:storm:{1500 + 700 * i}:{1 + i % 7}" for i in range(14)]
        by_the_clock(f"bursts-of-edges-{rate}", rate, 0, *bursts)
