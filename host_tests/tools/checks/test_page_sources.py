"""Pages of measurements: which hash says that one is stale, what check_pages says of it, of a wrong table or page; who writes a hash."""
import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import misspelt  # noqa: E402
import page_sources  # noqa: E402
import results

from system_support import refused, run_all, test

CHECKS = pathlib.Path("checks").resolve()
SOURCE = '#include "b.h"\n/* a gain */\nint f(int a) { return a * 3; } // "3"\n'
TABLE = ("# pages\n@lib\n    lib/*.[ch]\n\ndocs/results/p.md | make p | never\n    @lib tools/p.py\n"
         "docs/typed.md | make q | every commit\n    tools/p.py\n")
PAGE = "# Pages\nWritten by `make p`; do not edit it.\n<!-- sources: none -->\n\nWhat.\n\n1\n"
FILES = {"checks/pages.txt": TABLE, "tools/p.py": "print(1)  # one\n", "lib/a.c": SOURCE, "lib/b.h": "int f(int a);\n", "docs/results/p.md": PAGE,
         "docs/typed.md": "Typed: 1\n", "mk/pythonpath": "tools\n"}


def put(name, text):
    path = pathlib.Path(name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


class Tree:
    """A tree of its own as the current folder, whose two pages are fresh."""

    def __enter__(self):
        self.before, self.folder = os.getcwd(), tempfile.TemporaryDirectory()
        os.chdir(self.folder.name)
        for name, text in FILES.items():
            put(name, text)
        for name in page_sources.table():
            page_sources.write_hash(name, page_sources.hash_now(name))
        return self

    def __exit__(self, *_):
        os.chdir(self.before)
        self.folder.cleanup()


def said(*words, program="check_pages.py"):
    done = subprocess.run([sys.executable, CHECKS / program, *words], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


@test
def comments_line_ends_of_c_and_folders_change_no_hash():
    own = page_sources.digest({"lib/a.c": SOURCE.encode(), "tools/p.py": b'"""p"""\nif a:\n    b("#")  # c\n'})
    for a, python in ((SOURCE.replace("a gain", "a factor"), '"""q"""\n\nif a:\n    b("#")\n'), (SOURCE.replace("{ return", "{\n    return"), None)):
        python = (python or '"""p"""\nif a:\n    b("#")  # c\n').encode()
        assert page_sources.digest({"lib/room/a.c": a.encode(), "tools/p.py": python}) == own, a
    for a, python in ((SOURCE.replace("a * 3", "a * 4"), 'if a:\n    b("#")\n'), (SOURCE, 'if a:\n    b("$")\n'), (SOURCE, 'if a:\n  c\nb("#")\n')):
        assert page_sources.digest({"lib/a.c": a.encode(), "tools/p.py": python.encode()}) != own, (a, python)
    assert page_sources.digest({"s.csv": b"# 1\n"}) != page_sources.digest({"s.csv": b"# 2\n"})


@test
def a_stale_page_is_skipped_and_fails_where_it_is_strict():
    with Tree():
        assert said() == (0, "pages: 2 of 2 measured on the sources as they are\nskipped: 0 (stale pages, at which make nightly fails)\n")
        assert said("--strict")[0] == 0
        put("lib/a.c", SOURCE.replace("3;", "4;"))
        status, text = said()
        assert status == 0 and "skipped: 1 (" in text, text
        assert "stale: docs/results/p.md: make p measures it again (in CI: never); its sources have changed\n" in text, text
        status, text = said("--strict")
        assert status == 1 and text.endswith("1 passed, 1 failed\n"), text
        page_sources.write_hash("docs/typed.md", page_sources.NONE)
        assert "stale: docs/typed.md: make q measures it again (in CI: every commit); never measured as a whole" in said()[1]


@test
def git_says_which_sources_have_changed_since():
    with Tree():
        for words in (["init", "-q"], ["add", "."], ["-c", "user.name=t", "-c", "user.email=t@t", "commit", "-qm", "measured"]):
            subprocess.run(["git", *words], check=True)
        put("lib/a.c", "/* new */ " + SOURCE)
        put("lib/b.h", "int f(int a), g;\n")
        put("lib/c.c", "int g;\n")
        assert "; changed since: lib/b.h lib/c.c\n" in said()[1], said()[1]


@test
def what_is_wrong_with_table_or_page_is_a_finding():
    for name, old, new, words in (
            ("checks/pages.txt", "lib/*.[ch]", "lib/*.z", "checks/pages.txt: lib/*.z: there is no such file"),
            ("checks/pages.txt", "    tools/p.py\n", "    tools/gone.py\n", "checks/pages.txt: tools/gone.py: there is no such file"),
            ("checks/pages.txt", "docs/typed.md", "docs/gone.md", "No such file or directory: 'docs/gone.md'"),
            ("checks/pages.txt", "docs/results/p.md", "docs/typed.md", "checks/pages.txt:7: docs/typed.md stands there twice"),
            ("checks/pages.txt", " | never", "", "checks/pages.txt:5: a line is PAGE | COMMAND | CI, or @SET"),
            ("checks/pages.txt", "    @lib", "    @libs", "checks/pages.txt:6: @libs is no set above"),
            ("checks/pages.txt", "@lib\n", "", "checks/pages.txt:2: files of no page"),
            ("checks/pages.txt", "make p", "make r", "docs/results/p.md is written by make p, which is not its row"),
            ("checks/pages.txt", "lib/*.[ch]", "lib/a.c", "docs/results/p.md depends on lib/b.h too, which lib/a.c names"),
            ("checks/pages.txt", "lib/*.[ch]", "lib/b.h lib/x.h", "docs/results/p.md depends on lib/x.c too, which lib/x.h names"),
            ("tools/p.py", "print", "import q\nprint", "docs/results/p.md depends on tools/q.py too, which tools/p.py names"),
            ("docs/new.md", "", PAGE, "docs/new.md is written by make p, which is not its row"),
            ("docs/new.md", "", "<!-- written by make p: begin -->\n", "docs/new.md is written by make p, which is not its row"),
            ("docs/results/new.md", "", "By hand.\n", "docs/results/new.md: no line 'Written by `make ...`'"),
            ("docs/results/p.md", "What.", "[a](../typed.md) [b](https://x.org) [c](gone.md)", "p.md: a link to gone.md, which leads nowhere"),
            ("docs/results/p.md", "What.", "[a](../typed.md#b)", "docs/results/p.md: a link to ../typed.md#b, which leads nowhere"),
            ("docs/results/p.md", "<!-- sources", "<!-- source", "docs/results/p.md: no line '<!-- sources: HASH -->'"),
            ("docs/results/p.md", "What.", "<!-- sources: none -->", "docs/results/p.md: two lines '<!-- sources: HASH -->'"),
            ("docs/results/p.md", "<!-- sources: ", "<!-- sources: x", " is no hash of sources")):
        with Tree():
            for extra in ("lib/x.h", "lib/x.c", "tools/q.py"):
                put(extra, "")
            for measured in page_sources.table():
                page_sources.write_hash(measured, page_sources.hash_now(measured))
            text = pathlib.Path(name).read_text(encoding="utf-8") if pathlib.Path(name).exists() else ""
            assert old in text, name
            put(name, text.replace(old, new, 1) if old else new)
            status, text = said()
            assert status != 0 and words in text and "Traceback" not in text, (words, text)
    assert said("--strickt") == (2, "check_pages.py: check_pages.py [--strict]\n")


@test
def the_command_that_measures_writes_the_hash():
    with Tree():
        put("lib/a.c", "int f;\n")
        written = results.Results(pathlib.Path("docs/results/p.md"), "Pages", "make p", "What.\n")
        written.write(["2"])
        text = written.held()
        assert text == PAGE.replace("1", "2").replace("none", page_sources.hash_now("docs/results/p.md")), text
        assert said("--strict")[0] == 0


@test
def what_does_not_come_out_again_is_named_and_a_title_that_stands_twice_is_refused():
    with Tree():
        page, said_of = results.Results(pathlib.Path("docs/results/p.md"), "Pages", "make p", "What."), io.StringIO()

        def lines(number):
            return results.table("Roll", "In degrees.", ["stream", "raw"], [["steps", number]])

        with contextlib.redirect_stdout(said_of), contextlib.redirect_stderr(said_of):
            assert [page.publish(lines("1")), page.publish(lines("1"), good=False), page.publish(lines("2"))] == [0, 1, 1]
        assert "p: Roll, steps, raw: 1 on the page, 2 in this run\n" in said_of.getvalue(), said_of.getvalue()
        assert page.check(lines("2")) == [] != page.check([*lines("2"), "More."])
        assert page.write([]) == ["Roll, steps, raw: 2 on the page, not there in this run"]
        refused(results.Fault, lambda: page.text(lines("1") + lines("2")), "docs/results/p.md: the title 'Roll' occurs 2 times")


@test
def a_person_writes_the_hash_only_of_a_page_that_no_command_writes():
    with Tree():
        put("tools/p.py", "print(2)\n")
        assert said("--stamp", "docs/typed.md", program="page_sources.py") == (0, "")
        assert page_sources.hash_in("docs/typed.md") == page_sources.hash_now("docs/typed.md") != page_sources.hash_in("docs/results/p.md")
        for words, answer in ((["docs/results/p.md"], "docs/results/p.md: make p measures it and writes its hash"),
                              (["docs/gone.md"], "No such file"), (["lib/a.c"], "lib/a.c: not in checks/pages.txt"),
                              ([], "page_sources.py --stamp PAGE")):
            status, text = said("--stamp", *words, program="page_sources.py")
            assert status == 1 and answer in text and "Traceback" not in text, text


@test
def the_table_says_what_ci_does():
    steps = pathlib.Path(".ci/run").read_text(encoding="utf-8")
    makefiles = "".join(path.read_text(encoding="utf-8") for path in misspelt.makefiles())
    for name, row in page_sources.table().items():
        target = row.command.removeprefix("make ")
        assert re.search(rf"^{target}:", makefiles, re.M), f"{name}: {row.command} is no target"
        run = re.search(rf"(?:step|counted) {target}( \w+=\d+)?$", steps, re.M)
        assert row.ci in (["never"] if not run else ["never", "every commit, in part"] if run[1] else ["every commit"]), f"{name}: {row.ci}"


if __name__ == "__main__":
    sys.exit(run_all())
