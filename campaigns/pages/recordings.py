"""make recordings: the filters on real recordings, which are not part of this repository; writes build/recordings.csv (every number) and
docs/results/recordings.md. Status 1: a number of the committed page does not come out again, each is named, or an estimate left its bounds. Status 0
with `skipped: 1` when the recordings are not there."""
import csv
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import PLAIN
from results import Fault, Results, markdown, run_as_program

PROGRAM = "build/host/recordings"
CSV = pathlib.Path("build/recordings.csv")
DOCUMENT = pathlib.Path("docs/results/recordings.md")
ABSENT, SAID = 3, 2  # status of the program; SAID: it has told why

COUNTS = ("samples", "gated", "reacquired", "saturated", "longest_gated", "bounds_broken", "judged", "broken", "worst_share", "hull_judged",
          "hull_broken", "hull_left_lsb", "outside", "outside_worst_lsb")
OWN, OF_PLAIN = "the filter's own run without faults", f"the run of `{PLAIN}` without faults"
ABOUT = """\
What every filter does with its defaults on recordings of real ADXL345, and on faults put into them at the rates measured on real boards. Each axis
goes the firmware's way: noise estimate, gaps of up to 100 ms coasted, clipping, filter. The yardstick `median5_...` has a median of five samples
before that filter. What the recordings are and where they come from: [recordings](../recordings.md)."""
PAGE = Results(DOCUMENT, "Real recordings: results", "make recordings", ABOUT)

OF_STREAMS = "Hz is the sensor's nominal rate; in brackets the rate of the rows, where a board polled faster or slower."
OF_RULES = """\
Samples of all axes. The rules that show divergence are derived in `host_tests/support/envelope.h`; a share of 1 is the limit. Empty: the filter has
none. Saturated: a state was held at its bound, for the filters with a limit of the rate as a rule that: in fast motion; of
synthesised filters, whose rate is a step between two estimates, also among noise."""
OF_GATED = """\
Refused, limited or taken in part; with the mixtures: more likely an outlier than not. Filters that gate nothing are left out."""
OF_AGAIN = "Sum of the three axes; the longest run on any axis."
OF_OUTSIDE = "Farther than 9 sqrt(R) from the range of the raw samples of the last second, of the samples of all axes. Empty: never."
OF_REST = "Standard deviation and tails of the raw samples, and the share that is gated, x/y/z."
OF_FAULTS = "RMS error in LSB, mean of 20 seeds (worst)."

FIELDS = {
    "stream": ("name", "rate_hz", "range_g", "rows_hz", "rows", "clipped", "duplicates", "zeros", "ones"),
    "filter": ("name", "filter", "axis", *COUNTS),
    "tails": ("name", "from_s", "axis", "samples", "sd_lsb", "beyond3", "beyond5"),
    "rest": ("name", "from_s", "filter", "axis", *COUNTS),
    "fault": ("pool", "fault", "filter", "share", "own_mean", "own_worst", "plain_mean", "plain_worst", "predicted"),
}


def measure():
    """(the program's rows {kind: [dict]}, or None when there are no recordings; whether every estimate stayed within its bounds)"""
    done = subprocess.run([PROGRAM], stdout=subprocess.PIPE, text=True, timeout=600)
    if done.returncode == ABSENT:
        return None, True
    if done.returncode == SAID:
        sys.exit(SAID)
    if done.returncode not in (0, 1):
        raise Fault(f"{PROGRAM} gave status {done.returncode}")
    CSV.write_text(done.stdout, encoding="ascii")
    rows = {kind: [] for kind in FIELDS}
    for kind, *values in csv.reader(done.stdout.splitlines()):
        if kind not in FIELDS or len(values) != len(FIELDS[kind]):
            raise Fault(f"{CSV}: a row of kind '{kind}' with {len(values)} fields")
        rows[kind].append(dict(zip(FIELDS[kind], values)))
    return rows, done.returncode == 0


def unique(rows, field):
    return list(dict.fromkeys(row[field] for row in rows))


def of(rows, **wanted):
    return [row for row in rows if all(row[k] == v for k, v in wanted.items())]


def total(rows, field):
    return sum(int(row[field]) for row in rows)


def per_cent(part, whole):
    share = 100.0 * float(part) / max(1.0, float(whole))
    if share == 0.0:
        return "0"
    return f"{share:.2g}" if share < 1.0 else f"{share:.0f}"


def gating(rows):
    """Filters that gate anything."""
    return [name for name in unique(rows, "filter") if total(of(rows, filter=name), "gated")]


def by_filter(head, rows, field, filters, cell):
    """A line for each value of a field, and in it for each filter what cell(its rows) says."""
    lines = [[value, *(cell(of(rows, **{field: value, "filter": name})) for name in filters)] for value in unique(rows, field)]
    return markdown([head, *(f"`{name}`" for name in filters)], lines)


def gated(axes):
    return "/".join(per_cent(row["gated"], row["samples"]) for row in axes)


