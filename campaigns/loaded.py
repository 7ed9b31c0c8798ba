#!/usr/bin/env python3
"""loaded.py [--load 8] [--rounds 10] [--jobs 2] [TEST...]: runs the tests that use a browser, a serial port, a boot loader or a live process while
so many busy loops take the processors, again and again; prints each round, what failed with its reason, and `N passed, N failed`.

Each loop is a process of this program and ends with it, however that ends. The test programs must have been built (make test builds them).
"""
import argparse
import concurrent.futures
import contextlib
import ctypes
import os
import pathlib
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
os.chdir(ROOT)
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import run_tests  # noqa: E402

LIVE = ["test_resets", "test_flash", "test_plotter", "test_progress", "test_run_tests", "test_faults", "test_demo", "test_demo_page", "tilt_live",
        "tilt_live_direct", "tilt_board_played", "tilt_board_ports", "tilt_live_page", "tilt_live_parser", "tilt_live_rate", "tilt_nav_port",
        "tilt_plot", "tilt_record", "tilt_record_sent", "tilt_record_timing", "tilt_start", "system_tests:who_"]
DIE_WITH_PARENT = 1  # prctl's PR_SET_PDEATHSIG


def die_with_parent():
    ctypes.CDLL(None).prctl(DIE_WITH_PARENT, signal.SIGKILL)


@contextlib.contextmanager
def load(count):
    """So many busy loops, of the priority of everything else."""
    loops = []
    try:
        for _ in range(count):
            loops.append(subprocess.Popen([sys.executable, "-c", "while True: pass"], preexec_fn=die_with_parent))
        yield loops
    finally:
        for loop in loops:
            loop.kill()
        for loop in loops:
            loop.wait()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--load", type=int, default=8, metavar="N", help="busy loops (default 8)")
    parser.add_argument("--rounds", type=int, default=10, metavar="N", help="of all tests (default 10)")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="tests at a time (default 2, as make test)")
    parser.add_argument("tests", nargs="*", metavar="TEST",
                        help=f"as campaigns/tests/test_table.py names them, with :WORD those whose name has it (default: {' '.join(LIVE)})")
    options = parser.parse_args()
    if options.load < 0 or options.rounds < 1 or options.jobs < 1:
        parser.error("--load wants 0 or more, --rounds and --jobs 1 or more")
    return options


def command_of(test):
    name, _, word = test.partition(":")
    runs = run_tests.chosen([])
    if name not in runs:
        sys.exit(f"loaded.py: there is no test {name}; there are: {' '.join(runs)}")
    return [*runs[name], *([word] if word else [])]


def one_round(number, commands, jobs, total):
    """Adds passed and failed tests to the total as programs end, for a campaign may be ended within a round."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        names = {pool.submit(run_tests.run, f"loaded-{test.replace(':', '-')}", command): test for test, command in commands.items()}
        for job in concurrent.futures.as_completed(names):
            result = job.result()
            (tests, failures, ignored), line, why = run_tests.judged(result)
            print(f"round {number}: {names[job]:<24}{line:<42}{result.took_s:>4.0f} s", flush=True)
            print("".join(f"    {text}\n" for text in [*why, *run_tests.reasons(result.said, ":IGNORE")]), end="", flush=True)
            total["skipped"] += ignored
            total["passed"] += tests - failures - ignored
            total["failed"] += failures
            total["programs"] += 1


def main():
    options = arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    commands = {test: command_of(test) for test in options.tests or LIVE}
    run_tests.OUT.mkdir(parents=True, exist_ok=True)
    total = {"passed": 0, "failed": 0, "skipped": 0, "programs": 0}
    began = time.monotonic()
    try:
        with load(options.load):
            for number in range(1, options.rounds + 1):
                one_round(number, commands, options.jobs, total)
    finally:
        run_tests.RUNNING.end()
        rounds = total["programs"] / len(commands)
        print(f"loaded: {rounds:.4g} rounds of {len(commands)} programs under a load of {options.load} in {time.monotonic() - began:.0f} s")
        print(f"skipped: {total['skipped']} (each with its reason above: it proves nothing)")
        print(f"{total['passed']} passed, {total['failed']} failed", flush=True)
    sys.exit(total["failed"] != 0)


if __name__ == "__main__":
    main()
