#!/usr/bin/env python3
"""Tests of mk/scripts/progress.py on a makefile made here: the count, what is passed on, the status, a dry run."""
import io
import os
import pathlib
import pty
import re
import subprocess
import sys
from types import SimpleNamespace
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import progress as tool  # noqa: E402
from system_support import OUT, run_all, test  # noqa: E402

FOLDER = OUT / "progress"
TOOL = pathlib.Path("mk/scripts/progress.py").resolve()
RULES = """all: one two three
one two:
\t@echo words of $@; touch $@
three: one
\t@echo 'one.c:1: error: no' >&2; STATUS
\t@touch three
"""


def ready(status="true"):
    FOLDER.mkdir(parents=True, exist_ok=True)
    for path in FOLDER.iterdir():
        path.unlink()
    (FOLDER / "Makefile").write_text(RULES.replace("STATUS", status), encoding="utf-8")


def progress(*words, **environment):
    return subprocess.run([sys.executable, TOOL, "make", *words], cwd=FOLDER, capture_output=True, text=True, timeout=600, check=False,
                          env={name: value for name, value in os.environ.items() if name != "MAKEFLAGS"} | environment)


@test
def steps_are_counted_and_only_the_commands_are_left_out():
    ready()
    done = progress("all")
    first, *lines = done.stdout.splitlines()
    assert done.returncode == 0 and re.fullmatch(r"building 1 of 3 \(\d+ s\): one", first), done
    *others, last = [line for line in lines if not line.startswith("building ")]
    assert others == ["words of one", "words of two"] and last.startswith("built 3 of 3 after "), done
    assert done.stderr == "one.c:1: error: no\n", done
    again = progress("all")
    assert (again.returncode, again.stdout, again.stderr) == (0, "", ""), again


@test
def a_log_has_a_line_every_few_seconds_and_more_seldom_where_nothing_is_new():
    said, now = io.StringIO(), [100.0]
    with mock.patch.object(tool, "time", SimpleNamespace(monotonic=lambda: now[0])):
        shown = tool.Progress(9, said)
        for now[0], target in ((100.0, "a"), (101.0, "b"), (104.9, "c"), (105.0, "d"), (109.0, None), (134.9, None), (135.0, None)):
            shown.step(target) if target else shown.show()
    assert said.getvalue() == "building 1 of 9 (0 s): a\nbuilding 4 of 9 (5 s): d\nbuilding 4 of 9 (35 s): d\n", said.getvalue()


@test
def a_failure_keeps_its_words_and_its_status():
    ready("false")
    done = progress("all")
    assert done.returncode == 2 and "one.c:1: error: no\n" in done.stderr and "Error 1" in done.stderr, done
    assert done.stdout.splitlines()[-1].startswith("building stopped at 3 of 3 after "), done
    wrong = progress("nothing")
    assert wrong.returncode == 2 and "No rule to make target 'nothing'" in wrong.stderr and wrong.stdout == "", wrong


@test
def a_dry_run_stays_one():
    ready()
    done = progress("-n", "all")
    assert done.returncode == 0 and not (FOLDER / "one").exists(), done
    done = progress("all", MAKEFLAGS="n")
    assert "touch one" in done.stdout and "building" not in done.stdout and not (FOLDER / "one").exists(), done


@test
def a_terminal_has_one_line_that_an_error_overwrites():
    ready("false")
    master, slave = pty.openpty()
    done = subprocess.run([sys.executable, TOOL, "make", "all"], cwd=FOLDER, stdout=slave, stderr=subprocess.PIPE, text=True, timeout=600,
                          check=False)
    os.close(slave)
    shown = os.read(master, 1 << 16).decode()
    os.close(master)
    assert done.returncode == 2 and re.search(r"\r\x1b\[Kbuilding 1 of 3 \(\d+ s\): one\r", shown) and "\nbuilding" not in shown, repr(shown)


@test
def it_wants_a_command():
    done = subprocess.run([sys.executable, TOOL], capture_output=True, text=True, timeout=600, check=False)
    assert (done.returncode, done.stderr) == (2, "progress.py: usage: progress.py make ARGUMENT...\n"), done


if __name__ == "__main__":
    sys.exit(run_all())
