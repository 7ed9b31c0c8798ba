"""make figures in small: every figure is drawn, has its axes' labels and what its paper prints; the page shows each, with its numbers."""
import pathlib
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import needs, run_all, test

needs("papers", "numpy", "matplotlib")

import figures  # noqa: E402
import pictures  # noqa: E402
import figures_style  # noqa: E402
import results  # noqa: E402

RUNS, FOLDER, MOST_BYTES = 10, pathlib.Path("build/figures_small"), 100_000
NOTHING_PRINTED = {"003-9-11"}  # no number of these figures is readable
EXPECTED = {"000-1-3", "001-2-4", *(f"002-{n}" for n in range(2, 8)), "003-2-4", "003-5", "003-6-8", "003-9-11", "004-5-6"}
UNITS = ("seconds", " in ", "probability", "density", "ratio")  # a label has a unit, or names a number without one


def lacking(figure, printed):
    """What a drawn figure does not have, one sentence each."""
    faults = []
    for number, axes in enumerate(figure.axes):
        colour_bar = axes.get_label() == "<colorbar>"
        for which, words in (("x", axes.get_xlabel()), ("y", axes.get_ylabel())):
            if not any(unit in words for unit in UNITS) and not (colour_bar and which == "x"):
                faults.append(f"axes {number}: the label of {which} is '{words}'")
    marks = [artist for axes in figure.axes for artist in axes.findobj(lambda artist: artist.get_gid() == figures_style.PRINTED)]
    if printed and not marks:
        faults.append("nothing printed is marked")
    return faults


def save_small(drawn):
    """Draws a figure into FOLDER; what it lacks."""
    picture, found = drawn.picture(), []
    draw = picture.draw

    def watched(figure, data):
        draw(figure, data)
        found.extend(lacking(figure, drawn.name not in NOTHING_PRINTED))

    picture.draw, picture.path = watched, FOLDER / picture.path.name
    picture.path.unlink(missing_ok=True)
    with mock.patch.object(pictures, "DPI", 30):
        picture.save()
    return picture.path, found


@test
def every_figure_is_drawn_with_labels_and_printed_marks():
    drawn = figures.all_figures(RUNS)
    assert {figure.name for figure in drawn} == EXPECTED
    for figure in drawn:
        path, faults = save_small(figure)
        assert path.is_file() and path.stat().st_size <= MOST_BYTES, path
        assert faults == [], f"{figure.name}: {faults}"


@test
def a_figure_without_label_or_mark_is_named():
    def draw(figure, _):
        figures_style.panel(figure.subplots(), "", "time in seconds", "roll")

    bare = figures_style.Drawn("bare", "", 1, draw, (), __file__, "")
    assert save_small(bare)[1] == ["axes 0: the label of y is 'roll'", "nothing printed is marked"]


@test
def the_page_shows_each_and_says_what_is_not_drawn():
    page = figures.PAGE.held()
    for name in EXPECTED:
        path = results.PICTURES / f"paper-{name}.png"
        assert path.is_file() and path.stat().st_size <= MOST_BYTES, path
        assert f"({results.PICTURES.name}/{path.name})" in page, path
    strangers = {path.name for path in results.PICTURES.glob("paper-*")} - {f"paper-{name}.png" for name in EXPECTED}
    assert not strangers, strangers
    rows = [row for title, row, column, cell in results.cells(page) if title == "Printed and ours" and column == "ours"]
    assert len(rows) >= 40 and {row[:3] for row in rows} == {"000", "001", "002", "003", "004"}, rows
    for figure, why in figures.NOT_DRAWN:
        assert f"| {figure} | {why} |" in page


if __name__ == "__main__":
    raise SystemExit(run_all())
