"""The judge of make papers: bands, and verdicts by the rule that docs/papers.md states; the pages as they are committed, in which no verdict disobeys
its rule and no line of the index leads nowhere; each with a fault that must be named."""
import pathlib
import re
import subprocess
import sys
import types
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import papers  # noqa: E402
import papers_index  # noqa: E402
import papers_judge  # noqa: E402
import papers_page  # noqa: E402
from laws import ROBUST  # noqa: E402
from papers_support import made, rule  # noqa: E402
from papers_verdict import VERDICTS, published_range, rule_of, share_within, verdict  # noqa: E402
from system_support import refused, run_all, test  # noqa: E402

INFINITE = float("inf")


@test
def verdicts_follow_from_number_interval_and_rule():
    for shown, value, interval, wanted in (
            ("30 to 40", 35, (20, 90), "reproduced"), ("30 to 40", 41, (39, 43), "reproduced within the spread"),
            ("30 to 40", 25, (24, 26), "not reproduced"), ("30 to 40", 25, (None, None), "not reproduced"),
            ("30 to 40", 40, (None, None), "reproduced"),
            # ten times off, and just not
            ("30 to 40", 2.9, (None, None), "refuted"), ("30 to 40", 3.1, (None, None), "not reproduced"),
            ("30 to 40", 401, (400.5, 402), "refuted"),
            ("30 to 40", 399, (398, 400), "not reproduced"), ("0 to 0", 0.66, (0.65, 0.67), "refuted"), ("1 to 1", 0, (0, 0), "refuted"),
            # the paper's own numbers, an order of its choices
            ("own: 1.05 to 1.07", 1.04, (None, None), "refuted"), ("own: 1.05 to 1.07", 1.06, (None, None), "reproduced"),
            ("order: >= 38", 29, (28, 30), "refuted"), ("order: >= 38", 37, (36, 39), "reproduced within the spread"),
            ("order: <= 1", 0.9, (0.8, 1.1), "reproduced"),
            # a claim in words
            ("<= 0.8", 1.1, (1.0, 1.2), "not reproduced"), ("<= 0.8", 8.1, (8.05, 8.2), "refuted"), (">= 200", 19, (None, None), "refuted"),
            (">= 200", 36, (None, None), "not reproduced"), ("<= 0.8", INFINITE, (None, None), "refuted"),
            ("other things", 4, (None, None), "not comparable")):
        assert verdict(shown, value, *interval) == wanted, (shown, value, interval, verdict(shown, value, *interval))
    assert {verdict("30 to 40", *case) for case in ((35,), (41, 39, 43), (25,), (1,))} | {"not comparable"} == set(VERDICTS)


@test
def between_two_peaks_is_not_within_the_spread():
    """Of 200 experiments 20 are a tenth. One peak far below, one above: the interval spans what is printed, and hardly an experiment is there."""
    assert share_within("12 to 15", [11.9, 12.0, 15.0, 15.1]) == 0.5
    for between, wanted in ((0, "refuted"), (19, "refuted"), (20, "reproduced within the spread")):
        sample = [0.2] * 150 + [13.5] * between + [28.0] * (50 - between)
        row, = rows = [made(value=0.2, ci_lo=0.2, ci_hi=28.0, sample=sample)]
        assert papers_judge.judge(rows, [rule(published="12-15", reason="why")], partial=True) == []
        assert (row["verdict"], row["share"]) == (wanted, between / 200), row
    # one peak, whose edge what is printed touches
    sample = [30.0 + 0.05 * i for i in range(200)]
    assert verdict("20 to 30.92", 35.0, 30.5, 39.5, share_within("20 to 30.92", sample)) == "not reproduced"
    assert verdict("20 to 30.97", 35.0, 30.5, 39.5, share_within("20 to 30.97", sample)) == "reproduced within the spread"
    # a number of experiments that the printed range holds is reproduced, whatever their share
    assert verdict("30 to 40", 35.0, 0.0, 90.0, 0.01) == "reproduced"


