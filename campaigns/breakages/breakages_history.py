"""How many product commits would have had to touch campaigns/breakages/breakages.txt, had it always existed as it is today (breakages.py --history).

Of each commit that touches lib, firmware or hal it is asked for which entries the text to break was there exactly once before, and no more
after it (`lost`; what the commit deletes counts), and for which the definition was there on both sides and the text only after (`new form`:
a list of that time would have quoted another text, or the commit wrote the code that the entry is about)."""
import subprocess

import anchors


def git(*words, data=None):
    return subprocess.run(["git", *words], input=data, capture_output=True, check=True).stdout


def product(commit):
    """{path: blob} of the product's sources in a commit."""
    rows = (row.split("\t") for row in git("ls-tree", "-r", commit, "--", *anchors.PRODUCT).decode().splitlines())
    return {path: head.split()[2] for head, path in rows if path.endswith((".c", ".h", ".ino"))}


class Blobs:
    """Texts of git, read once, and what is asked of them."""

    def __init__(self):
        self.text, self.found = {}, {}

    def hits(self, blob, entry):
        """None if the blob does not define the entry's name, else how often its first text is there."""
        if blob not in self.text:
            self.text[blob] = git("cat-file", "blob", blob).decode("utf-8", "replace")
        if (blob, entry.name) not in self.found:
            self.found[blob, entry.name] = self.look(self.text[blob], entry)
        return self.found[blob, entry.name]

    @staticmethod
    def look(text, entry):
        name = entry.place.rpartition(":")[2]
        file_alone = "." in name
        if not file_alone and name not in text:
            return None
        found = [(0, len(text))] if file_alone else anchors.definitions(text, name)
        return len(anchors.matches(entry.edits[0][0], text, found)) if found else None


def state(blobs, tree, entry):
    """'once', 'other' or 'absent'"""
    file = entry.place.rpartition(":")[0] or (entry.place if "." in entry.place else "")
    near = [blob for path, blob in tree.items() if not file or path == file or path.endswith("/" + file)]
    found = [hits for hits in (blobs.hits(blob, entry) for blob in near) if hits is not None]
    return "absent" if not found else "once" if found == [1] else "other"


def show(entries):
    commits = git("log", "--reverse", "--format=%H %h %s", "--", *anchors.PRODUCT).decode().splitlines()
    blobs, before, tree = Blobs(), {entry.name: "absent" for entry in entries}, {}
    touched = {"lost": 0, "new form": 0}
    for line in commits:
        commit, title = line.split(" ", 1)
        old, tree = tree, product(commit)
        changed = {p: b for p, b in {**old, **tree}.items() if old.get(p) != tree.get(p)}
        either = [b for p in changed for b in (old.get(p), tree.get(p)) if b]
        what = {"lost": [], "new form": []}
        for entry in entries:
            if not any(blobs.hits(blob, entry) is not None for blob in either):
                continue
            was, now = before[entry.name], state(blobs, tree, entry)
            before[entry.name] = now
            if was == "once" != now:
                what["lost"].append(entry.name)
            elif was == "other" and now == "once":
                what["new form"].append(entry.name)
        for kind, names in what.items():
            touched[kind] += bool(names)
            if names:
                print(f"{kind}: {title[:60]}: {'; '.join(names)}")
    for kind, count in touched.items():
        print(f"{kind}: {count} of {len(commits)} product commits, {100 * count / len(commits):.1f} %")
