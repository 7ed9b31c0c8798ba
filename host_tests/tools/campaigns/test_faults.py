#!/usr/bin/env python3
"""The fault campaign and the soak (faults.py and soak.py in campaigns/faults): what they plan, and how they judge what a run of simrun says."""
import itertools
import pathlib
import random
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, LIGHT  # noqa: E402
import faults  # noqa: E402
import faults_kinds  # noqa: E402
import faults_runs  # noqa: E402
import soak  # noqa: E402
import faults_commanded  # noqa: E402, F401
from faults_judged import result  # noqa: E402
import faults_shares  # noqa: E402,F401
from system_support import FW, OUT, run_all, test  # noqa: E402


@test
def a_run_in_which_all_went_well_fails_nothing():
    for kind in faults_kinds.KINDS:
        assert result(kind.name).failures() == []


@test
def each_number_of_a_run_has_its_limit():
    # the limits: 50, 150 and 600 ms; two samples; no wrong row, no reset, no hang
    for name, limit in (("sda", 50), ("hang", 50), ("nack", 50), ("unplug", 150), ("power", 150), ("devid", 150), ("starve", 600)):
        assert not result(name, ms_to_good=limit).failures() and len(result(name, ms_to_good=limit + 0.1).failures()) == 1, name
    for name in ("arb", "buserr", "nack", "nackdata", "torn", "hang", "glitch"):
        assert not result(name, lost=2).failures() and len(result(name, lost=3).failures()) == 1, name
    assert result("sda", wrong=1).failures() == ["1 wrong rows"]
    assert result("sda", resets=1).failures() == ["1 resets instead of 0"]
    assert result("sda", hang="crash").failures() == ["crash"]
    assert result("sda", recovered=False).failures() == ["no good row any more"]


@test
def of_what_nobody_can_see_as_many_rows_may_be_wrong_as_samples_were_altered():
    for name in ("flip 1", "flip 2", "noise", "double", "mixed"):
        assert not result(name, wrong=1, altered=1).failures(), name
        assert result(name, wrong=1).failures() == ["1 wrong rows"], name
        assert result(name, wrong=3, altered=2).failures() == ["3 wrong rows of 2 samples altered"], name
        assert result(name, altered=1, steps_back=1).failures() == ["1 steps back in time"], name
        assert result(name, resets=1).failures(), name
    assert not result("sda", "noise", wrong=1, altered=1).failures() and result("sda", "torn", wrong=1, altered=1).failures()
    assert result("sda", "noise", wrong=2, altered=1).failures() and result("sda", "noise", steps_back=1, altered=1).failures()


@test
def a_pair_has_the_longer_limit_and_is_judged_from_the_later_end():
    assert not result("sda", "power", ms_to_good=150).failures() and result("sda", "power", ms_to_good=151).failures()
    stats = {"fault_1": "a", "fault_1_injected": 1, "fault_1_recovered": 1, "fault_1_last_end_ms": 1010.0, "fault_1_worst_recovery_ms": 70.0,
             "fault_2": "b", "fault_2_injected": 1, "fault_2_recovered": 1, "fault_2_last_end_ms": 1050.0, "fault_2_worst_recovery_ms": 30.0,
             "fault_3": "c", "fault_3_injected": 0, "fault_3_recovered": 0, "fault_3_last_end_ms": 0.0, "fault_3_worst_recovery_ms": 0.0}
    assert list(faults_runs.ends_of(stats)) == [(1010.0, 70.0), (1050.0, 30.0)]
    stats["fault_2_recovered"] = 0
    assert list(faults_runs.ends_of(stats))[1] == (1050.0, None)


