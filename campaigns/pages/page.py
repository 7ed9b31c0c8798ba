"""Pages whose tables, and numbers in the text between <!--=KEY--> and <!--.-->, a command writes: filling them, and what no longer is so."""
import hashlib
import pathlib
import re
import subprocess
import sys

import page_sources
from page_sources import Fault

INLINE = re.compile(r"<!--=([^>]*?)-->([^<]*)<!--\.-->")
KEPT = pathlib.Path("build/pages")  # where there is no git: pages as they were before a command wrote them


def run_as_program(name, main):
    """Ends the program with main's status; 2 and one sentence where it cannot do its work."""
    try:
        sys.exit(main())
    except (Fault, OSError, subprocess.TimeoutExpired) as problem:
        print(f"{name}: {problem}", file=sys.stderr)
        sys.exit(2)


class Page:
    """A document with a begin and an end marker around its tables."""

    def __init__(self, document, begin, end):
        self.document, self.begin, self.end = document, begin, end

    def filled(self, text, lines, values):
        """The page's text with its tables and numbers put in."""
        if text.count(self.begin) != 1 or text.count(self.end) != 1:
            raise Fault(f"{self.document}: its markers are missing or doubled: '{self.begin}' and '{self.end}'")
        no_title_twice(self.document, lines)
        head, rest = text.split(self.begin)
        tail = rest.split(self.end)[1]

        def number(match):
            key = match[1].strip()
            if key not in values:
                raise Fault(f"{self.document}: no number is called '{key}'")
            return f"<!--={match[1]}-->{values[key]}<!--.-->"

        return INLINE.sub(number, head) + "\n".join([self.begin, *lines, self.end]) + INLINE.sub(number, tail)

    def inside(self, text):
        """The lines between the markers."""
        return text[text.index(self.begin) + len(self.begin):text.index(self.end)].strip("\n").split("\n")

    def cells(self, text):
        """(title, row, column, cell) of the tables between the markers."""
        title, head = "", None
        inside = text[text.index(self.begin):text.index(self.end)] if self.begin in text and self.end in text else ""
        for line in inside.splitlines():
            cells = [cell.strip() for cell in line.strip().removeprefix("|").removesuffix("|").split("|")]
            if line.startswith("#"):
                title, head = line.lstrip("# "), None
            elif line.startswith("|---") or not line.startswith("|"):
                continue
            elif head is None:
                head = cells
            else:
                yield from ((title, cells[0], column, cell) for column, cell in zip(head[1:], cells[1:]))

    def numbers_of(self, text):
        """{what: number} of a page: the cells of its tables by title, row and column, and the numbers in its text by line."""
        found = {f"{title}, {row}, {column}": cell for title, row, column, cell in self.cells(text)}
        found.update({f"the text's '{match[1].strip()}'": match[2] for match in INLINE.finditer(text)})
        return found

    def differences(self, old, new):
        """Numbers of an old page that a new one does not have or has otherwise, one sentence each."""
        before, now = self.numbers_of(old), self.numbers_of(new)
        return [f"{what}: {number} on the page, {now.get(what, 'not there')} in this run"
                for what, number in before.items() if now.get(what) != number]

    def before(self, text):
        """The committed page; without git, or where it is not committed, the one that lay there before this command wrote it."""
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

    def write(self, text, lines, values):
        """Fills and writes the page whose text this is, and the hash of its sources; what the page before had otherwise."""
        new, before = self.filled(text, lines, values), self.before(text)
        if str(self.document) in page_sources.table():
            new = page_sources.with_hash(new, page_sources.hash_now(self.document))
        KEPT.mkdir(parents=True, exist_ok=True)
        kept, written = self.kept()
        kept.write_text(before, encoding="utf-8")
        written.write_text(digest(new), encoding="ascii")
        self.document.write_text(new, encoding="utf-8")
        return self.differences(before, new)


def no_title_twice(document, lines):
    """Refuses tables of one title: a number is known by the title that it stands under, so one of them would be lost."""
    titles = [line.lstrip("# ") for line in "\n".join(lines).splitlines() if line.startswith("#")]
    for title in titles:
        if titles.count(title) > 1:
            raise Fault(f"{document}: the title '{title}' occurs {titles.count(title)} times")


def digest(text):
    return hashlib.sha256(text.encode("utf-8")).hexdigest()
