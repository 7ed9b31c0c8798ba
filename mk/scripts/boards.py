"""The boards that BOARD= of make names: mk/boards.txt, one a line."""
import dataclasses
import pathlib

FILE = pathlib.Path(__file__).resolve().parents[1] / "boards.txt"


@dataclasses.dataclass(frozen=True)
class Board:
    name: str
    baud: int      # of its boot loader
    flash: int     # bytes that the boot loader leaves
    clock_hz: int
    folder: str    # of its image, in build/
    what: str      # with its article


def board(line):
    name, baud, flash, clock_hz, folder, what = line.split(maxsplit=5)
    return Board(name, int(baud), int(flash), int(clock_hz), folder, what)


TABLE = {each.name: each for each in map(board, (line for line in FILE.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"))}
