"""docs/results/papers-NNN.md, one page for each paper, written whole by make papers: papers_page_NNN.py has a paper's tables."""
import fnmatch
import importlib
import math

from results import FOLDER, Results, markdown

BESIDE = "Beside the paper"
JUDGED = ("filter", "arithmetic", "experiment", "number", "measured", "interval", "printed", "rule", "share", "verdict", "reason")
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


def exactly(value):
    return "never" if math.isinf(value) else f"{value:.6g}"


def verdicts(rows):
    """What is printed beside what is measured, with the digits that the verdict needs."""
    lines = []
    for r in (r for r in rows if r.get("verdict")):
        interval = f"{exactly(r['ci_lo'])} to {exactly(r['ci_hi'])}" if r.get("ci_lo") is not None else ""
        share = "" if r.get("share") is None else exactly(r["share"])
        lines.append([f"`{r['filter']}`", r["arithmetic"], r["experiment"], r["metric"], exactly(r["value"]), interval, r["published"], r["rule"],
                      share, r["verdict"], r["reason"]])
    return table(JUDGED, lines)


def judged_on(text):
    """The rows of a page's table of verdicts, as dictionaries of JUDGED; measured, interval and share are numbers."""
    found = []
    for line in text.partition(f"## {BESIDE}\n")[2].partition("\n## ")[0].splitlines():
        if line.startswith("| `"):
            row = dict(zip(JUDGED, (cell.strip() for cell in line[2:-2].split(" | "))), line=line)
            low, _, high = row["interval"].partition(" to ")
            found.append({**row, "filter": row["filter"].strip("`"), "measured": float(row["measured"].replace("never", "inf")),
                          "interval": (float(low), float(high.replace("never", "inf"))) if low else (None, None),
                          "share": float(row["share"]) if row["share"] else None})
    return found


def part_of(paper):
    """What papers_page_NNN.py has for a paper: runs_of(runs), tables(rows), and the experiments in which there is no chance."""
    return importlib.import_module(f"papers_page_{paper}")


def document(paper):
    return FOLDER / f"papers-{paper}.md"


def lines_of(paper, rows):
    """A paper's tables that have a line, under their headings."""
    lines = []
    for heading, table_lines in part_of(paper).tables(rows):
        if any(line.startswith("| `") for line in table_lines):
            lines += [f"## {heading}", "", *table_lines]
    return lines


def page_of(paper, options):
    about = (f"{part_of(paper).runs_of(options.runs)}, seed {options.seed}. How it is counted, and the errata: "
             f"[paper {paper}](../papers-{paper}.md).\n"
             "What the verdicts mean: [papers](../papers.md). From a claim to its row, function and test: [index](papers-index.md).")
    return Results(document(paper), f"Paper {paper}: results", "make papers", about)


def write_page(paper, rows, options, sources=None):
    page_of(paper, options).write(lines_of(paper, rows), sources)


def stale(paper, rows, text):
    """Lines that the rows without chance, judged, give and the page's text lacks, and such that it has beyond them. Where a part is in double only a
    filter that is added to FILTER_LIST may add lines of fixed point, which make papers then writes."""
    part, in_double = part_of(paper), paper != "002"

    def counts(line):
        return line.startswith("| `") and not (in_double and "| fixed |" in line)

    def free(line):
        """Of a line of the verdicts."""
        named = line.split(" | ")
        return len(named) > 2 and any(fnmatch.fnmatchcase(named[2], pattern) for pattern in part.CHANCE_FREE)

    tables = list(part.tables(rows))
    made = [line for _, lines in tables for line in lines if counts(line)]
    titles = [heading for heading, lines in tables if any(line.startswith("| `") for line in lines) and heading != BESIDE]
    held, heading = [], ""
    for line in text.splitlines():
        heading = line[3:] if line.startswith("## ") else heading
        if counts(line) and (heading in titles or (heading == BESIDE and free(line))):
            held.append(line)
    return [f"the page lacks: {line}" for line in made if line not in held] + [f"the page has: {line}" for line in held if line not in made]
