#!/usr/bin/env python3
"""Tests of tools/run_tests.py: what a program says and how it ends, into one line and the sum."""
import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, "tools")
import run_tests  # noqa: E402
from system_support import run_all, test  # noqa: E402


def told(status, said):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        counts = run_tests.tell("it", status, said, 2.0)
    return counts, out.getvalue()


@test
def report_is_counted_and_shown_in_one_line():
    assert told(0, "a.c:1:x:PASS\n\n3 Tests 0 Failures 1 Ignored\nOK\n") == ((3, 0, 1), f"{'it':<28}{'3 Tests 0 Failures 1 Ignored':<42}   2 s\n")


@test
def failed_and_ignored_tests_are_named():
    counts, text = told(1, "a.c:1:x:FAIL: no\nb.c:2:y:IGNORE: absent\nc.c:3:z:PASS\n3 Tests 1 Failures 1 Ignored\nFAIL\n")
    assert counts == (3, 1, 1) and "    a.c:1:x:FAIL: no\n" in text and "    b.c:2:y:IGNORE: absent\n" in text and "z:PASS" not in text


@test
def program_that_ends_without_a_report_is_one_failure():
    counts, text = told(-11, "a.c:1:x:PASS\n")
    assert counts == (1, 1, 0) and "crashed (status -11)" in text and "a.c:1:x:PASS" in text


@test
def good_report_with_a_bad_end_is_one_failure_more():
    """What a sanitizer finds after the last test."""
    counts, text = told(1, "3 Tests 0 Failures 0 Ignored\nOK\nLeakSanitizer: 8 bytes\n")
    assert counts == (4, 1, 0) and "ended with status 1" in text and "LeakSanitizer" in text


@test
def failures_in_the_report_are_not_counted_twice():
    assert told(2, "3 Tests 2 Failures 0 Ignored\n")[0] == (3, 2, 0)


@test
def program_that_is_not_there_is_a_failure_that_names_it():
    with tempfile.TemporaryDirectory() as folder:
        run_tests.OUT = pathlib.Path(folder)
        status, said, _ = run_tests.run("it", [f"{folder}/nothing"])
    assert told(status, said)[0] == (1, 1, 0) and "nothing: No such file" in said


@test
def what_is_left_out_must_be_a_test():
    done = subprocess.run([sys.executable, "tools/run_tests.py"], env={**os.environ, "LEAVE_OUT": "test_design nothing"}, capture_output=True,
                          text=True, timeout=60, check=False)
    assert done.returncode == 1 and done.stderr == "run_tests: LEAVE_OUT names what is no test: nothing\n" and not done.stdout, done


@test
def every_test_of_the_tools_is_in_the_list():
    """But those of make check and make piocheck."""
    here = {path.stem for path in pathlib.Path("host_tests").glob("test_*.py")}
    assert here - {"test_planted", "test_platformio"} == {*run_tests.PLAIN, *run_tests.WITH_NUMPY}
    assert set(run_tests.FIRST) <= {"system_tests", "bitexact"} | here | {name for name in run_tests.FIRST if name.startswith("chip_")} | {
        path.stem for path in pathlib.Path("host_tests").glob("test_*.c")}


if __name__ == "__main__":
    sys.exit(run_all())
