#!/usr/bin/env python3
"""run_tests.py [quick]: runs all tests of test_table.py, or the unit tests of the PC, two at a time, those that took longest the last time
first; beside them, one at a time, those that mostly wait for a browser or a port. Prints each as it ends, with what failed or was skipped and
why; at the end where the time went, all that failed once more, and the sum. The log of each is build/host/NAME.log, the times of the last run
build/host/times.json.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time
from dataclasses import dataclass

import test_table
from unity_report import MORE

OUT = pathlib.Path("build/host")
TIMES = "times.json"
SUM = re.compile(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", re.M)
SANITIZER = re.compile(r"runtime error: |^==\d+==ERROR: |^SUMMARY: ")
LIMIT_S = 3600   # by the clock, for one program: only one that hangs takes so long, on any machine
LAST_WORDS = 12  # lines of a program that ended without a report
SHOW_S = 30      # on a log, between two lines that say what runs
SLOWEST = 10
SHARES = {"system_tests": 6}  # tests that are run as so many programs, each with its share
# what a test is taken to need that has never run here, in seconds of a processor: of its kind, and of those that are known to need more
UNKNOWN_S = {"python": 5, "chip": 4, "program": 1}
LONG_S = {"bitexact": 75, "system_tests": 48, "test_papers": 33, "test_nav_image": 30, "test_design": 28, "test_resets": 27,
          "exhaustive_isqrt": 23, "test_design_command": 23, "test_demo_page": 40, "test_demo": 25,
          "test_compile_commands": 17, "test_design_refusals": 16, "test_papers_synthesis": 15,
          "test_recording_faults": 15, "tilt_replay": 15, "test_adaptive_reference": 11, "test_recordings": 10,
          "tilt_board_played": 30}
# they wait for most of their time, so they take no turn from those that compute
WAITING = {"test_demo", "test_demo_page", "test_flash", "tilt_board_played", "tilt_live_page", "tilt_start"}


@dataclass
class Result:
    """One program's end."""
    status: int
    said: str
    took_s: float = 0.0  # by the clock
    cpu_s: float = 0.0   # of a processor, its own programs counted in


# --- order ------------------------------------------------------------------------------------------------------------

