#!/usr/bin/env python3
"""Every breakage of make mutants, make proof, make fuzz and make check still has its place: the text it replaces stands exactly once
in its file, and those of make mutants in C still compile with every warning an error. What has gone or no longer builds would
otherwise be noticed only by the long target that uses it. WARNINGS and UNITY_DIR come from the Makefile by the environment."""
import pathlib
import subprocess
import sys
import tempfile

import check_compile
from check_support import parallel

LISTS = ("host_tests/mutants.txt", "host_tests/planted.txt", "host_tests/proof/plants.txt", "host_tests/fuzz/planted.txt")


COMPILED = LISTS[0]


def breakages(path):
    """(name, file, text, broken text) of each"""
    for block in pathlib.Path(path).read_text(encoding="utf-8").split("\n=== ")[1:]:
        head, old, new = block.rstrip("\n").split("\n---\n")
        name, file, *_ = head.split("\n")
        yield name, file, old, new


def homeless(path):
    """(breakages, one sentence each for those without a place)"""
    blocks = list(breakages(path))
    faults = [] if blocks else [f"{path}: no breakage stands in it"]
    for name, file, old, new in blocks:
        if old == new:
            faults.append(f"{path}: '{name}': it changes nothing")
        if not old.strip():
            continue  # a new file
        source = pathlib.Path(file)
        count = source.read_text(encoding="utf-8").count(old) if source.is_file() else 0
        if count != 1:
            faults.append(f"{path}: '{name}': its text stands {count} times in {file}, not once")
    return len(blocks), faults


def unbuilt(breakage):
    """One sentence if the broken file does not compile; a header is compiled alone."""
    name, file, old, new = breakage
    source = pathlib.Path(file)
    with tempfile.TemporaryDirectory() as folder:
        broken = pathlib.Path(folder) / source.name
        broken.write_text(source.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
        compiled = broken
        if source.suffix == ".h":
            compiled = broken.with_name("alone.c")
            compiled.write_text(f'#include "{source.name}"\n', encoding="utf-8")
        if "host" in check_compile.compilers(source):
            command = ["gcc", "-O1", f"-I{folder}", *check_compile.host_flags(source)]
        else:
            command = ["avr-gcc", "-Os", f"-I{folder}", *check_compile.avr_flags(source)]
        done = subprocess.run([*command, *check_compile.warnings(), "-c", "-o", "/dev/null", compiled], capture_output=True, text=True)
    why = next((line for line in done.stderr.splitlines() if "error" in line), "?").replace(f"{folder}/", "")
    return f"{COMPILED}: '{name}' does not build: {why}" if done.returncode else None


def main():
    judged = [homeless(path) for path in LISTS]
    faults = [fault for _, found in judged for fault in found]
    in_c = [breakage for breakage in breakages(COMPILED) if breakage[1].endswith((".c", ".h")) and pathlib.Path(breakage[1]).is_file()]
    faults += [fault for fault in parallel(unbuilt, in_c) if fault]
    print("\n".join(faults), end="\n" if faults else "")
    print(f"breakages: {sum(count for count, _ in judged)} in {len(LISTS)} lists, {len(faults) or 'no'} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
