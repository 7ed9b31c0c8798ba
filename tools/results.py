"""Pages of results, docs/results/NAME.md: the command that measures one writes it whole, title, command, hash of the sources, then its writer's text
and tables."""
from page import Page, digest, no_title_twice
import page_sources


class Results(Page):
    """A page without any text of a person's."""

    def __init__(self, document, command, title):
        super().__init__(document, f"<!-- written by {command} -->", "<!-- end -->")
        self.command, self.title = command, title

    def whole(self, lines, sources):
        """The page's text; sources: the hash of what was measured."""
        no_title_twice(self.document, lines)
        head = [f"# {self.title}", "", self.begin, f"<!-- sources: {sources} -->", f"`{self.command}` writes this page."]
        return "\n".join([*head, "", *lines]).rstrip("\n") + "\n"

    def text(self):
        """The page as it lies there; nothing where it was never written."""
        return self.document.read_text(encoding="utf-8") if self.document.is_file() else ""

    def cells(self, text):
        return super().cells(text + self.end)

    def section(self, text, title):
        """The lines under a heading of a page, up to the next one."""
        return text.partition(f"\n## {title}\n")[2].partition("\n## ")[0].strip("\n").split("\n")

    def write(self, lines, sources=None):
        """Writes the page; numbers that the page before has otherwise, a sentence each. sources: their hash when the measurement began."""
        if sources is None:
            sources = page_sources.hash_now(self.document) if str(self.document) in page_sources.table() else page_sources.NONE
        new, before = self.whole(lines, sources), self.before(self.text())
        kept, written = self.kept()
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(before, encoding="utf-8")
        written.write_text(digest(new), encoding="ascii")
        self.document.parent.mkdir(parents=True, exist_ok=True)
        beside = self.document.with_name(self.document.name + ".new")
        beside.write_text(new, encoding="utf-8")
        beside.replace(self.document)  # what ends the program meanwhile leaves the page before
        return self.differences(before, new)
