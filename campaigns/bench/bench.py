"""make bench: runs the images of the benchmark in the simulator, judges the numbers, writes build/bench.json and docs/results/benchmarks.md."""
import argparse
import concurrent.futures
import json
import pathlib
import re
import statistics
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import bench_parts
import bench_peers
import laws
import page_benchmarks
import page_sources
from bench_firmware import COMPILER, OUT, Fault, image_size, measure_rest, measure_sample, printed, run
from page_benchmarks import CALLS, DOCUMENT
from results import cells, markdown, run_as_program

JSON = pathlib.Path("build/bench.json")

# of what is no filter: those of a filter stand beside its yardstick (mk/scripts/laws.py)
ANGLES = laws.Limits(worst=1500, ratio=4.0, rms=0.029)  # degrees: the bound that lib/tilt derives
KEPT = f"float_{laws.LIGHT}_kept"  # a row of its own: what the float version takes when it keeps the coefficients made from a1
SAMPLES_MIN = 5000
REGRESSION = 0.02
# At 12.5 Hz P grows so fast that single decisions at the gate's threshold fall differently, and each shows for some samples.
RMS_FROM_DHZ = 250

# How much more than the measured worst case may be declared
DECLARED_OVER = 1.10
COLUMNS = ("median", "worst", "worst, firmware's flags", "flash", "RAM", "stack")


# --- what the image prints ---

def parse(text, source):
    """Sections [(name, regime, rate_dhz, [(ours, float)...])], stack {name: bytes}, rms [(name, regime, rate_dhz, value)]."""
    sections, stack, rms = [], {}, []
    for line in text.splitlines():
        word = line.split()
        if line == "=end":
            return sections, stack, rms
        if line.startswith("="):
            sections.append((word[0][1:], word[1], int(word[2]), []))
        elif line.startswith("+stack"):
            stack[word[1]] = max(stack.get(word[1], 0), int(word[2]))
        elif line.startswith("+rms"):
            rms.append((word[1], *sections[-1][1:3], int(word[2]) / 1000.0))
        elif line:
            cells = [int(line[i:i + 4], 16) for i in range(0, len(line), 4)]
            sections[-1][3].extend(zip(cells[::2], cells[1::2]))
    raise Fault(f"{source}: the benchmark did not run to its end")


def summarise(sections):
    """{name: {min, median, worst, where, samples}}; the median is that of the typical streams, the rest of all. The samples of a filter's
    start, which its float version does not see, are of the row `start`, all filters together."""
    calls = {}
    for name, regime, rate_dhz, pairs in sections:
        where = regime + (f" {rate_dhz / 10:g} Hz" if rate_dhz else "")
        both = [pair for pair in pairs if pair[1]]
        begins = [ours for ours, yardstick in pairs if both and not yardstick]
        for key, told, values in ((name, where, [ours for ours, _ in both or pairs]), (f"float_{name}", where, [yardstick for _, yardstick in both]),
                                  ("start", f"{name}, {where}", begins)):
            if values:
                calls.setdefault(key, []).append((told, regime == "typical", values))
    result = {}
    for name, parts in calls.items():
        values = [v for _, _, part in parts for v in part]
        typical = [v for _, is_typical, part in parts if is_typical for v in part] or values
        worst, where = max((max(part), where) for where, _, part in parts)
        result[name] = {"min": min(values), "median": round(statistics.median(typical)), "worst": worst, "where": where, "samples": len(values)}
    return result


def measure(images):
    """The results of each image, two at a time."""
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        return [parse(text, image.stem) for image, text in zip(images, pool.map(printed, images))]


# --- sizes ---

def preprocessed(flags, source):
    return run(["avr-gcc", *flags, "-E", "-P", "-x", "c", "-"], source)


def filters_of(flags):
    source = '#include "filter_list.h"\n#define NAME(F) @F@\nFILTER_LIST(NAME)\n'
    names = re.findall(r"@ *(\w+) *@", preprocessed(flags, source))
    if not names:
        raise Fault("cannot read the list of filters")
    return names


def declared_of(flags, filters):
    """{name: worst case in cycles that the code declares}: the filters, sample_rest and row."""
    source = '#include "settings/settings.h"\n'
    source += "sample_rest_worst_cycles = SETTINGS_REST_CYCLES\nrow_worst_cycles = SETTINGS_ROW_CYCLES\n"
    found = laws.worst_cycles()
    found |= {name: int(value) for name, value in re.findall(r"\b(\w+)_worst_cycles = (\d+)u?\b", preprocessed(flags, source))}
    missed = [name for name in [*filters, "sample_rest", "row"] if name not in found]
    if missed:
        raise Fault(f"{missed[0]}: declares no worst case")
    return found


