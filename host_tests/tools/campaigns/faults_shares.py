"""The fault campaign's long faults and the shares that are asked for; part of test_faults.py."""
import argparse
import pathlib
from unittest import mock

import faults
import faults_judge
import faults_kinds
import faults_runs
import page_faults
import soak
from faults_judged import ALL, result
from system_support import FW, OUT, refused, test
from laws import DEFAULT  # noqa: E402


@test
def long_faults_have_the_limits_of_the_short_ones():
    ms = {name: [round(kind.lasts_ms) for kind in faults_kinds.LONG if kind.name.partition(",")[0] == name] for name in faults_kinds.OF}
    assert {name: long for name, long in ms.items() if long} == dict.fromkeys(
        ("unplug", "power", "sda", "scl", "devid", "noint", "inthigh"), [3000, 10000]) | {"frozen": [1500, 10000]}
    for kind in faults_kinds.LONG:
        short = faults_kinds.OF[kind.name.partition(",")[0]]
        assert (kind.limit_ms, kind.resets, kind.rate) == (short.limit_ms, 0, 100) and kind.what[-1].endswith(f":{kind.lasts_ms}"), kind
    assert faults_kinds.OF["devid"].what[0] == "power:20" == next(k for k in faults_kinds.LONG if k.name == "devid, 3 s").what[0]
    runs = faults.planned(argparse.Namespace(fw=FW, words=["sda, 3", "noint, 10"], seed=1, pairs=5, sample=0))
    assert [faults.group_of(kinds) for kinds, _, _ in runs if kinds[0] in faults_kinds.LONG] == ["long"] * 16, runs
    rows = [{"group": "long", "fault": kind.name, "phases": 8 - (kind.name == "sda, 3 s")} for kind in faults_kinds.LONG]
    said = [words for words in faults_judge.shortfalls(rows, [], faults_kinds.LONG) if "phases" in words]
    assert said == ["sda, 3 s: 7 phases were judged of at least 8"], said


@test
def a_long_fault_is_seen_to_its_end():
    sda = next(kind for kind in faults_kinds.LONG if kind.name == "sda, 3 s")
    done = faults_runs.attempt(FW, DEFAULT, (sda,), ("1003ms",))
    assert done.injected and done.recovered and not done.failures() and 295 < done.lost < 310, done


def with_made_up(**functions):
    """What faults.share_* give when what they measure is made up."""
    def call(function, *words):
        with mock.patch.multiple(faults, **{name: mock.Mock(return_value=value) for name, value in functions.items()}):
            return function(*words)
    return call


@test
def of_large_changes_99_percent_are_flagged_and_100_are_the_least():
    kind = faults_kinds.OF["noise"]
    for large, flagged, good in ((1000, 990, True), (1000, 989, False), (100, 99, True), (100, 98, False), (99, 99, False), (0, 0, False)):
        row = with_made_up(flagged_share=(large, flagged))(faults.share_flagged, FW, kind, "at rest", faults.REST, 2.0, 1)
        assert row["good"] is good and (row["changes_of_8_sigma"], row["flagged"]) == (large, flagged), row


@test
def of_rows_999_in_a_thousand_have_roll_within_half_a_degree_and_1_percent_may_lack():
    for within, beyond, missing, good in ((9990, 10, 0, True), (9989, 11, 0, False), (9900, 0, 100, True), (9899, 0, 101, False)):
        row = with_made_up(roll_differences=([50] * within + [51] * beyond, missing))(faults.share_of_roll, FW, "torn", ["torn"], faults.REST, 1)
        assert row["good"] is good and row["rows_without_partner"] == missing and row["rows"] == within + beyond, row
    assert "| torn | 9899 | 101 | 100.000 % | 0.50 |" in page_faults.tables([], [row])


@test
def of_the_binarys_lines_95_percent_have_to_run():
    for ran, good in ((1900, True), (1899, False)):
        with mock.patch.object(faults.coverage, "campaign_lines", return_value=(ran, 2000, ["x.c:1"])):
            assert faults.lines_that_ran(argparse.Namespace(fw=FW), set())["good"] is good, ran


