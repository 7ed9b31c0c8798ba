"""make papers in small: some experiments with a few hundred runs against wide bands, and the judge, the page and the messages, each with a
fault that must be named."""
import copy
import io
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import papers  # noqa: E402
import papers_judge  # noqa: E402
import papers_page  # noqa: E402
import laws  # noqa: E402
from laws import PLAIN, ROBUST, SLOWEST  # noqa: E402
from system_support import run_all, test  # noqa: E402

(PROGRAM, OPERATIONS), EXPECTED = papers.PAPERS["002"]
RUNS = 300

# as published: the one that starts on its first sample; the linear ones have no gate, and the structurally shortened one loses more
PUBLISHED = laws.first(lambda name, traits: "FIRST_SAMPLE" in traits)
LINEAR, SAFE = laws.kalman()[2], [name for name in laws.kalman() if "GATED" in laws.laws()[name].traits and name != PUBLISHED]


class Options:
    runs, seed = RUNS, 7


def rows_of(experiment, runs=RUNS, program=PROGRAM):
    options = Options()
    options.runs = runs
    return papers.run_one(program, experiment, options, papers.Bar({experiment: 1.0}, io.StringIO()))


def value(rows, experiment, name, arithmetic, metric):
    found = [r["value"] for r in rows if (r["experiment"], r["filter"], r["arithmetic"], r["metric"]) == (experiment, name, arithmetic, metric)]
    assert len(found) == 1, f"{experiment}, {name} ({arithmetic}), {metric}: {len(found)} rows"
    return found[0]


def within(low, number, high, what):
    assert low <= number <= high, f"{what} = {number:g}, not within {low:g} .. {high:g}"


@test
def k_ef_of_a_few_runs_is_where_it_belongs():
    # 300 runs: the intervals of 10,000 runs are six times as wide
    rows = rows_of("shipped_start")
    for name in SAFE:
        within(30, value(rows, "shipped_start", name, "double", "k_ef_steady"), 46, name)
    within(1.8, value(rows, "shipped_start", LINEAR, "double", "k_ef_steady"), 2.4, LINEAR)
    fixed = {r["filter"] for r in rows if r["arithmetic"] == "fixed"}
    assert fixed == set(laws.kalman()), fixed
    within(30, value(rows, "shipped_start", ROBUST, "fixed", "k_ef_steady"), 46, f"{ROBUST}, fixed")
    within(0.97, value(rows, "shipped_start", ROBUST, "fixed", "k_ef_steady_by_double"), 1.03, f"{ROBUST}, fixed by double")


@test
def refuted_readings_are_refuted():
    rows = rows_of("printed_readings")
    names = {reading.rpartition("_")[2]: reading for reading in sorted({r["filter"] for r in rows if "_eq" in r["filter"]})}
    for equation in ("eq33", "eq34", "eq24", "eq26"):
        assert value(rows, "printed", names[equation], "double", "k_ef_steady") < 0.05, names[equation]
    within(1.7, value(rows, "printed", names["eq21"], "double", "k_ef_steady"), 2.6, names["eq21"])
    # the twin: what is refuted does not pass for the working filter
    rule = dict(next(r for r in papers_judge.read_expected(EXPECTED) if r["filter"] == ROBUST and r["metric"] == "k_ef_steady"))
    impostor = dict(next(r for r in rows if r["filter"] == names["eq33"] and r["metric"] == "k_ef_steady"))
    faults = papers_judge.judge_row(impostor, rule)
    assert len(faults) == 1 and names["eq33"] in faults[0] and "below its band" in faults[0], faults


@test
def nothing_locks_out_but_the_published_filter():
    rows = [r for r in rows_of("lockout", 100) if r["metric"] == "not_back"]
    assert {r["filter"] for r in rows} >= set(laws.kalman()) - {PLAIN}
    for row in rows:
        assert row["runs"] == 1000
        assert (row["value"] > 300) if row["filter"] == PUBLISHED else (row["value"] == 0), papers_judge.name_of(row)


@test
def numbers_without_chance_keep_their_bands():
    rows = rows_of("covariance", 1) + rows_of("steady_gain", 1)
    faults = papers_judge.judge(rows, papers_judge.read_expected(EXPECTED), partial=True)
    assert faults == [], faults
    assert sum(1 for row in rows if row.get("band")) >= 6


