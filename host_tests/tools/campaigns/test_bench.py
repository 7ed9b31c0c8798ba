"""The judgement of make bench: each limit is broken once and must be named; and the page that it writes."""
import copy
import importlib.util
import pathlib
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, SIMRUN, STREAMS, image_with, refused, run, run_all, test

import images  # noqa: E402
from laws import ROBUST  # noqa: E402
spec = importlib.util.spec_from_file_location("bench", pathlib.Path("campaigns/bench/bench.py"))
bench = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bench)
bench_firmware, page_benchmarks, bench_peers, laws = (sys.modules[name] for name in ("bench_firmware", "page_benchmarks", "bench_peers", "laws"))

# a filter of this test's own
limits_of_the_list = laws.limits
laws.limits = {"one": laws.Limits(worst=800, ratio=4.0, rms=0.25)}.get

PRINTED = """
=one typical 1000
02bc0000
02c0128e02c81290
+stack one 16
+stack float_one 68
+rms one 12
=one provoked 125
03181300
+stack one 20
=end
"""


def rows():
    """Numbers that keep every limit."""
    row = {"min": 200, "median": 700, "worst": 790, "where": "provoked 12.5 Hz", "samples": 6000, "worst_small": 800,
           "flash": 1000, "shared": 500, "ram": 60, "stack": 16}
    return {"one": row, "angles": dict(row, worst=1400), "float_one": dict(row, median=4000, worst=5000),
            "float_angles": dict(row, median=6000, worst=7000)}


def whole_page(calls):
    """The page's text with that table of calls."""
    return page_benchmarks.PAGE.text(page_benchmarks.lines(calls, ["| parts |"], ["| peers |"]))


RMS = [("one", "typical", 250, 0.01), ("one", "provoked", 250, 99.0), ("one", "typical", 125, 9.0), ("angles", "typical", 0, 0.004)]


def one_finding(changed, *words, rms=None, filters=("one",)):
    assert bench.limit_faults(["one"], rows(), RMS) == []
    found = bench.limit_faults(list(filters), changed, RMS if rms is None else rms)
    assert len(found) == 1 and all(word in found[0] for word in words), found


def changed(name, **values):
    result = rows()
    result[name].update(values)
    return result


@test
def printed_calls_are_read_and_summed_up():
    sections, stack, rms = bench.parse(PRINTED, "printed")
    assert stack == {"one": 20, "float_one": 68} and rms == [("one", "typical", 1000, 0.012)]
    summary = bench.summarise(sections)
    # 0x2bc of the start, 0x2c0 0x2c8, then 0x318 in the stream that is not typical
    assert summary["one"] == {"min": 704, "median": 708, "worst": 792, "where": "provoked 12.5 Hz", "samples": 3}, summary
    early = bench.summarise([("one", "typical", 1000, [(900, 0), (700, 4000)])])
    assert early["one"]["worst"] == 700 and early["start"]["worst"] == 900, early  # the float version sees nothing of the start
    assert early["start"]["where"] == "one, typical 100 Hz", early
    assert summary["float_one"]["samples"] == 3 and summary["float_one"]["worst"] == 0x1300, summary


@test
def a_run_cut_short_is_noticed():
    refused(bench.Fault, lambda: bench.parse(PRINTED.replace("=end", ""), "printed"), "did not run to its end")


@test
def each_limit_is_broken_once_and_named():
    new, lacking = rows(), rows()
    new["later"], new["float_later"] = copy.deepcopy(new["one"]), copy.deepcopy(new["float_one"])
    del lacking["float_one"]
    for values, *words in ((dict(worst=801), "one", "801", "800", "provoked 12.5 Hz"),
                           (dict(worst_small=801), "one", "801", "800", "the firmware's flags"), (dict(samples=4999), "4999")):
        one_finding(changed("one", **values), *words)
    one_finding(changed("angles", worst=1501), "angles", "1501")
    one_finding(changed("float_one", worst=3159), "worst 790", "3159")
    one_finding(changed("float_one", median=2799), "median 700", "2799")
    one_finding(lacking, "one", "no float version")
    one_finding(new, "later", "no limits beside its yardstick", filters=("one", "later"), rms=RMS + [("later", "typical", 250, 0.0)])
    # a yardstick that does another job
    one_finding(rows(), "0.26", "25 Hz", rms=[("one", "typical", 250, 0.26), RMS[3]])
    one_finding(rows(), "angles", "0.03", rms=[RMS[0], ("angles", "anything", 0, 0.03)])
    one_finding(rows(), "not compared", rms=RMS[1:])


