#!/usr/bin/env python3
"""Pages of measurements against their sources (checks/pages.txt): a stale page was measured on others than there are now. Stale pages are counted
as skipped; a page without a hash, one that the table does not have, a file that the table lacks, and a link between pages that leads nowhere are
findings.

    check_pages.py [--strict]     --strict: a stale page is a failure
"""
import pathlib
import re
import sys

import page_sources
from check_support import Stop, main, report
from page_sources import TABLE, WRITTEN, Fault

NAMED = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"(?:[^"\n]*/)?([^"/\n]+)"|^[ \t]*(?:from|import)[ \t]+\.?([\w.]+)', re.M)
LINK = re.compile(r"\]\(([^)\s:]+)\)")
IMPLEMENTED = (".c", ".cpp")
PRODUCT = ("lib", "firmware", "hal", "nav", "sim", "host_tests")
PAGES = ("docs", "second", "web", "wokwi", "tools", "checks", "campaigns", "mk")
# what writes a page, draws it, launches a program or says what is wrong with it makes no number
NO_NUMBER = {"page_sources.py", "results.py", "pictures.py", "page_benchmarks.py", "page_faults.py", "robust_pictures.py", "look.py", "launched.py",
             "port.py", "errors.py", "unity_line.py", "unity_report.py", "page_mutants.py"}
NIGHT = pathlib.Path("docs/results/nightly.md")  # of make nightly: a commit in each row
RESULTS = pathlib.Path("docs/results")
PYTHONPATH = pathlib.Path("mk/pythonpath")
COMMITS = 10  # of a page, searched for the one whose sources it was measured on
SHOWN = 4


def headers():
    """{name: [paths]} of the tree's headers."""
    found = {}
    for path in (path for folder in PRODUCT for path in sorted(pathlib.Path(folder).rglob("*.h*"))):
        found.setdefault(path.name, []).append(str(path))
    return found


def needed(path, data, known):
    """Lists of paths, of each of which a file needs one: what it includes or imports, and what implements a header."""
    path = pathlib.Path(path)
    if path.suffix in (".h", ".hpp"):
        yield from ([str(path.with_suffix(suffix))] for suffix in IMPLEMENTED if path.with_suffix(suffix).is_file())
    if path.suffix not in (".c", ".h", ".cpp", ".hpp", ".py"):
        return
    for header, module in NAMED.findall(data.decode("utf-8")):
        if header in known:
            yield known[header]
        if module:
            file = f"{module.replace('.', '/')}.py"
            places = {pathlib.Path(folder, file) for folder in [*PYTHONPATH.read_text(encoding="ascii").split(), path.parent]}
            yield from ([str(place)] for place in sorted(places) if place.is_file())


def missing(page, files, known):
    """Files that the table does not give a page, and that one of its files names."""
    absent = {}
    for path, data in files.items():
        for paths in needed(path, data, known):
            if not any(path in files for path in paths) and pathlib.Path(paths[0]).name not in NO_NUMBER:
                absent.setdefault(paths[0], path)
    return [f"{TABLE}: {page} depends on {path} too, which {namer} names" for path, namer in absent.items()]


def unlisted(rows):
    """Pages that a command writes and that the table does not have, or under another command; results that no command writes."""
    for path in sorted({*pathlib.Path("docs").rglob("*.md")} - {NIGHT}):
        commands = set(WRITTEN.findall(path.read_text(encoding="utf-8")))
        for command in commands:
            if str(path) not in rows or rows[str(path)].command != command:
                yield f"{TABLE}: {path} is written by {command}, which is not its row"
        if path.parent == RESULTS and not commands:
            yield f"{path}: no line 'Written by `make ...`'"


def anchors(page):
    """The headings of a page as GitHub links to them."""
    seen, found = {}, set()
    for heading in re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.M):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.add(f"{anchor}-{seen[anchor]}" if anchor in seen else anchor)
        seen[anchor] = seen.get(anchor, 0) + 1
    return found


def broken_links():
    """Links from one page of the tree to a file, or to a heading of a page, that is not there."""
    places = ("*.md", *(f"{folder}/**/*.md" for folder in (*PRODUCT, *PAGES)))
    for page in (page for place in places for page in sorted(pathlib.Path(".").glob(place))):
        for link in LINK.findall(page.read_text(encoding="utf-8")):
            name, _, anchor = link.partition("#")
            file = page.parent / name if name else page
            if not file.exists() or (anchor and file.suffix == ".md" and anchor not in anchors(file)):
                yield f"{page}: a link to {link}, which leads nowhere"


def changed(page, row, held, files):
    """Files that have changed since a page was measured, where git has the commit; None where it has not."""
    for commit in page_sources.git("log", f"-{COMMITS}", "--format=%h", "--", page).decode().split():
        old = page_sources.files_at(commit, row.globs)
        if page_sources.digest(old) == held:
            return [path for path in sorted({*files, *old}) if path not in files or path not in old
                    or page_sources.code(path, files[path]) != page_sources.code(path, old[path])]
    return None


def why(page, row, held, files):
    if held == page_sources.NONE:
        return "never measured as a whole"
    paths = changed(page, row, held, files)
    if not paths:
        return "its sources have changed"
    more = f" and {len(paths) - SHOWN} more" if len(paths) > SHOWN else ""
    return f"changed since: {' '.join(paths[:SHOWN])}{more}"


def judged(page, row, known):
    """(what is wrong with a page's row or line, the sentence about it when it is stale)."""
    try:
        files, held = page_sources.files_now(row.globs), page_sources.hash_in(page)
    except (Fault, OSError) as fault:
        return [str(fault)], ""
    stale = page_sources.digest(files) != held
    return missing(page, files, known), stale and f"{row.command} measures it again (in CI: {row.ci}); {why(page, row, held, files)}"


def check():
    strict = sys.argv[1:] == ["--strict"]
    if sys.argv[1:] and not strict:
        raise Stop("check_pages.py [--strict]")
    rows, known = page_sources.table(), headers()
    findings, fresh, stale = [*unlisted(rows), *broken_links()], 0, 0
    for page, row in rows.items():
        faults, sentence = judged(page, row, known)
        findings += faults
        fresh, stale = fresh + (not faults and not sentence), stale + bool(sentence)
        if sentence:
            print(f"stale: {page}: {sentence}")
    status = report("pages", findings, f"{fresh} of {len(rows)} measured on the sources as they are")
    if strict:
        print(f"{fresh} passed, {stale + len(findings)} failed")
        return 1 if stale else status
    print(f"skipped: {stale} (stale pages, at which make nightly fails)")
    return status


if __name__ == "__main__":
    try:
        main(check)
    except Fault as fault:
        sys.exit(f"check_pages.py: {fault}")
