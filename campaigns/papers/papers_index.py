#!/usr/bin/env python3
"""docs/results/papers-index.md: from each claim of the five papers to its verdict, function, test and row, from index.csv and the pages that make
papers writes.

    papers_index.py     writes the page; refuses a function, a test, a row or a table that is not there
"""
import fnmatch
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from page_sources import Fault
from papers_page import BESIDE, document, judged_on
from papers_verdict import VERDICTS
from results import FOLDER, Results, markdown, run_as_program

TABLE = pathlib.Path("campaigns/papers/index.csv")
CODE = ("lib/filters/src", "lib/tilt/src", "nav/lib", "host_tests/reference", "campaigns/synthesis", "campaigns/resilience",
        "campaigns/variable_structure", "tools/design")
TESTS = ("host_tests/filters", "host_tests/tools/campaigns", "host_tests/tools/design", "nav/tests")
HEAD = ("claim", "verdict, row", "function", "test")
DEFINITION = r"(?m)^(?:def |class |[a-zA-Z_][\w ]*[ *]){name}\(|^class {name}\b"
PROOF = r"(?m)^(?:@test\ndef {name}\(|TEST\({name}\))"
ABOUT = """Each claim and equation of the five papers: what became of it, the row or table that says so, the function that computes it and a test of
that. Several verdicts: of several cases. The verdicts' meaning: [papers](../papers.md)."""
PAGE = Results(FOLDER / "papers-index.md", "From a claim to its code", "make papers", ABOUT)


def entries(path=TABLE):
    """[(line, paper, claim, row, function, test)]"""
    paper, found = "", []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if re.fullmatch(r"\[\d{3}\]", line):
            paper = line[1:-1]
        elif line and not line.startswith("#"):
            cells = [cell.strip() for cell in line.split(" | ")]
            if len(cells) != (2 if len(cells) > 1 and cells[1].startswith("left out ") else 4):
                raise Fault(f"{path}:{number}: a line is CLAIM | ROW | FUNCTION | TEST, or CLAIM | left out WHY")
            found.append((f"{path}:{number}", paper, *cells, *[""] * (4 - len(cells))))
    return found


def defined(line, cell, folders, what):
    """A link to the file of a function or a test, `FILE NAME`, which must be defined there; a test must be one that is run."""
    file, _, name = cell.partition(" ")
    pattern = (PROOF if what == "test" else DEFINITION).format(name=re.escape(name))
    for path in (pathlib.Path(folder, file) for folder in folders):
        if path.is_file() and re.search(pattern, path.read_text(encoding="utf-8")):
            return f"[{name}](../../{path})"
    raise Fault(f"{line}: there is no {what} {name} in {file}")


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def fits(row, cell):
    """Whether a judged row of a page is one that a ROW of the table names."""
    if cell.startswith(("left out ", "erratum ", "table ")):
        return False
    experiment, name, metric, *printed = cell.split(" ")
    return all(fnmatch.fnmatchcase(row[field], pattern) for field, pattern in (
        ("experiment", experiment), ("filter", name), ("number", metric), ("printed", " ".join(printed) or "*")))


def errata(text):
    """What stands under the heading of a paper's page."""
    return text.partition("\n## Errata\n")[2].partition("\n## ")[0]


def result(line, paper, cell, text):
    """The cell of verdict and row; text: of the paper's page of results."""
    kind, _, rest = cell.partition(" ")
    if cell.startswith("left out "):
        return f"left out: {cell[len('left out '):]}"
    if kind == "erratum":
        place, _, words = rest.partition(": ")
        if place not in errata(pathlib.Path(f"docs/papers-{paper}.md").read_text(encoding="utf-8")):
            raise Fault(f"{line}: docs/papers-{paper}.md has no erratum of {place}")
        return f"[erratum](../papers-{paper}.md#errata): {words}"
    page = document(paper).name
    if kind == "table":
        if f"\n## {rest}\n" not in text:
            raise Fault(f"{line}: {page} has no table '{rest}'")
        return f"[table]({page}#{anchor(rest)})"
    rows = [row for row in judged_on(text) if fits(row, cell)]
    if not rows:
        raise Fault(f"{line}: {page} has no verdict on '{cell}'")
    found = [word for word in VERDICTS if any(row["verdict"] == word for row in rows)]
    return f"{', '.join(found)}: [`{cell}`]({page}#{anchor(BESIDE)})"


def lines(found=None):
    """The page's; refuses what is not there."""
    made, found = [], entries() if found is None else found
    for paper in dict.fromkeys(entry[1] for entry in found):
        text = document(paper).read_text(encoding="utf-8")
        rows = [(claim, result(line, paper, row, text), function and defined(line, function, CODE, "function"),
                 test and defined(line, test, TESTS, "test")) for line, of_paper, claim, row, function, test in found if of_paper == paper]
        made += [f"## Paper {paper}", "", *markdown(HEAD, rows), ""]
    return made


def write():
    PAGE.write(lines())


if __name__ == "__main__":
    run_as_program("papers_index", write)