@test
def a_declared_worst_case_is_held_from_both_sides():
    declared = {"one": 800, "angles": 1480}
    assert bench.declared_faults(declared, rows()) == []
    for changes, words in (({"worst": 801}, ("one", "801", "800", "more than declared")),
                           ({"worst_small": 801}, ("one", "801", "more than declared")),
                           ({"worst": 720, "worst_small": 727}, ("one", "727", "800", "10% too much"))):
        found = bench.declared_faults(declared, changed("one", **changes))
        assert len(found) == 1 and all(word in found[0] for word in words), found
    assert bench.declared_faults(declared, changed("one", worst=700, worst_small=728)) == []
    assert len(bench.declared_faults({"angles": 1399}, rows())) == 1


@test
def what_the_code_declares_is_read():
    folders = ("lib/machine/src", "lib/filters/src", "lib/tilt/src", "lib/adxl345/src", "firmware", "hal", "hal/avr")
    flags = ["-mmcu=atmega328p", *(f"-I{folder}" for folder in folders), "-DF_CPU=16000000UL"]
    filters = bench.filters_of(flags)
    declared = bench.declared_of(flags, filters)
    assert set(declared) == {*filters, "sample_rest", "row"} and all(300 < cycles < 12000 for cycles in declared.values()), declared
    refused(bench.Fault, lambda: bench.declared_of(flags, [*filters, "later"]), "later: declares no worst case")


@test
def the_rest_of_a_sample_s_way_is_its_mean_and_what_may_come_on_top():
    parts = {"noise": {"worst": 535, "worst_small": 550, "median": 504}, "one_set_noise": {"worst": 2011}, "other_set_noise": {"worst": 3520}}
    rest = bench_firmware.rest_row({"one": 5300.4, "other": 5000.0}, parts)
    # 5300.4 + 3 (550 - 504) + 3 x 3520 / 16
    assert rest["worst"] == 6098 and rest["where"] == "one" and rest["min"] == 5000, rest


@test
def every_filter_of_the_list_has_limits():
    for name in laws.names():
        limits = limits_of_the_list(name)
        assert limits and laws.worst_cycles()[name] <= limits.worst and limits.ratio > 1 and limits.rms > 0, (name, limits)
    assert limits_of_the_list("later") is None


@test
def a_number_two_per_cent_up_is_named_with_old_and_new():
    old = bench.read_table(whole_page(bench.table(rows())))
    assert old["one"] == {"median": 700, "worst": 790, "worst, firmware's flags": 800, "flash": 1000, "RAM": 60, "stack": 16}, old["one"]
    for column, value, found in (("worst", 805, 0), ("worst", 806, 1), ("flash", 1020, 0), ("flash", 1021, 1), ("stack", 17, 1), ("median", 1, 0)):
        new = copy.deepcopy(old)
        new["one"][column] = value
        faults = bench.regressions(old, new)
        assert len(faults) == found, (column, value, faults)
        assert not faults or str(old["one"][column]) in faults[0] and str(value) in faults[0] and "one" in faults[0], faults
    del new["one"]
    assert len(bench.regressions(old, new)) == 1
    assert bench.regressions(old, {**old, "float_one": {}}) == []


def fault_of(function, *arguments):
    try:
        function(*arguments)
    except bench.Fault as fault:
        return str(fault)
    raise AssertionError("no fault")


@test
def other_people_s_filters_are_skipped_and_counted_where_they_are_absent():
    nowhere, part = OUT / "nowhere", OUT / "peers_in_part"
    for folder in ("TinyEKF/src", "libfixkalman"):
        (part / folder).mkdir(parents=True, exist_ok=True)
    found, absent = bench_peers.present(nowhere)
    said = bench_peers.said_of(absent, nowhere)
    assert found == [] and len(absent) == len(bench_peers.THEIRS) and len(said) == 1, said
    assert said[0].startswith(f"skipped: {len(absent)} (") and all(s.name in said[0] for s in absent) and f"no folder {nowhere}" in said[0], said
    found, absent = bench_peers.present(part)
    said = bench_peers.said_of(absent, part)
    assert [s.name for s in found] == ["TinyEKF"] and "libfixmath, libfixmatrix" in said[0] and "TinyEKF" not in said[0], said
    assert bench_peers.said_of([], part) == []


@test
def their_table_and_the_hash_are_left_alone_unless_all_of_them_were_measured():
    page = OUT / "benchmarks.md"
    with mock.patch.object(page_benchmarks.PAGE, "document", page):
        page_benchmarks.write(["| old |"], ["| old |"], ["| old |"], "0123456789ab")
        for table, left, sources in ((None, 1, "0123456789ab"), (["| new |"], 0, "ba9876543210")):
            page_benchmarks.write(["| new |"], ["| new |"], table, "ba9876543210")
            written = page_benchmarks.PAGE.held()
            assert written.count("| old |") == left and f"<!-- sources: {sources} -->" in written, written


