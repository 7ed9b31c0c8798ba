#!/usr/bin/env python3
"""Planted faults, each of which its check must find: a fault is put into a copy of the tree, its check runs there, must fail and say
of the file what is wrong with it (host_tests/tools/checks/test_planted.py shows that another complaint does not count).

    planted.py [WORD...]     all of checks/planted.txt, or those whose name contains a word
    PLANTED=20 planted.py    so many of them, others for each commit
"""
import concurrent.futures
import os
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import anchors
from sampled import by_commit

LIST = pathlib.Path("checks/planted.txt")
COPIES = pathlib.Path("build/planted")
WORKERS = 2
KILLED = {124, 137}  # what timeout gives
LIMIT_S = 600  # by the wall, on a machine that others may load: only a check that hangs takes that long
# these look at one file when it is named; the others look at the whole
TAKES_FILE = {"compile", "tidy", "int16", "cppcheck", "format", "lengths"}
# these look at an image, which must link with the fault in it: one of few filters has room for that
TAKES_IMAGE = {"memory", "painted", "size", "symbols", "waits"}
FOLDERS = ["firmware", "nav", "lib", "hal", "sim", "host_tests", "mk", "tools", "checks", "campaigns", "docs"]
FILES = ["Makefile", ".clang-tidy", ".clang-format", "platformio.ini", "sim/streams/outliers-15pct.csv", "build/uno/firmware.elf",
         "build/uno/filters.txt", "build/sim/simrun"]
BUILT = ["build/check/avr", "build/check/host", "build/uno/firmware", "build/uno/hal", "build/uno/lib"]


def load(path):
    """The list's entries, without those that make fuzz plants. Each check must say what the finding is, or what it does not see."""
    faults = [entry for entry in anchors.load(path) if entry.judges[0].split()[0] != "fuzz"]
    for fault in faults:
        mute = [check for check in fault.judges if check not in fault.says and check not in fault.silent]
        if mute:
            raise SystemExit(f"planted: {path}: '{fault.name}': nothing states what the finding must be: {mute[0]} says: WORDS")
    return faults


def unplanted(faults):
    """Checks of checks/check.mk for which no fault is planted."""
    line = re.search(r"^CHECKS := (.*)$", pathlib.Path("checks/check.mk").read_text(encoding="utf-8"), re.M)
    return [c for c in line.group(1).split() if not any(c in f.says for f in faults)]


def newer(source, target):
    return not target.exists() or target.stat().st_mtime_ns != source.stat().st_mtime_ns or target.stat().st_size != source.stat().st_size


def prepare(number):
    """A copy of the sources and of what is built, with its times, so that make builds only what a fault touches."""
    copy = COPIES / str(number)
    copy.mkdir(parents=True, exist_ok=True)
    wanted = [p for p in map(pathlib.Path, FILES) if p.exists()]
    for folder in FOLDERS + BUILT:
        wanted += [p for p in pathlib.Path(folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts and p.suffix != ".csv"]
    keep = {str(p) for p in wanted}
    for path in [p for p in copy.rglob("*") if p.is_file() and not p.is_symlink()]:
        if str(path.relative_to(copy)) not in keep:
            path.unlink()
    for source in wanted:
        target = copy / source
        target.parent.mkdir(parents=True, exist_ok=True)
        if newer(source, target):
            shutil.copy2(source, target)
    for shared in ("unity", "venv"):
        link = copy / "build" / shared
        if not link.is_symlink():
            link.symlink_to(pathlib.Path("build", shared).resolve())
    return copy


def run_check(copy, check, file):
    """Status and output; None as the status of one that hangs, which is ended with all that it started."""
    only = [f"ONLY={file}"] if check in TAKES_FILE else ["FILTERS=small"] if check in TAKES_IMAGE else []
    done = subprocess.run(["timeout", "--kill-after=10", str(LIMIT_S), "make", f"check-{check}", *only], cwd=copy, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
    return (None if done.returncode in KILLED else done.returncode), done.stdout


def judged(check, fault, status, output):
    """(text, good) of what a check says of a fault: each finding that is stated must be in a line that names the file, none that is
    excluded."""
    file = file_of(fault)
    named = [line.strip() for line in output.splitlines() if file in line and not line.startswith("make")]
    missing = [words for words in fault.says.get(check, []) if not any(re.search(words, line) for line in named)]
    seen = [line for words in fault.silent.get(check, []) for line in named if re.search(words, line)]
    if status is None:
        return f"check-{check} gives no answer within {LIMIT_S} s", False
    if seen:
        return f"check-{check} says what the list excludes: state it as a finding: {seen[0][:300]}", False
    if check not in fault.says:
        return f"check-{check} does not see it, as the list says", True
    if status == 0:
        return f"NOT FOUND by check-{check}: {output.strip()[-200:]}", False
    if not named:
        return f"check-{check} fails without naming {file}: {output.strip()[-300:]}", False
    if missing:
        return f"check-{check} fails, but says nothing of {file} with '{missing[0]}': {named[0][:300]}", False
    return f"found by check-{check}: {next(line for line in named if re.search(fault.says[check][0], line))[:150]}", True


def file_of(fault):
    return fault.place.partition(":")[0]


def verdicts(copy, fault):
    """(text, good) of each check of a fault that stands in the copy."""
    for check in fault.judges:
        yield judged(check, fault, *run_check(copy, check, file_of(fault)))


def planted_text(fault, whole):
    """The file with the fault; Lost when it has no place."""
    if fault.new and whole is not None:
        raise anchors.Lost(f"{file_of(fault)} exists, and there is no text to replace in it")
    return fault.new or anchors.broken(fault, {file_of(fault): whole.decode() if whole else ""})[1]


def try_one(copies, fault):
    copy = copies.get()
    path = copy / file_of(fault)
    whole = path.read_bytes() if path.exists() else None
    try:
        text = planted_text(fault, whole)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return list(verdicts(copy, fault))
    except anchors.Lost as why:
        return [(str(why), False)]
    finally:
        restore(copy, fault, whole)
        copies.put(copy)


def restore(copy, fault, whole):
    """As it was; what was built from the fault is older than the file again, so it is built again."""
    path = copy / file_of(fault)
    if whole is None:
        path.unlink(missing_ok=True)
    else:
        path.write_bytes(whole)
    for built in (copy / "build").rglob("firmware.elf"):
        built.unlink()


def main():
    words = sys.argv[1:]
    faults = [f for f in load(LIST) if not words or any(w in f.name for w in words)]
    sample = os.environ.get("PLANTED", "")
    if sample and not (sample.isdecimal() and int(sample) > 0):
        print(f"planted: PLANTED={sample} is no number of faults")
        return 2
    if not faults:
        print(f"planted: no fault's name contains {' or '.join(words)}")
        return 2
    began = time.monotonic()
    copies = queue.Queue()
    for number in range(WORKERS):
        copies.put(prepare(number))
    good = bad = 0
    for check in unplanted(faults) if not words else []:
        print(f"check-{check}: no fault is planted for it in {LIST}")
        bad += 1
    faults = by_commit(faults, int(sample or 0), "planted", "faults")
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        for fault, results in zip(faults, pool.map(lambda f: try_one(copies, f), faults)):
            for text, found in results:
                good, bad = good + found, bad + (not found)
                print(f"{fault.name}: {text}", flush=True)
    print(f"planted faults: {good} passed, {bad} failed ({time.monotonic() - began:.0f} s)")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
