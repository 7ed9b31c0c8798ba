"""The tables of docs/papers.md, written by make papers between two markers for each paper: papers_page_NNN.py has those of a paper."""
import fnmatch
import importlib
import math
import pathlib

from page_sources import Fault
from results import markdown, no_title_twice

DOCUMENT = pathlib.Path("docs/papers.md")
BEGIN, END = "<!-- written by make papers: begin -->", "<!-- written by make papers: end -->"
DIVERGED = 1e-6  # a K_ef below it is that of an estimate without bounds


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
    if row["metric"].startswith("k_ef") and row["value"] < DIVERGED:
        return "diverges"
    return shown(row["value"]) + (f" [{shown(row['ci_lo'])}, {shown(row['ci_hi'])}]" if row.get("ci_lo") is not None else "")


def pick(rows, experiment, name, arithmetic, metric):
    return next((r for r in rows if (r["experiment"], r["filter"], r["arithmetic"], r["metric"]) == (experiment, name, arithmetic, metric)), None)


def table(head, lines):
    return [*markdown(head, lines), ""]


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


def part_of(paper):
    """What papers_page_NNN.py has for a paper: runs_of(runs), tables(rows), and the experiments in which there is no chance."""
    return importlib.import_module(f"papers_page_{paper}")


def page_text(paper, rows, options):
    """The part of a paper: how many runs, then its tables that have a line."""
    part = part_of(paper)
    lines = [f"{part.runs_of(options.runs)}, seed {options.seed}.", ""]
    for heading, table_lines in part.tables(rows):
        if any(line.startswith("| `") for line in table_lines):
            lines += [f"### {heading}", "", *table_lines]
    return "\n".join(lines)


def markers(paper):
    """Of the part of the page that make papers writes for a paper."""
    return (BEGIN, END) if paper == "002" else tuple(m.replace("papers:", f"papers, {paper}:") for m in (BEGIN, END))


def between(text, paper):
    """(before, the part, after)."""
    begin, end = markers(paper)
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
        raise Fault(f"{DOCUMENT}: wants one line '{begin}', and one '{end}' below it")
    before, rest = text.split(begin)
    part, after = rest.split(end)
    return before, part, after


def write_page(paper, rows, options):
    begin, end = markers(paper)
    before, _, after = between(DOCUMENT.read_text(encoding="utf-8"), paper)
    part = page_text(paper, rows, options)
    no_title_twice(DOCUMENT, part.splitlines())
    DOCUMENT.write_text(f"{before}{begin}\n{part}\n{end}{after}", encoding="utf-8")


def stale(paper, rows, text):
    """Lines that the rows without chance, judged, give and the page's text lacks, and such that it has beyond them. Where a part is in double only a
    filter that is added to FILTER_LIST may add lines of fixed point, which make papers then writes."""
    part, in_double = part_of(paper), paper != "002"

    def counts(line):
        return line.startswith("| `") and not (in_double and "| fixed |" in line)

    def free(line):
        """Of a line under "Beside the paper"."""
        named = line.split(" | ")
        return len(named) > 2 and any(fnmatch.fnmatchcase(named[2].replace(" ", "_"), pattern) for pattern in part.CHANCE_FREE)

    tables = list(part.tables(rows))
    made = [line for _, lines in tables for line in lines if counts(line)]
    titles = [heading for heading, lines in tables if any(line.startswith("| `") for line in lines) and heading != "Beside the paper"]
    held, heading = [], ""
    for line in between(text, paper)[1].splitlines():
        heading = line[4:] if line.startswith("### ") else heading
        if counts(line) and (heading in titles or (heading == "Beside the paper" and free(line))):
            held.append(line)
    return [f"the page lacks: {line}" for line in made if line not in held] + [f"the page has: {line}" for line in held if line not in made]
