#!/usr/bin/env python3
"""Tests of campaigns/tests/run_tests.py and of the reports it reads: what a program says and how it ends, into lines, reasons and the sum."""
import contextlib
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import run_tests  # noqa: E402
import system_support  # noqa: E402
import test_table  # noqa: E402
from run_tests import Result  # noqa: E402
from system_support import refused, run_all, test  # noqa: E402
from unity_report import failure  # noqa: E402


def shown(*results):
    """(the sum, what is printed) of programs it1, it2, ..."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        report = run_tests.Report(len(results))
        for number, result in enumerate(results, 1):
            report.add(f"it{number}", result)
        report.end()
    return tuple(report.total), out.getvalue()


def before_the_closing_line(text):
    """What stands between the list of failures and the end of a log."""
    return text.split("\nfailed:\n")[1]


@test
def report_is_counted_and_shown_in_one_line():
    counts, text = shown(Result(0, "a.c:1:x:PASS\n\n3 Tests 0 Failures 1 Ignored\nOK\n", 2.0, 1.5))
    assert counts == (3, 0, 1)
    assert text.splitlines() == [f"test 1 of 1: {'it1':<28}{'3 Tests 0 Failures 1 Ignored':<42}   2 s", "processor time 2 s, of which it1 2",
                                 "skipped: 1 (each with its reason above)", "2 passed, 0 failed"]


@test
def failed_and_ignored_tests_are_named():
    counts, text = shown(Result(1, "a.c:1:x:FAIL: no\nb.c:2:y:IGNORE: absent\nc.c:3:z:PASS\n3 Tests 1 Failures 1 Ignored\nFAIL\n"))
    assert counts == (3, 1, 1) and "    a.c:1:x:FAIL: no\n" in text and "    b.c:2:y:IGNORE: absent\n" in text and "z:PASS" not in text


@test
def each_reason_stands_again_above_the_closing_line():
    """With what another program said, and after all that ended later."""
    why = failure("t.py", "writes", "avrdude gave status 1:\navrdude: programmer is not responding\navrdude done.  Thank you.")
    _, text = shown(Result(1, f"{why}\nTraceback\n2 Tests 1 Failures 0 Ignored\n"), Result(-11, "a.c:1:x:PASS\nlast words\n"),
                    Result(0, "2 Tests 0 Failures 0 Ignored\n"))
    tail = before_the_closing_line(text)
    assert tail == ("  it1 (all it said: build/host/it1.log)\n    t.py:writes:FAIL: avrdude gave status 1:\n"
                    "      | avrdude: programmer is not responding\n      | avrdude done.  Thank you.\n"
                    "  it2 (all it said: build/host/it2.log)\n    ended with status -11; its last words:\n    a.c:1:x:PASS\n    last words\n"
                    "skipped: 0 (each with its reason above)\n3 passed, 2 failed\n"), tail
    assert text.count("programmer is not responding") == 2 and "Traceback" not in text, text


@test
def program_that_ends_without_a_report_is_one_failure():
    counts, text = shown(Result(-11, "a.c:1:x:PASS\n"))
    assert counts == (1, 1, 0) and "crashed (status -11)" in text and "a.c:1:x:PASS" in before_the_closing_line(text)


@test
def program_that_prints_nothing_or_runs_no_test_is_a_failure():
    counts, text = shown(Result(0, ""))
    assert counts == (1, 1, 0) and "it printed nothing" in before_the_closing_line(text) and text.endswith("0 passed, 1 failed\n")
    counts, text = shown(Result(0, "0 Tests 0 Failures 0 Ignored\nOK\n"))
    assert counts == (1, 1, 0) and "it ran no test" in before_the_closing_line(text)


@test
def good_report_with_a_bad_end_is_one_failure_more():
    """What a sanitizer finds after the last test; its first line is shown however long its trace is."""
    trace = "==7==ERROR: LeakSanitizer: 8 bytes\n" + "  #0 somewhere\n" * 40
    counts, text = shown(Result(1, f"3 Tests 0 Failures 0 Ignored\nOK\n{trace}"))
    assert counts == (4, 1, 0) and "ended with status 1" in text and text.count("#0") < 40, text
    assert "LeakSanitizer" in before_the_closing_line(text), text


@test
def failures_in_the_report_are_not_counted_twice():
    counts, text = shown(Result(2, "3 Tests 2 Failures 0 Ignored\n"))
    assert counts == (3, 2, 0) and "no reason given" in before_the_closing_line(text)


@test
def program_is_run_timed_and_logged():
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(run_tests, "OUT", pathlib.Path(folder)):
        done = run_tests.run("it", [sys.executable, "-c", "import sys, subprocess; print('seen', flush=True); sys.stderr.write('both\\n');"
                                    "subprocess.run([sys.executable, '-c', 'while __import__(\"time\").process_time() < 0.3: pass']); sys.exit(3)"])
        assert done.status == 3 and done.said == "seen\nboth\n" == (pathlib.Path(folder) / "it.log").read_text(encoding="utf-8"), done
        assert done.cpu_s >= 0.3 and done.took_s > 0, done  # of the program that it ran too
        done = run_tests.run("it", [sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"])
        assert done.status == -11, done


@test
def program_that_is_not_there_is_a_failure_that_names_it():
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(run_tests, "OUT", pathlib.Path(folder)):
        done = run_tests.run("it", [f"{folder}/nothing"])
    counts, text = shown(done)
    assert counts == (1, 1, 0) and "nothing: No such file" in before_the_closing_line(text)


@test
def what_took_longest_the_last_time_is_begun_first():
    runs = run_tests.shared({"quick": ["q"], "new": ["n"], "chip_new": ["python3", "c"], "long": ["l"], "system_tests": ["python3", "s"]})
    parts = [f"system_tests {number}of6" for number in range(1, 7)]
    assert runs[parts[0]] == ["python3", "s", "1of6"] and len(runs) == 10, runs
    times = {"quick": {"took_s": 0.5}, "long": {"took_s": 70.0}}
    assert run_tests.longest_first(runs, times) == ["long", *parts, "chip_new", "new", "quick"]
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(run_tests, "OUT", pathlib.Path(folder)):
        assert run_tests.times_of_last_run() == {}
        (pathlib.Path(folder) / run_tests.TIMES).write_text("{", encoding="utf-8")
        assert run_tests.times_of_last_run() == {}
        (pathlib.Path(folder) / run_tests.TIMES).write_text(json.dumps(times), encoding="utf-8")
        assert run_tests.times_of_last_run() == times


@test
def programs_that_wait_take_no_turn_of_those_that_compute():
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(run_tests, "OUT", pathlib.Path(folder)), \
            contextlib.redirect_stdout(io.StringIO()):
        wait = f"for i in $(seq 600); do [ -e {folder}/here ] && echo '1 Tests 0 Failures 0 Ignored' && exit 0; sleep 0.1; done; exit 1"
        runs = {"one": ["sh", "-c", wait], "other": ["sh", "-c", wait],
                min(run_tests.WAITING): ["sh", "-c", f"touch {folder}/here; echo '1 Tests 0 Failures 0 Ignored'"]}
        report = run_tests.Report(len(runs))
        run_tests.carried_out(runs, list(runs), report)
    assert report.total == [3, 0, 0], report.failed


@test
def an_interrupt_ends_all_that_runs():
    """What has begun, what begins meanwhile in the place of what has ended, and what was to begin later."""
    with tempfile.TemporaryDirectory() as folder, mock.patch.object(run_tests, "OUT", pathlib.Path(folder)), \
            mock.patch.object(run_tests, "RUNNING", run_tests.Running()):
        report = mock.Mock(**{"add.side_effect": KeyboardInterrupt})
        runs = {"short": ["true"], "long": ["sh", "-c", "sleep 600; true"], min(run_tests.WAITING): ["sleep", "600"],
                "next": ["sleep", "600"], "later": ["sleep", "600"]}
        began = time.monotonic()
        refused(KeyboardInterrupt, lambda: run_tests.carried_out(runs, list(runs), report), "")
        assert time.monotonic() - began < 300 and not run_tests.RUNNING.programs and not (pathlib.Path(folder) / "later.log").exists()


UNITTEST = '''
import pathlib, sys, unittest
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from unity_line import main
class Group(unittest.TestCase):
    def test_bad(self):
        self.assertEqual("one\\ntwo", "one\\nthree", "words of the page")
    def test_error(self):
        raise ValueError("what is wrong")
    def test_good(self):
        pass
    @unittest.skip("no browser here")
    def test_skipped(self):
        pass
main()
'''
PLAIN = '''
import pathlib, sys
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import run, run_all, test
import subprocess
@test
def compares():
    assert 1 + 1 == 3
@test
def calls():
    run("sh", "-c", "echo the reason >&2; exit 4")
@test
def waits():
    subprocess.run(["sh", "-c", "echo half >&2; exec sleep 60"], capture_output=True, timeout=0.5)
sys.exit(run_all())
'''


def reported(program):
    """What the log's tail says of a program of Python."""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=False)
    counts, text = shown(Result(done.returncode, done.stderr + done.stdout))
    return counts, before_the_closing_line(text)


