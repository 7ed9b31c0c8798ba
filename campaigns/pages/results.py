"""Pages of results, docs/results/*.md: written whole by the command that measures them, with the hash of its sources under the title. Numbers
that differ from the committed page are listed."""
import pathlib
import subprocess
import sys
import textwrap

import page_sources
from page_sources import Fault

FOLDER = pathlib.Path("docs/results")
PICTURES = FOLDER / "pictures"
COLUMNS = 150


def run_as_program(name, main):
    """Ends the program with main's status; 2 and one sentence where it cannot do its work."""
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        print(f"{name}: {problem}", file=sys.stderr)
        sys.exit(2)


def output_of(command, given=None, statuses=(0,)):
    """What a program prints."""
    command = [str(word) for word in command]
    try:
        done = subprocess.run(command, input=given, capture_output=True, text=True, timeout=1200)
    except FileNotFoundError as missing:
        why = " is not built: the make target of this page builds it" if "/" in command[0] else ": not found"
        raise Fault(command[0] + why) from missing
    if done.returncode not in statuses:
        raise Fault(f"{command[0]} gave status {done.returncode}: {(done.stderr or done.stdout).strip()}")
    return done.stdout


def markdown(head, rows):
    """The lines of a table; whole numbers with commas, None as an empty cell."""
    shown = [[f"{cell:,}" if isinstance(cell, int) else cell or "" for cell in row] for row in rows]
    return [f"| {' | '.join(head)} |", "|---" * len(head) + "|", *(f"| {' | '.join(row)} |" for row in shown)]


def table(title, text, head, rows):
    """A table under its title, below the text, if there is any."""
    above = textwrap.wrap(text, COLUMNS, break_long_words=False, break_on_hyphens=False)
    return [f"## {title}", *above, "", *markdown(head, rows), ""]


def cells(text):
    """(title, row, column, cell) of all tables of a page."""
    title, head = "", None
    for line in text.splitlines():
        parts = [part.strip() for part in line.strip().removeprefix("|").removesuffix("|").split("|")]
        if line.startswith("#"):
            title, head = line.lstrip("# "), None
        elif not line.startswith("|"):
            head = None
        elif head is None:
            head = parts
        elif not line.startswith("|---"):
            yield from ((title, parts[0], column, cell) for column, cell in zip(head[1:], parts[1:]))


def section(text, title):
    """The lines of a page under a heading, up to the next one."""
    return text.partition(f"\n## {title}\n")[2].partition("\n## ")[0].strip("\n").split("\n")


def numbers_of(text):
    """{title, row, column: cell} of a page."""
    return {f"{title}, {row}, {column}": cell for title, row, column, cell in cells(text)}


def differences(old, new):
    """Cells of an old page that a new one does not have or has otherwise, one sentence each."""
    before, after = numbers_of(old), numbers_of(new)
    return [f"{what}: {number} on the page, {after.get(what, 'not there')} in this run"
            for what, number in before.items() if after.get(what) != number]


def no_title_twice(document, lines):
    """Refuses two tables with one title: a number is identified by its table's title, so one of them would be lost."""
    titles = [line.lstrip("# ") for line in "\n".join(lines).splitlines() if line.startswith("#")]
    for title in titles:
        if titles.count(title) > 1:
            raise Fault(f"{document}: the title '{title}' occurs {titles.count(title)} times")


class Results:
    """A page of docs/results: its title, the command that writes it, and what is measured."""

    def __init__(self, document, title, command, about):
        self.document, self.command = document, command
        self.head = [f"# {title}", f"Written by `{command}`; do not edit it.", page_sources.line(page_sources.NONE), "", about.strip(), ""]

    def text(self, lines):
        """The page without the hash of its sources."""
        no_title_twice(self.document, lines)
        return "\n".join([*self.head, *lines]).rstrip("\n") + "\n"

    def held(self):
        return self.document.read_text(encoding="utf-8")

    def check(self, lines, held=None):
        """What of the page, or of another text of it, is not what these lines give; the hash does not count."""
        held, new = page_sources.with_hash(held or self.held(), page_sources.NONE), self.text(lines)
        faults = differences(held, new)
        if not faults and new != held:
            faults = ["its text or its tables differ from those of this run"]
        return [f"{self.document}: {fault}" for fault in faults]

    def before(self):
        """The committed page; where there is none, the one that lies there."""
        committed = page_sources.git("show", f"HEAD:./{self.document}").decode()
        return committed or (self.held() if self.document.is_file() else "")

    def write(self, lines, sources=None):
        """Writes the page with the hash of its sources, that of now or of when a long measurement began; what the page before had otherwise."""
        new, before = self.text(lines), self.before()
        if sources is None and str(self.document) in page_sources.table():
            sources = page_sources.hash_now(self.document)
        new = page_sources.with_hash(new, sources or page_sources.NONE)
        self.document.parent.mkdir(parents=True, exist_ok=True)
        beside = self.document.with_name(f"{self.document.name}.new")
        beside.write_text(new, encoding="utf-8")
        beside.replace(self.document)  # what ends the program meanwhile leaves the page before
        return differences(before, new)

    def publish(self, lines, pictures=(), good=True):
        """Writes the page and draws the pictures that show something else; names each number that did not come out again. The exit status, which
        is 1 too where the measurement was not good."""
        name, faults = self.command.removeprefix("make "), self.write(lines)
        drawn = sum(picture.draw_if_stale() for picture in pictures)
        for fault in faults:
            print(f"{name}: {fault}", file=sys.stderr)
        print(f"{name}: {self.document} written, {drawn} pictures drawn; {len(faults)} numbers of the page before did not come out again")
        passed = good and not faults
        print("1 passed, 0 failed" if passed else "0 passed, 1 failed")
        return 0 if passed else 1