@test
def a_filter_of_theirs_that_does_not_build_is_named():
    peers = OUT / "peers_broken"
    broken = next(s for s in bench_peers.THEIRS if s.name == "TinyEKF")
    (peers / broken.folders[0]).mkdir(parents=True, exist_ok=True)
    (peers / broken.folders[0] / "tinyekf.h").write_text("#error of another make\n", encoding="ascii")
    said = fault_of(bench_peers.build, broken, ["-mmcu=atmega328p"], [], peers)
    assert said.startswith("TinyEKF: does not build: ") and said.endswith("of another make") and len(said.splitlines()) == 1, said


@test
def what_a_filter_beside_others_prints_is_read():
    assert bench_peers.parse("\n=f\n02bc3fc00000\n\n=end\n", "one", 1) == [(700, 1.5)]
    assert bench_peers.parse("=q 0001fffe8000 =end", "one", 1) == [(1, -1.5)]
    assert bench_peers.parse("=i 00010000fffe =end", "one", 1) == [(1, -2)]
    assert "one: 1 of 2 samples" in fault_of(bench_peers.parse, "=f 000100000000 =end", "one", 2)
    assert "did not run to its end" in fault_of(bench_peers.parse, "=f 000100000000 000100000000", "one", 2)
    assert "one: a call takes more" in fault_of(bench_peers.parse, "=f ffff00000000 =end", "one", 1)
    settled = [(500, 0.0)] * bench_peers.SETTLED
    row = bench_peers.row_of([*settled, (100, 3.0), (102, 4.0), (300, 5.0)], [9.0] * len(settled) + [0.0, 0.0, 5.0])
    assert row == {"min": 100, "median": 102, "worst": 300, "error": (25 / 3) ** 0.5}, row


SOFT = "soft"  # in its image the step of the Kalman filters is not in line; the next one there has no gate
UNGATED = images.HOLDS[SOFT][1]


def symbol(function):
    """Its name in the firmware: link-time optimisation appends to that of a static one which it moves between its parts."""
    names = [line.split()[-1] for line in run("avr-nm", image_with(SOFT)).stdout.splitlines()]
    return next(name for name in names if name.split(".")[0] == function)


@test
def spans_leave_the_interrupts_out():
    """From the move of an estimate to the turn of its rate: products, and signs that make less than 40 cycles of difference, an interrupt more."""
    spans = OUT / "spans.csv"
    command = (SIMRUN, "--fw", image_with(SOFT), "--in", STREAMS / "rest-2lsb.csv", "--out", OUT / "x.csv", "--max-ms", "3000",
               "--filter", UNGATED, "--span")
    run(*command, f"{symbol('filter_tracker_move')}:{symbol('filter_tracker_turn')}:{spans}")
    lines = spans.read_text(encoding="ascii").splitlines()
    cycles = [int(line.split(",")[1]) for line in lines[1:]]
    assert lines[0] == "at_us,cycles,stack_bytes" and len(cycles) > 500, len(cycles)
    assert min(cycles) > 80 and max(cycles) - min(cycles) < 40, (min(cycles), max(cycles))


def page_row(name):
    """The cells of a row of the page."""
    row = next(line for line in page_benchmarks.PAGE.held().splitlines() if line.startswith(f"| `{name}` |"))
    return [cell.strip() for cell in row.split("|")[2:-1]]


@test
def the_librarys_readme_has_the_numbers_of_the_page():
    library = pathlib.Path("lib/filters/README.md").read_text(encoding="utf-8")
    for name in (*bench.filters_of(["-mmcu=atmega328p", "-Ilib/machine/src", "-Ilib/filters/src"]), "noise"):
        row = page_row(name)
        wanted = f"| {row[1]}, {row[2]} | {row[7]} B | {row[8]} B |"
        line = next(line for line in library.splitlines() if line.startswith(f"| `{name}` |"))
        assert line.endswith(wanted), f"lib/filters/README.md: {line}, the page says {wanted}"
    for name in bench.filters_of(["-mmcu=atmega328p", "-Ilib/machine/src", "-Ilib/filters/src"]):
        assert page_row(f"{name}_set_noise")[2] in library, f"lib/filters/README.md: set_noise of {name}"


@test
def a_span_of_an_unknown_function_is_refused():
    for names, what in (("nowhere:main:x.csv", "no function nowhere"), ("main:nowhere:x.csv", "no function nowhere"), ("main", "FROM:TO:CSV")):
        done = run(SIMRUN, "--fw", image_with(ROBUST), "--in", STREAMS / "rest-2lsb.csv", "--out", OUT / "x.csv", "--span", names, expect=2)
        assert what in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr


if __name__ == "__main__":
    raise SystemExit(run_all())
