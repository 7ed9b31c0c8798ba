"""docs/results/variable-structure.md: its tables are those of docs/results/papers-004.md, what has no chance in it comes out again, its picture shows
what it should."""
import pathlib
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, run_all, test

needs("papers", "numpy", "matplotlib")

import structure_page  # noqa: E402
import results  # noqa: E402
import structure_picture  # noqa: E402
from papers_page import document  # noqa: E402
from papers_page_004 import COLUMNS, FLIGHTS  # noqa: E402

TEXT = structure_page.PAGE.held()
PAPERS = document("004").read_text(encoding="utf-8")


def of_papers():
    """{(experiment, rule, metric): as shown, without its interval} of the tables that make papers writes."""
    found = {}
    for experiment, title in FLIGHTS:
        lines = [line for line in PAPERS.split(f"## {title}\n")[1].split("\n## ")[0].splitlines() if line.startswith("| `")]
        for line in lines:
            rule, _, *cells = (cell.strip() for cell in line.strip("|").split("|"))
            found.update({(experiment, rule.strip("`"), metric): cell.split(" [")[0] for cell, (_, metric) in zip(cells, COLUMNS)})
    return found


def table_of(title):
    """{rule: {column: cell}}"""
    rows = {}
    for found, row, column, cell in results.cells(TEXT):
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


@test
def what_has_no_chance_in_it_comes_out_again():
    lines = structure_page.channel_table(structure_page.measured(("observability",)))
    assert len(lines) == 9 and "\n".join(lines).rstrip() in TEXT, lines


@test
def the_picture_shows_this_flight():
    assert not structure_picture.picture().stale(), "make structure draws it"
    assert structure_page.PICTURE in TEXT
    # the twin: of another flight it would be drawn anew
    with mock.patch.object(structure_picture, "RUN", structure_picture.RUN + 1):
        assert structure_picture.picture().stale()


if __name__ == "__main__":
    raise SystemExit(run_all())