@test
def unittests_give_names_and_reasons():
    counts, tail = reported(UNITTEST)
    assert counts == (4, 2, 1), counts
    assert "Group.test_bad:FAIL: AssertionError: 'one\\ntwo' != 'one\\nthree'\n" in tail and "words of the page" in tail, tail
    assert "Group.test_error:FAIL: ValueError: what is wrong\n" in tail, tail


@test
def tests_of_this_kind_give_names_reasons_and_the_words_of_others():
    counts, tail = reported(PLAIN)
    assert counts == (3, 3, 0), counts
    assert "compares:FAIL: AssertionError:" in tail and "calls:FAIL: sh gave status 4: the reason\n" in tail, tail
    assert "waits:FAIL: Command" in tail and "timed out" in tail and "      | half\n" in tail, tail


@test
def a_long_reason_loses_its_middle():
    text = failure("t.py", "x", "\n".join(f"line {number}" for number in range(100)))
    assert text.startswith("t.py:x:FAIL: line 0\n  | line 1\n") and text.endswith("\n  | line 99"), text
    assert "\n  | ... 79 lines left out ...\n" in text, text


def loops_of(parent):
    """The busy loops that a process has begun."""
    children = pathlib.Path(f"/proc/{parent}/task/{parent}/children").read_text(encoding="ascii").split()
    return [child for child in children if "while True" in word_of(child, "cmdline")]


