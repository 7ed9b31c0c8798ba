"""make default: the rule of the default filter, its scores, its program."""
import json
import math
import pathlib
import subprocess
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST  # noqa: E402
import default_filter
import default_score as score
import default_streams as streams
import make_streams
import results

from system_support import run_all, test

OUT = pathlib.Path("build/default-test")
SECOND, THIRD = "second", "third"
ALL_BUT_ONE = len(score.CLASSES) - 1
PROGRAM = default_filter.PROGRAM


# --- the rule ---------------------------------------------------------------------------------------------------------


def planted(ratio, **more):
    """Scores in which the candidate is ratio[i] times the best other in class i."""
    return {group: {PLAIN: 3.0, ROBUST: 2.0, SECOND: 2.0, THIRD: 5.0, DEFAULT: 2.0 * r, **more} for group, r in zip(score.CLASSES, ratio)}


def decided(*ratio, **more):
    return score.verdict(planted(ratio, **more))


@test
def the_least_geometric_mean_of_those_that_pass_is_the_default():
    assert decided(*(0.5,) * (ALL_BUT_ONE + 1)).default == DEFAULT
    found = decided(*(0.9,) * ALL_BUT_ONE, 1.25)  # the mean of these is 0.94 of the other's
    assert found.default == DEFAULT and found.beyond == [] and found.best_in == list(score.CLASSES[:ALL_BUT_ONE]), found
    assert abs(found.mean[DEFAULT] - 2.0 * (0.9 ** ALL_BUT_ONE * 1.25) ** (1 / (ALL_BUT_ONE + 1))) < 1e-9
    assert decided(1.01, *(1.0,) * ALL_BUT_ONE).default in (ROBUST, SECOND)  # no better in any class


@test
def one_class_too_far_from_the_best_rules_out_and_is_named():
    found = decided(0.1, 0.1, 0.1, 0.1, 1.251, *(0.1,) * (ALL_BUT_ONE - 4))
    assert found.default != DEFAULT and found.beyond == ["vibration"] and "vibration (1.25 times)" in found.why, found
    assert decided(1.251, *(0.1,) * ALL_BUT_ONE).beyond == ["rest"]
    assert decided(*(0.1,) * ALL_BUT_ONE, 1.251).beyond == ["bursts"]


@test
def every_filter_is_compared_but_what_is_none():
    assert decided(*(1.0,) * (ALL_BUT_ONE + 1), another=0.1).default == "another"
    assert decided(*(0.9,) * (ALL_BUT_ONE + 1), **{name: 0.01 for name in score.NOT_FILTERS}).default == DEFAULT


@test
def where_no_filter_passes_none_is_chosen():
    scores = {group: {PLAIN: 1.0 + 9.0 * (i % 2), DEFAULT: 10.0 - 9.0 * (i % 2), ROBUST: 5.0} for i, group in enumerate(score.CLASSES)}
    assert score.verdict(scores).default == score.NONE_PASSES


@test
def a_missing_class_or_candidate_chooses_none():
    scores = planted((0.5,) * (ALL_BUT_ONE + 1))
    del scores["walking"]
    assert score.verdict(scores).default == score.NONE_PASSES and "walking" in score.verdict(scores).why
    scores = planted((0.5,) * (ALL_BUT_ONE + 1))
    del scores["bad reads"][DEFAULT]
    found = score.verdict(scores)
    assert found.default == score.NONE_PASSES and f"{DEFAULT} is not in the filter list" in found.why, found


# --- scores -----------------------------------------------------------------------------------------------------------


def cell(group, name, rate_hz, rmse, made=False):
    """Of 100 values each; the filters by name."""
    return score.Cell(group, name, rate_hz, made, group, {f: score.Sums(100, (100.0 * v * v,) * 4) for f, v in rmse.items()})


@test
def no_rate_and_no_stream_outweighs_the_others():
    cells = [cell("rest", "a", 25, {PLAIN: 1.0}), cell("rest", "b", 25, {PLAIN: 100.0}), cell("rest", "a", 50, {PLAIN: 1000.0})]
    assert abs(score.geometric(cells, PLAIN) - 100.0) < 1e-9  # of 10 at 25 Hz and 1000 at 50 Hz
    assert abs(score.pooled_rms(cells, PLAIN) - math.sqrt((1.0 + 1e4 + 1e6) / 3.0)) < 1e-9


