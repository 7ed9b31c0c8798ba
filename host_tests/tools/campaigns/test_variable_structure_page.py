"""docs/variable-structure.md: its tables and the numbers in its text are those of docs/papers.md, what has no chance in it comes out again, its
picture shows what it should, its links lead somewhere, the tests that it names exist."""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, run_all, test

needs("papers", "numpy", "matplotlib")

import structure_page  # noqa: E402
import structure_picture  # noqa: E402
from page import INLINE  # noqa: E402
from papers_page import between  # noqa: E402
from papers_page_structure import COLUMNS, FLIGHTS  # noqa: E402

TEXT = structure_page.DOCUMENT.read_text(encoding="utf-8")
PAPERS = between(pathlib.Path("docs/papers.md").read_text(encoding="utf-8"), "004")[1]


def of_papers():
    """{(experiment, rule, metric): as shown, without its interval} of the tables that make papers writes."""
    found = {}
    for experiment, title in FLIGHTS:
        lines = [line for line in PAPERS.split(f"### {title}\n")[1].split("\n### ")[0].splitlines() if line.startswith("| `")]
        for line in lines:
            rule, _, *cells = (cell.strip() for cell in line.strip("|").split("|"))
            found.update({(experiment, rule.strip("`"), metric): cell.split(" [")[0] for cell, (_, metric) in zip(cells, COLUMNS)})
    return found


def table_of(title):
    """{rule: {column: cell}}"""
    rows = {}
    for found, row, column, cell in structure_page.PAGE.cells(TEXT):
        if found == title:
            rows.setdefault(row, {})[column] = cell
    return rows


@test
def both_pages_hold_the_same_numbers():
    papers, compared = of_papers(), 0
    for title, kind in structure_page.TABLES:
        rows = table_of(title)
        assert set(rows) == set(structure_page.RULES.values()), set(rows)
        for rule, words in structure_page.RULES.items():
            for column, metric in structure_page.COLUMNS:
                assert rows[words][column] == papers[f"windows_{kind}", rule, metric], (title, words, column)
                compared += 1
            assert rows[words]["median, chosen by the window before"] == papers[f"next_window_{kind}", rule, "rms_median"], (title, words)
    assert compared == 150
    told = [(tuple(key.split()), number) for key, number in INLINE.findall(TEXT)]
    flights = [(key, number) for key, number in told if key in papers]
    assert len(flights) >= 20 and all(papers[key] == number for key, number in flights), [entry for entry in flights if papers[entry[0]] != entry[1]]


@test
def what_has_no_chance_in_it_comes_out_again():
    again = structure_page.values_of(structure_page.measured(("observability",)))
    told = {key: number for key, number in INLINE.findall(TEXT) if key.startswith("observability")}
    assert len(told) == 3 and all(again[key] == number for key, number in told.items()), (told, again)


@test
def the_picture_shows_this_flight():
    assert not structure_picture.stale(), "make structure draws it"
    assert structure_picture.PATH.stat().st_size <= structure_picture.MAX_BYTES
    # the twin: of another flight it would be drawn anew
    kept = structure_picture.RUN
    structure_picture.RUN = kept + 1
    try:
        assert structure_picture.stale()
    finally:
        structure_picture.RUN = kept


def anchors(path):
    """The headings of a page as GitHub links to them."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@test
def every_link_leads_somewhere_and_every_test_named_exists():
    for target in re.findall(r"\]\(([^)]+)\)", TEXT):
        name, _, anchor = target.partition("#")
        path = structure_page.DOCUMENT.parent / name
        assert path.is_file() and (not anchor or anchor in anchors(path)), target
    sources = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("host_tests/tools/campaigns").glob("test_variable_structure*.py"))
    named = re.findall(r"`([a-z0-9]+(?:_[a-z0-9]+){3,})`", TEXT)
    assert len(named) >= 10 and all(f"def {name}()" in sources for name in named), [name for name in named if f"def {name}()" not in sources]


if __name__ == "__main__":
    raise SystemExit(run_all())
