"""make cycles, a part of make bench: where the cycles of one sample go, by part, in the image that is flashed. Each part is held to its limit
in campaigns/bench/cycles_by_part.txt; into build/cycles_by_part.json, and by make bench into docs/results/benchmarks.md.

    bench_parts.py [--write-limits]     the limits anew: what is measured and 5 %
"""
import argparse
import collections
import csv
import fnmatch
import functools
import json
import math
import pathlib
import sys
from typing import NamedTuple

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import laws
from bench_firmware import COMPILER, CPU_HZ, OUT, SIMRUN, Fault, run
from images import FW
from results import markdown, run_as_program

LIMITS = pathlib.Path("campaigns/bench/cycles_by_part.txt")
JSON = pathlib.Path("build/cycles_by_part.json")
STREAM = "sim/streams/outliers-15pct.csv"
FROM_MS, TO_MS = 2500, 8500  # the difference of two runs: start and commands are in both
LOAD_OFF = 0.01              # how far the parts together may be from the load that simrun reports
OVER, CHEAPER = 1.05, 0.90   # a limit is so much above what was measured; below this share of it a lower one is asked for
CHEAPER_CYCLES = 5           # and at least so many below it, or rounding asks

# Functions of the source, in line or not; the first match counts. A part of PARTS has all that its functions call unless another part names it.
# A part of OWN has the code of its functions and of HELPERS alone: what else they call is in REST until it is named here.
REST = "rest"
PARTS = {
    "noise estimate": "filter_noise_* estimate_noise",
    "filters": "filter_update filter_set_noise",
    "calibration and gravity": "calibration_* tilt_gravity_* tilt_axis_estimate_*",
    "angles": "tilt_angles",
    "row: mg": "to_mg",
    "row: format": "write_csv",
    "row: ring": "hal_uart_tx_*",
    "driver": "adxl345_*",
    "I2C handler": "__vector_24",
    "transmit handler": "__vector_19",
    "other handlers (clock, INT0, reception)": "__vector_*",
    "sleep": "hal_sleep_until_wake",
    "time and alarm": "hal_time_* hal_wake_at set_alarm",
    "missing samples": "coast_* expect",
    "supervision": "service health_* sensor_watch_second control_second",
    "commands and replies": "commands_pass takes_commands speaker_pass measure_pass measure_sample",
}
OWN = {
    "glue per axis": "filter_axes tilt_axis_update tilt_at_rail flags_of",
    "glue per sample": "pipeline_work begin_next pipeline_sample count_sample hung silence_* pipeline_second retime gravity_*",
    "row: rest": "write_row settings_every_in_force rows_sample rows_at_once newest_time pipeline_row with_state find_angles pipeline_row_done write",
    "main loop": "main app_pass serve work_piece filter_samples next_sample pass_* control_follow "
                 "control_line_waits measure_asks measure_borrows store_busy",
}
HELPERS = "__* fx_* filter_fx_* hal_irq_* hal_wake here count pipeline_flag"


class Case(NamedTuple):
    """What is measured: a filter by its role, a rate, a row for every so many samples."""
    role: str
    rate_hz: int
    every: int
    baud: int

    def filter_name(self):
        return {"default": laws.DEFAULT, "robust": laws.ROBUST}[self.role]

    def column(self):
        return f"{self.role}:{self.rate_hz}"


CASES = [Case(role, *line) for role in ("default", "robust") for line in ((100, 1, 115200), (400, 1, 500000), (800, 4, 500000))]
ROWS = {1: "every row", 4: "every 4th row"}
SLOW_HZ, NO_ROWS = ("12.5", "25", "50"), 10000  # their load, for information


# --- attribution ---

def fits(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns.split())


@functools.cache
def named(name):
    """(part that names a function, whether it has all below too); the part is None where none does."""
    for parts, whole in ((PARTS, True), (OWN, False)):
        for part, patterns in parts.items():
            if fits(name, patterns):
                return part, whole
    return None, False


@functools.cache
def part_of(chain):
    """(part, stranger): a chain of functions, the outermost first, belongs to the innermost that a part names. The stranger is the function
    for which it is in no part."""
    stranger = None
    for name in reversed(chain):
        part, whole = named(name)
        if part and (whole or not stranger):
            return part, None
        if part:
            break
        stranger = stranger if fits(name, HELPERS) else name
    return REST, stranger or chain[-1]


def nobody(functions):
    """Names of the table that no function has."""
    return [f"{pattern} ({part}): no function of this name ran: is it renamed?" for parts in (PARTS, OWN, {"helpers": HELPERS})
            for part, patterns in parts.items() for pattern in patterns.split() if not fnmatch.filter(functions, pattern)]


