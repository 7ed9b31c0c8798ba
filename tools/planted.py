#!/usr/bin/env python3
"""Planted faults, each of which its check must find: a fault is put into a copy of the tree, its check runs there, must fail and name
the file.

    planted.py [WORD...]     all of host_tests/planted.txt, or those whose name contains a word
"""
import concurrent.futures
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import time

LIST = pathlib.Path("host_tests/planted.txt")
COPIES = pathlib.Path("build/planted")
WORKERS = 2
LIMIT_S = 120
# these look at one file when it is named; the others look at the whole
TAKES_FILE = {"compile", "tidy", "int16", "cppcheck", "format", "lengths"}
FOLDERS = ["firmware", "lib", "hal", "sim", "host_tests", "mk", "tools", "docs"]
FILES = ["Makefile", ".clang-tidy", ".clang-format", "platformio.ini", "sim/streams/outliers-15pct.csv", "build/uno/firmware.elf",
         "build/sim/simrun"]
BUILT = ["build/check/avr", "build/uno/firmware", "build/uno/hal", "build/uno/lib"]


def load():
    """Blocks of name, file, checks that must find it, then the old and the new text; `blind` lists checks known not to see it."""
    faults = []
    for block in LIST.read_text(encoding="utf-8").split("\n=== ")[1:]:
        parts = block.rstrip("\n").split("\n---\n")
        head = parts[0].split("\n")
        if len(parts) != 3 or len(head) not in (3, 4):
            raise SystemExit(f"planted: {LIST}: '{head[0]}': a block is name, file, checks, perhaps 'blind: checks', ---, old, ---, new")
        blind = head[3].removeprefix("blind: ").split() if len(head) == 4 else []
        faults.append({"name": head[0], "file": head[1], "checks": head[2].split(), "blind": blind, "old": parts[1], "new": grown(parts[2])})
    return faults


def grown(text):
    """A line `@repeat N: words` stands for N lines, {} being the number."""
    lines = []
    for line in text.split("\n"):
        found = re.match(r"@repeat (\d+): (.*)", line)
        lines += [found.group(2).replace("{}", str(i)) for i in range(int(found.group(1)))] if found else [line]
    return "\n".join(lines)


def unplanted(faults):
    """Checks of mk/check.mk for which no fault is planted."""
    line = re.search(r"^CHECKS := (.*)$", pathlib.Path("mk/check.mk").read_text(encoding="utf-8"), re.M)
    return [c for c in line.group(1).split() if not any(c in f["checks"] for f in faults)]


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
    only = [f"ONLY={file}"] if check in TAKES_FILE else []
    try:
        done = subprocess.run(["make", f"check-{check}", *only], cwd=copy, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", timeout=LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        return 0, f"no answer within {LIMIT_S} s"
    return done.returncode, done.stdout


def verdicts(copy, fault):
    """(text, good) of each check of a fault that stands in the copy."""
    for check in fault["checks"]:
        status, output = run_check(copy, check, fault["file"])
        lines = [line for line in output.splitlines() if fault["file"] in line and not line.startswith("make")]
        if status == 0:
            yield f"NOT FOUND by check-{check}: {output.strip()[-200:]}", False
        elif not lines:
            yield f"check-{check} fails without naming {fault['file']}: {output.strip()[-300:]}", False
        else:
            yield f"found by check-{check}: {lines[0].strip()[:150]}", True
    for check in fault["blind"]:
        status, _ = run_check(copy, check, fault["file"])
        if status != 0:
            yield f"check-{check} sees it now: move it from `blind` to the checks", False


def try_one(copies, fault):
    copy = copies.get()
    path = copy / fault["file"]
    whole = path.read_bytes() if path.exists() else None
    text = whole.decode() if whole else ""
    try:
        if fault["old"] and text.count(fault["old"]) != 1:
            return [(f"the text to replace stands {text.count(fault['old'])} times in {fault['file']}", False)]
        if not fault["old"] and whole is not None:
            return [(f"{fault['file']} exists, and there is no text to replace in it", False)]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text.replace(fault["old"], fault["new"]) if fault["old"] else fault["new"] + "\n", encoding="utf-8")
        return list(verdicts(copy, fault))
    finally:
        restore(copy, fault, whole)
        copies.put(copy)


def restore(copy, fault, whole):
    """As it was; what was built from the fault is older than the file again, so it is built anew."""
    path = copy / fault["file"]
    if whole is None:
        path.unlink(missing_ok=True)
    else:
        path.write_bytes(whole)
    for built in (copy / "build").glob("*/firmware.elf"):
        built.unlink()


def main():
    words = sys.argv[1:]
    faults = [f for f in load() if not words or any(w in f["name"] for w in words)]
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
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        for fault, results in zip(faults, pool.map(lambda f: try_one(copies, f), faults)):
            for text, found in results:
                good, bad = good + found, bad + (not found)
                print(f"{fault['name']}: {text}", flush=True)
    print(f"planted faults: {good} passed, {bad} failed ({time.monotonic() - began:.0f} s)")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
