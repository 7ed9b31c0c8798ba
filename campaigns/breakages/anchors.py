"""Lists of breakages and planted faults, and how one finds its place in the code.

A list holds paragraphs of three lines or more, `#` begins a comment:

    NAME
        PLACE | JUDGE, JUDGE
        OLD => NEW

PLACE is FILE:DEFINITION, FILE or DEFINITION: a path or its end, and the name of a function, macro, table or enumerator. The file may be
left out where one file of lib, firmware and hal alone defines the name, so that a file may move. OLD is compared token by token (white
space and comments count for nothing) and must occur exactly once in the definition, or in the file; `...` in it stands for any tokens
of a piece of a statement, and a `...` in NEW for the same ones. NEW may be empty. Several lines OLD => NEW are done one after another.
Instead of them lines `| TEXT` make a new file (`| TEXT [N]`: N such lines, {} being the number)."""
import dataclasses
import functools
import pathlib
import re

PRODUCT = ("lib", "firmware", "nav/lib", "nav/image", "hal")
TOKEN = re.compile(r"""/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|[A-Za-z_]\w*|\d[\w.]*|\.\.\.|<<=|>>=|->|\+\+|--|<<|>>"""
                   r"""|[<>=!+\-*/%&|^]=|&&|\|\||\S""", re.S)
OPEN, CLOSE = "([{", ")]}"


class Lost(Exception):
    """A breakage without its place: where, and why."""


@dataclasses.dataclass
class Entry:
    name: str
    place: str
    judges: list  # of text: a judge's name and the words that choose among its tests
    edits: list  # of (old, new)
    says: dict  # judge -> regular expressions, each of which a line of its findings must hold
    silent: dict  # judge -> regular expressions that none may hold
    new: str = ""  # a whole file

    def __str__(self):
        return f"'{self.name}' ({self.place})"


def lists(path):
    """A list and its further parts beside it, breakages_NAME.txt of breakages.txt."""
    return [path, *sorted(path.parent.glob(f"{path.stem}_*{path.suffix}"))]


def load(path):
    """The entries of a list and its parts."""
    entries = []
    for part in lists(path):
        paragraphs = re.split(r"\n\s*\n", re.sub(r"^#.*\n?", "", part.read_text(encoding="utf-8"), flags=re.M).strip("\n"))
        entries += [entry_of(paragraph.rstrip("\n").split("\n"), part) for paragraph in paragraphs if paragraph.strip()]
    names = [entry.name for entry in entries]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise SystemExit(f"{path}: two entries are called '{twice[0]}': give one another name")
    return entries


def entry_of(lines, path):
    if len(lines) < 3 or lines[0][:1].isspace() or lines[1].count(" | ") != 1 or not lines[1][:1].isspace():
        raise SystemExit(f"{path}: '{lines[0].strip()}': an entry is NAME, then indented PLACE | JUDGES, then OLD => NEW (or | TEXT)")
    place, judges = lines[1].strip().split(" | ")
    entry = Entry(lines[0], place, [judge.strip() for judge in judges.split(",")], [], {}, {})
    for line in lines[2:]:
        says = re.fullmatch(r"\s+(\w+) (says|does not say): (\S.*)", line)
        if says:
            (entry.says if says[2] == "says" else entry.silent).setdefault(says[1], []).append(says[3])
        elif " =>" in line:
            old, _, new = line.strip().partition(" =>")
            entry.edits.append((old.strip(), new.strip()))
        elif line.lstrip().startswith("| ") or line.strip() == "|":
            entry.new += grown(line.lstrip()[2:])
        else:
            raise SystemExit(f"{path}: {entry}: '{line.strip()}' is neither OLD => NEW nor | TEXT nor CHECK says: WORDS")
    if bool(entry.edits) == bool(entry.new):
        raise SystemExit(f"{path}: {entry}: either lines OLD => NEW or lines | TEXT")
    return entry


def grown(text):
    """A line, or N of it."""
    times = re.search(r" \[(\d+)\]$", text)
    return "".join(text[:times.start()].replace("{}", str(i)) + "\n" for i in range(int(times[1]))) if times else text + "\n"


def tokens(text):
    """[(token, where it begins, where it ends)] without comments."""
    return [(m[0], m.start(), m.end()) for m in TOKEN.finditer(text) if not m[0].startswith(("/*", "//"))]


