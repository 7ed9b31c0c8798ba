"""The one table of the tests: name -> what make builds for it and its program. run_tests.py runs all of them, `make quick` the unit tests of
the PC, `make t T=NAME` one; campaigns/breakages/breakages.py takes its judges from here.

    test_table.py targets [quick]     what make has to build for all, or for the unit tests
    test_table.py t NAME [WORD...]    builds and runs one; after a test in C, words are further tests; else they go to its program
                                      (system_tests takes parts of names)
"""
import difflib
import functools
import os
import pathlib
import subprocess
import sys
from typing import NamedTuple

HOST = pathlib.Path("build/host")
VENV = "build/venv/bin/python"
NEAR = 6  # names shown for one that is not there


class Test(NamedTuple):
    """What make builds for it, and its program."""
    targets: list
    command: list


def sources(suffix):
    """name -> file of the tests; those of the command tilt have a list of their own."""
    found = [*pathlib.Path("host_tests").rglob(f"test_*{suffix}"), *pathlib.Path("nav/tests").glob(f"test_*{suffix}")]
    return {path.stem: path for path in sorted(found) if path.parts[1:3] not in (("tools", "tilt"), ("tools", "pio"))}


PROGRAMS = sources(".py")


def plain(name, *targets, python="python3"):
    return Test(list(targets), [python, str(PROGRAMS[name])])


def packages(name, *targets):
    return plain(name, *targets, python=VENV)


# Tests in Python; those without targets compile what they need, or need nothing.
SCRIPTS = [
    plain("test_flash", "flashtest_images"), packages("test_flash_words"), plain("test_resets", "system_images", "flashtest_images"),
    plain("test_fault_page"), plain("test_limits"), plain("test_bench", "system_images"), plain("test_bench_parts", "system_images"),
    plain("test_layout", "system_images"), plain("test_mutants"), plain("test_mutants_page"), plain("test_progress"),
    plain("test_papers", "paper_programs"), plain("test_papers_synthesis", "paper_programs"), plain("test_papers_verdicts", "paper_programs"),
    packages("test_figures", "paper_programs"), packages("test_comparison", "paper_programs"), plain("test_schedule"),
    plain("test_pages"), plain("test_page_sources"), plain("test_steps"), plain("test_make_words"), plain("test_proved"),
    plain("test_default"), plain("test_default_streams"), plain("test_images", "build/uno/firmware.elf"),
    plain("test_run_tests", "system_images"), plain("test_faults", "system_images"),
    plain("test_clients", "client_images"), plain("test_model_elsewhere"),
    plain("test_release", "flashtest_images", "build/library/tilt-filters.zip", "build/release/libtilt.args", "build/host/libtilt.so"),
    plain("test_arduino", "arduino_images"), plain("test_plotter", "system_images"), plain("test_compile_commands"),
    packages("test_nav_image", "build/sim/simrun", "nav_images"), packages("test_plot_run"), packages("test_robust", "build/host/pipeline_replay"),
    packages("test_design"), packages("test_design_command"), packages("test_design_refusals"), packages("test_design_typed", "system_images"),
    packages("test_synthesised"),
    packages("test_filter_pages"), packages("test_variable_structure"), packages("test_variable_structure_flight"),
    packages("test_demo", "system_images", "demo_built"), packages("test_demo_page", "demo_built"),
]
NOT_HERE = {"test_planted", "test_platformio"}  # make check and make piocheck run these


def units():
    """The Unity programs of the PC."""
    return {name: Test([f"{HOST}/{name}"], [f"{HOST}/{name}"]) for name in sorted(sources(".c"))}


def on_chip(images):
    """The programs for the ATmega328P in the simulator."""
    found = {}
    for image in images:
        stem = pathlib.Path(image).stem
        beside = [f"{HOST}/{stem}"] if stem.startswith("filter_sequence") else []
        found[f"chip_{stem}"] = Test([image, "build/sim/simrun", *beside], ["python3", "host_tests/chip/chip_test.py", image])
    return found


@functools.cache
def table():
    """name -> Test. $CHIP_TESTS, $WARNINGS, $AVR_SMALL and $CHIP_SECOND come from the Makefile (TEST_ENV)."""
    tests = units()
    tests["filter_sequence"] = Test([f"{HOST}/filter_sequence"], [f"{HOST}/filter_sequence"])
    tests |= on_chip(os.environ.get("CHIP_TESTS", "").split())
    tests["bitexact"] = Test(["build/sim/simrun"], ["python3", "campaigns/tests/bitexact.py"])
    tests["exhaustive_isqrt"] = Test([f"{HOST}/exhaustive_isqrt"], [f"{HOST}/exhaustive_isqrt"])
    tests |= {pathlib.Path(test.command[1]).stem: test for test in SCRIPTS}
    for path in sorted(pathlib.Path("host_tests/tools/tilt").glob("test_*.py")):
        tests[f"tilt_{path.stem.removeprefix('test_')}"] = Test(["system_images", "build/host/nav_replay_12"], [VENV, str(path)])
    tests["system_tests"] = Test(["system_images"], ["python3", "host_tests/system/system_tests.py"])
    return tests


def full_name(name, tests):
    """`sprf` is test_sprf; None if there is none."""
    return next((full for full in (name, f"test_{name}") if full in tests), None)


def found(name, tests):
    """The full name, or the end of the program with names that are near."""
    full = full_name(name, tests)
    if full:
        return full
    if f"test_{name.removeprefix('test_')}" in NOT_HERE:
        sys.exit(f"t: {name} is a part of make {'check' if 'planted' in name else 'piocheck'}")
    short = {each.removeprefix("test_"): each for each in tests}
    near = [each for each in short if name and name in each] + difflib.get_close_matches(name, short, NEAR, 0.5)
    near = list(dict.fromkeys(near))[:NEAR]
    hint = f"; near: {', '.join(near)}" if near else "; make t T=list lists all names"
    sys.exit(f"t: no test is called '{name}'{hint}")


def one(words):
    tests = table()
    if words[:1] == ["list"]:
        print(" ".join(sorted(name.removeprefix("test_") for name in tests)))
        return 0
    if not words:
        sys.exit("t: which test? make t T=filters (make t T=list lists all names)")
    chosen = [tests[found(words[0], tests)]]
    further = words[1:]
    if len(chosen[0].command) == 1:
        chosen += [tests[found(name, tests)] for name in further]
        further = []
    if any(test.command[0] == VENV for test in chosen):
        subprocess.run(["sh", "tools/deps.sh", "design", "tilt"], check=False)
    targets = dict.fromkeys(target for test in chosen for target in test.targets)
    if targets:
        built = subprocess.run(["make", "-s", "-j2", *targets], check=False)
        if built.returncode != 0:
            return built.returncode
    return max(abs(subprocess.run([*test.command, *further], check=False).returncode) for test in chosen)


def main():
    if sys.argv[1:2] == ["t"]:
        return one(sys.argv[2:])
    if sys.argv[1:2] != ["targets"]:
        sys.exit(f"usage: {__doc__.split(':', 2)[2]}")
    tests = units() if "quick" in sys.argv else table()
    print(" ".join(dict.fromkeys(target for test in tests.values() for target in test.targets)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
