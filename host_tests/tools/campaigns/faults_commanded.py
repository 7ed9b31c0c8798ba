"""Faults while a command is carried out: which the campaign has, when they come, and how a run is judged; part of test_faults.py."""
import dataclasses
import re

import faults
import faults_commands
import faults_judge
import faults_kinds
import faults_runs
import page_faults
from faults_judge import Ending
from faults_judged import ALL, result
from system_support import FW, test
from laws import DEFAULT  # noqa: E402

STREAMS = {"rate 50": (50, 16, 20000), "rate 400": (400, 16, 2500), "range 8": (100, 8, 10000), "stop and go": (100, 16, 10000)}


def ended(name, **said):
    """Failures of a run in which all went well but what is said of its end."""
    command = ALL[name].command
    if command.rate:
        hz, range_g, step_us = STREAMS[command.name]
        good = Ending(hz, range_g, 1400, (step_us,) * (440000 // step_us), 0, 100, (("streaming", hz, hz), ("streaming", hz, hz)), (7, 7), 0)
    else:
        good = Ending(0, 16, 100, (), 0, 0, (("stopped", 100, 0), ("stopped", 100, 0)), (7, 7), 0)
    gone = {} if command.rate else {"recovered": False, "since_good_ms": 1600}
    return dataclasses.replace(result(name, calm_gap_ms=30.0, **gone), ending=dataclasses.replace(good, **said)).failures()


@test
def every_command_meets_every_fault_of_bus_sensor_and_int1():
    faulty = {"unplug", "power", "sda", "scl", "hang", "hang a byte", "arb", "buserr", "nack", "nackdata", "torn", "devid", "noint", "inthigh",
              "glitch", "storm", "frozen"}
    kinds = {(kind.command.name, kind.base) for kind in faults_commands.KINDS}
    assert kinds == {(name, base) for name in (*STREAMS, "stop") for base in faulty} and len(faults_commands.KINDS) == len(kinds), kinds
    for name, base in kinds:
        kind = ALL[f"command {name}: {base}"]
        assert not ended(kind.name), (kind, ended(kind.name))
        assert kind.what == faults_kinds.OF[base].what and kind.resets == 0 and faults.group_of((kind,)) == "command", kind
        assert kind.typed[:-3] == kind.command.typed and name.split(" and ")[0] in " ".join(kind.typed), kind
    for name, limit in (("rate 50: sda", 110), ("rate 400: sda", 50), ("range 8: power", 150), ("stop and go: sda", 80)):
        assert ALL["command " + name].limit_ms == limit, ALL["command " + name]
    # 40 ms, the limit to the first good row and 60 ms in which rows are held, at the greater one of the old and the new rate
    for name, most in (("rate 50: sda", 21), ("rate 400: sda", 60), ("range 8: sda", 15)):
        assert faults_judge.lost_most((ALL["command " + name],)) == most, faults_judge.lost_most((ALL["command " + name],))
    assert all(faults.wanted(["command"], kind) and not faults.wanted(["command"], faults_kinds.OF[kind.base]) for kind in faults_commands.KINDS)


@test
def each_transfer_of_a_change_has_its_faults_and_the_others_come_and_go_in_it():
    for name, changes in (("rate 50", 1), ("stop and go", 2)):
        nack, data, hang, sda = (ALL[f"command {name}: {base}"] for base in ("nack", "nackdata", "hang", "sda"))
        whens = faults_commands.phases(FW, nack, 1)
        numbers = [int(when[5:-2]) for when in whens]
        before = faults_runs.simulate(FW, DEFAULT, max_ms=999)[2]["i2c_transfers"]
        # standby, the sensor's name, 11 registers and those that are read back, Measure
        assert all(when.startswith("xfer:") and when.endswith(".1") for when in whens) and 14 < len(whens) < 30, whens
        assert numbers == list(range(before + 1, before + 1 + len(numbers))), numbers
        for kind, last in ((data, "2"), (hang, "3")):
            places = [when.partition(".") for when in faults_commands.phases(FW, kind, 1)]
            assert [int(when[5:]) for when, _, _ in places] == numbers and max(byte for _, _, byte in places) == last, places
        moments = [float(when[:-2]) for when in faults_commands.phases(FW, sda, 1)]
        near = [[ms for ms in moments if -1 <= ms + gone - at <= 8] for at in (1000, 1030)[:changes] for gone in (0, 40)]
        assert len(moments) == 10 and all(len(each) >= 2 for each in near) and sum(map(len, near)) == 10, (moments, near)
        assert len(faults_commands.phases(FW, hang, 1)) == len(whens) and faults_commands.phases(FW, sda, 1) != faults_commands.phases(FW, sda, 2)
    # `stop` alone has one transfer
    whens = faults_commands.phases(FW, ALL["command stop: nack"], 1)
    assert sum(when.startswith("xfer:") for when in whens) >= 1 and sum(when.endswith("ms") for when in whens) >= 7 and len(whens) == 10, whens
    assert all(len(set(faults_commands.phases(FW, kind, 1))) >= faults_judge.COMMAND_PHASES_AT_LEAST for kind in faults_commands.KINDS)


@test
def rows_and_sensor_have_what_was_commanded():
    name = "command rate 50: nack"
    assert ended(name, sensor_hz=100) == ["the sensor has 100 Hz instead of 50"]
    assert ended("command range 8: nack", range_g=16) == ["the sensor has 16 g instead of 8"]
    steps = (20000,) * 22
    assert not ended(name, steps_us=(15001, 24999) + steps[2:])
    for step in (14999, 25001):
        assert ended(name, steps_us=steps[1:] + (step,)) == [f"1 rows {step / 1000:.1f} ms behind the one ahead instead of 20.0"], step
    assert not ended(name, steps_us=steps[3:]) and ended(name, steps_us=steps[4:]) == ["only 19 rows in 440 ms near the end"]
    assert ended(name, steps_us=()) == ["only 1 rows in 440 ms near the end"]
    assert ended(name, coasted=1) == ["1 rows coasted to the end"]
    assert ended(name, lost=(7, 8)) == ["lost goes on growing: 7, 8"]
    good = ("streaming", 50.0, 50.0)
    assert ended(name, states=(good, ("backing", 50.0, 50.0))) == ["status says backing"]
    assert ended(name, states=(good, ("streaming", 100.0, 50.0))) == ["status says 100 Hz, measured 50 Hz"]
    for measured, bad in ((51.0, False), (49.0, False), (51.1, True), (48.9, True)):
        assert bool(ended(name, states=(good, ("streaming", 50.0, measured)))) == bad, measured
    assert not ended(name, states=(("waiting", 100.0, 0.0), good))
    assert ended(name, states=(good,)) == ["1 of 2 status replies are whole"]


@test
def a_stopped_sensor_stands_still_and_has_no_rows():
    for name in ("command stop: nack", "command stop: unplug"):
        assert ended(name, sensor_hz=100.0) == ["the sensor still measures, at 100 Hz"]
        assert not ended(name, measured_since_ms=100) and ended(name, measured_since_ms=101) == ["the sensor measured for 101 ms (limit 100)"]
        assert ended(name, rows_since=1) == ["1 rows of a stopped sensor"]
        assert ended(name, states=(("stopped", 100.0, 0.0), ("streaming", 100.0, 100.0))) == ["status says streaming"]
        assert result(name, recovered=False, hang="crash").failures() == ["crash"] and result(name, wrong=1).failures() == ["1 wrong rows"]
    # where it goes again a good row has to come, and they have to go on
    name = "command stop and go: nack"
    assert result(name, recovered=False).failures() == ["no good row any more"] and result(name, since_good_ms=200).failures()
    assert not ended(name, rows_since=150)


@test
def one_failed_transfer_is_no_missing_sensor():
    for base, once in (("nack", True), ("hang a byte", True), ("torn", True), ("unplug", False), ("devid", False)):
        said = ended(f"command range 8: {base}", no_sensor=2)
        assert said == (["2 times told that no sensor answers"] if once else []), (base, said)


def instead(name, *typed, **more):
    """A run of a kind in which something else is typed than what is judged."""
    kind = dataclasses.replace(ALL[name], typed=(*typed, *faults_commands.STATUS), **more)
    return faults_runs.attempt(FW, DEFAULT, (kind,), ("1100ms",))


@test
def what_a_run_came_to_is_seen_in_the_sensor_its_rows_and_the_status():
    for name, (hz, range_g, step_us) in STREAMS.items():
        done = faults_runs.attempt(FW, DEFAULT, (ALL[f"command {name}: glitch"],), ("1100ms",))
        end = done.ending
        assert not done.failures() and (end.sensor_hz, end.range_g, end.coasted, len(end.lost)) == (hz, range_g, 0, 2), done
        assert all(abs(step - step_us) < 20 for step in end.steps_us) and end.states[1][:2] == ("streaming", hz), end
    end = faults_runs.attempt(FW, DEFAULT, (ALL["command stop: glitch"],), ("999ms",)).ending
    assert (end.sensor_hz, end.rows_since, end.steps_us, end.states[1][0]) == (0, 0, (), "stopped") and -20 < end.measured_since_ms < 10, end
    # the setting not made, a stop that does not last, and one that comes late
    sensor, rows, status = instead("command rate 50: glitch").failures()
    assert sensor == "the sensor has 100 Hz instead of 50" and status == "status says 100 Hz, measured 100 Hz", (sensor, status)
    assert re.fullmatch("4[1-4] rows 10.0 ms behind the one ahead instead of 20.0", rows), rows
    assert instead("command range 8: glitch").failures() == ["the sensor has 16 g instead of 8"]
    done = instead("command stop: glitch", "1000:stop", "1300:go")
    assert done.failures()[0] == "the sensor still measures, at 100 Hz" and 110 <= done.ending.rows_since <= 125, done
    measured, rows = instead("command stop: glitch", "1300:stop").failures()
    assert re.fullmatch(r"the sensor measured for (19\d|20[01]) ms \(limit 100\)", measured) and re.fullmatch("2[789] rows of a stopped sensor", rows)
    # no samples in the last half second, and a sensor that is away
    done = instead("command range 8: glitch", "1000:range 8", what=("glitch", "@1200 unplug:100"))
    words = " ".join(done.failures())
    assert done.ending.coasted > 3 and "rows coasted to the end" in words and "lost goes on growing: 0, " in words, done
    assert done.ending.no_sensor == 1, done


@test
def the_table_has_a_line_for_each_fault_and_a_column_for_each_command():
    runs = [result("command rate 50: nack", ms_to_good=33.0), result("command stop: nack"), result("command stop: nack", when="1001ms", wrong=1),
            result("sda")]
    lines = page_faults.tables(faults.summarised(runs), [])
    assert "| nack | 1, 33.0 | - | - | 2, -, 1 FAILED | - |" in lines and not any(line.startswith("| command ") for line in lines), lines
    assert any(line.endswith("| `rate 50` | `rate 400` | `range 8` | `stop` | `stop and go` |") for line in lines), lines
