"""What slow wires do to the bus and to the firmware, by the times of UM10204 and of the data sheets; part of system_tests.py."""
import math
import re

from system_injections import REST, bus_probe
from system_support import FW, OUT, SIMRUN, assert_nothing_lost, run, simrun, test

OHM = 10000
BIT_NS = 2750.0  # of the firmware, 363.6 kHz
TWBR_100_KHZ = 72
SENSOR_LINE = "# sensor: ADXL345 at 0x53, I2C at 363.6 kHz"


def to_one_ns(pf):
    """From 0 to 0.7 VCC."""
    return OHM * pf * 1e-3 * -math.log(0.3)


def most_sda_pf(scl_pf, low_ns, valid_ns):
    """SDA is released valid_ns after SCL has fallen; the one must be up 100 ns before SCL is."""
    return scl_pf + (low_ns - valid_ns - 100) / (OHM * 1e-3 * -math.log(0.3))


def with_wires(name, *pf, ms=1500):
    return simrun(f"wires-{name}", REST, "--wires", ",".join(str(part) for part in (OHM, *pf)), "--max-ms", ms)


@test
def slow_wires_stretch_each_bit_by_the_rise_of_scl():
    loads = [simrun(f"wires-stretch-{i}", REST, *options, "--max-ms", 1500)[3]["i2c_load"] for i, options in enumerate(
        ((), ("--wires", f"{OHM},100"), ("--wires", f"{OHM},400")))]
    for load, pf in zip(loads[1:], (100, 400)):
        wanted = loads[0] * (BIT_NS + to_one_ns(pf)) / BIT_NS
        print(f"    {pf} pF: bus load {load:.4f}, by the rise of {to_one_ns(pf):.0f} ns {wanted:.4f}")
        assert abs(load - wanted) < 0.03 * wanted, (pf, load, wanted)


@test
def both_wires_slow_cost_time_and_no_row():
    """Equal on both lines: SDA begins to rise before SCL does. 400 pF is the most that the standard allows."""
    for rate, pf in ((100, 30), (100, 400), (800, 100), (800, 400)):
        rows, notes, served, stats = simrun(f"wires-both-{rate}-{pf}", REST, "--rate", rate, "--every", 4, "--baud", 500000, "--loop",
                                            "--wires", f"{OHM},{pf}", "--max-ms", 2000)
        assert SENSOR_LINE in notes and not any(note.startswith("# fault") for note in notes), (rate, pf, notes)
        assert stats["sensor_overruns"] == stats["rows_wrong"] == stats["rows_stale"] == 0, (rate, pf, stats)
        assert_nothing_lost(rows, served, every=4, from_us=1000000, end_us=1900000)
        assert f"SCL rises in {OHM * pf * 1e-3 * math.log(7 / 3):.0f} ns" in stats["stderr"], stats["stderr"]


@test
def sda_slower_than_scl_is_read_wrong_and_refused_by_the_identity():
    """Of DEVID, 0xE5, each one after a zero reads zero: 0x60. The sensor's data are valid 0.9 us after SCL has fallen."""
    limit_pf = most_sda_pf(30, BIT_NS / 2, 900)
    _, notes, _, stats = with_wires("sda-good", 30, round(limit_pf - 1.5))
    assert SENSOR_LINE in notes and stats["rows_wrong"] == 0 and stats["rows"] > 140, (limit_pf, notes)
    rows, notes, served, _ = with_wires("sda-late", 30, round(limit_pf + 1.5), ms=300)
    assert "# fault 2: no ADXL345 at 0x53: DEVID 0x60, not 0xE5" in notes and not served, (limit_pf, notes)
    assert all(row[1:7] == [0] * 6 and row[9] & 2 for row in rows), rows


@test
def sda_too_slow_for_the_master_is_lost_arbitration_and_told():
    """The master sees a zero where it put out a one; its own data are valid 0.3 us after SCL has fallen."""
    limit_pf = most_sda_pf(30, BIT_NS / 2, 300)
    _, notes, _, _ = with_wires("sda-slow", 30, round(limit_pf - 1.5), ms=300)
    assert any(note.startswith("# fault 2: ") for note in notes), notes
    _, notes, served, stats = with_wires("sda-slower", 30, round(limit_pf + 1.5), ms=300)
    assert "# fault 3: I2C bus disturbed: check SDA, SCL, pull-ups, GND" in notes and not served and stats["resets"] == 0, notes


@test
def wires_too_slow_for_400_khz_are_good_at_100_khz():
    """The same wires with a program that reads DEVID and two zeros: SCL is low for 5 us then, not for 1.25."""
    pf = round((most_sda_pf(30, 1250, 900) + most_sda_pf(30, 1250, 300)) / 2)
    wires = ("--wires", f"{OHM},30,{pf}")
    assert bus_probe(*wires, twbr=12)[0][-1] == "600000"
    assert bus_probe(*wires, twbr=TWBR_100_KHZ)[0][-1] == "E50000"
    assert most_sda_pf(30, 5000, 900) > 300


