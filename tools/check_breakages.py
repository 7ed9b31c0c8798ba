#!/usr/bin/env python3
"""Every breakage of make mutants, make proof, make fuzz and make check still has its place: the text it replaces stands exactly once
in its file. A breakage whose text has gone would otherwise be noticed only by the long target that uses it."""
import pathlib
import sys

LISTS = ("host_tests/mutants.txt", "host_tests/planted.txt", "host_tests/proof/plants.txt", "host_tests/fuzz/planted.txt")


def homeless(path):
    """(breakages, one sentence each for those without a place)"""
    blocks = pathlib.Path(path).read_text(encoding="utf-8").split("\n=== ")[1:]
    faults = [] if blocks else [f"{path}: no breakage stands in it"]
    for block in blocks:
        head, old, new = block.rstrip("\n").split("\n---\n")
        name, file, *_ = head.split("\n")
        if old == new:
            faults.append(f"{path}: '{name}': it changes nothing")
        if not old.strip():
            continue  # a new file
        source = pathlib.Path(file)
        count = source.read_text(encoding="utf-8").count(old) if source.is_file() else 0
        if count != 1:
            faults.append(f"{path}: '{name}': its text stands {count} times in {file}, not once")
    return len(blocks), faults


def main():
    judged = [homeless(path) for path in LISTS]
    faults = [fault for _, found in judged for fault in found]
    print("\n".join(faults), end="\n" if faults else "")
    print(f"breakages: {sum(count for count, _ in judged)} in {len(LISTS)} lists, {len(faults) or 'no'} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