@test
def streams_are_drawn_anew_with_all_their_rates():
    same = [cell("rest", str(i), hz, {PLAIN: 2.0 + i, SECOND: 1.0 + i / 2}) for i in range(9) for hz in (25, 50)]
    low, high = score.ratio_interval(score.redrawn(same, [PLAIN, SECOND]), "rest", PLAIN, SECOND)
    assert abs(low - 2.0) < 1e-9 and abs(high - 2.0) < 1e-9
    # 1, 2, 3 times, three streams each: ln has a mean of 0.597 and a standard deviation of 0.452, 0.151 for nine; rates go together
    draws = score.redrawn([cell("rest", str(i), hz, {PLAIN: 1.0 + i % 3, SECOND: 1.0}) for i in range(9) for hz in (25, 50)], [PLAIN, SECOND])
    low, high = score.ratio_interval(draws, "rest", PLAIN, SECOND)
    assert abs(math.log(low) - (0.597 - 1.96 * 0.151)) < 0.06 and abs(math.log(high) - (0.597 + 1.96 * 0.151)) < 0.06, (low, high)


def row(fault, seed, name, whole, after_bad):
    numbers = [f"{count},{square},{square},{square},{own}" for count, square, own in (whole, after_bad)]
    return ",".join(["rest:x:0", "1000", fault, str(seed), name, *numbers])


@test
def a_seed_without_a_fault_is_the_run_without_faults():
    source = streams.Source("x", "rest", "")
    job = streams.Job(source, 100, pathlib.Path("x"), 16, 1, True, 60_000, True)  # 4 seeds
    text = "\n".join([row("none", 0, PLAIN, (300, 300.0, 0.0), (0, 0.0, 0.0)),
                      row(score.HEALTHY, 3, PLAIN, (300, 1500.0, 1200.0), (150, 1350.0, 1200.0)),
                      row(score.WIRING, 1, PLAIN, (300, 2700.0, 9.0), (150, 2400.0, 9.0))])
    assert job.seeds() == 4
    healthy, wiring, contention, *_ = score.cells_of([job], score.read_rows(text))
    assert healthy.group == "rest" and abs(healthy.rmse(PLAIN) - math.sqrt((3 * 300 + 1500) / 1200)) < 1e-9
    assert abs(healthy.rmse(PLAIN, score.OWN) - 1.0) < 1e-9
    assert wiring.group == "bad reads" and abs(wiring.rmse(PLAIN) - 4.0) < 1e-9  # half a second after each bad read alone
    assert contention.group == score.CONTENTION and abs(contention.rmse(PLAIN) - 1.0) < 1e-9
    whole = score.cells_of([job], score.read_rows(text), whole_bad_reads=True)[1]
    assert abs(whole.rmse(PLAIN) - math.sqrt((3 * 300 + 2700) / 1200)) < 1e-9


@test
def outliers_have_a_class_and_both_kinds_of_bursts_another():
    """Judged whole, over the seeds that the job has of them."""
    source = streams.Source("x", "rest", "")
    job = streams.Job(source, 100, pathlib.Path("x"), 16, 1, True, 12_000, True)  # 2 seeds with outliers
    kinds = list(score.OUTLIER_KINDS)
    text = "\n".join([row("none", 0, PLAIN, (300, 300.0, 0.0), (0, 0.0, 0.0)),
                      *(row(kind, seed, PLAIN, (300, 300.0 * (i + 1) * seed, 9.0), (150, 1.0, 9.0))
                        for i, kind in enumerate(kinds) for seed in (1, 2))])
    assert (job.seeds(), job.outlier_seeds()) == (10, 2) and len(kinds) == 3
    found = [(cell.group, cell.fault, cell.rmse(PLAIN) ** 2) for cell in score.cells_of([job], score.read_rows(text))
             if cell.fault in kinds]
    assert [part[:2] for part in found] == [("outliers", kinds[0]), ("bursts", kinds[1]), ("bursts", kinds[2])], found
    assert all(abs(part[2] - 1.5 * (i + 1)) < 1e-9 for i, part in enumerate(found)), found