def in_line(pcs):
    """{pc: functions of the source that are there, the outermost first}; none where there is no line information."""
    found = {}
    for line in run(["avr-addr2line", "-f", "-i", "-a", "-e", FW], "\n".join(pcs)).splitlines():
        if line.startswith("0x"):
            lines = found.setdefault(int(line, 16), [])
        else:
            lines.append(line)
    return {pc: [name.partition(".")[0] for name in lines[::2] if name != "??"][::-1] for pc, lines in found.items()}


class Profile:
    """What simrun --calls wrote: a chain of functions and the cycles of each cell."""

    def __init__(self, rows, sources):
        self.sources, self.chains, self.entries = sources, {"0": ()}, {}
        self.cycles = {row["cell"]: int(row["cycles"]) for row in rows}
        for row in rows:
            self.chains[row["cell"]] = self.chains[row["frame"]] + self.functions(row)

    def functions(self, row):
        symbol, _, offset = row["symbol"].partition("+")
        if symbol == "__vectors" and offset != "0x0":
            return (f"__vector_{int(offset, 16) // 4}",)
        found = tuple(self.sources.get(int(row["pc"], 16)) or [symbol.partition(".")[0]])
        if row["frame"] == "0":
            return found
        # the first instruction in a frame is the entry of the function called; what that jumps to runs for it
        entry = self.entries.setdefault(row["frame"], found[0])
        return found if entry == found[0] else (entry, *found)


def divided(before, after):
    """{part: cycles} and {function in no part: cycles} of what the longer of two runs did after the shorter one."""
    parts, strangers = collections.Counter(), collections.Counter()
    for cell, cycles in after.cycles.items():
        spent = cycles - before.cycles.get(cell, 0)
        part, stranger = part_of(after.chains[cell])
        parts[part] += spent
        if stranger and spent:
            strangers[stranger] += spent
    return parts, strangers


# --- runs ---

def simulated(options, ms, calls=None):
    """Statistics of a run of the image that is flashed."""
    stats = OUT / "cycles_by_part.stats.json"
    profile = ["--calls", calls] if calls else []
    run([SIMRUN, "--fw", FW, "--in", STREAM, "--loop", "--out", OUT / "cycles_by_part.txt", "--stats", stats, "--max-ms", ms, *options, *profile])
    return json.loads(stats.read_text(encoding="ascii"))


