"""make figures: the figures of the five papers, drawn from our own runs with what the papers print beside, into docs/results/paper-figures.md.

    figures.py [--runs N]      N: 500 for the page; with another number page and pictures are left alone, files go to build/figures
"""
import argparse
import importlib
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import pictures
    PARTS = [importlib.import_module(path.stem) for path in sorted(pathlib.Path(__file__).parent.glob("figures_00*.py"))]
except ImportError as missing:
    sys.exit(f"figures: {missing.name} is missing: run make figures, which installs it")
from papers_program import whole_number
from results import FOLDER, Results, run_as_program, table

PAGE_RUNS = 500
OTHER_RUNS = pathlib.Path("build/figures")
ABOUT = """
What the papers' figures show, drawn anew from our own runs of the papers' experiments, in one style. Dashed, hatched or in black letters: what the
paper prints. No curve of a paper is copied: their data are not published. [The papers](../papers.md) has the verdicts.
"""
PAGE = Results(FOLDER / "paper-figures.md", "The papers' figures", "make figures", ABOUT)
NOT_DRAWN = (("001, Fig. 1; 002, Fig. 1; 004, Figs 1 to 4; 003, Figs 3.1, 4.1 to 4.3", "diagrams of structure: nothing is measured in them"),
             ("003, Fig. 2.1", "a drawing of frames of reference"),
             ("000, Fig. 1 as the paper has it", "a recording of a flight that is not published: drawn above of the nearest made roll"),
             ("004, Figs 5 and 6 as the paper has them", "a field test whose data and noise are not published: drawn above of a made flight"),
             ("003, b) of Figs 3.2 to 3.11", "what the second panels show is lost with the thesis' words"))


def all_figures(runs):
    return [drawn for part in PARTS for drawn in part.figures(runs)]


def lines_of(drawn):
    lines = []
    for figure in drawn:
        lines += [f"## {figure.title}", figure.words, "", *pictures.on_page([figure.picture()])]
    beside = [[figure.title[6:9], *row] for figure in drawn for row in figure.beside]
    rows = [[f"{paper}, {what}", printed, ours] for paper, what, printed, ours in beside]
    return [*lines, *table("Printed and ours", "", ["figure and quantity", "printed", "ours"], rows),
            *table("Not drawn", "", ["figure", "why"], NOT_DRAWN)]


def main():
    parser = argparse.ArgumentParser(usage="figures.py [--runs N]")
    parser.add_argument("--runs", type=whole_number, default=PAGE_RUNS)
    runs = parser.parse_args().runs
    drawn = all_figures(runs)
    shown = [figure.picture() for figure in drawn]
    if runs == PAGE_RUNS:
        return PAGE.publish(lines_of(drawn), shown)
    for picture in shown:
        picture.path = OTHER_RUNS / picture.path.name
        picture.save()
    print(f"figures: {len(shown)} in {OTHER_RUNS}; {runs} runs: the page is left alone")
    return 0


if __name__ == "__main__":
    run_as_program("figures", main)