@test
def what_is_tuned_with_does_not_decide():
    name = next(source.name for source in streams.RECORDINGS if source.tuning)
    jobs = [streams.Job(streams.Source(n, "rest", ""), 100, pathlib.Path("x"), 16, 1, True, 60_000, True) for n in ("x", name)]
    line = row("none", 0, PLAIN, (300, 300.0, 0.0), (300, 0.0, 0.0))
    cells = score.cells_of(jobs, score.read_rows("\n".join([line, line.replace("rest:x:0", jobs[1].key())])))
    assert len(cells) == 12 and [cell.group.startswith(score.NOT_JUDGED) for cell in cells] == [False] * 6 + [True] * 6
    assert score.by_class(cells, [PLAIN]) == score.by_class(cells[:6], [PLAIN])


@test
def wins_of_others_are_found():
    cells = [cell("rest", "a", 25, {PLAIN: 1.0, SECOND: 2.0, DEFAULT: 1.5}), cell("rest", "a", 50, {PLAIN: 1.0, SECOND: 2.0, DEFAULT: 0.5})]
    assert score.other_wins(cells, [PLAIN, SECOND, DEFAULT]) == [("rest", 25, PLAIN, 1.5)]
    assert score.other_wins(cells, [SECOND, DEFAULT]) == []


# --- the program ------------------------------------------------------------------------------------------------------