@test
def rules_are_what_is_printed():
    for text, limits in (("~30", (29.5, 30.5)), ("~60-80", (59.5, 80.5)), ("~0.09", (0.085, 0.095)), ("~102", (101.5, 102.5)), ("2-2.5", (2, 2.5)),
                         ("< 2", (-INFINITE, 2)), ("0.1", (0.05, 0.15)), ("0.10", (0.095, 0.105)), ("-3.5", (-3.55, -3.45)),
                         ("6 degrees", (5.5, 6.5)), ("0 +-0.05", (-0.05, 0.05)), ("16", (16, 16))):
        assert all(abs(a - b) < 1e-12 or a == b for a, b in zip(published_range(text), limits)), text
    # a tolerance in per cent is nothing that a paper's digits say
    assert all(published_range(text) is None for text in ("< two", "best", "0.1 +-5 %"))
    for printed, takes, shown in (("30-40", "", "30 to 40"), ("< 2", "", "<= 2"), ("1.06", "own numbers", "own: 1.055 to 1.065"),
                                  ("best", "order >= 1 x g", "order: >= 7"), ("best", "<= 1 x g", "<= 7"), ("47", "other things", "other things")):
        assert rule_of(printed, takes, lambda text: 7.0) == shown, (printed, takes)


@test
def no_row_of_the_pages_disobeys_its_rule():
    judged = {paper: papers_page.judged_on(papers_page.document(paper).read_text(encoding="utf-8")) for paper in papers.PAPERS}
    assert all(len(rows) > 5 for rows in judged.values()) and sum(map(len, judged.values())) > 200, {p: len(rows) for p, rows in judged.items()}
    disobeying = [row["line"] for rows in judged.values() for row in rows
                  if verdict(row["rule"], row["measured"], *row["interval"], row["share"]) != row["verdict"]]
    assert disobeying == [], disobeying
    # the rule is that of the file of expectations, where it holds no bound of the run
    for paper, (_, path) in papers.PAPERS.items():
        rules = [r for r in papers_judge.read_expected(path) if r["published"]]
        for row in judged[paper]:
            found = [r for r in rules if r["published"] == row["printed"] and papers_judge.fits({**row, "metric": row["number"]}, r)]
            assert len(found) == 1, (row, found)
            if not any(mark in found[0]["takes"] for mark in "<>"):
                assert row["rule"] == rule_of(row["printed"], found[0]["takes"], None), row
    # the twin: each row with a range, moved ten times off, is seen
    moved = [row for rows in judged.values() for row in rows if " to " in row["rule"] and row["verdict"] == "reproduced"]
    assert len(moved) > 20 and all(verdict(row["rule"], 30 * abs(row["measured"]) + 30) == "refuted" for row in moved)


@test
def a_second_seed_that_changes_a_verdict_is_named():
    text = papers_page.document("002").read_text(encoding="utf-8")
    held = papers_page.judged_on(text)
    rows = [{"experiment": r["experiment"], "filter": r["filter"], "arithmetic": r["arithmetic"], "metric": r["number"], "published": r["printed"],
             "verdict": r["verdict"], "rule": r["rule"], "value": 1.0} for r in held]
    assert list(papers.changed_verdicts(rows, text)) == []
    other = dict(rows[0], verdict="not comparable")
    found = list(papers.changed_verdicts([other, *rows[1:]], text))
    assert len(found) == 1 and papers_judge.name_of(other) in found[0] and f"on the page {rows[0]['verdict']}" in found[0], found


@test
def every_line_of_the_index_leads_somewhere():
    found = papers_index.entries()
    assert papers_index.PAGE.check(papers_index.lines(found)) == [], "python3 campaigns/papers/papers_index.py"
    assert {entry[1] for entry in found} == set(papers.PAPERS) and len(found) > 60
    # each verdict of the pages is that of a line
    for paper in papers.PAPERS:
        named = [entry[3] for entry in found if entry[1] == paper]
        text = papers_page.document(paper).read_text(encoding="utf-8")
        for row in papers_page.judged_on(text):
            assert any(papers_index.fits(row, cell) for cell in named), f"{paper}: no line of the index has {row['line']}"


@test
def what_the_index_names_must_be_there():
    line, paper, claim, row, function, proof = next(entry for entry in papers_index.entries() if entry[3].startswith("table1_start"))
    for broken, words in (((row + "x", function, proof), "no verdict on"), (("table Nothing", function, proof), "no table 'Nothing'"),
                          ((row, f"{function}_gone", proof), "no function"), ((row, "gone.c step", proof), "no function step in gone.c"),
                          ((row, function, f"{proof}_gone"), "no test"),
                          # a function is no test
                          ((row, function, "test_figures.py save_small"), "no test"),
                          (("erratum (99): gone", function, proof), "no erratum of (99)")):
        refused(papers.Fault, lambda: papers_index.lines([(line, paper, claim, *broken)]), words, line)
    path = pathlib.Path("build/papers/index.csv")
    path.write_text("[000]\na claim | a row | a function\n", encoding="utf-8")
    refused(papers.Fault, lambda: papers_index.entries(path), "index.csv:2", "left out WHY")