@test
def below_100_hz_three_periods_are_granted_and_above_none():
    rated = {kind.name: kind for kind in faults_kinds.rated()}
    assert {name.partition(",")[0] for name in rated} == set(faults_kinds.OF)
    for name, limit in (("sda, 12.5 Hz", 290), ("sda, 400 Hz", 50), ("sda, 800 Hz", 50), ("power, 12.5 Hz", 390), ("power, 800 Hz", 150),
                        ("flip 2, 12.5 Hz", 290), ("double, 12.5 Hz", 290), ("mixed, 12.5 Hz", 530), ("mixed, 400 Hz", 50)):
        kind = rated[name]
        assert kind.limit_ms == limit and f"{kind.rate:g} Hz" in name and kind.what == faults_kinds.OF[kind.base].what, kind
        whens = [float(when[:-2]) for when in faults_runs.moments(kind, 8, 1)]
        assert whens == sorted(set(whens)) and 1000 <= whens[0] < whens[-1] < 1000 + 2000 / kind.rate, whens
    done = faults_runs.attempt(FW, DEFAULT, (rated["nack, 800 Hz"],), ("1000.4ms",))
    assert done.injected and done.recovered and not done.failures() and done.ms_to_good < 10, done


@test
def words_choose_kinds_and_pairs():
    def names(*words):
        kinds = [kind.name for kind in faults_kinds.KINDS if faults.wanted(words, kind)]
        return kinds, [(a.name, b.name) for a in faults_kinds.KINDS for b in faults_kinds.KINDS if faults.wanted(words, a, b)]

    assert names("sd", "odr") == (["sda", "odr fast", "odr slow"], [])
    assert names("sda+noint") == ([], [("sda", "noint"), ("noint", "sda")])
    assert len(names()[0]) == len(faults_kinds.KINDS) and len(names()[1]) == len(faults_kinds.KINDS) ** 2


@test
def a_kind_of_several_faults_has_each_at_its_time():
    kind = next(kind for kind in faults_kinds.TYPED if kind.name == "starve again")
    assert kind.faults("1000.5ms")[:2] == ["1000.5ms:starve:2000", "1450.500ms:starve:2000"]
    assert faults_kinds.OF["devid"].faults("xfer:3.4") == ["xfer:3.4:power:20", "xfer:3.4:devid:0:200"]
    done = faults_runs.attempt(FW, DEFAULT, (kind,), ("1003ms",))
    assert done.injected and not done.failures() and done.resets == done.resets_due == 4, done


@test
def what_is_typed_in_a_run_is_answered():
    kind = next(kind for kind in faults_kinds.TYPED if kind.name == "typed: words")
    done = faults_runs.attempt(FW, DEFAULT, (kind,), ("1000ms",))
    said = (faults_runs.folder() / "out.csv").read_text(encoding="ascii")
    assert done.recovered and not done.failures(), done
    for words in ("# state ", "illegal characters", "line too long", "unknown command", "# stopped", "# going", "roll_raw:", "mode is one of"):
        assert words in said, words


@test
def lines_that_no_run_reached_are_missed():
    profile = set()
    faults_runs.simulate(FW, DEFAULT, max_ms=600, profile=profile)
    ran, lines, missed = faults.coverage.campaign_lines(FW, {int(address, 16) for address in profile})
    assert 0.3 * lines < ran < 0.9 * lines and len(missed) >= lines - ran, (ran, lines)
    assert any("adxl345.c:" in line for line in missed) and any("filter" in line for line in missed)


@test
def phases_are_every_byte_every_stage_and_the_whole_period():
    whens = faults_runs.phases(FW, faults_kinds.OF["arb"], LIGHT, 50)
    bytes_of = [tuple(map(int, w[5:].split("."))) for w in whens if w.startswith("xfer:")]
    assert len(set(whens)) == len(whens) >= 50, len(whens)
    assert len({transfer for transfer, _ in bytes_of}) == 1 and [byte for _, byte in bytes_of] == list(range(1, len(bytes_of) + 1)), bytes_of
    assert len(bytes_of) in range(9, 16)
    functions = {w[3:].partition("#")[0].partition(".")[0] for w in whens if w.startswith("pc:")}
    assert functions >= {"adxl345_burst_judge", "slope_of", "format_u32", "__vector_1", "__vector_24"} and "text_char" not in functions, functions
    moments = [float(w[:-2]) for w in whens if w.endswith("ms")]
    assert len(moments) >= 10 and min(moments) < 1001 and 1009 < max(moments) < 1010, moments