class Sizes:
    """Images of bench_size.c with a choice of parts."""

    def __init__(self, flags, sources, filters):
        self.flags, self.folder = flags, OUT / "bench_size"
        self.parts = filters + [f"float_{f}" for f in filters] + ["noise", "angles", "float_angles", "format_row"]
        self.folder.mkdir(parents=True, exist_ok=True)
        self.objects = []
        for source in sources:
            self.objects.append(self.folder / (pathlib.Path(source).stem + ".o"))
            run(["avr-gcc", *flags, "-Os", "-c", source, "-o", self.objects[-1]])
        self.empty = self.of([])

    def of(self, chosen):
        elf = self.folder / "bench_size.elf"
        choice = ["-DPARTS=(" + "|".join(["0UL", *(f"PART({part})" for part in self.parts if part in chosen)]) + ")"]
        run(["avr-gcc", *self.flags, "-Os", *choice, "host_tests/chip/bench_size.c", *self.objects, "-lm", "-o", elf])
        return image_size(elf)

    def above_empty(self, chosen):
        return tuple(a - b for a, b in zip(self.of(chosen), self.empty))


def measure_sizes(flags, sources, filters):
    """{part: (flash, RAM)} alone, and {filter: flash bytes of it that the other filters link too}."""
    sizes = Sizes(flags, sources, filters)
    alone = {part: sizes.above_empty([part]) for part in sizes.parts}
    everything = sizes.above_empty(filters)[0]
    shared = {f: alone[f][0] - (everything - sizes.above_empty([g for g in filters if g != f])[0]) for f in filters}
    return alone, shared


# --- table and judgement ---

def limits_of(name):
    """What the filter, or the angles, are held to; no row for a filter without the line beside its yardstick."""
    return ANGLES if name == "angles" else laws.limits(name)


def limit_faults(filters, rows, rms):
    """What is over a limit, one sentence each."""
    faults = []
    for name in [*filters, "angles"]:
        row, yardstick, limits = rows[name], rows.get(f"float_{name}"), limits_of(name)
        if limits is None:
            faults.append(f"{name}: no limits beside its yardstick ({laws.yardstick(name)}: bench: worst ...)")
            continue
        faults += [f"{name}: worst case {row[kind]} cycles ({where}), limit {limits.worst}"
                   for kind, where in (("worst", row["where"]), ("worst_small", "the firmware's flags")) if row[kind] > limits.worst]
        if row["samples"] < SAMPLES_MIN:
            faults.append(f"{name}: {row['samples']} samples, at least {SAMPLES_MIN} are wanted")
        if yardstick is None:
            faults.append(f"{name}: no float version was measured")
            continue
        for kind in ("median", "worst"):
            if yardstick[kind] < limits.ratio * row[kind]:
                faults.append(f"{name}: {kind} {row[kind]} cycles, float {yardstick[kind]}: "
                              f"{yardstick[kind] / row[kind]:.2f} times fewer, wanted {limits.ratio:g}")
    return faults + agreement_faults(filters, rms)


def declared_faults(declared, rows):
    """A declared worst case must be at least what was measured in any build, and not much more."""
    faults = []
    for name, cycles in declared.items():
        measured = max(rows[name]["worst"], rows[name].get("worst_small") or 0)
        if measured > cycles:
            faults.append(f"{name}: worst case {measured} cycles, declared {cycles}: more than declared")
        elif cycles > measured * DECLARED_OVER:
            faults.append(f"{name}: worst case {measured} cycles, declared {cycles}: more than {DECLARED_OVER - 1:.0%} too much")
    return faults


def agreement_faults(filters, rms):
    faults = []
    for name in [*filters, "angles"]:
        limits = limits_of(name)
        compared = [(value, regime, rate) for n, regime, rate, value in rms
                    if n == name and (name == "angles" or (regime == "typical" and rate >= RMS_FROM_DHZ))]
        if not compared:
            faults.append(f"{name}: not compared with its float version")
        for value, regime, rate in compared:
            if limits is not None and value > limits.rms:
                faults.append(f"{name}: differs from its float version by {value:g} rms ({regime} {rate / 10:g} Hz), limit {limits.rms:g}")
    return faults


def table(rows):
    """Markdown lines."""
    lines = []
    for name, row in rows.items():
        yardstick, ours = (row, rows[laws.LIGHT]) if name == KEPT else (rows.get(f"float_{name}"), row)
        ratios = [f"{yardstick[k] / ours[k]:.1f}" if yardstick else "" for k in ("median", "worst")]
        keys = ("min", "median", "worst", "where", "worst_small", "flash", "shared", "ram", "stack")
        lines.append([f"`{name}`", *(row.get(key) for key in keys), *ratios])
    head = ["name", "min", *COLUMNS[:2], "worst seen in", *COLUMNS[2:4], "of it shared", *COLUMNS[4:], "float / ours, median", "worst"]
    return markdown(head, lines)


def read_table(text):
    """{name: {column: number}} of the calls' table of a page; empty if it has none."""
    found = {}
    for title, name, column, cell in cells(text):
        digits = cell.replace(",", "")
        if title == CALLS and column in COLUMNS and digits.isdigit():
            found.setdefault(name.strip("`"), {}).setdefault(column, int(digits))
    return found


