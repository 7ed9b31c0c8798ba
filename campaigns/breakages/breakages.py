#!/usr/bin/env python3
"""Named breakages of the product, each of which its judges must catch: a copy of the tree is broken in one place, one test is built and run.

    breakages.py [--sample N] [NAME...]    all of campaigns/breakages/breakages.txt, N of them, or those whose name contains a word; a survivor makes
                                           the exit status 1. Which N goes by the commit, so that in time all have their turn.

The judges `proof` and `fuzz` are those of make proof and make fuzz, which read the same list.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
sys.path.append("campaigns/mutants")
import anchors  # noqa: E402
import shop  # noqa: E402
import test_table  # noqa: E402
from sampled import by_commit  # noqa: E402

LIST = pathlib.Path("campaigns/breakages/breakages.txt")
TREE = pathlib.Path("build/breakages")
ELSEWHERE = ("proof", "fuzz")
UNBROKEN_LIMIT_S = 300
BUILD_LIMIT_S = 600
# a judge hangs when it takes so many times as much of the processor as on the unbroken code: a loaded machine shall not pass for a catch
HANG_TIMES, HANG_MIN_S = 10, 30
ENDED = (-9, -24)  # by the limit: SIGKILL, SIGXCPU

# a judge that is no test of campaigns/tests/test_table.py: what make builds for it, its program
CAMPAIGN = test_table.Test(["system_images"], ["python3", "campaigns/faults/faults.py"])

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


def test_of(kind):
    """The test that a judge names, or None."""
    tests = test_table.table()
    return CAMPAIGN if kind == "campaign" else tests.get(test_table.full_name(kind, tests))


def known(judge):
    """Whether there is such a judge."""
    kind = judge.split()[0]
    return kind in ELSEWHERE or test_of(kind) is not None


def judged(judge, limit_s):
    """Builds and runs the judge: (None when it passes, else the first line that says what failed; the processor's seconds of the run)."""
    kind, *words = judge.split()
    test = test_of(kind)
    status, said = shop.run(["make", "-j2", *test.targets], TREE, BUILD_LIMIT_S)
    if status != 0:
        wrong = [line for line in said.splitlines() if "rror" in line]
        return f"does not build: {f'no end within {BUILD_LIMIT_S} s' if status is None else wrong[0] if wrong else '?'}", 0
    with tempfile.TemporaryFile() as output:
        status, took_s = shop.timed([*test.command, *words], TREE, limit_s, output)
        output.seek(0)
        lines = [line for line in output.read().decode("utf-8", "replace").splitlines() if "FAIL" in line]
    if status == 0:
        return None, took_s
    if status in ENDED:
        return f"hangs: no end within {limit_s:.0f} s of the processor", took_s
    return lines[0][:110] if lines else f"status {status}", took_s


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


def options_of(arguments):
    parser = argparse.ArgumentParser(usage="breakages.py [--sample N] [NAME...]")
    parser.add_argument("--sample", default="")
    parser.add_argument("words", nargs="*")
    options = parser.parse_args(arguments)
    if options.sample and not (options.sample.isdecimal() and int(options.sample)):
        sys.exit(f"breakages: SAMPLE={options.sample} is no whole number above 0; without SAMPLE all are judged")
    options.sample = int(options.sample or 0)
    return options


def main():
    options = options_of(sys.argv[1:])
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