@test
def every_fault_of_a_plan_comes_and_a_run_is_judged_by_the_model():
    whens = faults_runs.phases(FW, faults_kinds.OF["flip 1"], LIGHT, 50)
    for when in (whens[5], next(w for w in whens if w.startswith("pc:__vector_1#")), whens[-1]):
        done = faults_runs.attempt(FW, LIGHT, (faults_kinds.OF["flip 1"],), (when,))
        assert done.injected and done.recovered and not done.failures() and done.lost == 0, done
    # the byte of x: it is altered, so the judge that looks at the model alone finds the row wrong
    done = faults_runs.attempt(FW, LIGHT, (faults_kinds.OF["flip 1"],), (whens[5],))
    assert done.wrong == done.altered == 1, done
    done = faults_runs.attempt(FW, LIGHT, (faults_kinds.OF["reset"],), ("1000ms",))
    assert done.recovered and done.resets == done.resets_due == 1 and 20 < done.ms_to_good < 600, done


@test
def all_pairs_are_planned_and_the_same_for_the_same_seed():
    count = len(faults_kinds.KINDS)
    pairs = list(faults_runs.seeded_pairs(5, 3))
    assert len(pairs) == 5 * count * (count - 1) // 2 and len({frozenset(k.name for k in kinds) for kinds, _ in pairs}) == len(pairs) // 5
    assert all(len(set(whens)) == 2 and all(1000 <= float(w[:-2]) <= 1100 for w in whens) for _, whens in pairs)
    assert pairs == list(faults_runs.seeded_pairs(5, 3)) != list(faults_runs.seeded_pairs(5, 4))


@test
def every_kind_that_simrun_has_is_in_the_campaign():
    table = pathlib.Path("sim/faults/simrun_faults_parse.c").read_text(encoding="utf-8")
    known = set(re.findall(r'\{ (?:\.name = )?"(\w+)"', table))
    used = {what.rpartition(" ")[2].partition(":")[0] for kind in faults_kinds.KINDS + faults_kinds.TYPED for what in kind.what}
    assert len(known) > 25 and known - used == {"plug", "poke"} and used <= known, known ^ used
    undetectable = {kind.what[0].partition(":")[0] for kind in faults_kinds.KINDS if not kind.detectable}
    assert undetectable == {"flip", "noise", "double", "mixed"}, undetectable


@test
def a_sample_takes_all_kinds_alike():
    runs = [((kind,), (f"{n}ms",), LIGHT) for kind in "abcde" for n in range(40)]
    chosen = faults.take(random.Random(1), runs, 20)
    assert len(chosen) == 20 and all(sum(run[0] == (kind,) for run in chosen) == 4 for kind in "abcde"), chosen
    assert len({run[1] for run in chosen}) > 10 and len(faults.take(random.Random(1), runs, 500)) == 200


def soak_stats(**said):
    stats = {"rows": 180000, "rows_judged": 170000, "rows_wrong": 0, "rows_stale": 0, "rows_twice": 0, "t_us_steps_back": 0, "resets": 8,
             "sim_ms": 1.8e6, "pass_max_cycles": 64000, "rows_gap_ms": 300.0, "rows_last_good_ms": 1.8e6 - 9.0}
    for n, (fault, _) in enumerate(soak.faults_of(600, 1.8e6, 1), 1):
        stats |= {f"fault_{n}": fault, f"fault_{n}_injected": 1, f"fault_{n}_recovered": 1, f"fault_{n}_worst_recovery_ms": 30.0}
    return stats | said


