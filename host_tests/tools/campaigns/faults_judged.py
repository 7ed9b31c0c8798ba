"""The fault campaign's judge, run by run and of a whole campaign, and how campaign and soak end; part of test_faults.py."""
import argparse
import contextlib
import dataclasses
import io
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
from unittest import mock

import faults
import faults_commands
import faults_judge
import faults_kinds
import faults_runs
import page_faults
import soak
from system_support import FW, OUT, test
from laws import DEFAULT, LIGHT, ROBUST  # noqa: E402

PATIENCE_S = 300  # only reached when something is broken, however busy the machine
ALL = {kind.name: kind for kind in faults_kinds.KINDS + faults_kinds.LONG + faults_kinds.rated() + faults_kinds.TYPED + faults_commands.KINDS}


def until(true):
    end = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end, f"what was waited for did not come within {PATIENCE_S} s"
        time.sleep(0.01)


def result(*names, **said):
    """Of a run in which all went well but what is said."""
    kinds = tuple(ALL[name] for name in names)
    due = sum(kind.resets for kind in kinds)
    good = {"when": "1000ms", "filter_name": LIGHT, "hang": "", "injected": True, "recovered": True, "ms_to_good": 20.0, "lost": 0,
            "wrong": 0, "steps_back": 0, "altered": 0, "resets": due, "resets_due": due, "pass_cycles": 64000, "waits": (),
            "calm_gap_ms": 10.1, "since_good_ms": 9.9, "command": ""}
    return faults_judge.Result(kinds, **(good | said))


@test
def a_pass_of_the_main_loop_has_4_ms():
    for name in ALL:
        assert result(name, pass_cycles=64001).failures() == ["a pass of 64001 cycles (limit 64000)"], name
    done = faults_runs.attempt(FW, DEFAULT, (ALL["flood at 1000000 baud"],), ("1008.954ms",))
    assert done.recovered and not done.failures() and 6000 < done.pass_cycles, done
    print(f"    under a flood of bytes: {done.pass_cycles} cycles")


@test
def a_line_that_has_to_come_is_missed():
    assert result("typed: cal6 to its end", missing=("# cal6: residual ",)).failures() == ["no line '# cal6: residual '"]
    asks = dataclasses.replace(ALL["nack"], typed=("1100:every",))
    for prints, missing in (("# every ", ()), ("# ever ", ("# ever ",)), ("every ", ("every ",))):
        assert faults_runs.attempt(FW, DEFAULT, (dataclasses.replace(asks, prints=prints),), ("1000ms",)).missing == missing, prints


@test
def resets_are_those_asked_for_and_no_fewer():
    for name, due in (("reset", 1), ("starve", 1), ("starve again", 4)):
        for resets in (due - 1, due + 1):
            assert result(name, resets=resets).failures() == [f"{resets} resets instead of {due}"], name
    assert result("reset", "brownout", resets=1).failures() == ["1 resets instead of 2"]
    # a reset ends the starvation that it comes into, and the watchdog does not bark
    starve, reset = faults_kinds.OF["starve"], faults_kinds.OF["reset"]
    for kinds, whens, due in (((starve, reset), ("1000ms", "1050ms"), 1), ((starve, reset), ("1050ms", "1000ms"), 2),
                              ((reset, starve), ("1050ms", "1000ms"), 1), ((reset, starve), ("1000ms", "1050ms"), 2)):
        assert faults_judge.resets_due(kinds, whens) == due, (kinds, whens)
        done = faults_runs.attempt(FW, DEFAULT, kinds, whens)
        assert done.resets == due and not done.failures(), done
    assert faults_judge.resets_due((starve, reset), ("1000ms", "1240ms")) is None
    assert not result("starve", "reset", resets=1, resets_due=None).failures()


@test
def the_stream_has_to_go_on_after_the_first_good_row():
    # a row's time and 8 ms without a sample's row; six rows' times and 8 ms without a good one; every second sample has a row at 800 Hz, and
    # after a reset the rate is 100 Hz
    for name, gap_ms, end_ms in (("sda", 18, 68), ("sda, 12.5 Hz", 88, 488), ("sda, 400 Hz", 10.5, 23), ("sda, 800 Hz", 10.5, 23),
                                 ("reset, 800 Hz", 18, 68), ("reset, 12.5 Hz", 18, 68), (f"vibration, {ROBUST}", 18, 168),
                                 ("typed: settings", 375, 750)):
        assert not result(name, calm_gap_ms=gap_ms, since_good_ms=end_ms).failures(), name
        assert "without a sample's row" in result(name, calm_gap_ms=gap_ms + 0.1).failures()[0], name
        assert "before the end" in result(name, since_good_ms=end_ms + 0.1).failures()[0], name
    assert result("sda", since_good_ms=None).failures() == ["no good row"]


