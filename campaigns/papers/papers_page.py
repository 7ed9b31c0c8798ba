"""The tables of docs/papers.md, written by make papers between two markers."""
import math
import pathlib

from laws import ROBUST
from page import no_title_twice

DOCUMENT = pathlib.Path("docs/papers.md")
BEGIN, END = "<!-- written by make papers: begin -->", "<!-- written by make papers: end -->"
STEPS = ("1..5", "5", "10", "20", "50", "100", "5..100")
FACTORS = ("1/16", "1/4", "1/2", "1", "2", "4", "16")
LOCKOUT_NOTE = ('"Not back" means not within the limit: P widens the gate of `sprf_paper` too slowly, and a sample taken by chance '
                "closes it again.")
GATES = ("1", "2", "2.5", "3", "3.5", "4")


def shown(value):
    if math.isinf(value):
        return "never"
    if value == 0 or abs(value) >= 1000:
        return f"{value:,.0f}"
    if abs(value) < 1e-3:
        return f"{value:.1e}"
    return f"{value:#.3g}".rstrip(".")


DIVERGED = 1e-6  # a K_ef below it is that of an estimate without bounds


def with_interval(row):
    if row is None:
        return ""
    if row["metric"].startswith("k_ef") and row["value"] < DIVERGED:
        return "diverges"
    return shown(row["value"]) + (f" [{shown(row['ci_lo'])}, {shown(row['ci_hi'])}]" if row.get("ci_lo") is not None else "")


def pick(rows, experiment, name, arithmetic, metric):
    return next((r for r in rows if (r["experiment"], r["filter"], r["arithmetic"], r["metric"]) == (experiment, name, arithmetic, metric)), None)