@test
def soak_finds_what_went_wrong():
    path = OUT / "soak.json"
    many = soak.faults_of(600, 1.8e6, 1)
    # every kind twice: its time and its limit until the first good row, and the start
    gone_ms = 1000 + 2 * sum(len(kind.what) * (kind.lasts_ms + (kind.limit_ms if kind.name != "clip" else 50)) for kind in soak.ASKED)
    least = 180000 - gone_ms // 10
    whats = [soak.what_of(fault) for fault, _ in many]
    never = {f"fault_{n}_injected": 0 for n, what in enumerate(whats, 1) if what.startswith("sda")}
    for said, status, words in (({}, 7, []), ({}, 0, []), ({"rows_wrong": 2}, 7, ["wrong: 2"]), ({"rows_stale": 1}, 7, ["stale: 1"]),
                                ({"rows_twice": 1}, 7, ["twice: 1"]), ({"t_us_steps_back": 1}, 7, ["steps_back: 1"]),
                                ({"resets": 13}, 7, ["5 resets not asked for"]), ({"rows": 100}, 7, [f"100 rows of {least} at least"]),
                                ({"rows": least}, 7, []), ({"rows": least - 1}, 7, [f"{least - 1} rows of {least} at least"]),
                                (never, 7, ["sda:40 never came"]),
                                ({"fault_3_worst_recovery_ms": 1011.0}, 7, ["1011 ms to a good row after sda:40"]),
                                ({"fault_3_worst_recovery_ms": 1010.0, "rows_gap_ms": 1010.0, "rows_last_good_ms": 1.8e6 - 1010.0}, 7, []),
                                ({"rows_gap_ms": 1011.0}, 7, ["1011 ms without a sample's row"]),
                                ({"rows_last_good_ms": 1.8e6 - 1011}, 7, ["last good row 1011 ms before the end"]),
                                ({"rows_last_good_ms": None}, 7, ["no good row"]), ({"pass_max_cycles": 64001}, 7, ["a pass of 64001 cycles"]),
                                ({"sim_ms": 1.7e6, "rows_last_good_ms": 1.7e6}, 0, ["ended after 1700000 of 1800000 ms"]),
                                ({"resets": 6}, 7, ["2 resets asked for did not come"]),
                                ({}, 3, ["crash: what it said"])):
        path.write_text(soak.json.dumps(soak_stats(**said)), encoding="ascii")
        row, wrong = soak.judged(0, status, "what it said", path, 1.8e6, many)
        assert wrong == words and row["resets_asked_for"] == 8, (said, wrong, row)
    assert soak.GOOD_ROW_WITHIN_MS == 1010 and soak.judged(0, 1, "ended by a signal", path, None, many)[1] == []
    # ended by a signal, a half is asked neither for a fault nor, while it starts, for a row
    none = {f"fault_{n}_injected": 0 for n in range(1, len(many) + 1)}
    path.write_text(soak.json.dumps(soak_stats(**none, resets=0, sim_ms=30.0, rows=0, rows_judged=0, rows_last_good_ms=None)), encoding="ascii")
    assert soak.judged(0, 1, "ended by a signal", path, None, many)[1] == []
    assert soak.judged(0, 2, "refused", path.with_name("none.json"), 1.8e6, many)[1] == ["simrun gave status 2 and no statistics: refused"]


@test
def each_kind_comes_in_each_half_of_a_soak():
    for hours, every in ((0.1667, 100), (24, 600)):
        options = soak.arguments(["--hours", str(hours)])
        assert round(options.every) == every, options
        faults_due = soak.faults_of(options.every, hours * 1.8e6, 1)
        by_chance = [fault for fault, _ in faults_due if fault.startswith("p:")]
        moments = {kind.name: float(fault.partition("ms:")[0]) for fault, kind in faults_due if "ms:" in fault}
        assert set(moments) == {kind.name for kind in soak.ASKED} and len(by_chance) == len(faults_due) // 2 <= 32, faults_due
        between = [b - a for a, b in itertools.pairwise(sorted(moments.values()))]
        assert min(moments.values()) >= 1000 and max(moments.values()) < hours * 1.8e6 - 1000 and min(between) > 1500, moments
    assert soak.faults_of(600, 3e5, 1) != soak.faults_of(600, 3e5, 2)


if __name__ == "__main__":
    sys.exit(run_all())