@test
def simrun_says_how_long_no_row_came_and_when_the_last_good_one_did():
    sda = faults_kinds.OF["sda"]
    for typed, words in ((("1800:stop", "1900:go"), "without a sample's row when all was over"), (("2400:stop",), "last good row")):
        done = faults_runs.attempt(FW, DEFAULT, (dataclasses.replace(sda, typed=typed),), ("1000ms",))
        assert len(done.failures()) == 1 and words in done.failures()[0], done
    assert 190 < done.since_good_ms < 215 and done.calm_gap_ms < 11, done
    # the gap that the fault itself makes is no calm: 40 ms of it, and the way back
    stats = faults_runs.simulate(FW, DEFAULT, "--fault", "1000ms:sda:40")[2]
    assert 40 < stats["rows_gap_ms"] < 100 and 980 < stats["rows_gap_from_ms"] < 1005 and stats["rows_calm_gap_ms"] < 11, stats
    assert stats["rows_calm_gap_from_ms"] > 1040 and stats["sim_ms"] - stats["rows_last_good_ms"] < 11, stats
    # a sensor that is never there, and one that gives the same readings to the end: rows, but no good one
    assert faults_runs.simulate(FW, DEFAULT, "--fault", "0ms:unplug")[2]["rows_last_good_ms"] is None
    stats = faults_runs.simulate(FW, DEFAULT, "--fault", "1000ms:frozen")[2]
    assert stats["rows"] > 200 and stats["rows_last_good_ms"] < 1100, stats
    # a row with an axis at the rail, which no filter takes, is no good row, but shows a sample
    stats = faults_runs.simulate(FW, DEFAULT, "--fault", "1000ms:clip:z")[2]
    assert stats["rows_last_good_ms"] < 1100, stats
    stats = faults_runs.simulate(FW, DEFAULT, "--fault", "1000ms:clip:z:200")[2]
    assert stats["fault_1_injected"] == 1 and stats["rows_gap_ms"] < 11, stats


@test
def what_is_lost_is_not_judged_where_nobody_knows():
    for name, known in (("sda, 400 Hz", True), ("sda, 800 Hz", False), ("reset", False)):
        done = faults_runs.attempt(FW, DEFAULT, (ALL[name],), ("1000.4ms",))
        assert (done.lost is not None) == known and not done.failures(), done
    assert result("arb", lost=None).failures() == [] and result("arb", lost=3).failures()
    assert result("sda", "power", lost=None).failures() == []
    rows = faults.summarised([result("arb", lost=None), result("sda", lost=None), result("sda", lost=2)])
    assert [row["worst_rows_lost"] for row in rows] == [None, 2] and "| - |" in "\n".join(page_faults.tables(rows, []))


@test
def a_whole_campaign_has_every_required_kind_at_50_phases_and_every_pair_at_5():
    kinds = faults_kinds.KINDS
    rows = [{"group": "single", "fault": kind.name, "phases": 50} for kind in kinds]
    rows += [{"group": "pair", "fault": f"{a.name} + {b.name}", "phases": 5} for n, a in enumerate(kinds) for b in kinds[n + 1:]]
    assert faults_judge.shortfalls(rows, kinds) == []
    assert {name for names in faults_judge.REQUIRED.values() for name in names} <= set(faults_kinds.OF) and len(faults_judge.REQUIRED) == 23
    few = [row | {"phases": row["phases"] - (row["fault"] in ("torn", "sda + scl"))} for row in rows]
    assert faults_judge.shortfalls(few, kinds) == ["torn: 49 phases were judged of at least 50", "sda + scl: 4 phases were judged of at least 5"]
    # runs whose fault never came, or that died, are no judged phases
    gone = [result("torn", when=f"{n}ms", injected=False) for n in range(60)]
    assert faults.summarised(gone)[0]["phases"] == 0
    without = [kind for kind in kinds if kind.name != "double"]
    commands = [kind for kind in faults_commands.KINDS if kind.command.name == "stop"]
    few = rows + [{"group": "command", "fault": kind.name, "phases": 6 - (kind.base == "scl")} for kind in commands if kind.base != "arb"]
    assert faults_judge.shortfalls(few, kinds, commands=commands) == ["command stop: arb: 0 phases were judged of at least 6",
                                                                      "command stop: scl: 5 phases were judged of at least 6"]
    said = faults_judge.shortfalls([row for row in rows if "double" not in row["fault"]], without)
    assert said == ["the required 'doubled axis' is in no run: there is no kind 'double'"], said