SLOWED = "# fault 15: I2C at 100 kHz up to 200 Hz: check SDA, SCL, pull-ups, GND"


@test
def wires_too_slow_for_400_khz_get_100_khz_and_no_fault_after_it():
    """For the identity, and for the master's arbitration; up to 200 Hz. It is told once, and lasts; 10 s at 100 Hz."""
    for delay_ns in (900, 300):
        pf = round(most_sda_pf(30, BIT_NS / 2, delay_ns) + 1.5)
        for rate in (12.5, 100, 200):
            ms = 12000 if rate == 100 else 4000
            rows, notes, served, stats = simrun(f"wires-fallback-{delay_ns}-{rate}", REST, "--wires", f"{OHM},30,{pf}", "--rate", rate, "--every",
                                                1, "--baud", 500000, "--loop", "--max-ms", ms, "--cmd", f"{ms - 600}:rate")
            told = [note for note in notes if note.startswith("# fault")]
            assert told[0].startswith("# fault 2: " if delay_ns == 900 else "# fault 3: ") and told[-1] == SLOWED and len(told) <= 3, told
            assert any(note.startswith(f"# rate {rate} Hz, I2C at 100 kHz") for note in notes), notes
            assert stats["sensor_overruns"] == stats["rows_wrong"] == stats["rows_stale"] == stats["resets"] == 0, stats
            assert_nothing_lost(rows, served, every=1, from_us=2000000, end_us=(ms - 700) * 1000)


@test
def a_speed_that_is_asked_for_ends_the_fall_back_beside_a_fault_that_does_not_end():
    """INT1 cut for good, and after a loss of supply DEVIDs with ones missing for 500 ms: 5 stays, 15 begins and ends beside it."""
    _, notes, _, _ = simrun("wires-beside", REST, "--fault", "300ms:noint", "--fault", "1000ms:devid:96:500", "--fault", "1000ms:power:1", "--loop",
                            "--max-ms", 6000, "--cmd", "4000:i2c 400", "--cmd", "5500:status")
    told = [note for note in notes if note.startswith("# fault")]
    assert SLOWED in told and any(re.fullmatch(r"# fault 15 over: after [123]000 ms, 0 lost, sensor at 0x53", note) for note in told), told
    assert not any(note.startswith("# fault 5 over") for note in told[told.index(SLOWED):]) and any(", fault 5, " in note for note in notes), notes


@test
def i2c_100_is_slow_from_the_start_and_400_stays_fast():
    """Saved. Told is nothing: it was asked for. 800 Hz does without."""
    wires = ("--wires", f"{OHM},30,{round(most_sda_pf(30, BIT_NS / 2, 900) + 1.5)}")
    for speed, first, last in (("100", SENSOR_LINE.replace("363.6", "100"), None), ("400", "# no ADXL345", "# fault 2: ")):
        image = OUT / "wires-i2c.eeprom"
        image.unlink(missing_ok=True)
        simrun("wires-i2c-save", REST, "--eeprom", image, "--cmd", f"600:i2c {speed}", "--cmd", "900:save", "--max-ms", 2000)
        notes = simrun("wires-i2c", REST, "--eeprom", image, *wires, "--max-ms", 3000)[1]
        told = [note for note in notes if note.startswith("# fault")]
        assert (first in notes if last is None else not any("I2C at 100" in note for note in notes)), (speed, notes)
        assert (told == [] if last is None else len(told) == 1 and told[0].startswith(last)), (speed, told)


@test
def line_that_rises_later_than_the_firmware_waits_reads_as_held_low():
    """By hand it waits 5 us for a line: more than the 4.8 of 10 kOhm and 400 pF, less than the 9.6 of 800 pF, twice what is allowed."""
    _, notes, _, stats = with_wires("hand-400", 400)
    assert SENSOR_LINE in notes and stats["i2c_hand_stops"] == 1, notes
    _, notes, _, stats = with_wires("hand-800", 800)
    assert any(note.startswith(("# fault 7: ", "# fault 8: ")) for note in notes) and stats["resets"] == 0, notes


@test
def wrong_wires_are_refused():
    for wires in ("x", "1000", "50,30", "1000,30,", "1000,30,40,50", "1000,-1", "1000,30x", "1000,nan"):
        done = run(SIMRUN, "--fw", FW, "--in", REST, "--out", OUT / "x.csv", "--wires", wires, expect=2)
        assert "--wires wants OHM,PF" in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
