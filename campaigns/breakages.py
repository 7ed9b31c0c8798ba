#!/usr/bin/env python3
"""Named breakages of the product, each of which its judges must catch: a copy of the tree is broken in one place, one test is built and run.

    breakages.py [--sample N] [NAME...]    all of campaigns/breakages.txt, N of them, or those whose name contains a word; a survivor makes
                                           the exit status 1. Which N goes by the commit, so that in time all have their turn.

The judges `proof` and `fuzz` are those of make proof and make fuzz, which read the same list.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import time

sys.path.insert(0, "tools")
import anchors  # noqa: E402
from sampled import by_commit  # noqa: E402

LIST = pathlib.Path("campaigns/breakages.txt")
TREE = pathlib.Path("build/breakages")
ELSEWHERE = ("proof", "fuzz")
UNBROKEN_LIMIT_S = 300
# a judge hangs when it takes so many times as long as on the unbroken code: a loaded machine shall not pass for a catch
HANG_TIMES, HANG_MIN_S = 10, 30

# kind of judge (a host test is named by itself): what make builds for it, its program; the words after the kind choose among its tests
PYTHON, WITH_PACKAGES = "python3", "build/venv/bin/python"
JUDGES = {
    "system": (["system_images"], PYTHON, "host_tests/system_tests.py"),
    "fault_page": (["help"], PYTHON, "host_tests/test_fault_page.py"),
    "resets": (["system_images"], PYTHON, "host_tests/test_resets.py"),
    "faults": (["system_images"], PYTHON, "tools/faults.py"),
    "robust": (["build/host/pipeline_replay"], WITH_PACKAGES, "host_tests/test_robust.py"),
    "images": (["help"], PYTHON, "host_tests/test_images.py"),
    "plotter": (["system_images"], PYTHON, "host_tests/test_plotter.py"),
    "arduino": (["arduino_images"], PYTHON, "host_tests/test_arduino.py"),
    "schedule": (["help"], PYTHON, "host_tests/test_schedule.py"),
}

COMPLETE = ".complete"  # a copy that was not cut short
BUILT = ("host", "sim", "uno")  # folders of build that the first copy begins with


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
            # later ones with a new time, so that make builds them again
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


def program_of(judge):
    """(targets of make, command) of a judge as the list names it."""
    kind, *words = judge.split()
    if kind in JUDGES:
        targets, *command = JUDGES[kind]
        return targets, command + words
    return [f"build/host/{judge}"], [f"build/host/{judge}"]


def known(judge):
    """Whether there is such a judge."""
    kind = judge.split()[0]
    return kind in JUDGES or kind in ELSEWHERE or pathlib.Path(f"host_tests/{judge}.c").is_file()


def judged(judge, limit_s):
    """Builds and runs the judge: (None when it passes, else the first line that says what failed; seconds of the run)."""
    targets, command = program_of(judge)
    built = subprocess.run(["make", "-j2", *targets], cwd=TREE, capture_output=True, text=True, timeout=600, check=False)
    if built.returncode != 0:
        said = [line for line in built.stderr.splitlines() if "rror" in line]
        return f"does not build: {said[0] if said else '?'}", 0
    began = time.monotonic()
    try:
        done = subprocess.run(command, cwd=TREE, capture_output=True, text=True, timeout=limit_s, errors="replace", check=False)
    except subprocess.TimeoutExpired:
        return f"hangs: no end within {limit_s:.0f} s", limit_s
    took_s = time.monotonic() - began
    if done.returncode == 0:
        return None, took_s
    lines = [line for line in done.stdout.splitlines() if "FAIL" in line]
    return lines[0][:110] if lines else f"status {done.returncode}", took_s


def try_one(entry, judge, limit_s):
    """(what came of it, whether the judge caught it)"""
    try:
        file, text = anchors.broken(entry)
    except anchors.Lost as why:
        return f"{entry.name}: {why}", False
    path = TREE / file
    whole = path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    try:
        verdict, _ = judged(judge, limit_s)
    finally:
        path.write_text(whole, encoding="utf-8")
    if verdict is None:
        return f"{entry.name}: SURVIVED {judge}", False
    if verdict.startswith("does not build"):
        return f"{entry.name}: {verdict}", False
    return f"{entry.name}: caught by {judge}: {verdict}", True


def chosen(sample, words):
    """[(entry, judge)]"""
    named = [entry for entry in anchors.load(LIST) if not words or any(word in entry.name for word in words)]
    if not named:
        sys.exit(f"breakages: no name in {LIST} contains any of: {' '.join(words)}")
    pairs = [(entry, judge) for entry in named for judge in entry.judges if judge.split()[0] not in ELSEWHERE]
    if not pairs:
        sys.exit(f"breakages: '{named[0].name}' is judged by {', '.join(named[0].judges)}: run make {named[0].judges[0].split()[0]}")
    return by_commit(pairs, sample, "breakages", "breakages")


def main():
    parser = argparse.ArgumentParser(usage="breakages.py [--sample N] [NAME...]")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("words", nargs="*")
    options = parser.parse_args()
    pairs = chosen(options.sample, options.words)
    prepare()
    limits_s = {}
    for judge in sorted({judge for _, judge in pairs}):
        verdict, took_s = judged(judge, UNBROKEN_LIMIT_S)
        limits_s[judge] = max(HANG_MIN_S, HANG_TIMES * took_s)
        if verdict is not None:
            print(f"breakages: {judge} fails without a breakage: {verdict}")
            return 1
    caught = 0
    for number, (entry, judge) in enumerate(pairs, 1):
        text, good = try_one(entry, judge, limits_s[judge])
        caught += good
        print(f"[{number}/{len(pairs)}] {text}", flush=True)
    print(f"{caught} passed, {len(pairs) - caught} failed")
    return 0 if caught == len(pairs) else 1


if __name__ == "__main__":
    sys.exit(main())