@test
def a_run_that_dies_is_a_failure_with_its_command():
    done = faults_runs.attempt("build/no.elf", DEFAULT, (faults_kinds.OF["arb"],), ("1000ms",))
    assert len(done.failures()) == 1 and "build/no.elf" in done.failures()[0] and done.command == "--fault 1000ms:arb --expect-resets 0", done
    assert not done.injected and not done.recovered
    stats = faults_runs.simulate(FW, DEFAULT, "--fault", "1000ms:arb")[2]
    arb = (faults_kinds.OF["arb"],)
    assert faults_runs.judged(DEFAULT, arb, ("1000ms",), 2600, "", 0, "", stats).failures() == []
    assert faults_runs.judged(DEFAULT, arb, ("1000ms",), 9000, "", 0, "", stats).failures() == ["ended after 2600 of 9000 ms"]
    back = faults_runs.judged(DEFAULT, arb, ("1000ms",), 2600, "", 0, "", stats | {"t_us_steps_back": 2})
    assert back.failures() == ["2 steps back in time"], back
    assert faults.share(faults.share_of_roll, "build/no.elf", "bad reads", ["arb"], faults.REST, 1)["good"] is False


def told_by(runs, attempt, **options):
    """(exit status, output) of a campaign of made-up runs."""
    kept = [(number, signal.getsignal(number)) for number in (signal.SIGTERM, signal.SIGINT)]
    wanted = {"jobs": 1, "seed": 1, "words": ["sda"], "sample": 0, "fw": FW, "no_page": True} | options
    said = io.StringIO()
    try:
        signal.signal(signal.SIGTERM, faults.ended_by_signal)
        with contextlib.redirect_stdout(said), mock.patch.multiple(faults, planned=lambda options: runs, attempt=attempt,
                                                                   RESULTS=OUT / "faults.json", shares=lambda options, extra: None):
            status = faults.carried_out_and_told(argparse.Namespace(**wanted), time.monotonic())
    finally:
        for number, handler in kept:
            signal.signal(number, handler)
    return status, said.getvalue()


@test
def a_campaign_that_is_ended_tells_what_it_has_seen():
    taken, carried_out = [], faults.carried_out

    def watched(options, runs, profile, results):
        taken.append(results)
        carried_out(options, runs, profile, results)

    def attempt(firmware, name, kinds, whens, profile):
        number = int(whens[0][:-2])
        if number == 1003:
            until(lambda: len(taken[0]) == 3)
            os.kill(os.getpid(), signal.SIGTERM)
            until(lambda: signal.getsignal(signal.SIGTERM) == signal.SIG_IGN)  # which is how the campaign takes it
        return result("sda", when=whens[0], wrong=int(number == 1001), command=f"--fault {number}")

    runs = [((faults_kinds.OF["sda"],), (f"{1000 + n}ms",), LIGHT) for n in range(40)]
    with mock.patch.object(faults, "carried_out", watched):
        status, said = told_by(runs, attempt)
    lines = said.splitlines()
    assert status == 1 and lines[-1] == "2 passed, 1 failed" and "faults: ended by a signal after 3 of 40 runs" in lines, said
    assert f"    1001ms {LIGHT}: 1 wrong rows    [--fault 1001]" in lines, said


@test
def what_a_whole_campaign_lacks_is_a_failure():
    def attempt(firmware, name, kinds, whens, profile):
        return result(*(kind.name for kind in kinds), when=whens[0], injected=whens[0] != "1001ms")

    runs = [((kind,), (f"{1000 + n}ms",), LIGHT) for kind in faults_kinds.KINDS for n in range(50)]
    runs += [((kind,), (f"{1010 + n}ms",), LIGHT) for kind in faults_kinds.LONG for n in range(8)]
    runs += [(pair, (f"{1000 + n}ms",) * 2, LIGHT) for pair in faults.itertools.combinations(faults_kinds.KINDS, 2) for n in (0, 2, 3, 4, 5)]
    runs += [((kind,), (f"{1002 + n}ms",), DEFAULT) for kind in faults_commands.KINDS for n in range(5 if kind.name == "command stop: scl" else 6)]
    with mock.patch.object(faults, "lines_that_ran", return_value={"fault": "lines", "good": True}):
        status, said = told_by(runs, attempt, words=[])
    kinds = len(faults_kinds.KINDS)
    assert status == 1 and said.endswith(f"{len(runs) - kinds + 1} passed, {kinds + 1} failed\n"), said[-300:]
    assert "faults: torn: 49 phases were judged of at least 50" in said and "faults: command stop: scl: 5 phases were" in said, said[-900:]
    # more than one in ten that never came
    status, said = told_by(runs[1:3], attempt)
    assert status == 1 and said.endswith("1 passed, 1 failed\n") and "1 of 2 faults never came" in said, said


