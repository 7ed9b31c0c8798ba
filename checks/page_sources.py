#!/usr/bin/env python3
"""The files that the numbers of a page depend on (checks/pages.txt), and the line of the page that holds their hash: the command that measures
a page writes it, so a page whose line is not today's hash was measured on other sources.

    page_sources.py                  the hash of each page's sources as they are
    page_sources.py --stamp PAGE     puts it into a page whose numbers are typed in, once all of them have been measured again
"""
import hashlib
import io
import pathlib
import re
import subprocess
import sys
import tarfile
from typing import NamedTuple

import comments

TABLE = pathlib.Path("checks/pages.txt")
LINE = re.compile(r"^<!-- sources: (\w+) -->\n?", re.M)
HASH = re.compile(r"[0-9a-f]{12}")
NONE = "none"  # no commit is known on whose sources the page was measured
# the line of a page that a command writes whole, or in part
WRITTEN = re.compile(r"^(?:Written by `|<!-- (?:[\w ,]*written by|table:) )(make \w+)", re.M)
CODE = comments.C_LIKE | {".py", ".mk", ".sh", ""}


class Fault(Exception):
    """One sentence about what is wrong."""


class Row(NamedTuple):
    command: str
    ci: str
    globs: list


def table(path=None):
    """{page: Row}"""
    path, sets, rows, globs = path or TABLE, {}, {}, None
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if line.startswith(" "):
            strangers = [word for word in line.split() if word.startswith("@") and word not in sets]
            if globs is None or strangers:
                raise Fault(f"{path}:{number}: {strangers[0] + ' is no set above' if strangers else 'files of no page'}")
            for word in line.split():
                globs += sets.get(word, [word])
            continue
        cells, globs = [cell.strip() for cell in line.split("|")], []
        name = cells[0]
        if name in sets or name in rows:
            raise Fault(f"{path}:{number}: {name} stands there twice")
        if len(cells) == 1 and name.startswith("@"):
            sets[name] = globs
        elif len(cells) == 3 and all(cells):
            rows[name] = Row(cells[1], cells[2], globs)
        else:
            raise Fault(f"{path}:{number}: a line is PAGE | COMMAND | CI, or @SET")
    return rows


def row_of(page):
    rows = table()
    if str(page) not in rows:
        raise Fault(f"{page}: not in {TABLE}")
    return rows[str(page)]


def matches(path, glob):
    path, glob = pathlib.PurePath(path), pathlib.PurePath(glob)
    return len(path.parts) == len(glob.parts) and path.match(str(glob))


def files_now(globs):
    """{path: bytes}; each pattern must find something."""
    found = {}
    for glob in globs:
        paths = [path for path in pathlib.Path(".").glob(glob) if path.is_file()]
        if not paths:
            raise Fault(f"{TABLE}: {glob}: there is no such file")
        found.update({str(path): path.read_bytes() for path in paths})
    return found


def git(*words):
    """What git prints; nothing where there is no git or it does not know."""
    try:
        done = subprocess.run(["git", *words], capture_output=True, timeout=60, check=False)
    except FileNotFoundError:
        return b""
    return done.stdout if done.returncode == 0 else b""


def files_at(commit, globs):
    """{path: bytes} of a commit, whatever of it there was."""
    names = git("ls-tree", "-r", "--name-only", commit).decode().splitlines()
    wanted = [name for name in names if any(matches(name, glob) for glob in globs)]
    packed = git("archive", "--format=tar", commit, "--", *wanted) if wanted else b""
    if not packed:
        return {}
    with tarfile.open(fileobj=io.BytesIO(packed)) as tar:
        return {member.name: tar.extractfile(member).read() for member in tar if member.isfile()}


def code(path, data):
    """What of a file can change a number: no comment, and of C no line end."""
    suffix = pathlib.PurePath(path).suffix
    if suffix not in CODE:
        return data
    text = comments.without(data.decode("utf-8", "replace"), suffix)
    if suffix in comments.C_LIKE:
        return " ".join(text.split()).encode()
    return "\n".join(line.rstrip() for line in text.splitlines() if line.strip()).encode()


def digest(files):
    """Of {path: bytes}: a file that only moves to another folder changes nothing."""
    parts = sorted((pathlib.PurePath(path).name, hashlib.sha256(code(path, data)).hexdigest()) for path, data in files.items())
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:12]


def hash_now(page):
    return digest(files_now(row_of(page).globs))


def line(value):
    return f"<!-- sources: {value} -->"


def with_hash(text, value):
    """The page's text with this hash in its line, which stands at the end if it has none."""
    if LINE.search(text):
        return LINE.sub(line(value) + "\n", text)
    return text.rstrip("\n") + f"\n\n{line(value)}\n"


def write_hash(page, value):
    text = pathlib.Path(page).read_text(encoding="utf-8")
    pathlib.Path(page).write_text(with_hash(text, value), encoding="utf-8")


def hash_in(page):
    """The hash that a page holds."""
    found = LINE.findall(pathlib.Path(page).read_text(encoding="utf-8"))
    if len(found) != 1:
        raise Fault(f"{page}: {'two lines' if found else 'no line'} '<!-- sources: HASH -->'")
    if found[0] != NONE and not HASH.fullmatch(found[0]):
        raise Fault(f"{page}: '{found[0]}' is no hash of sources")
    return found[0]


def stamp(page):
    """For pages that nobody writes but a person."""
    writer = WRITTEN.search(pathlib.Path(page).read_text(encoding="utf-8"))
    if writer:
        raise Fault(f"{page}: {writer[1]} measures it and writes its hash")
    write_hash(page, hash_now(page))


def main(words):
    if len(words) == 2 and words[0] == "--stamp":
        stamp(words[1])
    elif words:
        raise Fault(__doc__.partition("\n\n")[2].rstrip())
    else:
        for page in table():
            print(f"{hash_now(page)}  {page}")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (Fault, OSError) as problem:
        sys.exit(f"page_sources: {problem}")