@test
def what_has_no_chance_in_it_is_as_on_the_page():
    rows = rows_of("covariance", 1) + rows_of("steady_gain", 1) + rows_of("table2", 1) + rows_of("operations", 1, OPERATIONS)
    papers_judge.judge(rows, papers_judge.read_expected(EXPECTED), partial=True)
    page = papers_page.DOCUMENT.read_text(encoding="utf-8")
    assert papers_page.stale(rows, page) == [], "run make papers: " + "; ".join(papers_page.stale(rows, page))
    # twins: one more multiplication, another gain, a row too many
    for experiment, metric in (("operations", "multiplications_most"), ("operations", "memory_cells"), ("steady_gain", "gain"),
                               ("covariance", "variance_ratio"), ("table2", "additions_by_kf")):
        changed = copy.deepcopy(rows)
        row = next(r for r in changed if (r["experiment"], r["metric"]) == (experiment, metric) and
                   (r.get("verdict") or experiment == "steady_gain"))
        row["value"] *= 1.25
        found = papers_page.stale(changed, page)
        assert found and all(f"`{row['filter']}`" in line for line in found), (experiment, found)
    fewer = [r for r in rows if r["filter"] != SLOWEST]
    assert any(line.startswith(f"the page has: | `{SLOWEST}`") for line in papers_page.stale(fewer, page))


@test
def fewer_runs_and_other_seeds_leave_the_page_alone():
    before = papers_page.DOCUMENT.read_bytes()
    for words in (["--runs", "20"], ["--runs", "20", "--seed", "7"]):  # the quickest paper: which one makes no difference
        done = subprocess.run([sys.executable, "campaigns/papers/papers.py", "--paper", "001", *words], capture_output=True, text=True, timeout=600)
        assert "page left alone" in done.stdout and papers_page.DOCUMENT.read_bytes() == before, done


@test
def operations_are_those_of_the_equations():
    # kalman.h: products P11 -> w1 r, w2 = P12 g, w2 P12, w2 r; one reciprocal. sprf adds r^2 and gate^2 R S
    rows = rows_of("operations", 1, OPERATIONS)
    for name, products in ((PLAIN, 4), (ROBUST, 6)):
        assert value(rows, "operations", name, "fixed", "multiplications") == products, name
        assert value(rows, "operations", name, "fixed", "divisions") == 1, name
    # ranges of z and x, each by a sum; sums of the prediction (5: x, P11 twice, P12, P22), r, S, 1 - g, P22, x and rate, and the size of a
    # negative rate
    within(13, value(rows, "operations", PLAIN, "fixed", "additions"), 14, f"{PLAIN}, additions")


def faults_of_004(rows):
    return papers_judge.judge(rows, papers_judge.read_expected(papers.PAPERS["004"][1]), True, papers.FULL_RUNS["004"], papers.WANTED["004"])


@test
def a_program_in_python_is_one_of_them():
    programs = papers.PAPERS["004"][0][:1]
    known = papers.experiments_of(programs)
    assert len(known) >= 8 and all(program == programs[0] for program, _ in known.values()), known
    rows = rows_of("windows_stuck_at_zero", 1600, programs[0]) + rows_of("observability", 1, programs[0])
    assert faults_of_004(copy.deepcopy(rows)) == []
    # twins: the degree of observability alone with the acceptor's numbers, and a fixed sensor with more noise than the second moments allow
    for name, metric, change in (("degree_only", "rms_median", 0.5), ("gate_then_degree", "rms_median", 4.0), ("fixed_1", "mse", 1.6),
                                 ("channel", "sum_a2_2", 1.001), ("trend_acceptor", "best_sensor", 0.7)):
        changed = copy.deepcopy(rows)
        row = next(r for r in changed if (r["filter"], r["metric"]) == (name, metric))
        row["value"] *= change
        assert any(fault.startswith(papers_judge.name_of(row)) for fault in faults_of_004(changed)), papers_judge.name_of(row)
    # one sentence of it reaches the user
    kept, away = papers.PYTHON, pathlib.Path("build/none/python")
    for python, sentence in ((kept, "nothing: variable_structure: 'nothing': no such experiment (--list tells them)"),
                             (away, f"{programs[0]}: needs {away}, which is not there: sh tools/deps.sh papers")):
        papers.PYTHON = python
        try:
            rows_of("nothing", 1, programs[0])
        except papers.Fault as fault:
            assert str(fault) == sentence, fault
        else:
            raise AssertionError("an experiment called nothing was run")
        finally:
            papers.PYTHON = kept


@test
def paper_004_runs_alone_and_leaves_the_page_alone():
    before = papers_page.DOCUMENT.read_bytes()
    done = subprocess.run([sys.executable, "campaigns/papers/papers.py", "--paper", "004", "--runs", "1000"], capture_output=True, text=True,
                          timeout=600)
    assert done.returncode == 0 and "page left alone" in done.stdout and papers_page.DOCUMENT.read_bytes() == before, done