@test
def no_erratum_is_dropped():
    """As many as have been found; a table with a row less is named."""
    for paper, least in (("000", 7), ("001", 4), ("002", 18)):
        rows = re.findall(r"(?m)^\| (?!place |---)", papers_index.errata(pathlib.Path(f"docs/papers-{paper}.md").read_text(encoding="utf-8")))
        assert len(rows) >= least, f"docs/papers-{paper}.md: {len(rows)} errata, there were {least}"
    assert papers_index.errata("a\n## Errata\n| b |\n## c\n| d |") == "| b |"


@test
def a_number_that_leaves_its_band_is_named():
    assert papers_judge.judge_row(made(), rule(low=30, high=40)) == []
    for broken, word in ((rule(low=36), "below"), (rule(high=34), "above")):
        found = papers_judge.judge_row(made(), broken)
        assert len(found) == 1 and word in found[0] and "e, f (double), m = 35" in found[0] and "expected:1" in found[0], found
    assert papers_judge.judge_row(made(value=float("nan")), rule()) != []
    assert "above" in papers_judge.judge_row(made(value=float("inf"), ci_lo=None, ci_hi=None), rule(high=5))[0]


@test
def two_claims_on_one_number_are_two_rows():
    rows = [made(metric="k_ef"), made(metric="other")]
    faults = papers_judge.judge(rows, [rule(metric="k_ef", published="30-40", reason="why"),
                                       rule(metric="k_ef", published="60-80", reason="says the end")], partial=True)
    assert faults == [] and [r.get("verdict") for r in rows] == ["reproduced", "not reproduced", None], (faults, rows)


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
    whole = papers.PAPERS["002"][1].read_text(encoding="utf-8")
    path = pathlib.Path("build/papers/broken.csv")
    for line, words in (("a,b,double,m,1\n", "5 fields"), ("a,b,triple,m,1,2,,,\n", "'triple'"), ("a,b,double,m,1,2,30-40,,\n", "has a reason"),
                        ("a,b,double,m,1,2,30-40,refuted,why\n", "takes 'refuted'"), ("a,b,double,m,1,2,,<= 1,why\n", "nothing else takes a verdict"),
                        ("a,b,fixed,m,,,half as good,,why\n", "needs a limit"), ("a,b,fixed,m,,,half as good,<= soon enough,why\n", "is no bound")):
        path.write_text(whole + line, encoding="utf-8")
        refused(papers.Fault, lambda: papers_judge.read_expected(path), words, f":{whole.count(chr(10)) + 1}:")


@test
def a_number_that_is_not_finite_is_null_in_the_json():
    rows = [made(value=0.9765), made(value=float("inf")), made(value=3.8e-14)]
    assert [row["value"] for row in papers.as_json("002", rows)] == [0.9765, None, 3.8e-14]


@test
def the_page_holds_what_was_measured():
    rows = [made(experiment="clean", filter=ROBUST, metric="clean_efficiency", value=0.9765, ci_lo=0.97, ci_hi=0.98),
            made(value=float("inf"), experiment="step_clean_5_sigma", metric="reacq_p95"),
            made(metric="k_ef_steady", value=3.8e-14, experiment="printed"),
            made(published="30-40", rule="30 to 40", verdict="reproduced", reason="why")]
    document = pathlib.Path("build/papers/page.md")
    with mock.patch.object(papers_page, "document", lambda paper: document):
        papers_page.write_page("002", rows, types.SimpleNamespace(runs=300, seed=7), "0123456789ab")
    text = document.read_text(encoding="utf-8")
    assert text.startswith("# Paper 002: results\nWritten by `make papers`; do not edit it.\n<!-- sources: 0123456789ab -->\n"), text
    for words in (f"| `{ROBUST}` | double | 0.977", "never", "| 30-40 | 30 to 40 |  | reproduced | why |", "diverges",
                  "300 runs per experiment (", ", seed 7."):
        assert words in text, f"{words} is not in:\n{text}"
    assert [row["measured"] for row in papers_page.judged_on(text)] == [35.0]


@test
def a_run_that_is_not_the_page_s_leaves_it_alone():
    before = papers_page.document("001").read_bytes()
    done = subprocess.run([sys.executable, "campaigns/papers/papers.py", "--paper", "001", "--runs", "2000"], capture_output=True, text=True,
                          timeout=600)
    assert done.returncode == 0 and "pages left alone" in done.stdout and papers_page.document("001").read_bytes() == before, done


if __name__ == "__main__":
    raise SystemExit(run_all())
