#!/usr/bin/env python3
"""run_tests.py TEST...: runs each Unity program, the images of $CHIP_TESTS in the simulator, the comparisons and the tests of the tools,
two at a time and the longest first; tells of each as it ends, with what failed or was skipped, and at last the sum. $LEAVE_OUT: names of
tests that are not run and said to be left out (for .ci/run, which runs them by turns).
"""
import concurrent.futures
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

OUT = pathlib.Path("build/host")
VENV = "build/venv/bin/python"
SUM = re.compile(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", re.M)
PLAIN = ["test_flash", "test_resets", "test_fault_page", "test_bench", "test_papers", "test_papers_synthesis", "test_schedule", "test_pages",
         "test_default", "test_images", "test_run_tests", "test_faults", "test_arduino", "test_plotter", "test_compile_commands"]
WITH_NUMPY = ["test_nav_image", "test_plot_run", "test_robust", "test_design", "test_design_command", "test_design_refusals", "test_synthesised",
              "test_variable_structure", "test_variable_structure_flight", "test_variable_structure_page"]
TILT = sorted(pathlib.Path("host_tests/tilt").glob("test_*.py"))
FIRST = ["system_tests", "bitexact", "test_design_command", "test_design", "test_design_refusals", "chip_filter_sequence_2", "chip_filter_sequence_1",
         "test_synth_opt_reference", "test_flash"]  # begun before the others: what takes long begins early
running = set()  # programs, to be ended with this one


def commands(tests):
    """name -> command"""
    runs = {pathlib.Path(test).name: [test] for test in tests}
    runs["filter_sequence"] = [OUT / "filter_sequence"]
    for image in os.environ.get("CHIP_TESTS", "").split():
        runs[f"chip_{pathlib.Path(image).stem}"] = ["python3", "host_tests/chip_test.py", image]
    runs["bitexact"] = ["python3", "tools/bitexact.py"]
    runs["exhaustive_isqrt"] = [OUT / "exhaustive_isqrt"]
    runs |= {name: ["python3", f"host_tests/{name}.py"] for name in PLAIN}
    runs |= {name: [VENV, f"host_tests/{name}.py"] for name in WITH_NUMPY}
    runs |= {f"tilt_{path.stem.removeprefix('test_')}": [VENV, path] for path in TILT}
    runs["system_tests"] = ["python3", "host_tests/system_tests.py"]
    return runs


def run(name, command):
    """(status, what it said, seconds)"""
    began = time.monotonic()
    try:
        with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as program:
            running.add(program)
            said = program.communicate()[0].decode("utf-8", "replace")
            status = program.returncode
        running.discard(program)
    except OSError as why:
        status, said = 127, f"{command[0]}: {why.strerror}\n"
    (OUT / f"{name}.log").write_text(said, encoding="utf-8")
    return status, said, time.monotonic() - began


def tell(name, status, said, seconds):
    """Prints the result; returns (tests, failures, ignored), a crash as one failure more."""
    sums = SUM.findall(said)
    line = f"{sums[-1][0]} Tests {sums[-1][1]} Failures {sums[-1][2]} Ignored" if sums else f"crashed (status {status})"
    print(f"{name:<28}{line:<42}{seconds:>4.0f} s")
    for text in said.splitlines():
        if ":FAIL" in text or ":IGNORE" in text:
            print(f"    {text}")
    tests, failures, ignored = (int(part) for part in sums[-1]) if sums else (0, 0, 0)
    if not sums or (failures == 0 and status != 0):
        print(f"    ended with status {status}")
        for text in said.splitlines()[-12:]:
            print(f"    {text}")
        tests, failures = tests + 1, failures + 1
    sys.stdout.flush()
    return tests, failures, ignored


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    runs = commands(sys.argv[1:])
    left_out = os.environ.get("LEAVE_OUT", "").split()
    unknown = [name for name in left_out if name not in runs]
    if unknown:
        sys.exit(f"run_tests: LEAVE_OUT names what is no test: {' '.join(unknown)}")
    for name in left_out:
        del runs[name]
        print(f"{name:<28}left out")
    order = [name for name in FIRST if name in runs] + [name for name in runs if name not in FIRST]
    total = [0, 0, 0]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = {pool.submit(run, name, runs[name]): name for name in order}
        try:
            for job in concurrent.futures.as_completed(jobs):
                total = [a + b for a, b in zip(total, tell(jobs[job], *job.result()))]
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for program in set(running):
                program.terminate()
            raise
    tests, failures, ignored = total
    print(f"skipped: {ignored} (each with its reason above)")
    print(f"{tests - failures - ignored} passed, {failures} failed")
    sys.exit(failures != 0)


if __name__ == "__main__":
    main()