def streams_table(rows):
    lines = []
    for r in rows["stream"]:
        nominal, seen = float(r["rate_hz"]), float(r["rows_hz"])
        rate = f"{nominal:g}" + (f" (rows {seen:.0f})" if abs(seen - nominal) > 0.05 * nominal else "")
        lines.append([r["name"], rate, r["range_g"], int(r["rows"]), per_cent(r["clipped"], r["rows"]), per_cent(r["duplicates"], r["rows"]),
                      f"{r['zeros']} / {r['ones']}"])
    return markdown(["stream", "Hz", "range, g", "rows", "clipped, %", "duplicates, %", "0,0,0 / -1,-1,-1"], lines)


def rules_table(rows):
    lines = []
    for name in unique(rows["filter"], "filter"):
        axes = of(rows["filter"], filter=name)
        sums = {field: total(axes, field) for field in ("samples", "bounds_broken", "saturated", "judged", "broken", "hull_judged", "hull_broken")}
        left = [float(r["hull_left_lsb"]) for r in axes if int(r["hull_judged"])]
        lines.append([f"`{name}`", sums["samples"], str(sums["bounds_broken"]), sums["saturated"], sums["judged"], str(sums["broken"]),
                      f"{max(float(r['worst_share']) for r in axes):.2f}" if sums["judged"] else "",
                      *([sums["hull_judged"], str(sums["hull_broken"]), f"{min(left):.1f}"] if left else ["", "", ""])])
    return markdown(["filter", "samples", "outside documented bounds", "saturated", "judged by band, run or wait", "broken", "worst share used",
                     "judged by hull", "broken", "least left, LSB"], lines)


def gated_table(rows):
    return by_filter("gated x/y/z, %", rows["filter"], "name", gating(rows["filter"]), gated)


def again_table(rows):
    rates = {r["name"]: float(r["rate_hz"]) for r in rows["stream"]}

    def cell(axes):
        longest = max(int(r["longest_gated"]) for r in axes)
        return f"{total(axes, 'reacquired')}; {longest / rates[axes[0]['name']]:.2f} s"

    return by_filter("re-acquired; longest gated", rows["filter"], "name", gating(rows["filter"]), cell)


def outside_table(rows):
    def cell(axes):
        outside, worst = total(axes, "outside"), max(float(r["outside_worst_lsb"]) for r in axes)
        return f"{per_cent(outside, total(axes, 'samples'))}; {worst:.0f}" if outside else ""

    return by_filter("outside, %; farthest, LSB", rows["filter"], "name", unique(rows["filter"], "filter"), cell)


def rest_table(rows):
    filters, lines = gating(rows["rest"]), []
    for name, from_s in dict.fromkeys((r["name"], r["from_s"]) for r in rows["tails"]):
        tails = of(rows["tails"], name=name, from_s=from_s)
        lines.append([f"{name} from {from_s} s", int(tails[0]["samples"]), "/".join(f"{float(t['sd_lsb']):.1f}" for t in tails),
                      *("/".join(per_cent(t[beyond], 1) for t in tails) for beyond in ("beyond3", "beyond5")),
                      *(gated(of(rows["rest"], name=name, from_s=from_s, filter=f)) for f in filters)])
    return markdown(["at rest", "samples", "sd x/y/z, LSB", "beyond 3 sd, %", "beyond 5 sd, %", *(f"`{f}`, %" for f in filters)], lines)


def faults_table(rows, pool, reference):
    part = of(rows["fault"], pool=pool)
    return by_filter(pool, part, "fault", unique(part, "filter"),
                     lambda cells: f"{float(cells[0][f'{reference}_mean']):.3g} ({float(cells[0][f'{reference}_worst']):.3g})")


def tables(rows):
    parts = [(title, words, table(rows)) for title, words, table in (
        ("The recordings", OF_STREAMS, streams_table), ("Diverged?", OF_RULES, rules_table), ("Gated", OF_GATED, gated_table),
        ("Re-acquisitions, longest run of gated samples", OF_AGAIN, again_table),
        ("Outside the range of the last second's samples", OF_OUTSIDE, outside_table), ("At rest: false gates", OF_REST, rest_table))]
    parts += [(f"Faults put in {pool}, from {words}", OF_FAULTS, faults_table(rows, pool, reference))
              for reference, words in (("own", OWN), ("plain", OF_PLAIN)) for pool in unique(rows["fault"], "pool")]
    return [line for title, words, lines in parts for line in (f"## {title}", words, "", *lines, "")]


def main():
    rows, good = measure()
    if rows is None:
        print(f"skipped: 1 (no recordings, {DOCUMENT} left as it is)")
        return 0
    if not good:
        print("recordings: an estimate left its bounds, see 'Diverged?'", file=sys.stderr)
    return PAGE.publish(tables(rows), good=good)


if __name__ == "__main__":
    run_as_program("recordings", main)
