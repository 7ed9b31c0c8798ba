"""A sample's cycles by part: whose a cycle is, and the judgement of make cycles, where each limit is broken once and must be named."""
import csv
import json
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import FW, OUT, SIMRUN, STREAMS, run, run_all, test

import bench_parts  # noqa: E402
import page_benchmarks  # noqa: E402
from results import section  # noqa: E402
from bench_parts import OWN, PARTS, REST, Case, Measured, Profile, part_names  # noqa: E402

CASE = Case("default", 100, 1, 115200)

# pc: what the line numbers tell, the outermost function first; none for the compiler's own code and the table of vectors
SOURCES = {0x200: ["main"], 0x202: ["main", "app_pass", "serve"], 0x204: ["main", "app_pass", "newcomer"], 0x206: ["main", "app_pass", "set_alarm"],
           0x300: ["filter_axes"], 0x302: ["filter_axes", "tilt_axis_update", "filter_update"], 0x304: ["filter_axes", "newcomer", "filter_fx_abs32"],
           0x400: ["step"], 0x402: ["step", "learn"], 0x500: ["sort"], 0x600: ["__vector_24", "i2c_bus_step"]}
CALLS = """cell,frame,pc,count,cycles,symbol
1,0,0x0000,1,3,__vectors+0x0
2,0,0x0200,1,10,main+0x0
3,0,0x0202,1,4,main+0x2
4,3,0x0300,1,20,filter_axes+0x0
5,3,0x0800,1,7,__prologue_saves__+0x8
6,3,0x0302,1,4,filter_axes+0x2
7,6,0x0400,1,100,step.lto_priv.35+0x0
8,7,0x0700,1,30,__umulhisi3+0x0
9,6,0x0402,1,50,step.lto_priv.35+0x2
10,6,0x0802,1,8,__epilogue_restores__+0x8
11,0,0x0060,1,7,__vectors+0x60
12,11,0x0600,1,60,__vector_24+0x0
13,3,0x0304,1,2,filter_axes+0x4
14,0,0x0204,1,5,main+0x4
15,14,0x0500,1,9,sort+0x0
16,0,0x0206,1,6,main+0x6
"""


def profile(text=CALLS):
    return Profile(list(csv.DictReader(text.splitlines())), SOURCES)


def divided(text=CALLS):
    nothing = profile("cell,frame,pc,count,cycles,symbol\n")
    return bench_parts.divided(nothing, profile(text))


@test
def every_cycle_is_in_one_part():
    parts, strangers = divided()
    # the registers that filter_axes saves are its own, those of step and the product the filter's
    assert parts == {"main loop": 10 + 4, "glue per axis": 20 + 7, "filters": 4 + 100 + 30 + 50 + 8, "I2C handler": 7 + 60, "time and alarm": 6,
                     REST: 3 + 2 + 5 + 9}, parts
    assert sum(parts.values()) == sum(profile().cycles.values())
    assert strangers == {"__vectors": 3, "newcomer": 2 + 5 + 9}, strangers


@test
def a_function_in_no_part_is_the_rest_s_where_its_caller_has_its_own_code_alone():
    assert bench_parts.part_of(("main", "app_pass", "newcomer", "sort")) == (REST, "newcomer")
    assert bench_parts.part_of(("main", "app_pass", "service", "newcomer")) == ("supervision", None)
    assert bench_parts.part_of(("main", "app_pass", "newcomer", "filter_update", "step")) == ("filters", None)
    assert bench_parts.part_of(("main", "app_pass", "filter_fx_abs32", "__umulhisi3")) == ("main loop", None)
    assert bench_parts.part_of(("newcomer", "__umulhisi3")) == (REST, "newcomer")


@test
def what_the_shorter_run_did_is_not_counted():
    before = profile("\n".join(CALLS.splitlines()[:8]).replace(",100,", ",40,"))
    parts, strangers = bench_parts.divided(before, profile())
    assert parts["filters"] == 60 + 30 + 50 + 8 and parts["main loop"] == 0 and parts["glue per axis"] == 0, parts
    assert strangers == {"newcomer": 16}, strangers


def measured(load=0.10, reported=0.10, strangers=None, **parts):
    every = {part: 100.0 for part in part_names()}
    every |= {REST: 0.0, **parts}
    return Measured(every, strangers or {}, load, reported, set())


LIMITS = bench_parts.read_limits(bench_parts.written_limits({CASE: measured()}))["default:100"]


def one_finding(result, *words, limits=None):
    assert bench_parts.judged("default:100", measured(), LIMITS) == ([], [])
    findings, requests = bench_parts.judged("default:100", result, limits or LIMITS)
    assert len(findings) == 1 and not requests and all(word in findings[0] for word in ("default:100", *words)), (findings, requests)


@test
def limits_are_what_was_measured_and_five_per_cent():
    assert LIMITS == {part: 0 if part == REST else 105 for part in part_names()}, LIMITS
    assert [bench_parts.limit_of(cycles) for cycles in (0, 0.4, 100, 100.1, 2000)] == [0, 1, 105, 106, 2100]