def table(head, lines):
    return ["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(line) + " |" for line in lines), ""]


def grid(rows, columns, intervals=False):
    """One line per filter and arithmetic, one column per (title, experiment, metrics)."""
    wanted = {(experiment, metric) for _, experiment, metrics in columns for metric in metrics}
    keys = list(dict.fromkeys((r["filter"], r["arithmetic"]) for r in rows if (r["experiment"], r["metric"]) in wanted))
    lines = []
    for name, arithmetic in keys:
        cells = []
        for _, experiment, metrics in columns:
            found = [pick(rows, experiment, name, arithmetic, metric) for metric in metrics]
            cells.append(" / ".join((with_interval(r) if intervals else shown(r["value"])) for r in found if r))
        lines.append([f"`{name}`", arithmetic, *cells])
    return table(["filter", "arithmetic", *(title for title, _, _ in columns)], lines)


def verdicts(rows):
    lines = [[f"`{r['filter']}`", r["arithmetic"], r["experiment"].replace("_", " "), r["metric"].replace("_", " "), with_interval(r), r["published"],
              f"**{r['verdict']}**" if r["verdict"] == "refuted" else r["verdict"], r["reason"]] for r in rows if r.get("verdict")]
    return table(["filter", "arithmetic", "experiment", "number", "measured [95 %]", "paper", "verdict", "reason"], lines)


def starts_alike(row):
    """Not where the reference of sprf_paper begins with Table 1's estimate and the shipped code with its first sample."""
    return not (row["filter"].startswith("sprf_paper") and row["experiment"] in ("median_start", "shipped_start") and
                (row["arithmetic"] == "double" or row["metric"].endswith("by_double")))


def efficiency(rows):
    part, rows = [], [row for row in rows if starts_alike(row)]
    for title, experiment in (("Start of Table 1", "table1_start"), ("Start of Table 1, first sample no outlier", "first_sample_clean"),
                              ("Median of five, the rate as in Table 1", "median_start"), ("As shipped at 40.5 Hz", "shipped_start")):
        part += [f"**{title}**", "", *grid(rows, [
            ("steady", experiment, ["k_ef_steady"]), ("steady, median of groups of 50 [5 %, 95 %]", experiment, ["k_ef_steady_median_of_50"]),
            ("k = 6..60", experiment, ["k_ef_transient_6_60"]), ("k = 1..60", experiment, ["k_ef_transient"]),
            ("k = 1..60, median of groups of 50 [5 %, 95 %]", experiment, ["k_ef_transient_median_of_50"]),
            ("locked out", experiment, ["lockout_rate"])], intervals=True)]
    return part


def table_2(rows):
    """Ours, the most of any sample, beside the paper's three columns."""
    names = list(dict.fromkeys(r["filter"] for r in rows if r["experiment"] == "operations"))
    lines = []
    for name in names:
        cells = []
        for metric in ("multiplications_most", "additions_most", "memory_cells"):
            row = pick(rows, "operations", name, "fixed", metric)
            cells += [f"{row['value']:g}" if row else "", (row or {}).get("published") or "-"]
        lines.append([f"`{name}`", *cells])
    return table(["filter", "multiplications", "paper", "additions", "paper", "bytes / 4", "paper's cells"], lines)


def tables(rows):
    """(heading, lines) of the page."""
    back = ["reacq_median", "reacq_p95"]
    yield "Beside the paper", verdicts(rows)
    yield "K_ef: mean square error of the Kalman filter over that of the filter", efficiency(rows)
    yield "Steady K_ef of fixed point by that of double, same runs", grid([r for r in rows if starts_alike(r)], [
        (title, experiment, ["k_ef_steady_by_double"]) for title, experiment in (
            ("Start of Table 1", "table1_start"), ("first sample no outlier", "first_sample_clean"), ("median of five", "median_start"),
            ("as shipped", "shipped_start"))])
    yield "Equations as printed: K_ef from the start of Table 1", grid(rows, [
        ("steady", "printed", ["k_ef_steady"]), ("k = 1..60", "printed", ["k_ef_transient"]),
        ("steady, first sample no outlier", "printed_first_sample_clean", ["k_ef_steady"]),
        ("k = 1..60, first sample no outlier", "printed_first_sample_clean", ["k_ef_transient"])], intervals=True)
    yield "Without outliers: the Kalman filter's mean square error over the filter's", grid(
        rows, [("efficiency", "clean", ["clean_efficiency"])], intervals=True)
    yield "Width of the gate in sigma: false alarms / misses (first sample no outlier)", grid(
        [r for r in rows if r["filter"] == ROBUST], [(g, f"gate_{g}_sigma", ["false_alarm", "miss"]) for g in GATES])
    yield "Width of the gate in sigma: K_ef", grid(rows, [(g, f"gate_{g}_sigma", ["k_ef_steady"]) for g in GATES])
    yield "Samples until back after a step of so many sigma, no outliers: median / 95 %", grid(
        rows, [(s, f"step_clean_{s}_sigma", back) for s in STEPS])
    yield "The same with 15 % outliers", grid(rows, [(s, f"step_15_percent_{s}_sigma", back) for s in STEPS])
    yield "Bursts of outliers on clean data", grid(rows, [(f"{n}: {title}", f"burst_{n}", metrics) for n in (10, 30) for title, metrics in (
        ("peak error in steady sigmas, median / 95 %", ["peak_error_sigma_median", "peak_error_sigma_p95"]),
        ("samples until back, 95 %", ["recovery_p95"]))])
    yield "Steady K_ef with R wrong by a factor (first sample no outlier)", grid(rows, [(f, f"wrong_r_{f}", ["k_ef_steady"]) for f in FACTORS])
    yield "Lock-out: steps of 1 to 100 sigma in a random phase, 0 to 30 % outliers", [LOCKOUT_NOTE, "", *grid(rows, [
        (title, "lockout", [metric]) for title, metric in (
            ("limit, samples", "limit_samples"), ("trials not back", "not_back"), ("99.9 %", "samples_p999"),
            ("worst", "samples_worst"))])]
    yield "Table 2: most operations per sample, and the state", table_2(rows)
    yield "Operations per sample of the shipped code, counted: median / most", grid(rows, [
        (title, "operations", [metric, f"{metric}_most"]) for title, metric in (
            ("multiplications", "multiplications"), ("additions", "additions"), ("reciprocals", "divisions"))])
    yield "Gain at rest; fixed point by double", grid(rows, [("gain", "steady_gain", ["gain"]), ("by double", "steady_gain", ["gain_by_double"])])


def page_text(rows, options):
    lines = [f"{options.runs:,} runs per experiment ({10 * options.runs:,} trials for lock-out), seed {options.seed}.", ""]
    for heading, part in tables(rows):
        if any(line.startswith("| `") for line in part):
            lines += [f"### {heading}", "", *part]
    return "\n".join(lines)


def markers(paper):
    """Of the part of the page that make papers writes for a paper."""
    return (BEGIN, END) if paper == "002" else tuple(m.replace("papers:", f"papers, {paper}:") for m in (BEGIN, END))


def between(text, paper):
    """(before, the part, after)."""
    begin, end = markers(paper)
    if text.count(begin) != 1 or text.count(end) != 1:
        raise OSError(f"{DOCUMENT}: has no line '{begin}' or '{end}', or two")
    before, rest = text.split(begin)
    part, after = rest.split(end)
    return before, part, after


def write_page(paper, rows, options):
    """The part of a paper, by the function that makes its text (papers_page_synthesis.py has those of 000 and 001, papers_page_navigation.py that
    of 003, papers_page_structure.py that of 004)."""
    import papers_page_navigation  # noqa: E402, which import this module
    import papers_page_structure  # noqa: E402
    import papers_page_synthesis  # noqa: E402
    make = {"000": papers_page_synthesis.page_text_000, "001": papers_page_synthesis.page_text_001, "002": page_text,
            "003": papers_page_navigation.page_text_003, "004": papers_page_structure.page_text_004}[paper]
    begin, end = markers(paper)
    before, _, after = between(DOCUMENT.read_text(encoding="utf-8"), paper)
    part = make(rows, options)
    no_title_twice(DOCUMENT, part.splitlines())
    DOCUMENT.write_text(f"{before}{begin}\n{part}\n{end}{after}", encoding="utf-8")


CHANCE_FREE = ("covariance", "steady_gain", "table2", "operations")


def stale(rows, page):
    """Lines that the rows of CHANCE_FREE, judged, give and the page lacks, and lines of such that it has beyond them."""
    made = [line for _, part in tables(rows) for line in part if line.startswith("| `")]
    titles = [heading for heading, part in tables(rows) if any(line.startswith("| `") for line in part) and heading != "Beside the paper"]
    held, heading = [], ""
    for line in page.split(BEGIN)[-1].split(END)[0].splitlines():
        heading = line[4:] if line.startswith("### ") else heading
        cells = line.split(" | ")
        free = len(cells) > 2 and cells[2].replace(" ", "_") in CHANCE_FREE
        if line.startswith("| `") and (heading in titles or (heading == "Beside the paper" and free)):
            held.append(line)
    return [f"the page lacks: {line}" for line in made if line not in held] + [f"the page has: {line}" for line in held if line not in made]
