"""Pages of results, docs/results/*.md: written whole by the command that measures them, with the hash of its sources under the title. A number
that the committed page has otherwise is named."""
import hashlib
import pathlib
import subprocess
import textwrap

import page_sources
from page import no_title_twice

FOLDER = pathlib.Path("docs/results")
PICTURES = FOLDER / "pictures"
COLUMNS = 150
KEPT = pathlib.Path("build/pages")  # where there is no git: pages as they were before a command wrote them


def table(title, text, head, rows):
    """The lines of one table; text, if there is any, stands above it."""
    above = textwrap.wrap(text, COLUMNS, break_long_words=False, break_on_hyphens=False)
    return [f"## {title}", *above, "", f"| {' | '.join(head)} |", "|---" * len(head) + "|", *(f"| {' | '.join(row)} |" for row in rows), ""]


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


def digest(text):
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


class Results:
    """A page of docs/results: its title, the command that writes it, and what is measured."""

    def __init__(self, document, title, command, about):
        self.document = document
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
        """The committed page; without git, or where it is not committed, the one that lay there before this command wrote it."""
        text = self.held() if self.document.is_file() else ""
        try:
            done = subprocess.run(["git", "show", f"HEAD:./{self.document}"], capture_output=True, text=True, timeout=60)
            if done.returncode == 0:
                return done.stdout
        except FileNotFoundError:
            pass
        kept, written = self.kept()
        if kept.is_file() and written.is_file() and written.read_text(encoding="ascii") == digest(text):
            return kept.read_text(encoding="utf-8")
        return text

    def kept(self):
        return KEPT / self.document.name, KEPT / f"{self.document.name}.written"

    def write(self, lines, sources=None):
        """Writes the page with the hash of its sources, that of now or of when a long measurement began; what the page before had otherwise."""
        new, before = self.text(lines), self.before()
        if sources is None and str(self.document) in page_sources.table():
            sources = page_sources.hash_now(self.document)
        new = page_sources.with_hash(new, sources or page_sources.NONE)
        KEPT.mkdir(parents=True, exist_ok=True)
        kept, written = self.kept()
        kept.write_text(before, encoding="utf-8")
        written.write_text(digest(new), encoding="ascii")
        self.document.parent.mkdir(parents=True, exist_ok=True)
        beside = self.document.with_name(f"{self.document.name}.new")
        beside.write_text(new, encoding="utf-8")
        beside.replace(self.document)  # what ends the program meanwhile leaves the page before
        return differences(before, new)