@test
def paper_003_has_rows_in_float():
    (program,), bands = papers.PAPERS["003"]
    rows = rows_of("tau", 1, program) + rows_of("closed_loop", 2000, program)
    judged = lambda of: papers_judge.judge(of, papers_judge.read_expected(bands), True, papers.FULL_RUNS["003"], papers.WANTED["003"])
    assert judged(copy.deepcopy(rows)) == [] and {row["arithmetic"] for row in rows} == {"double", "float"}
    # twins: an element of tau wrong by 1e-6 in float, a heading ten times worse
    for name, metric, change in (("lib_nav", "tau_22", 1 + 1e-6), ("12_states_drift(q1:10_hz)", "heading_without_gps", 10.0)):
        changed = copy.deepcopy(rows)
        row = next(r for r in changed if (r["filter"], r["arithmetic"], r["metric"]) == (name, "float", metric))
        row.update(value=row["value"] * change)
        assert any(fault.startswith(papers_judge.name_of(row)) for fault in judged(changed)), papers_judge.name_of(row)
    # a rule of both is of double and fixed point
    both = {**rule(filter="lib_nav", experiment="tau", metric="tau_22"), "arithmetic": "both"}
    assert [papers_judge.fits(made(filter="lib_nav", experiment="tau", metric="tau_22", arithmetic=a), both)
            for a in papers_judge.ARITHMETICS] == [True, False, True]


@test
def a_seed_gives_the_same_numbers_again():
    assert rows_of("bursts", 20) == rows_of("bursts", 20)


def made(**changes):
    return {"experiment": "e", "filter": "f", "arithmetic": "double", "metric": "m", "value": 35.0,
            "ci_lo": 34.0, "ci_hi": 36.0, "runs": 1, **changes}


def rule(**changes):
    made_so = {"experiment": "e", "filter": "f", "arithmetic": "double", "metric": "m", "low": "", "high": "",
               "published": "", "verdict": "", "reason": "", "line": "expected:1", **changes}
    return {**made_so, "low": str(made_so["low"]), "high": str(made_so["high"])}


@test
def a_number_that_leaves_its_band_is_named():
    assert papers_judge.judge_row(made(), rule(low=30, high=40)) == []
    for broken, word in ((rule(low=36), "below"), (rule(high=34), "above")):
        found = papers_judge.judge_row(made(), broken)
        assert len(found) == 1 and word in found[0] and "e, f (double), m = 35" in found[0] and "expected:1" in found[0], found
    assert papers_judge.judge_row(made(value=float("nan")), rule()) != []
    assert "above" in papers_judge.judge_row(made(value=float("inf"), ci_lo=None, ci_hi=None), rule(high=5))[0]


@test
def a_verdict_must_fit_its_number():
    reproduced = rule(published="30-40", verdict="reproduced", reason="why")
    refuted = rule(published="30-40", verdict="refuted", reason="why")
    row = made()
    assert papers_judge.judge_row(row, reproduced) == [] and (row["published"], row["verdict"], row["reason"]) == ("30-40", "reproduced", "why")
    assert "cannot be 'refuted'" in papers_judge.judge_row(made(), refuted)[0]
    far = made(value=50.0, ci_lo=41.0, ci_hi=60.0)
    assert "cannot be 'reproduced'" in papers_judge.judge_row(far, reproduced)[0] and papers_judge.judge_row(far, refuted) == []
    # of few runs the interval decides only against the paper
    assert papers_judge.judge_row(made(runs=2000), refuted) == []
    assert "cannot be 'reproduced'" in papers_judge.judge_row(made(value=50.0, ci_lo=41.0, ci_hi=60.0, runs=2000), reproduced)[0]
    assert "cannot be 'refuted'" in papers_judge.judge_row(made(runs=10000), refuted)[0]
    # numbers of different things are not compared, but keep their band
    apart = rule(published="30-40", verdict="not comparable", reason="why", high=40)
    assert papers_judge.judge_row(made(), apart) == [] and "above" in papers_judge.judge_row(made(value=50.0), apart)[0]
    # of K_ef, refuted is ten times below and nothing less
    for value_, verdict, sound in ((2.9, "refuted", True), (2.9, "not reproduced", False), (3.1, "refuted", False), (3.1, "not reproduced", True)):
        found = papers_judge.judge_row(made(metric="k_ef_steady", value=value_, ci_lo=None, ci_hi=None),
                                       rule(published="30-40", verdict=verdict, reason="why"))
        assert (found == []) == sound and (sound or f"cannot be '{verdict}'" in found[0]), (value_, verdict, found)
    # an interval that touches; the spread of groups does not count as one
    assert papers_judge.judge_row(made(value=41.0, ci_lo=39.0, ci_hi=43.0), reproduced) == []
    assert papers_judge.agrees(made(metric="m_of_50", value=41.0, ci_lo=20.0, ci_hi=60.0), (30, 40)) is False
    assert papers_judge.published_range("~30") == (27, 33) and papers_judge.published_range("2-2.5") == (2, 2.5)
    assert papers_judge.published_range("< 2") == (-float("inf"), 2) and papers_judge.published_range("< two") is None
    low, high = papers_judge.published_range("0.1 +-5 %")
    assert abs(low - 0.095) < 1e-12 and abs(high - 0.105) < 1e-12 and papers_judge.published_range("best") is None