def profiled(options, ms):
    """(profile, statistics)."""
    calls = OUT / "cycles_by_part.csv"
    stats = simulated(options, ms, calls)
    with open(calls, encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    return Profile(rows, in_line(sorted({row["pc"] for row in rows}))), stats


class Measured(NamedTuple):
    """Cycles a sample."""
    parts: dict
    strangers: dict
    load: float      # of all parts together
    reported: float  # by simrun
    functions: set   # all that ran, the start included


def load_between(before, after):
    """The processor's load between the ends of two runs."""
    return (after["cpu_load"] * TO_MS - before["cpu_load"] * FROM_MS) / (TO_MS - FROM_MS)


def measure(case):
    options = ["--rate", case.rate_hz, "--every", case.every, "--baud", case.baud, "--filter", case.filter_name()]
    (before, stats_before), (after, stats) = (profiled(options, ms) for ms in (FROM_MS, TO_MS))
    samples, rows = (stats[name] - stats_before[name] for name in ("samples_served", "rows"))
    if samples == 0 or abs(rows * case.every - samples) > 2 * case.every:
        raise Fault(f"{case.column()}: {rows} rows for {samples} samples, wanted one for every {case.every}")
    parts, strangers = divided(before, after)
    load = sum(parts.values()) / ((TO_MS - FROM_MS) * CPU_HZ / 1000)
    shares = [{name: cycles / samples for name, cycles in found.items()} for found in (parts, strangers)]
    return Measured(*shares, load, load_between(stats_before, stats), {name for chain in after.chains.values() for name in chain})


def slow_loads(every):
    """Words: the load at each low rate."""
    said = []
    for rate in SLOW_HZ:
        before, after = (simulated(["--rate", rate, "--every", every], ms) for ms in (FROM_MS, TO_MS))
        said.append(f"{rate} Hz {load_between(before, after):.2%}")
    return ", ".join(said)


# --- limits ---

def read_limits(text):
    """{column: {part: cycles}} of the table; its first line that is no comment names the columns."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    columns = lines[0].split()[:-1] if lines else []
    limits = {column: {} for column in columns}
    for line in lines[1:]:
        *numbers, part = line.split(None, len(columns))
        for column, number in zip(columns, numbers):
            limits[column][part] = int(number)
    return limits


def written_limits(results):
    """The table's text: what was measured and 5 %."""
    columns = [case.column() for case in results]
    lines = ["# Cycles a sample that each part may take, filter:rate: what was measured and 5 %. The parts: bench_parts.py; all anew, where",
             "# that is what you want: python3 campaigns/bench/bench_parts.py --write-limits",
             " ".join(f"{column:>12}" for column in columns) + "  part"]
    lines += [" ".join(f"{limit_of(m.parts.get(part, 0)):12}" for m in results.values()) + f"  {part}" for part in part_names()]
    return "\n".join(lines) + "\n"


def limit_of(cycles):
    return math.ceil(round(cycles * OVER, 6))


def part_names():
    return [*PARTS, *OWN, REST]


def over_limit(part, cycles, limit, strangers):
    if limit is None:
        return f"{part} has no limit in {LIMITS}"
    said = f"{part} takes {cycles:,.1f} cycles a sample, limit {limit:,}"
    if part == REST and strangers:
        named = ", ".join(f"{name} {share:,.1f}" for name, share in collections.Counter(strangers).most_common(5))
        said += f"; functions in no part (PARTS in campaigns/bench/bench_parts.py): {named}"
    return said


def judged(column, measured, limits):
    """(findings, requests): what breaks a limit, and limits that could be lower."""
    findings, requests = [], []
    if abs(measured.load - measured.reported) > LOAD_OFF * measured.reported:
        findings.append(f"{column}: the parts are {measured.load:.2%} of the processor's time, simrun --stats reports {measured.reported:.2%}")
    for part in part_names():
        cycles, limit = measured.parts.get(part, 0), limits.get(part)
        if limit is None or cycles > limit:
            findings.append(f"{column}: {over_limit(part, cycles, limit, measured.strangers)}")
        elif limit_of(cycles) < CHEAPER * limit and limit - limit_of(cycles) >= CHEAPER_CYCLES:
            requests.append(f"{column}: {part} takes {cycles:,.1f} cycles a sample: lower its limit from {limit:,} to {limit_of(cycles):,}")
    return findings, requests


# --- what is written ---

def table(results):
    """Markdown lines."""
    head = ["cycles a sample", *(f"`{case.filter_name()}`, {case.rate_hz} Hz, {ROWS[case.every]}" for case in results)]
    parts = sorted(part_names()[:-1], key=lambda part: -max(m.parts.get(part, 0) for m in results.values()))
    lines = [[part, *(f"{m.parts.get(part, 0):,.0f}" for m in results.values())] for part in [*parts, REST]]
    return markdown(head, [*lines, ["together", *(f"{sum(m.parts.values()):,.0f}" for m in results.values())],
                           ["of the processor's time", *(f"{m.load:.1%}" for m in results.values())]])


def json_rows(results):
    return [{"rate_hz": case.rate_hz, "filter": case.filter_name(), "part": part, "cycles": round(measured.parts.get(part, 0), 1)}
            for case, measured in results.items() for part in part_names()]


def findings_of(results):
    limits = read_limits(LIMITS.read_text(encoding="ascii"))
    findings = nobody(set().union(*(measured.functions for measured in results.values())))
    for case, measured in results.items():
        broken, requests = judged(case.column(), measured, limits.get(case.column(), {}))
        findings += broken
        for request in requests:
            print(f"cycles: {request}")
    return findings


def report(write_limits=False):
    """Measures and writes; returns the lines of the table and the findings."""
    results = {case: measure(case) for case in CASES}
    lines = table(results)
    print("\n".join(lines))
    for case, measured in results.items():
        print(f"cycles: {case.column()}: together {measured.load:.3%} of the processor's time, simrun --stats {measured.reported:.3%}")
    print(f"cycles: load at low rates, for information: {slow_loads(1)}; without rows {slow_loads(NO_ROWS)}")
    JSON.write_text(json.dumps(json_rows(results), indent=1) + "\n", encoding="ascii")
    if write_limits:
        LIMITS.write_text(written_limits(results), encoding="ascii")
    findings = findings_of(results)
    if run(["avr-gcc", "-dumpversion"]).strip() != COMPILER:
        print(f"cycles: reported only, the limits are for avr-gcc {COMPILER}")
        return lines, []
    return lines, findings


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--write-limits", action="store_true", help=f"write {LIMITS}: what is measured and 5 %%")
    _, findings = report(options.parse_args().write_limits)
    for finding in findings:
        print(f"cycles: {finding}", file=sys.stderr)
    print(f"cycles: {len(CASES)} columns, {len(findings)} findings; {JSON} written")
    return 1 if findings else 0


if __name__ == "__main__":
    run_as_program("cycles", main)
