"""Papers 000 and 001 of make papers in small: what has no chance in it against its bands and the page, Monte Carlo against the exact values,
the judge of fewer runs, each with a fault that must be named."""
import copy
import math
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import papers  # noqa: E402
import papers_bands  # noqa: E402
import papers_judge  # noqa: E402
import papers_page  # noqa: E402
import papers_page_000 as synthesis  # noqa: E402
import laws  # noqa: E402
from papers_support import expected, made, rows_of, rule, value  # noqa: E402
from system_support import run_all, test  # noqa: E402

WITHOUT_CHANCE = {"000": ("schedules", "table1_search", "equal_noise", "roll_as_angle", "complexity"), "001": ("altitude", "ratios")}


def exact_rows(paper, *experiments):
    return [row for experiment in experiments for row in rows_of(paper, experiment) if row["runs"] == 1]


@test
def a_sample_takes_the_products_that_the_headers_tell():
    done = subprocess.run(["build/papers/products000"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    found = {name: tuple(map(int, counts)) for name, *counts in (line.split("\t") for line in done.stdout.splitlines())}
    assert len(found) == 9, found
    for name, (steady, start, rounded_shifts, divisions, *by_hand) in found.items():
        assert [steady, rounded_shifts] == by_hand, f"{name}: {steady} products and {rounded_shifts} shifts"
        assert start <= 3 and divisions == 0, f"{name}: {start} products in the start, {divisions} divisions"


@test
def numbers_without_chance_keep_their_bands():
    for paper, experiments in {"000": (*WITHOUT_CHANCE["000"], "roll_reference"), "001": WITHOUT_CHANCE["001"]}.items():
        rows = exact_rows(paper, *experiments)
        rules_of = expected(paper)
        faults = papers_judge.judge(rows, rules_of, partial=True)
        assert faults == [], faults
        # the twin: a tenth more of any banded number leaves its band
        tight = [row for row in rows if row.get("band") and None not in row["band"] and row["band"][1] < 1.02 * row["band"][0]]
        assert len(tight) > 10, len(tight)
        for row in tight:
            row["value"] *= 1.1
            assert papers_judge.judge(copy.deepcopy([row]), rules_of, partial=True), papers_judge.name_of(row)


@test
def monte_carlo_agrees_with_the_exact_error():
    rows = rows_of("000", "roll_reference")
    compared = 0
    for row in rows:
        if row["metric"].startswith("mse_"):
            exact = value(rows, row["experiment"], row["filter"], "double", f"exact_{row['metric']}")
            error = (row["ci_hi"] - row["ci_lo"]) / 3.92
            # 336 numbers, 5 standard errors: one false alarm in five thousand seeds. Fixed point has 1 / 12 of a count squared on R.
            assert abs(row["value"] - exact) < 5 * error + 0.002 * exact, f"{papers_judge.name_of(row)} = {row['value']}, exactly {exact}"
            assert error < 0.05 * exact
            compared += 1
    assert compared == 7 * 6 * 4 * 2, compared


@test
def altitude_agrees_with_the_closed_forms():
    rows = rows_of("001", "altitude")
    noise_gain = lambda ac, b0: (2 - b0 - 2 * ac * b0 - 2 * ac * ac) / ((1 + 2 * ac) * (4 - 3 * b0 - 4 * ac))
    for a1, name in ((-0.3, "synth(-0.3:0.1)"), (0.0, "synth(0:0.1)")):
        for experiment, second in (("altitude_half_a_t2", 0.05), ("altitude_a_t2", 0.1)):
            sigma = 0.5 * math.sqrt(noise_gain(0.9 * a1, 0.1))
            lag = 9 * (1 + a1) * second
            assert abs(value(rows, experiment, name, "double", "sigma_stationary") - sigma) < 0.05 * sigma
            assert abs(value(rows, experiment, name, "double", "lag_noise_free") - lag) < 0.002 * lag
            assert abs(value(rows, experiment, name, "double", "lag_35_50") + lag) < 0.1 * lag
            assert value(rows, experiment, "synth_as_printed(-0.3:0.1)", "double", "lag_20_35") > 100


@test
def every_shipped_filter_has_its_rows():
    for paper, experiment, where in (("000", "all_filters", ("filters_ramp30", "filters_steps30")), ("000", "roll_as_angle", ("roll_tilt-slow",)),
                                     ("001", "altitude_shipped", ("altitude_half_a_t2", "altitude_a_t2"))):
        rows = rows_of(paper, experiment)
        for name in where:
            fixed = {r["filter"] for r in rows if r["experiment"] == name and r["arithmetic"] == "fixed"}
            assert set(laws.names()) <= fixed, set(laws.names()) - fixed
    # told the same R and process noise, fixed point does what the double Kalman filter does
    rows = rows_of("000", "all_filters")
    for turn in synthesis.TURNS:
        for window in ("2_5", "6_10", "11_15"):
            double = value(rows, f"filters_{turn}", "kf2_rate(0.1)", "double", f"mse_{window}")
            fixed = value(rows, f"filters_{turn}", "kf(0.1)", "fixed", f"mse_{window}")
            assert abs(fixed - double) < 0.02 * double, (turn, window, double, fixed)


@test
def what_has_no_chance_in_it_is_as_on_the_page():
    for paper, experiments in WITHOUT_CHANCE.items():
        page = papers_page.document(paper).read_text(encoding="utf-8")
        rows = [row for row in exact_rows(paper, *experiments) if synthesis.of([row], *papers_page.part_of(paper).CHANCE_FREE)]
        papers_judge.judge(rows, expected(paper), partial=True)
        found = papers_page.stale(paper, rows, page)
        assert found == [], "run campaigns/papers/papers.py --paper 000 001: " + "; ".join(found)
        # twins: another number, and one less
        for row in [r for r in rows if r["arithmetic"] == "double"][::40]:
            if row["metric"] not in ("sigma_one_run_sd", "true_variance_mean") and row["value"]:
                changed = copy.deepcopy(rows)
                changed[rows.index(row)]["value"] = row["value"] * 1.25 if math.isfinite(row["value"]) else 1.0
                assert papers_page.stale(paper, changed, page), papers_judge.name_of(row)
        without = [r for r in rows if r["filter"] != rows[0]["filter"]]
        assert any(line.startswith("the page has: ") for line in papers_page.stale(paper, without, page))


@test
def shipped_filters_without_a_band_are_named():
    claim = rule(published="30-40", reason="why")
    # a filter that ships and has no band is named; one of a stated tuning is not asked for
    row = made(arithmetic="fixed", runs=4000)
    faults = papers_judge.judge([dict(row)], [dict(claim, arithmetic="fixed")], False, 4000, ("m",))
    assert any("has no band" in fault for fault in faults), faults
    faults = papers_judge.judge([dict(row, filter="f(1)")], [dict(claim, arithmetic="fixed", filter="f*")], False, 4000, ("m",))
    assert not any("has no band" in fault for fault in faults), faults


def ruled(**changes):
    return rule(**{"arithmetic": "fixed", **changes})


def measured(**changes):
    return made(**{"arithmetic": "fixed", "value": 1.0, "ci_lo": 0.99, "ci_hi": 1.01, "runs": 4000, **changes})


@test
def numbers_with_chance_keep_to_exact_values_and_standard_errors():
    for paper, experiments in (("000", ("all_filters", "adaptive", "noise")), ("001", ("altitude", "altitude_shipped"))):
        rows = [row for experiment in experiments for row in rows_of(paper, experiment)]
        rules_of = expected(paper)
        faults = papers_judge.judge(rows, rules_of, True, papers.FULL_RUNS[paper])
        assert faults == [], faults
        # the twin: a number moved by nine standard errors leaves its band
        held = [row for row in rows if row.get("ci_lo") is not None and None not in row.get("band", (None,))
                and not row["experiment"].startswith("adaptive")]
        assert len(held) > 50, len(held)
        tight = [row for row in held if row["band"][1] - row["band"][0] < 9 * papers_bands.standard_error(row)]
        assert len(tight) > 0.8 * len(held), (len(tight), len(held))
        of_run = papers_bands.Rows(rows)
        for row in tight[::7]:
            off = dict(row, value=row["value"] + 9 * papers_bands.standard_error(row))
            rules = [r for r in rules_of if papers_judge.fits(row, r)]
            assert any(papers_judge.judge_row(dict(off), r, papers.FULL_RUNS[paper], of_run) for r in rules), papers_judge.name_of(row)


@test
def no_band_is_wider_than_its_reason_allows():
    for paper in ("000", "001", "003", "004"):
        rules_of = expected(paper)
        found = [f"{rule['line']}: {papers_bands.unreasoned(rule)}" for rule in rules_of if papers_bands.unreasoned(rule)]
        assert found == [] and len(rules_of) > 40, found
    # twins: each band says less than it takes
    for rule, words in ((ruled(low="0.02", high="1.25"), "0.02 and 1.25"), (ruled(low="1", high="+-5 se"), "5 standard errors"),
                        (ruled(low="1", high="+-2 %", reason="issue: 3 %"), "2 %"), (ruled(high="0.6", reason="issue: 0.64"), "0.6"),
                        (ruled(high="1.5 x g", reason="issue: 1.25 times"), "1.5"), (ruled(low="1", high="+-0.006", reason="0.0006"), "0.006")):
        assert words in (papers_bands.unreasoned(rule) or ""), (rule, papers_bands.unreasoned(rule))
    # and of a number with chance more than four standard errors, here 0.0051
    rows = papers_bands.Rows([measured()])
    for rule, wide in ((ruled(low="0.97", high="1.03", reason="0.97 1.03"), True), (ruled(low="1", high="+-4 se"), False),
                       (ruled(low="1", high="+-3 %", reason="3 %"), True), (ruled(low="1", high="+-3 %", reason="issue: 3 %"), False)):
        assert bool(papers_bands.too_wide(rule, measured(), rows)) == wide, rule
        faults = papers_judge.judge([measured()], [rule], True, 4000, ("m",))
        assert any("standard errors wide" in fault for fault in faults) == wide, faults


@test
def bounds_may_be_other_numbers_of_the_run():
    rows = [measured(value=1.2), measured(filter="g", value=1.0), measured(metric="exact_m", value=1.19, ci_lo=None, ci_hi=None, runs=1)]
    for high, sound in (("1.25 x g", True), ("1.15 x g", False), ("1.1 x exact", True), ("1 x exact", False), ("1.1 x @exact_m", True)):
        faults = papers_judge.judge(copy.deepcopy(rows), [ruled(high=high)], True, 4000)
        assert (faults == []) == sound, (high, faults)
    faults = papers_judge.judge(copy.deepcopy(rows), [ruled(high="1.25 x h")], False, 4000, ())
    assert any("this run has no number for e, h (fixed), m" in fault for fault in faults), faults
    # a limit that allows for chance, and one of fewer runs than the page's
    near = measured(value=1.01)
    for high, runs, sound in (("1", 4000, False), ("1 + 3 se", 4000, True), ("1", 400, True)):
        assert (papers_judge.judge_row(dict(near, runs=runs), ruled(high=high), 4000) == []) == sound, (high, runs)
    # guarded adaptive is held to what it has unguarded in the same run, whatever that is
    rows = rows_of("000", "adaptive")
    rules_of = expected("000")
    for turn in ("ramp30", "cos60", "bump30"):
        plain = value(rows, f"adaptive_clean_{turn}", "adaptive(guard=0)", "fixed", "mse_6_10")
        for factor, sound in ((1.24, True), (1.40, False)):
            changed = copy.deepcopy(rows)
            wanted = (f"adaptive_clean_{turn}", "adaptive(guard=3)", "mse_6_10")
            row = next(r for r in changed if (r["experiment"], r["filter"], r["metric"]) == wanted)
            row["value"] = factor * plain
            faults = [f for f in papers_judge.judge(changed, rules_of, True, 4000) if f.startswith(papers_judge.name_of(row))]
            assert (faults == []) == sound, (turn, factor, faults)


@test
def cells_of_adaptive_and_of_noise_are_what_was_measured():
    rows = rows_of("000", "adaptive") + rows_of("000", "noise")
    papers_judge.judge(rows, expected("000"), True, 4000)
    table, curve, noise = (make(rows) for make in (synthesis.adaptive_table, synthesis.guard_table, synthesis.identified_table))
    assert sum(line.startswith("| `adaptive(guard=") for line in table) == 5 and len(curve) == 8 + 3 and len(noise) == 6 + 3, (table, curve, noise)
    for turn, limit in (("ramp30", "0.280"), ("cos60", "0.440"), ("bump30", "0.500"), ("sine30", "0.640")):
        plain = value(rows, f"adaptive_clean_{turn}", "adaptive(guard=0)", "fixed", "mse_6_10")
        assert f" / {synthesis.shown(plain)} (<= {limit}) / " in table[2], (turn, table[2])
    plain = value(rows, "adaptive_clean_ramp30", "adaptive(guard=0)", "fixed", "mse_6_10")
    assert f"(<= {synthesis.shown(1.25 * plain)})" in table[3], table[3]
    assert [line for line in curve if "as shipped" in line][0].startswith("| `adaptive(guard=3)` | 3 sigma, as shipped | "), curve
    for line, experiment in zip(noise[2:], ("noise_rest_10_hz", "noise_cos60_10_hz")):
        metrics = ("r_by_true", "exact_r_by_true", "exact_r_one_run_sd")
        mean, exact, most = (value(rows, experiment, "noise(x)", "fixed", metric) for metric in metrics)
        assert f"| {synthesis.shown(mean)} [" in line and f"| {synthesis.shown(exact)} |" in line and f"(<= {synthesis.shown(most)}) |" in line, line
    # the twin: another gate as shipped is the one that is marked
    next(r for r in rows if r["metric"] == "guard_sigma")["value"] = 4.0
    assert [line for line in synthesis.guard_table(rows) if "as shipped" in line][0].startswith("| `adaptive(guard=4)` |")
    # and the page has all three, under their titles, with a limit that theory gives
    part = papers_page.document("000").read_text(encoding="utf-8")
    headings = [heading for heading, _ in synthesis.tables(rows) if heading.startswith(("adaptive: ", "noise: "))]
    assert len(headings) == 3 and all(part.count(f"## {heading}\n") == 1 for heading in headings), headings
    assert re.search(r"^\| `noise\(x\)` \| rest 10 hz \| 0\.8\d+ \[.* \| 0\.921 \| .* \(<= 0\.361\) \|$", part, re.M), headings


@test
def a_paper_that_there_is_not_is_refused():
    done = subprocess.run([sys.executable, "campaigns/papers/papers.py", "--paper", "005"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 2 and "005" in done.stderr, done


if __name__ == "__main__":
    raise SystemExit(run_all())
