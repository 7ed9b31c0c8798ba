"""docs/results/mutants.md: what a campaign of operator mutants found, as tables."""
import collections
import itertools
import math
import pathlib

from results import Fault, Results, table

DOCUMENT = pathlib.Path("docs/results/mutants.md")
EQUAL = pathlib.Path("campaigns/mutants/equal.txt")
GOAL_OF = ("lib/", "firmware", "hal")

ABOUT = """\
A mutant is one small change of the product: a comparison, a sign, a constant, a condition turned round, a statement or a critical section left out
(`campaigns/mutants/operators.py`). One that does not compile, or from which the compiler makes the same code, is dropped; the tests judge each of
the others, and it is killed when one of them fails. Portable code is judged by the unit tests on the PC, what only the chip compiles by the firmware
in the simulator.

Mutants are judged in an order drawn by lot, by a digest of seed 0 and the mutant, so those judged in a campaign that was stopped (`STOP_AFTER`) are a
fair sample of their folder: "drawn" says how many that were. Tests have been written for survivors of this draw, so of the mutants that were not
drawn somewhat fewer are killed than the tables say."""
PAGE = Results(DOCUMENT, "Mutants that the tests notice", "make mutants", ABOUT)
OF_FOLDERS = """\
± is two standard errors of the sample, 0 where every mutant was drawn. The last row is of lib, firmware and hal: those of which some were
drawn, weighted by how many mutants each has."""
OF_SURVIVORS = f"The last column has a reason where somebody has found that the mutant changes nothing that the product promises (`{EQUAL}`)."


def reasons(keys):
    """key -> why that mutant changes nothing; each must be a mutant's."""
    lines = [line for line in EQUAL.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    found = dict(line.rsplit(" | ", 1) for line in lines)
    for key in found:
        if key not in keys:
            raise Fault(f"{EQUAL}: {key} is no mutant: remove the line, or write what it is now")
    return found


def judged(mutants, rows, folder_of):
    """folder -> (how many it has, the rows of those drawn): up to the first without a verdict, as kills outlive survivals in what is kept."""
    known, folders = {row["key"]: row for row in rows}, collections.defaultdict(list)
    for mutant in mutants:
        folders[folder_of(mutant.file)].append(known.get(mutant.key))
    return {folder: (len(found), list(itertools.takewhile(bool, found))) for folder, found in sorted(folders.items())}


def share(every, rows):
    """(killed, judged, error of the share killed) of a folder; the error is that of Agresti and Coull, which is not 0 where all were killed."""
    verdicts = collections.Counter(row["verdict"] for row in rows)
    killed, of = verdicts["killed"], verdicts["killed"] + verdicts["survived"]
    middle = (killed + 2) / (of + 4)
    return killed, of, math.sqrt(middle * (1 - middle) / (of + 4) * (1 - len(rows) / every))


def line_of(name, every, rows):
    verdicts, (killed, of, error) = collections.Counter(row["verdict"] for row in rows), share(every, rows)
    return [name, every, len(rows), *(verdicts[word] for word in ("uncompiled", "same", "killed", "survived")),
            *((f"{100 * killed / of:.1f}", f"{200 * error:.1f}") if of else ("-", "-"))]


def sum_line(folders):
    """Each folder counts by the mutants that it has, whatever part of them was drawn."""
    drawn = [(every / len(rows), *share(every, rows)) for every, rows in folders if rows]
    of = sum(weight * judged_ for weight, _, judged_, _ in drawn)
    killed = sum(weight * killed for weight, killed, _, _ in drawn)
    error = math.sqrt(sum((weight * judged_ * error) ** 2 for weight, _, judged_, error in drawn))
    counts = line_of("lib, firmware, hal", sum(every for every, _ in folders), [row for _, rows in folders for row in rows])
    return [*counts[:-2], *((f"{100 * killed / of:.1f}", f"{200 * error / of:.1f}") if of else ("-", "-"))]


def tables(mutants, rows, folder_of, why):
    """The page's tables, as lines."""
    folders = judged(mutants, rows, folder_of)
    lines = [line_of(folder, *found) for folder, found in folders.items()]
    lines.append(sum_line([found for folder, found in folders.items() if folder.startswith(GOAL_OF)]))
    survivors = sorted((row for _, found in folders.values() for row in found if row["verdict"] == "survived"),
                       key=lambda row: (row["file"], row["line"], row["key"]))
    listed = [[f"`{row['file']}:{row['line']}`", f"`{row['function']}`", row["operator"], f"`{change_of(row)}`", why.get(row["key"])]
              for row in survivors]
    head = ["folder", "mutants", "drawn", "not compiled", "same code", "killed", "survived", "killed, %", "±"]
    return [*table("Each folder", OF_FOLDERS, head, [[name, *map(str, cells)] for name, *cells in lines]),
            *table("Survivors", OF_SURVIVORS, ["where", "function", "operator", "change", "why it changes nothing"], listed)]


def change_of(row):
    """A mutant's key without file, function and operator; a bar would end the cell."""
    return row["key"].partition(f" {row['operator']} ")[2].replace("|", "\\|")


def write(lines, sources):
    PAGE.write(lines, sources)