@test
def a_part_above_its_limit_is_named():
    assert bench_parts.judged("default:100", measured(driver=105.0), LIMITS) == ([], [])
    one_finding(measured(driver=105.1), "driver takes 105.1", "limit 105")


@test
def a_new_function_is_named():
    one_finding(measured(strangers={"newcomer": 15.5, "sort": 0.5}, **{REST: 16.0}), "rest takes 16.0", "limit 0", "newcomer 15.5, sort 0.5")


@test
def a_part_without_a_limit_is_named():
    one_finding(measured(), "driver has no limit", limits={part: limit for part, limit in LIMITS.items() if part != "driver"})


@test
def parts_that_are_not_the_reported_load_are_named():
    assert bench_parts.judged("default:100", measured(load=0.1009), LIMITS) == ([], [])
    for load in (0.1011, 0.0989):
        one_finding(measured(load=load), f"{load:.2%}", "10.00%")


@test
def a_cheaper_part_asks_for_a_lower_limit():
    for cycles, asked in ((90.0, 0), (89.5, 1), (0.0, 1)):
        findings, requests = bench_parts.judged("default:100", measured(driver=cycles), LIMITS)
        assert not findings and len(requests) == asked, (cycles, findings, requests)
    assert requests == ["default:100: driver takes 0.0 cycles a sample: lower its limit from 105 to 0"], requests
    few = {part: 4 for part in part_names()}  # so few that rounding would ask
    assert bench_parts.judged("default:100", measured(**{part: 0.0 for part in part_names()}), few) == ([], [])


@test
def a_name_that_no_function_has_is_told():
    functions = {pattern.replace("*", "x") for patterns in (*PARTS.values(), *OWN.values(), bench_parts.HELPERS) for pattern in patterns.split()}
    assert bench_parts.nobody(functions) == []
    told = bench_parts.nobody(functions - {"filter_update"})
    assert len(told) == 1 and told[0].startswith("filter_update (filters): "), told


@test
def no_function_is_named_by_two_parts():
    patterns = [pattern for parts in (PARTS, OWN, {"helpers": bench_parts.HELPERS}) for names in parts.values() for pattern in names.split()]
    assert len(set(patterns)) == len(patterns)


@test
def tables_have_every_part():
    limits = bench_parts.read_limits(bench_parts.LIMITS.read_text(encoding="ascii"))
    assert list(limits) == [case.column() for case in bench_parts.CASES]
    assert all(set(parts) == set(part_names()) for parts in limits.values()), limits
    page = section(page_benchmarks.PAGE.held(), page_benchmarks.PARTS)
    for part in (*part_names(), "together"):
        assert sum(line.startswith(f"| {part} |") for line in page) == 1, f"{part} has no row in {page_benchmarks.DOCUMENT}: run make bench"


@test
def results_are_rows_for_programs():
    row = next(row for row in bench_parts.json_rows({CASE: measured(driver=12.345)}) if row["part"] == "driver")
    assert row == {"rate_hz": 100, "filter": CASE.filter_name(), "part": "driver", "cycles": 12.3}, row


@test
def the_parts_are_all_that_the_processor_does():
    """To 0.1 %: the responses to interrupts alone are 0.7 % at 800 Hz."""
    case = bench_parts.CASES[2]
    result = bench_parts.measure(case)
    assert case.rate_hz == 800 and abs(result.load / result.reported - 1) < 0.001, result
    assert result.parts["filters"] > 500 and result.parts["I2C handler"] > 500, result.parts


@test
def callers_are_the_profile_in_more_detail():
    calls, flat, stats = OUT / "calls.csv", OUT / "flat.csv", OUT / "calls.json"
    run(SIMRUN, "--fw", FW, "--in", STREAMS / "rest-2lsb.csv", "--out", OUT / "x.csv", "--max-ms", "1000", "--calls", calls, "--profile", flat,
        "--stats", stats)
    by_pc, frames = {}, {"0"}
    for row in csv.DictReader(calls.read_text(encoding="ascii").splitlines()):
        assert row["frame"] in frames, row  # a call comes before what it leads to
        frames.add(row["cell"])
        count, cycles = by_pc.get(row["pc"], (0, 0))
        by_pc[row["pc"]] = count + int(row["count"]), cycles + int(row["cycles"])
    assert by_pc == {row["pc"]: (int(row["count"]), int(row["cycles"])) for row in csv.DictReader(flat.read_text(encoding="ascii").splitlines())}
    alone = OUT / "flat-alone.csv"
    run(SIMRUN, "--fw", FW, "--in", STREAMS / "rest-2lsb.csv", "--out", OUT / "x.csv", "--max-ms", "1000", "--profile", alone)
    assert alone.read_bytes() == flat.read_bytes()  # counted by runs of straight code
    told = json.loads(stats.read_text(encoding="ascii"))
    for vector, name in ((1, "int0"), (11, "timer1_compa"), (24, "twi")):
        count, cycles = by_pc[f"0x{vector * 4:04x}"]
        assert count == told[f"isr_{name}_n"] > 0 and cycles in (6 * count, 7 * count), (name, count, cycles)  # response 4, rjmp 2 or jmp 3


if __name__ == "__main__":
    raise SystemExit(run_all())