def times_of_last_run():
    """name -> {"took_s", "cpu_s"}; none of what cannot be read."""
    try:
        return json.loads((OUT / TIMES).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def guess_s(name, command):
    kind = "chip" if name.startswith("chip_") else "python" if len(command) > 1 else "program"
    return LONG_S.get(name.partition(" ")[0], UNKNOWN_S[kind])


def longest_first(runs, times):
    return sorted(runs, key=lambda name: -times.get(name, {}).get("took_s", guess_s(name, runs[name])))


# --- one program ------------------------------------------------------------------------------------------------------

class Running:
    """What runs now, to be shown, and to be ended with this program."""

    def __init__(self):
        self.lock, self.programs, self.begun, self.ended = threading.Lock(), {}, {}, False

    def add(self, name, program):
        with self.lock:
            self.programs[name], self.begun[name] = program, time.monotonic()
            if self.ended:  # begun while the others were ended
                os.killpg(program.pid, signal.SIGTERM)

    def remove(self, name):
        with self.lock:
            del self.programs[name], self.begun[name]

    def words(self):
        with self.lock:
            return ", ".join(f"{name} ({time.monotonic() - begun:.0f} s)" for name, begun in self.begun.items())

    def end(self):
        """Each with the programs that it has started, and what is begun later."""
        with self.lock:
            self.ended = True
            for program in self.programs.values():
                os.killpg(program.pid, signal.SIGTERM)


RUNNING = Running()


def run(name, command):
    """The program's Result; its words are in a log too."""
    began = time.monotonic()
    log = OUT / f"{name.replace(' ', '_')}.log"
    try:
        with open(log, "wb") as file, subprocess.Popen([str(word) for word in command], stdout=file, stderr=subprocess.STDOUT,
                                                start_new_session=True) as program:
            limit = threading.Timer(LIMIT_S, os.killpg, (program.pid, signal.SIGKILL))
            limit.start()
            RUNNING.add(name, program)
            try:
                _, status, usage = os.wait4(program.pid, 0)
            finally:
                limit.cancel()
                RUNNING.remove(name)
            program.returncode = os.waitstatus_to_exitcode(status)
        said = log.read_text(encoding="utf-8", errors="replace")
        if time.monotonic() - began >= LIMIT_S:
            said += f"\nstopped: no end within {LIMIT_S / 60:g} minutes\n"
        return Result(program.returncode, said, time.monotonic() - began, usage.ru_utime + usage.ru_stime)
    except OSError as why:
        log.write_text(f"{command[0]}: {why.strerror}\n", encoding="utf-8")
        return Result(127, f"{command[0]}: {why.strerror}\n")


# --- what it said -----------------------------------------------------------------------------------------------------

def reasons(said, word):
    """The lines of a report with this word, each with the further lines of its reason."""
    found, inside = [], False
    for text in said.splitlines():
        inside = word in text or inside and text.startswith(MORE)
        if inside:
            found.append(text)
    return found


def last_words(said):
    """What a program that did not end well said last, and what a sanitizer had to say before."""
    lines = [line for line in said.splitlines() if line.strip()]
    early = [line for line in lines[:-LAST_WORDS] if SANITIZER.search(line)]
    return [*early, *lines[-LAST_WORDS:]] or ["it printed nothing"]


def judged(result):
    """((tests, failures, ignored), one line, reasons of failure): a program without a report, without a test or with a bad end is a failure."""
    sums = SUM.findall(result.said)
    line = f"{sums[-1][0]} Tests {sums[-1][1]} Failures {sums[-1][2]} Ignored" if sums else f"crashed (status {result.status})"
    tests, failures, ignored = (int(part) for part in sums[-1]) if sums else (0, 0, 0)
    why = reasons(result.said, ":FAIL")
    if failures and not why:
        why = ["no reason given; its last words:", *last_words(result.said)]
    if tests == 0 or (failures == 0 and result.status != 0):
        why += ["it ran no test"] if sums and tests == 0 else []
        why += [f"ended with status {result.status}; its last words:", *last_words(result.said)]
        tests, failures = tests + 1, failures + 1
    return (tests, failures, ignored), line, why


class Report:
    """What is printed, and the sum."""

    def __init__(self, count):
        self.count, self.ended, self.total, self.failed, self.times = count, 0, [0, 0, 0], [], {}
        self.live, self.shown = sys.stdout.isatty(), time.monotonic()

    def say(self, text):
        print(("\r\x1b[K" if self.live else "") + text, flush=True)

    def add(self, name, result):
        counts, line, why = judged(result)
        self.ended += 1
        self.total = [a + b for a, b in zip(self.total, counts)]
        self.times[name] = {"took_s": round(result.took_s, 2), "cpu_s": round(result.cpu_s, 2)}
        self.say(f"test {self.ended} of {self.count}: {name:<28}{line:<42}{result.took_s:>4.0f} s")
        for text in [*why, *reasons(result.said, ":IGNORE")]:
            self.say(f"    {text}")
        if why:
            self.failed.append((name, why))

    def still(self, words):
        """What runs: on a terminal in a line of its own, on a log now and then."""
        if self.live:
            sys.stdout.write(f"\r\x1b[Ktest {self.ended} of {self.count} done; running: {words}"[:150])
            sys.stdout.flush()
        elif time.monotonic() - self.shown > SHOW_S:
            self.shown = time.monotonic()
            self.say(f"running: {words}")

    def end(self):
        """The slowest, the failures again, skipped, and the line that counts."""
        cpu_s = sum(each["cpu_s"] for each in self.times.values())
        slowest = sorted(self.times, key=lambda name: -self.times[name]["cpu_s"])[:SLOWEST]
        self.say(f"processor time {cpu_s:.0f} s, of which " + ", ".join(f"{name} {self.times[name]['cpu_s']:.0f}" for name in slowest))
        if self.failed:
            self.say("failed:")
        for name, why in self.failed:
            self.say(f"  {name} (all it said: {OUT / name.replace(' ', '_')}.log)")
            for text in why:
                self.say(f"    {text}")
        tests, failures, ignored = self.total
        self.say(f"skipped: {ignored} (each with its reason above)")
        self.say(f"{tests - failures - ignored} passed, {failures} failed")
        return failures


# --- all --------------------------------------------------------------------------------------------------------------

def shared(runs):
    """Those of SHARES as several."""
    found = {}
    for name, command in runs.items():
        count = SHARES.get(name, 1)
        words = [f"{number + 1}of{count}" for number in range(count)]
        found |= {f"{name} {word}": [*command, word] for word in words} if count > 1 else {name: command}
    return found


def carried_out(runs, order, report):
    with concurrent.futures.ThreadPoolExecutor(2) as computing, concurrent.futures.ThreadPoolExecutor(1) as waiting_ones:
        pools = {name: waiting_ones if name in WAITING else computing for name in order}
        jobs = {pools[name].submit(run, name, runs[name]): name for name in order}
        waiting = set(jobs)
        try:
            while waiting:
                done, waiting = concurrent.futures.wait(waiting, 1.0, concurrent.futures.FIRST_COMPLETED)
                for job in done:
                    report.add(jobs[job], job.result())
                report.still(RUNNING.words())
        except BaseException:
            for pool in (computing, waiting_ones):
                pool.shutdown(wait=False, cancel_futures=True)
            RUNNING.end()
            raise


def chosen(words):
    """name -> command of all tests, or of the unit tests."""
    if words not in ([], ["quick"]):
        sys.exit("usage: run_tests.py [quick]")
    tests = test_table.units() if words else test_table.table()
    return {name: test.command for name, test in tests.items()}


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    runs = shared(chosen(sys.argv[1:]))
    times = times_of_last_run()
    order = longest_first(runs, times)
    print(f"run_tests: {len(order)} test programs, two at a time and one that waits", flush=True)
    report = Report(len(order))
    try:
        carried_out(runs, order, report)
    except BaseException:
        report.say("run_tests: stopped before its end")
        report.end()
        raise
    finally:
        (OUT / TIMES).write_text(json.dumps(times | report.times, indent=0), encoding="utf-8")
    sys.exit(report.end() != 0)


if __name__ == "__main__":
    main()
