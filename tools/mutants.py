#!/usr/bin/env python3
"""Named breakages, each of which the tests must catch: a copy of the tree is broken in one place, one test is built and run.

    mutants.py [--sample N] [NAME...]      all, N of them, or those whose name contains a word; a survivor makes the exit
                                           status 1. Which N goes by the commit, so that in time all have their turn.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import time

from sampled import by_commit

TREE = pathlib.Path("build/mutants")
UNBROKEN_LIMIT_S = 300
# a judge hangs when it takes so many times as long as on the unbroken code: a loaded machine shall not pass for a catch
HANG_TIMES, HANG_MIN_S = 10, 30


def load():
    """The list lives in host_tests/mutants.txt: blocks of name, file, judge, then the old and the new text."""
    mutants = []
    for block in pathlib.Path("host_tests/mutants.txt").read_text(encoding="utf-8").split("\n=== ")[1:]:
        head, old, new = block.rstrip("\n").split("\n---\n")
        name, file, judge = head.split("\n")
        mutants.append((name, file, judge, old, new))
    return mutants


COMPLETE = ".complete"  # a copy that was not cut short
BUILT = ("host", "papers", "sim", "uno")  # folders of build that the first copy begins with


def prepare():
    """A copy of what git knows, with the downloads shared. A new copy keeps the times of the files and takes what is built along."""
    new = not (TREE / COMPLETE).exists()
    if new:
        shutil.rmtree(TREE, ignore_errors=True)
    TREE.mkdir(parents=True, exist_ok=True)
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True, check=True)
    for name in listed.stdout.splitlines():
        source, target = pathlib.Path(name), TREE / name
        if not source.is_file():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != source.read_bytes():
            # later ones with a new time, so that make builds them anew
            (shutil.copy2 if new else shutil.copy)(source, target)
    known = {COMPLETE, *listed.stdout.splitlines()}
    for path in list(TREE.rglob("*")):
        inside = path.relative_to(TREE)
        if inside.parts[0] != "build" and path.is_file() and str(inside) not in known:
            path.unlink()  # moved or deleted since: a makefile's wildcard would find it
    for folder in BUILT if new else ():
        if pathlib.Path("build", folder).is_dir():
            shutil.copytree(pathlib.Path("build", folder), TREE / "build" / folder, symlinks=True)
    for shared in ("unity", "venv"):
        link = TREE / "build" / shared
        link.parent.mkdir(exist_ok=True)
        if not link.exists():
            link.symlink_to(pathlib.Path("build", shared).resolve())
    (TREE / COMPLETE).touch()


def make(*targets):
    return subprocess.run(["make", "-j2", *targets], cwd=TREE, capture_output=True, text=True, timeout=600)


# kind of judge (a host test is named by itself): what make builds for it, its program; the words after the kind choose among its tests
PYTHON, WITH_PACKAGES = "python3", "build/venv/bin/python"
JUDGES = {
    "system": (["system_images"], PYTHON, "host_tests/system_tests.py"),
    "fault_page": (["help"], PYTHON, "host_tests/test_fault_page.py"),
    "resets": (["system_images"], PYTHON, "host_tests/test_resets.py"),
    "faults": (["system_images"], PYTHON, "tools/faults.py"),
    "campaign": (["system_images"], PYTHON, "host_tests/test_faults.py"),
    "papers": (["paper_programs"], PYTHON, "host_tests/test_papers.py"),
    "papers synthesis": (["paper_programs"], PYTHON, "host_tests/test_papers_synthesis.py"),
    "robust": (["build/host/pipeline_replay"], WITH_PACKAGES, "host_tests/test_robust.py"),
    "default": (["build/host/default_filter"], PYTHON, "host_tests/test_default.py"),
    "images": (["help"], PYTHON, "host_tests/test_images.py"),
    "design": (["help"], WITH_PACKAGES, "host_tests/test_design.py"),  # the three compile themselves what they need
    "design_command": (["help"], WITH_PACKAGES, "host_tests/test_design_command.py"),
    "design_refusals": (["help"], WITH_PACKAGES, "host_tests/test_design_refusals.py"),
    "variable_structure": (["help"], WITH_PACKAGES, "host_tests/test_variable_structure.py"),
    "variable_structure flight": (["help"], WITH_PACKAGES, "host_tests/test_variable_structure_flight.py"),
    "variable_structure page": (["help"], WITH_PACKAGES, "host_tests/test_variable_structure_page.py"),
    "synthesised": (["build/host/roll_replay"], WITH_PACKAGES, "host_tests/test_synthesised.py"),
    "plotter": (["system_images"], PYTHON, "host_tests/test_plotter.py"),
    "arduino": (["arduino_images"], PYTHON, "host_tests/test_arduino.py"),
    "compile_commands": (["compile_commands"], PYTHON, "host_tests/test_compile_commands.py"),
    "nav_image": (["build/sim/simrun", "build/uno/nav/firmware.elf", "build/host/nav_replay_12"], WITH_PACKAGES, "host_tests/test_nav_image.py"),
    "schedule": (["help"], PYTHON, "host_tests/test_schedule.py"),
}


def program_of(judge):
    """(targets of make, command) of a judge as host_tests/mutants.txt names it."""
    if judge.startswith("tilt_"):  # a file of host_tests/tilt, named as tools/run_tests.py does, and which of its tests
        name, *words = judge.removeprefix("tilt_").split()
        return ["help"], [WITH_PACKAGES, f"host_tests/tilt/test_{name}.py", *words]
    for kind in sorted(JUDGES, key=len, reverse=True):
        if judge == kind or judge.startswith(kind + " "):
            targets, *command = JUDGES[kind]
            return targets, command + judge[len(kind):].split()
    return [f"build/host/{judge}"], [f"build/host/{judge}"]


def judged(judge, limit_s):
    """Builds and runs the judge: (None when it passes, else the first line that says what failed; seconds of the run)."""
    targets, command = program_of(judge)
    built = make(*targets)
    if built.returncode != 0:
        return f"does not build: {built.stderr.strip().splitlines()[0] if built.stderr.strip() else '?'}", 0
    began = time.monotonic()
    try:
        done = subprocess.run(command, cwd=TREE, capture_output=True, text=True, timeout=limit_s, errors="replace")
    except subprocess.TimeoutExpired:
        return f"hangs: no end within {limit_s:.0f} s", limit_s
    took_s = time.monotonic() - began
    if done.returncode == 0:
        return None, took_s
    lines = [line for line in done.stdout.splitlines() if "FAIL" in line]
    return lines[0][:110] if lines else f"status {done.returncode}", took_s


def try_one(mutant, limit_s):
    name, file, judge, old, new = mutant
    path = TREE / file
    whole = path.read_text(encoding="utf-8")
    if whole.count(old) != 1:
        return f"{name}: the text to break stands {whole.count(old)} times in {file}", False
    path.write_text(whole.replace(old, new), encoding="utf-8")
    try:
        verdict, _ = judged(judge, limit_s)
    finally:
        path.write_text(whole, encoding="utf-8")
    if verdict is None:
        return f"{name}: SURVIVED {judge}", False
    if verdict.startswith("does not build"):
        return f"{name}: {verdict}", False
    return f"{name}: caught by {judge}: {verdict}", True


def chosen(sample, words):
    mutants = [m for m in load() if not words or any(w in m[0] for w in words)]
    mutants = by_commit(mutants, sample, "mutants", "breakages")
    if not mutants:
        sys.exit(f"mutants: no name contains any of: {' '.join(words)}")
    return mutants


def main():
    parser = argparse.ArgumentParser(usage="mutants.py [--sample N] [NAME...]")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("words", nargs="*")
    options = parser.parse_args()
    mutants = chosen(options.sample, options.words)
    prepare()
    limits_s = {}
    for judge in sorted({m[2] for m in mutants}):
        verdict, took_s = judged(judge, UNBROKEN_LIMIT_S)
        limits_s[judge] = max(HANG_MIN_S, HANG_TIMES * took_s)
        if verdict is not None:
            print(f"mutants: {judge} fails without a mutant: {verdict}")
            return 1
    caught = 0
    for number, mutant in enumerate(mutants, 1):
        text, good = try_one(mutant, limits_s[mutant[2]])
        caught += good
        print(f"[{number}/{len(mutants)}] {text}", flush=True)
    print(f"{caught} passed, {len(mutants) - caught} failed")
    return 0 if caught == len(mutants) else 1


if __name__ == "__main__":
    sys.exit(main())