def regressions(old, new):
    """Rows that need more than 2 % more than before, or are gone; the yardsticks do not count."""
    faults = []
    for name, columns in old.items():
        if name.startswith("float_"):
            continue
        if name not in new:
            faults.append(f"{name}: was in {DOCUMENT} and is gone")
            continue
        for column, before in columns.items():
            now = new[name].get(column)
            if now is None or now > before * (1.0 + REGRESSION):
                faults.append(f"{name}: {column} {before} before, {now} now")
    return faults


def bench_json(rows):
    keys = {"cycles_min": "min", "cycles_median": "median", "cycles_max": "worst", "flash_bytes": "flash", "ram_bytes": "ram", "stack_bytes": "stack"}
    return [{"name": name, **{key: row.get(source) for key, source in keys.items()}} for name, row in rows.items()]


def together(results):
    """The results of the images that time a part each, as of one."""
    sections = [s for part, _, _ in results for s in part]
    stack = {name: size for _, part, _ in results for name, size in part.items()}
    return sections, stack, [r for _, _, part in results for r in part]


def collect(filters, parts, sizes, sample):
    """The rows of the calls; sizes and sample: futures of measure_sizes and measure_sample."""
    *results, kept = measure([OUT / f"bench{name}.elf" for name in (*(f"_{p}" for p in parts), *(f"_small_{p}" for p in parts), "_kept")])
    sections, stack, rms = together(results[:len(parts)])
    small, _, _ = together(results[len(parts):])
    kept, kept_stack, _ = kept
    rows, rows_small = summarise(sections), summarise(small)
    rows[KEPT], stack[KEPT] = summarise(kept)[f"float_{laws.LIGHT}"], kept_stack[f"float_{laws.LIGHT}"]
    missed = [f for f in filters if f not in rows or f not in rows_small]
    if missed:
        raise Fault(f"{missed[0]}: in no image of the benchmark (BENCH_LIST in campaigns/bench/bench.mk)")
    alone, shared = sizes.result()
    rows["sample_total"], stack["sample_total"] = sample.result()
    rows_small["sample_total"] = rows["sample_total"]
    rows["noise"]["worst_small"] = rows_small["noise"]["worst"]
    for name, row in zip(("sample_rest", "row"), measure_rest(rows)):
        rows[name] = rows_small[name] = row
    alone["sample_total"] = image_size(OUT / "firmware.elf")
    for name, row in rows.items():
        row["worst_small"] = rows_small[name]["worst"] if name in rows_small else ""
        if name in stack:
            row["stack"] = stack[name]
        if name in alone:
            row["flash"], row["ram"] = alone[name]
        if name in shared:
            row["shared"] = shared[name]
    wanted = [*filters, "start", "angles", "format_row", "sample_total", "sample_rest", "row", "noise", *(f"{f}_set_noise" for f in filters),
              *(f"float_{f}" for f in filters), KEPT, "float_angles"]
    return {name: rows[name] for name in wanted}, rms


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--flags", required=True, help="compiler flags but -Os")
    options.add_argument("--small", default="", help="the firmware's flags, for the page")
    options.add_argument("--sources", required=True)
    options.add_argument("--parts", required=True, help="the images' numbers")
    options.add_argument("--peers", required=True, type=pathlib.Path, help="the folder of other people's filters")
    arguments = options.parse_args()
    hash_before = page_sources.hash_now(DOCUMENT)
    flags, sources, version = arguments.flags.split(), arguments.sources.split(), run(["avr-gcc", "-dumpversion"]).strip()
    filters = filters_of(flags)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        try:
            sizes, sample = pool.submit(measure_sizes, flags, sources, filters), pool.submit(measure_sample)
            others = pool.submit(bench_peers.measure, flags, sources, arguments.peers)
            firmware = pool.submit(bench_parts.report) if version == COMPILER else None
            rows, rms = collect(filters, arguments.parts.split(), sizes, sample)
            peers, absent = others.result()
            parts, part_faults = firmware.result() if firmware else ([], [])
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    lines = table(rows)
    print("\n".join([*lines, "", *bench_peers.table(peers), *bench_peers.said_of(absent, arguments.peers)]))
    JSON.write_text(json.dumps(bench_json(rows) + bench_peers.json_rows(peers), indent=1) + "\n", encoding="ascii")
    new = read_table("\n".join([f"## {CALLS}", *lines]))
    faults = limit_faults(filters, rows, rms) + declared_faults(declared_of(flags, filters), rows)
    faults += regressions(read_table(page_benchmarks.PAGE.before()), new)
    if version != COMPILER:
        print(f"bench: avr-gcc {version}: reported only, the limits and {DOCUMENT} are for {COMPILER}")
        return 0
    faults += part_faults
    page_benchmarks.write(lines, parts, None if absent else bench_peers.table(peers), hash_before)
    for fault in faults:
        print(f"bench: {fault}", file=sys.stderr)
    print(f"bench: {len(rows)} rows, {len(faults)} findings; {DOCUMENT} and {JSON} written")
    return 1 if faults else 0


if __name__ == "__main__":
    run_as_program("bench", main)
