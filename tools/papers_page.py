"""The tables of docs/papers.md, written by make papers between two markers."""
import math
import pathlib

DOCUMENT = pathlib.Path("docs/papers.md")
BEGIN, END = "<!-- written by make papers: begin -->", "<!-- written by make papers: end -->"
STEPS = ("1..5", "5", "10", "20", "50", "100", "5..100")
FACTORS = ("1/16", "1/4", "1/2", "1", "2", "4", "16")
GATES = ("1", "2", "2.5", "3", "3.5", "4")


def shown(value):
    if math.isinf(value):
        return "never"
    if value == 0 or abs(value) >= 1000:
        return f"{value:,.0f}"
    if abs(value) < 1e-3:
        return f"{value:.1e}"
    return f"{value:#.3g}".rstrip(".")


def with_interval(row):
    if row is None:
        return ""
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


def efficiency(rows):
    part = []
    for title, experiment in (("Start of Table 1", "table1_start"), ("Start of Table 1, first sample no outlier", "first_sample_clean"),
                              ("Median of five, the rate as in Table 1", "median_start"), ("As shipped at 40.5 Hz", "shipped_start")):
        part += [f"**{title}**", "", *grid(rows, [
            ("steady", experiment, ["k_ef_steady"]), ("median of groups of 50 [5 %, 95 %]", experiment, ["k_ef_steady_median_of_50"]),
                                                  ("k = 6..60", experiment, ["k_ef_transient_6_60"]), ("k = 1..60", experiment, ["k_ef_transient"]),
                                                  ("locked out", experiment, ["lockout_rate"])], intervals=True)]
    return part


def tables(rows):
    """(heading, lines) of the page."""
    back = ["reacq_median", "reacq_p95"]
    yield "Beside the paper", verdicts(rows)
    yield "K_ef: mean square error of the Kalman filter over that of the filter", efficiency(rows)
    yield "Without outliers: the Kalman filter's mean square error over the filter's", grid(
        rows, [("efficiency", "clean", ["clean_efficiency"])], intervals=True)
    yield "Width of the gate in sigma: false alarms / misses (first sample no outlier)", grid(
        [r for r in rows if r["filter"] == "sprf"], [(g, f"gate_{g}_sigma", ["false_alarm", "miss"]) for g in GATES])
    yield "Width of the gate in sigma: K_ef", grid(rows, [(g, f"gate_{g}_sigma", ["k_ef_steady"]) for g in GATES])
    yield "Samples until back after a step of so many sigma, no outliers: median / 95 %", grid(
        rows, [(s, f"step_clean_{s}_sigma", back) for s in STEPS])
    yield "The same with 15 % outliers", grid(rows, [(s, f"step_15_percent_{s}_sigma", back) for s in STEPS])
    yield "Bursts of outliers on clean data", grid(rows, [(f"{n}: {title}", f"burst_{n}", metrics) for n in (10, 30) for title, metrics in (
        ("peak error in steady sigmas, median / 95 %", ["peak_error_sigma_median", "peak_error_sigma_p95"]),
        ("samples until back, 95 %", ["recovery_p95"]))])
    yield "Steady K_ef with R wrong by a factor (first sample no outlier)", grid(rows, [(f, f"wrong_r_{f}", ["k_ef_steady"]) for f in FACTORS])
    yield "Lock-out: steps of 1 to 100 sigma in a random phase, 0 to 30 % outliers", grid(rows, [
        (title, "lockout", [metric]) for title, metric in (
            ("limit, samples", "limit_samples"), ("trials not back", "not_back"), ("99.9 %", "samples_p999"),
            ("worst", "samples_worst"))])
    yield "Operations per sample of the shipped code, counted: median / most", grid(rows, [
        (title, "operations", [metric, f"{metric}_most"]) for title, metric in (("multiplications", "multiplications"), ("additions", "additions"),
                                                                              ("reciprocals", "divisions"), ("cells of 32 bits", "memory_cells"))])
    yield "Gain at rest; fixed point by double", grid(rows, [("gain", "steady_gain", ["gain"]), ("by double", "steady_gain", ["gain_by_double"])])


def page_text(rows, options):
    lines = [f"{options.runs:,} runs per experiment ({10 * options.runs:,} trials for lock-out), seed {options.seed}.", ""]
    for heading, part in tables(rows):
        if len(part) > 3:
            lines += [f"### {heading}", "", *part]
    return "\n".join(lines)


def write_page(rows, options):
    text = DOCUMENT.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        raise OSError(f"{DOCUMENT}: has no line '{BEGIN}' or '{END}'")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    DOCUMENT.write_text(f"{before}{BEGIN}\n{page_text(rows, options)}\n{END}{after}", encoding="utf-8")