def program(*words):
    """(exit status, stdout, stderr) of one of the two programs."""
    done = subprocess.run([sys.executable, *map(str, words)], capture_output=True, text=True, timeout=PATIENCE_S)
    return done.returncode, done.stdout, done.stderr


def program_ended(words, far_enough):
    """The same, ended as `timeout` does from outside, by a signal to it and then to its group, once far_enough(process, what it has said)."""
    OUT.mkdir(parents=True, exist_ok=True)
    with open(OUT / "ended.log", "w+", encoding="utf-8") as said, open(OUT / "ended.err", "w+", encoding="utf-8") as errors:
        process = subprocess.Popen([sys.executable, *map(str, words)], stdout=said, stderr=errors, start_new_session=True)
        try:
            until(lambda: process.poll() is not None or far_enough(process, pathlib.Path(said.name).read_text(encoding="utf-8")))
            process.terminate()
            os.killpg(process.pid, signal.SIGTERM)
            process.wait(PATIENCE_S)
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        said.seek(0)
        errors.seek(0)
        return process.returncode, said.read(), errors.read()


def processor_times_s(parent):
    """Of each process that this one has begun."""
    times = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            words = stat.read_text(encoding="utf-8").rpartition(")")[2].split()
            times += [(int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")] if int(words[1]) == parent else []
    return times


@test
def both_programs_end_well_when_they_run_out_of_time():
    def planned(process, said):
        return "faults: " in said and " runs, seed " in said

    def simulating(process, said):
        times = processor_times_s(process.pid)
        return len(times) == 2 and min(times) >= 0.5

    for words, far_enough, least in ((("campaigns/faults/faults.py", "--no-page", "sda"), planned, 0),
                                     (("campaigns/faults/soak.py", "--hours", 20), simulating, 2)):
        status, said, errors = program_ended(words, far_enough)
        assert status == 1 and "Traceback" not in errors and "ended by a signal" in said, (words, status, said[-500:], errors)
        passed, failed = re.fullmatch(r"(\d+) passed, (\d+) failed", said.splitlines()[-1]).groups()
        assert int(passed) >= least and failed == "0", said[-500:]


@test
def what_cannot_be_is_one_sentence():
    for words, sentence in ((("sda+sda",), "faults: sda+sda: no kind makes a pair with itself: name two"),
                            (("sda", "nosuch"), "faults: nosuch: no kind begins with nosuch; there are: "),
                            (("sda+nosuch",), "faults: sda+nosuch: no kind begins with nosuch; there are: "),
                            (("a+b+c",), "faults: a+b+c: a pair is A+B, of two kinds"),
                            (("--fw", "build/no.elf"), "faults: there is no file build/no.elf: "),
                            (("--fw", "build/uno/hal_probe.elf", "sda"),
                             "faults: build/uno/hal_probe.elf gives no row in a second: is it the firmware?"),
                            (("--fw", "/etc/passwd", "sda+scl"), "faults: simrun gave status 2 and no statistics: "),
                            (("--sample", "abc"), "faults: argument --sample: invalid int value: 'abc'"),
                            (("--sample", "0"), "faults: --sample and --jobs want 1 or more, --pairs 0 or more")):
        status, said, errors = program("campaigns/faults/faults.py", *words)
        assert status == 1 and errors.startswith(sentence) and errors.count("\n") == 1 and "passed" not in said, (words, errors)
    for words, sentence in ((("--hours", "nan"), "--hours wants 0.1 (in less, faults overlap) to 1000, not nan"),
                            (("--hours", "0"), "not 0"),
                            (("--hours", "-3"), "not -3"), (("--hours", "1e7"), "not 1e+07"), (("--hours", "ten"), "invalid float value: 'ten'"),
                            (("--every", "nan"), "--every wants"), (("--seed", "0"), "--seed wants"),
                            (("--fw", "build/no.elf"), "there is no file build/no.elf: make build/no.elf"),
                            (("--fw", "Makefile"), "Makefile does not run: simrun: Makefile: not an ELF file"),
                            (("--fw", "build/uno/hal_probe.elf"), "hal_probe.elf does not run: simrun: status 8")):
        status, said, errors = program("campaigns/faults/soak.py", *words)
        assert status == 1 and errors.startswith("soak: ") and sentence in errors and errors.count("\n") == 1 and not said, (words, errors)
    for simrun, of in (("faults", faults.need), ("soak", lambda path, how: soak.need(path, how, "soak"))):
        try:
            of("build/no/simrun", "make it")
        except SystemExit as ended:
            assert str(ended) == f"{simrun}: there is no file build/no/simrun: make it"