@test
def every_fault_that_nobody_can_see_has_a_share_but_what_is_never_large():
    calls = []
    with mock.patch.object(faults, "side_by_side", lambda jobs, calls, take: list(map(take, calls))):
        faults.shares(argparse.Namespace(fw=FW, sample=300, jobs=1), calls)
    asked = [call[3].name for call in calls if call[1] is faults.share_flagged]
    assert asked == [name for name in ("flip 1", "flip 2", "noise", "double") for _ in range(2)], asked
    # a sample whose rest is of the one before: what it changes is noise, and one sample's motion
    large, _ = faults_runs.flagged_share(FW, faults_kinds.OF["mixed"], faults.MOVING, 2.6, 60)
    assert large < 5, large


@test
def samples_lost_are_those_of_the_fault_and_of_its_limit():
    # single transfers: 2 each; what lasts: its time and its limit; a pair: both
    for names, most in ((("arb", "nack"), 4), (("flip 1", "mixed"), 4), (("sda",), 9), (("sda, 12.5 Hz",), 5), (("sda, 400 Hz",), 36),
                        (("sda, 3 s",), 305), (("unplug",), 35), (("sda", "arb"), 11), (("sda", "overrun"), 36 + 60), (("clip",), 2)):
        assert not result(*names, lost=most, ms_to_good=1).failures(), names
        assert result(*names, lost=most + 1, ms_to_good=1).failures() == [f"{most + 1} samples lost (limit {most})"], names
    assert not result("typed: plot", lost=1000).failures()


@test
def interrupts_keep_their_deadline_in_every_run():
    short = {"isr_int0_worst_latency": 248, "isr_timer1_compa_worst_latency": 248, "isr_usart_rx_worst_latency": 248, "isr_twi_worst_latency": 248}
    sda, frozen = faults_kinds.OF["sda"], faults_kinds.OF["frozen"]
    assert not result("sda", waits=faults_runs.waits_of((sda,), short)).failures()
    for name in ("int0", "timer1_compa", "usart_rx"):
        late = faults_runs.waits_of((sda, frozen), short | {f"isr_{name}_worst_latency": 249})
        assert result("sda", waits=late).failures() == [f"{name} waited 249 cycles (limit 248)"], name
    # I2C has no deadline: where bytes are quick, and more so in a flood of them, it waits for all others
    limits = [dict((name, most) for name, _, most in faults_runs.waits_of((kind,), short))["twi"]
              for kind in (sda, ALL["sda, 400 Hz"], ALL["rxflood, 400 Hz"], ALL["typed: settings"], ALL["flood at 1000000 baud"])]
    # 266 cycles of others, 4 for the response and for an instruction of main after main's stretch and each of three handlers; a byte out
    # (55) for each 10 bits' time that begins meanwhile; one byte in (79), in a flood one for each (66) as well; 4 after each. At 1000000 baud
    # a byte takes 160 cycles: ten of them begin within 286 + 10 * 129 = 1576
    out, both = 55 + 4, 55 + 4 + 66 + 4
    assert limits == [286 + 83 + out, 286 + 83 + 2 * out, 286 + 2 * both, 286 + 83 + out, 286 + 10 * both], limits
    for kind in (sda, ALL["starve"]):  # main without time is no reason for a handler to wait
        done = faults_runs.attempt(FW, DEFAULT, (kind,), ("1003ms",))
        assert len(done.waits) == 4 and all(0 < cycles <= most for name, cycles, most in done.waits if name != "usart_rx"), done


@test
def a_full_disk_is_one_sentence_and_leaves_what_was_there():
    path = OUT / "whole.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    faults_runs.write_whole(path, "before")
    refused(UnicodeEncodeError, lambda: faults_runs.write_whole(path, "half\udc80"))  # what cannot be written breaks off
    assert path.read_text(encoding="utf-8") == "before" and not path.with_name("whole.json.new").exists()

    def broken(command):
        pathlib.Path(command[command.index("--stats") + 1]).write_text('{ "rows": 1, ', encoding="ascii")
        return 0, ""

    with mock.patch.object(faults_runs, "called", broken):
        refused(faults_runs.Fault, lambda: faults_runs.simulate(FW, DEFAULT), "breaks off: is the disk full?")
        broken_off = faults_runs.attempt(FW, DEFAULT, (faults_kinds.OF["sda"],), ("1000ms",)).failures()
        assert len(broken_off) == 1 and "is the disk full?" in broken_off[0], broken_off
    path.write_text('{ "rows": ', encoding="ascii")
    assert "breaks off" in soak.judged(0, 7, "", path, 1.8e6, [])[1][0]