def built():
    OUT.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(["make", "-s", PROGRAM], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr


def program(*jobs, expect=0):
    built()
    done = subprocess.run([PROGRAM], input="".join(job + "\n" for job in jobs), capture_output=True, text=True, timeout=600)
    assert done.returncode == expect, (done.returncode, done.stderr)
    return done


def still_stream(rows=600, roll=0.0, pitch=0.0):
    """Reads 4 LSB too much on x and 3 on z, to the nearest whole ones."""
    path = OUT / f"still-{rows}-{roll:g}.csv"
    OUT.mkdir(parents=True, exist_ok=True)
    x, y, z = (make_streams.round_half_up(lsb) for lsb in make_streams.to_lsb(make_streams.gravity_g(roll, pitch)))
    lines = [f"{10000 * i},{x + 4},{y},{z + 3},{100 * roll:.0f},{100 * pitch:.0f}" for i in range(rows)]
    path.write_text("\n".join([make_streams.HEADER, *lines]) + "\n", encoding="ascii")
    return path


@test
def a_constant_stream_is_off_by_what_it_is_off():
    """500 of 600 rows count on three axes; smoothed a stream is its own reference. A low pass comes to rest on a constant."""
    for roll, pitch in ((0.0, 0.0), (30.0, -20.0)):
        path = still_stream(600, roll, pitch)
        text = program(f"rest:x:0 {path} 1000 16 1 0 60 truth 0 0", f"rest:y:0 {path} 500 16 2 0 60 smooth 0 0").stdout
        rows = score.read_rows(text)
        names = list(rows["rest:x:0", 100]["none"][0])
        assert tuple(names[-len(score.NOT_FILTERS):]) == score.NOT_FILTERS and ROBUST in names and len(names) >= 9
        gravity = make_streams.to_lsb(make_streams.gravity_g(roll, pitch))
        off = [make_streams.round_half_up(lsb) + more - lsb for lsb, more in zip(gravity, (4, 0, 3))]
        expected = 500 * sum(lsb * lsb for lsb in off)
        for name in names:
            whole, after_bad = rows["rest:x:0", 100]["none"][0][name]
            assert whole.count == 1500 and after_bad.count == 0
            assert all(abs(whole.square[i] - expected) < 0.5 for i in range(3)) and whole.square[score.OWN] == 0.0, (name, whole, expected)
            whole = rows["rest:y:0", 50]["none"][0][name][0]
            assert whole.count == 3 * 250 and whole.square[0] < 1e-3, (name, whole)  # the first group ends at 10 ms


@test
def what_a_bad_read_does_to_the_raw_samples_lies_behind_it():
    rows = score.read_rows(program(f"rest:x:0 {still_stream()} 1000 16 1 0 60 truth 40 0").stdout)["rest:x:0", 100]
    bad = [runs["raw"] for fault in (score.WIRING, score.HEALTHY) for runs in rows[fault].values()]
    assert len(bad) >= 8 and len(rows[score.WIRING]) < 40, "seeds without a fault were told"
    for whole, after_bad in bad:
        assert whole.square[score.OWN] == after_bad.square[score.OWN] and after_bad.count <= 150 * 6
    assert any(0 < after_bad.count <= 150 for _, after_bad in bad), "no window of half a second"
    share = [runs["raw"][0].square[score.OWN] / (259.0 ** 2 * 500) for runs in rows[score.CONTENTION].values()]
    assert len(share) == 40 and abs(sum(share) / 40 - 0.2) < 0.02, sum(share) / 40


@test
def outliers_are_as_large_as_said():
    """15 % of 20 times 2, 2 and 2.6 LSB: a mean square of 0.15 x 1600 x (1 + 1 + 1.3^2). Of 90 x 500 readings that has a standard deviation of
    2 %, 3.5 % in runs, 6.3 % where a deviate is held; four of each."""
    runs = score.read_rows(program(f"rest:x:0 {still_stream()} 1000 16 1 0 60 truth 0 30").stdout)["rest:x:0", 100]
    assert set(runs) == {score.NONE, *score.OUTLIER_KINDS}
    for kind, off in zip(score.OUTLIER_KINDS, (0.08, 0.14, 0.25)):
        square = [found["raw"][0].square[score.OWN] / 500 for found in runs[kind].values()]
        assert len(square) == 30 and abs(sum(square) / 30 / (0.15 * 1600 * (2 + 1.69)) - 1.0) < off, (kind, sum(square) / 30)


@test
def a_job_that_cannot_be_done_is_named():
    path, plain, short = still_stream(), OUT / "plain.csv", OUT / "short.csv"
    plain.write_text("t_us,x,y,z\n0,1,2,3\n10000,1,2,3\n20000,1,2,3\n", encoding="ascii")
    short.unlink(missing_ok=True)
    for job, words in ((f"k {path} 1000 16 1 0 60 truth 0", "not a job: k"), (f"k {path} 1000 3 1 0 60 truth 0 0", "not a job"),
                       (f"k {path} 1000 16 0 0 60 truth 0 0", "not a job"), (f"k {short} 1000 16 1 0 60 truth 0 0", "cannot open"),
                       (f"k {plain} 1000 16 1 0 60 truth 0 0", "k at 100 Hz: it has no truth columns"),
                       (f"k {plain} 500 16 2 0 60 smooth 0 0", "k at 50 Hz: fewer than two rows at this rate"),
                       (f"k {path} 1000 16 1 50 60 truth 0 0", "fewer than two rows in this part")):
        done = program(job, expect=2)
        assert words in done.stderr and len(done.stderr.splitlines()) == 1 and done.stdout == "", (job, done.stderr)


@test
def without_recordings_the_page_is_left_alone():
    jobs = [job for job in streams.scenario_jobs() if job.path in (streams.SHIPPED / "bad-reads.csv", streams.SHIPPED / "tilt-fast.csv")]
    page = results.Results(OUT / "no-such-page.md", "None", "make none", "")
    built()
    with mock.patch.multiple(default_filter, JSON=OUT / "rows.json", PAGE=page, measure=lambda: (jobs, default_filter.run_all(jobs), False)):
        assert default_filter.main() == 0 and not default_filter.PAGE.document.exists()
        rows = json.loads(default_filter.JSON.read_text(encoding="ascii"))
        assert rows[0]["default"] == score.NONE_PASSES and rows[0]["recordings"] is False and "no stream of class rest" in rows[0]["why"], rows[0]


if __name__ == "__main__":
    raise SystemExit(run_all())