@test
def two_claims_on_one_number_are_two_rows():
    rows = [made(metric="k_ef"), made(metric="other")]
    faults = papers_judge.judge(rows, [rule(metric="k_ef", published="30-40", verdict="reproduced", reason="why"),
                                          rule(metric="k_ef", published="60-80", verdict="not reproduced", reason="says the end")], partial=True)
    assert faults == [] and [r.get("published") for r in rows] == ["30-40", "60-80", None], (faults, rows)


@test
def missing_numbers_and_missing_limits_are_named():
    faults = papers_judge.judge([made()], [rule(filter="f g", low=1.0)])
    assert len(faults) == 1 and "no number for e, g (double), m" in faults[0], faults
    # a filter that has left FILTER_LIST is missed, with or without other numbers of it
    faults = papers_judge.judge([made()], [rule(arithmetic="fixed", low=1.0)])
    assert len(faults) == 1 and "no number for e, f (fixed)" in faults[0], faults
    faults = papers_judge.judge([made(arithmetic="fixed", metric="other")], [rule(arithmetic="fixed", low=1.0)])
    assert any("no number for e, f (fixed)" in f for f in faults), faults
    # a shipped filter without limits
    assert [f for f in faults if "has no band" in f and f.startswith("f is in FILTER_LIST")], faults


@test
def a_bad_list_of_bands_is_named_by_line():
    whole = EXPECTED.read_text(encoding="utf-8")
    path = pathlib.Path("build/papers/broken.csv")
    for line, words in (("a,b,double,m,1\n", "5 fields"), ("a,b,triple,m,1,2,,,\n", "'triple'"), ("a,b,double,m,1,2,30-40,,\n", "has a verdict"),
                        ("a,b,double,m,1,2,30-40,refuted,\n", "a reason")):
        path.write_text(whole + line, encoding="utf-8")
        try:
            papers_judge.read_expected(path)
        except papers_judge.Fault as fault:
            assert words in str(fault) and f":{whole.count(chr(10)) + 1}:" in str(fault), fault
        else:
            raise AssertionError(f"{line.strip()} was taken")


@test
def the_page_holds_what_was_measured():
    rows = [made(experiment="clean", filter=ROBUST, metric="clean_efficiency", value=0.9765, ci_lo=0.97, ci_hi=0.98),
            made(value=float("inf"), experiment="step_clean_5_sigma",
                 metric="reacq_p95"), made(metric="k_ef_steady", value=3.8e-14, experiment="printed"),
            made(published="30-40", verdict="refuted", reason="why")]
    text = papers_page.page_text(copy.deepcopy(rows), Options())
    for words in (f"| `{ROBUST}` | double | 0.977", "never", "| 30-40 | **refuted** | why |", "300 runs per experiment", "diverges"):
        assert words in text, f"{words} is not in:\n{text}"
    assert [r["value"] for r in papers.as_json("002", rows)] == [0.9765, None, 3.8e-14, 35.0]


@test
def progress_tells_the_time_left_on_a_terminal_only():
    class Terminal(io.StringIO):
        def isatty(self):
            return True
    for stream, wanted in ((io.StringIO(), False), (Terminal(), True)):
        bar = papers.Bar({"long": 3.0, "short": 1.0}, stream)
        bar.at("long", 1.0)
        assert ("75 %" in stream.getvalue()) == wanted, stream.getvalue()
    bar.began = 0.0
    assert bar.text(30.0).endswith("75 %  10 s left"), bar.text(30.0)


@test
def bad_words_give_one_sentence():
    for words, sentence in ((["nothing"], "'nothing': no such experiment"), (["bursts", "--runs", "0"], "--runs: takes a whole number"),
                            (["bursts", "--runs"], "--runs: takes a whole number"), (["bursts", "--hurry", "1"], "--hurry: unknown option")):
        done = subprocess.run([str(PROGRAM), *words], capture_output=True, text=True, timeout=600)
        assert done.returncode == 2 and sentence in done.stderr and done.stderr.count("\n") == 1, done
    done = subprocess.run([sys.executable, "campaigns/papers/papers.py", "--only", "nothing"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 2 and "no experiment's name contains nothing" in done.stderr, done


if __name__ == "__main__":
    raise SystemExit(run_all())