def word_of(pid, file):
    """What /proc has of a process; empty when that is gone."""
    with contextlib.suppress(OSError):
        return pathlib.Path(f"/proc/{pid}/{file}").read_text(encoding="utf-8")
    return ""


def ends(pid):
    """Whether a process comes to its end, in a minute at most."""
    end = time.monotonic() + 60
    while word_of(pid, "stat").rpartition(") ")[2][:1] not in ("", "Z"):
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


@test
def loaded_rounds_count_failures_and_leave_no_loop_however_they_end():
    words = [sys.executable, "campaigns/loaded.py", "--load", "2", "--rounds", "1"]
    done = subprocess.run([*words, "system_tests:no_such_test"], capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 1 and "it ran no test" in done.stdout and done.stdout.endswith("0 passed, 1 failed\n"), done
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
        process = subprocess.Popen([*words, "test_progress"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while len(loops := loops_of(process.pid)) < 2:
            assert time.monotonic() < end and process.poll() is None, "no load"
        process.send_signal(number)
        process.wait(600)
        assert all(ends(loop) for loop in loops), number


@test
def every_test_of_the_tools_is_in_the_list():
    """But those of make check and make piocheck."""
    here = set(test_table.PROGRAMS)
    assert here - test_table.NOT_HERE == {pathlib.Path(each.command[1]).stem for each in test_table.SCRIPTS}
    others = {"system_tests", "bitexact", "exhaustive_isqrt"}
    known = {name for name in run_tests.LONG_S if not name.startswith(("chip_", "tilt_"))}
    assert known | set(run_tests.SHARES) <= others | here | set(test_table.sources(".c"))
    assert run_tests.WAITING <= set(test_table.table())


@test
def shares_hold_every_test_once():
    tests = [mock.Mock(__name__=name) for name in ("ab", "bc", "cd", "de", "abc", "x", "y")]
    for words in ([], ["b"], ["-b"], ["b", "x", "-c"]):
        parts = [system_support.chosen(tests, [*words, f"{number}of3"]) for number in (1, 2, 3)]
        assert sorted(map(id, sum(parts, []))) == sorted(map(id, system_support.chosen(tests, words))), (words, parts)
        assert max(map(len, parts)) - min(map(len, parts)) <= 1
    assert [each.__name__ for each in system_support.chosen(tests, ["b", "-c"])] == ["ab"]
    for word in ("0of6", "7of6", "1of0"):
        refused(SystemExit, lambda: system_support.chosen(tests, [word]), f"{word} is no share")


if __name__ == "__main__":
    sys.exit(run_all())
