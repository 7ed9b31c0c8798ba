"""Pages that commands write: docs/recordings.md's text holds what its tables hold; what does not come out again is named, every time. And the
list of what make proof does not prove."""
import contextlib
import io
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import PLAIN, ROBUST  # noqa: E402
import page
import page_sources
import proof
import recordings

from system_support import run_all, test

OUT = pathlib.Path("build/pages-test")
COUNTS = "1000,20,1,0,30,0,900,0,0.5,0,0,0.0"


def told(status=0, gated_farthest="12.0"):
    """The rows of host_tests/tools/campaigns/recordings.c for one recording and two filters."""
    lines = ["stream,walk,100.0,16,100.0,1000,0,0,0,0"]
    for kind, farthest in ((PLAIN, "3.0"), (ROBUST, gated_farthest)):
        for axis in "xyz":
            lines.append(f"filter,walk,{kind},{axis},{COUNTS},10,{farthest}")
            lines.append(f"rest,walk,0,{kind},{axis},{COUNTS},0,0.0")
        for pool in ("at rest", "moving"):
            lines.append(f"fault,{pool},bad reads 1e-3,{kind},0.001,1.500,2.500,1.500,2.500,1.500")
    lines += [f"tails,walk,0,{axis},1000,2.00,0.01,0.001" for axis in "xyz"]
    program = OUT / "program.sh"
    said = "echo 'recordings: walk: cannot open' >&2\n" if status == recordings.SAID else ""
    program.write_text(f"#!/bin/sh\n{said}cat <<'END'\n" + "\n".join(lines) + f"\nEND\nexit {status}\n", encoding="ascii")
    program.chmod(0o755)
    return str(program.resolve())


def run_of(**arguments):
    """(status, what it prints) of make recordings' command with that program and a page of its own."""
    recordings.PROGRAM = told(**arguments)
    text = io.StringIO()
    with contextlib.redirect_stderr(text), contextlib.redirect_stdout(text):
        try:
            status = recordings.main()
        except SystemExit as end:
            status = end.code
    return status, text.getvalue()


@contextlib.contextmanager
def own_page():
    OUT.mkdir(parents=True, exist_ok=True)
    kept = recordings.DOCUMENT, recordings.PAGE, recordings.CSV, recordings.PROGRAM, page.KEPT
    recordings.DOCUMENT, recordings.CSV, page.KEPT = OUT.resolve() / "page.md", OUT / "rows.csv", OUT / "kept"
    recordings.PAGE = page.Page(recordings.DOCUMENT, recordings.BEGIN, recordings.END)
    text = f"At most <!--=farthest {ROBUST}-->0<!--.--> LSB.\n{recordings.BEGIN}\n{recordings.END}\n"
    recordings.DOCUMENT.write_text(text, encoding="utf-8")
    for path in page.KEPT.glob("*"):
        path.unlink()
    try:
        yield recordings.DOCUMENT
    finally:
        recordings.DOCUMENT, recordings.PAGE, recordings.CSV, recordings.PROGRAM, page.KEPT = kept


@test
def the_text_on_recordings_holds_what_its_tables_hold():
    text = recordings.DOCUMENT.read_text(encoding="utf-8")
    assert recordings.check(text) == [], recordings.check(text)
    assert len(page.INLINE.findall(text)) >= 25, "the guide tells hardly a number"


@test
def a_changed_number_of_the_text_or_of_a_table_is_found():
    text = recordings.DOCUMENT.read_text(encoding="utf-8")
    key, number = page.INLINE.findall(text)[0]
    found = recordings.check(text.replace(f"<!--={key}-->{number}<!--.-->", f"<!--={key}-->9{number}<!--.-->", 1))
    assert len(found) == 1 and key in found[0] and f"9{number} on the page" in found[0], found
    farthest = recordings.facts(text)[f"farthest {ROBUST}"]
    found = recordings.check(text.replace(f"; {farthest} |", "; 99999 |"))
    assert any(f"farthest {ROBUST}" in fault and "99999 in this run" in fault for fault in found), found


@test
def no_page_has_a_title_twice():
    for name in page_sources.table():
        text = pathlib.Path(name).read_text(encoding="utf-8")
        for part in re.findall(r"<!-- written by [^>]*begin -->\n(.*?)<!-- written by [^>]*end -->", text, re.S):
            page.no_title_twice(name, part.splitlines())
    # the twin: a doubled table is named and nothing is written
    lines = ["### Roll", "", "| a | b |", "|---|---|", "| x | 1 |", "", "### Roll", "", "| a | b |", "|---|---|", "| x | 2 |"]
    try:
        page.Page(pathlib.Path("docs/any.md"), "<!--b-->", "<!--e-->").filled("<!--b--><!--e-->", lines, {})
    except page.Fault as fault:
        assert str(fault) == "docs/any.md: the title 'Roll' occurs 2 times between the markers", fault
    else:
        raise AssertionError("a title twice was taken")


@test
def what_does_not_come_out_again_is_named_by_every_run():
    with own_page() as document:
        status, text = run_of()
        assert status == 1 and f"the text's 'farthest {ROBUST}': 0 on the page, 12 in this run" in text, text
        written = document.read_text(encoding="utf-8")
        document.write_text(written + "\n", encoding="utf-8")  # a page of its own, as if it had been shipped
        assert run_of()[0] == 0
        for _ in range(2):
            status, text = run_of(gated_farthest="34.0")
            assert status == 1 and "0 passed, 1 failed" in text, text
            for words in (f"walk, `{ROBUST}`: 1; 12 on the page, 1; 34 in this run", f"'farthest {ROBUST}': 12 on the page, 34 in this run"):
                assert words in text, text
        assert f"At most <!--=farthest {ROBUST}-->34<!--.--> LSB" in document.read_text(encoding="utf-8")


@test
def a_failure_is_told_once():
    with own_page() as document:
        before = document.read_text(encoding="utf-8")
        status, text = run_of(status=recordings.SAID)
        assert status == recordings.SAID and text == "" and document.read_text(encoding="utf-8") == before, text
        status, text = run_of(status=1)
        assert status == 1 and "an estimate left its bounds" in text, text


@test
def a_line_of_deliberate_that_stands_twice_is_refused():
    lines = (proof.HERE / "deliberate.txt").read_text(encoding="utf-8").splitlines()
    assert len(proof.deliberate()) == len(lines) - 1 >= 50
    OUT.mkdir(parents=True, exist_ok=True)
    kept, text = proof.HERE, io.StringIO()
    proof.HERE = OUT
    (OUT / "deliberate.txt").write_text("\n".join([*lines, lines[1].split("|")[0] + "|" + lines[1].split("|")[1] + "| otherwise"]) + "\n")
    try:
        with contextlib.redirect_stderr(text):
            proof.deliberate()
    except SystemExit:
        first = " | ".join(part.strip() for part in lines[1].split("|")[:2])
        assert f"deliberate.txt: {first} stands twice: strike one" in text.getvalue(), text.getvalue()
    else:
        raise AssertionError("a line twice was taken")
    finally:
        proof.HERE = kept


@test
def the_readme_tells_how_many_lines_are_not_proved():
    readme = pathlib.Path("README.md").read_text(encoding="utf-8")
    assert f"; {len(proof.deliberate())} meant or argued wraps" in readme, f"{len(proof.deliberate())} lines in {proof.HERE / 'deliberate.txt'}"


if __name__ == "__main__":
    raise SystemExit(run_all())