def definitions(text, name):
    """[(begin, end)] of every definition of a name: functions (and handlers by their vector), macros, tables and enumerators."""
    word = re.escape(name)
    found = []
    for m in re.finditer(rf"^(?![ \t#{{}}/*])(?:[^;{{}}\n]|\n(?!\n))*?\b{word}\b[^;{{}}]*^\{{", text, re.M):
        end = re.compile(r"^\}", re.M).search(text, m.end())
        if end:
            found.append((m.end() - 1, end.end()))
    found += [m.span() for m in re.finditer(rf"^#\s*define\s+{word}\b(?:[^\n\\]|\\.)*(?:\\\n[^\n]*)*", text, re.M)]
    found += [m.span(1) for m in re.finditer(rf"^[^\n;(){{}}#]*\b{word}\[[^=;]*=\s*(\{{.*?^\}};|\{{[^\n]*\}};)", text, re.M | re.S)]
    found += [m.span(1) for m in re.finditer(rf"^[^\n;(]*\b{word}\s*(=\s*[^,;}}\n]+)[,}}\n]", text, re.M)] if name.isupper() else []
    return found


@functools.lru_cache(maxsize=None)
def product_text():
    """{path: text} of the product's sources."""
    paths = sorted(p for folder in PRODUCT for p in pathlib.Path(folder).rglob("*") if p.suffix in (".c", ".h", ".ino"))
    return {str(path): path.read_text(encoding="utf-8") for path in paths}


def spans(place, texts):
    """(path, text, [(begin, end)]) of a place among {path: text}."""
    file, _, name = place.rpartition(":") if "." not in place.rpartition(":")[2] else (place, "", "")
    near = {path: text for path, text in texts.items() if not file or path == file or path.endswith("/" + file)}
    if not near:
        raise Lost(f"there is no file {file}")
    if not name:
        homes = {path: [(0, len(text))] for path, text in near.items()}
    else:
        homes = {path: definitions(text, name) for path, text in near.items() if name in text}
        homes = {path: found for path, found in homes.items() if found}
    if len(homes) != 1:
        raise Lost(f"{name or file} is defined in {len(homes)} files, not in one: {' '.join(homes)}".rstrip(": "))
    path, found = homes.popitem()
    return path, near[path], found


def match(wanted, have, at):
    """The pieces that `...` stands for, and the end, if the wanted tokens stand there; else None."""
    if not wanted:
        return [], at
    if wanted[0] != "...":
        return match(wanted[1:], have, at + 1) if at < len(have) and have[at][0] == wanted[0] else None
    depth = 0
    for end in range(at, len(have) + 1):
        rest = match(wanted[1:], have, end) if depth == 0 else None
        if rest:
            return [(at, end), *rest[0]], rest[1]
        if end == len(have) or (have[end][0] == ";" and depth == 0):
            return None
        depth += (have[end][0] in OPEN) - (have[end][0] in CLOSE)
        if depth < 0:
            return None
    return None


def matches(old, text, found):
    """[(begin, end, pieces of text for `...`)] of a text to break within the spans."""
    wanted = [token for token, _, _ in tokens(old)]
    hits = []
    for begin, end in found:
        have = tokens(text[begin:end])
        for at, token in enumerate(have):
            hit = match(wanted, have, at) if token[0] == wanted[0] or wanted[0] == "..." else None
            if hit:
                pieces = [text[begin + have[a][1]:begin + have[b - 1][2]] if b > a else "" for a, b in hit[0]]
                hits.append((begin + token[1], begin + have[hit[1] - 1][2], pieces))
    return hits


def broken(entry, texts=None):
    """(path, its broken text); Lost when a text to break does not occur exactly once."""
    path, text, found = spans(entry.place, product_text() if texts is None else texts)
    for old, new in entry.edits:
        hits = matches(old, text, found)
        if len(hits) != 1:
            raise Lost(f"`{old}` occurs {len(hits)} times in {entry.place.rpartition(':')[2]} of {path}, not once")
        begin, end, pieces = hits[0]
        for piece in pieces if "..." in new else []:
            new = new.replace("...", piece, 1)
        before, text = text, text[:begin] + new + text[end:]
        grew = len(text) - len(before)
        found = [(a + (grew if a > begin else 0), b + (grew if b >= end else 0)) for a, b in found]
    return path, text
