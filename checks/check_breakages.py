#!/usr/bin/env python3
"""Every breakage of campaigns/breakages/breakages.txt and every fault of checks/planted.txt has its place: the text it replaces stands exactly
once in its definition, its judges exist, and those of breakages in C that a test judges still compile with every warning an error. What
is lost would otherwise be noticed only by the long target that uses it. Breakages are of the product, at most 120, the lists at most 1500
lines: what an operator makes by itself belongs to make mutants. WARNINGS and UNITY_DIR come from the Makefile by the environment."""
import pathlib
import subprocess
import sys
import tempfile

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import anchors
import breakages
import check_compile
import fuzz
from check_support import parallel
from proof import load_entries

PLANTED = pathlib.Path("checks/planted.txt")
MOST, MOST_LINES = 120, 1500


def broken(entry):
    """(file, broken text), or None and one sentence."""
    try:
        file, text = anchors.broken(entry)
    except anchors.Lost as why:
        return None, f"{breakages.LIST}: '{entry.name}': {why}"
    same = text == anchors.product_text()[file]
    return (None, f"{breakages.LIST}: '{entry.name}': it changes nothing") if same else (file, text)


def unknown(entry, entries):
    """One sentence for each judge that there is not."""
    for judge in entry.judges:
        kind, *words = judge.split()
        if not breakages.known(judge):
            yield f"{breakages.LIST}: '{entry.name}': there is no judge {kind}: it is no test of campaigns/tests/test_table.py"
        elif kind == "proof" and not set(words) <= set(entries):
            yield f"{breakages.LIST}: '{entry.name}': the proof has no entry {' '.join(sorted(set(words) - set(entries)))}"
        elif kind == "fuzz" and not set(words) <= set(fuzz.TARGETS):
            yield f"{breakages.LIST}: '{entry.name}': there is no fuzz target {' '.join(words)}"


def compiled_alone(file):
    return file is not None and file.endswith((".c", ".h")) and file not in check_compile.NOT_ALONE


def unbuilt(job):
    """One sentence if the broken file does not compile; a header is compiled alone."""
    entry, file, text = job
    source = pathlib.Path(file)
    with tempfile.TemporaryDirectory() as folder:
        changed = pathlib.Path(folder) / source.name
        changed.write_text(text, encoding="utf-8")
        compiled = changed
        if source.suffix == ".h":
            compiled = changed.with_name("alone.c")
            compiled.write_text(f'#include "{source.name}"\n', encoding="utf-8")
        if "host" in check_compile.compilers(source):
            command = ["gcc", "-O1", f"-I{folder}", *check_compile.host_flags(source)]
        else:
            command = ["avr-gcc", "-Os", f"-I{folder}", *check_compile.avr_flags(source)]
        # what only the prover reads may be what a compiler warns of
        warnings = ["-w"] if all(judge.startswith("proof ") for judge in entry.judges) else check_compile.warnings()
        done = subprocess.run([*command, *warnings, "-c", "-o", "/dev/null", compiled], capture_output=True, text=True, check=False)
    why = next((line for line in done.stderr.splitlines() if "error" in line), "?").replace(f"{folder}/", "")
    return f"{breakages.LIST}: '{entry.name}' does not build: {why}" if done.returncode else None


def misplaced(fault):
    """One sentence if a planted fault has no place."""
    file = pathlib.Path(fault.place.partition(":")[0])
    if not fault.edits:
        return f"{PLANTED}: '{fault.name}': {file} exists" if file.exists() else None
    try:
        anchors.broken(fault, {str(file): file.read_text(encoding="utf-8")} if file.is_file() else {})
    except anchors.Lost as why:
        return f"{PLANTED}: '{fault.name}': {why}"
    return None


def main():
    named, planted, entries = anchors.load(breakages.LIST), anchors.load(PLANTED), load_entries()
    faults = [sentence for entry in named for sentence in unknown(entry, entries)]
    jobs = [(entry, *broken(entry)) for entry in named]
    faults += [text for _, file, text in jobs if file is None]
    faults += [fault for fault in parallel(unbuilt, [job for job in jobs if compiled_alone(job[1])]) if fault]
    faults += [fault for fault in map(misplaced, planted) if fault]
    lines = sum(path.read_text(encoding="utf-8").count("\n") for path in (*anchors.lists(breakages.LIST), PLANTED))
    if len(named) > MOST or lines > MOST_LINES:
        faults.append(f"{breakages.LIST}: {len(named)} breakages, {lines} lines of lists, at most {MOST} and {MOST_LINES}: see make mutants")
    print("\n".join(faults), end="\n" if faults else "")
    print(f"breakages: {len(named)} named, {len(planted)} planted, {lines} lines, {len(faults) or 'no'} findings")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
