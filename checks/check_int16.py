#!/usr/bin/env python3
"""No product and no left shift that the chip's 16-bit int would cut off: found in clang's syntax tree with the AVR target.

    check_int16.py [FILE...]     only these files

Compilers do not see these (docs/deviations.md has the table). The rules name the way out; the matchers are in int16.query.
"""
import re

from check_support import chosen, main, report, run
from clang_avr import groups, relative, tool

CUT = "an unsigned product or left shift is cut off at 16 bits before it is"
WAY_OUT = "cast its first value to uint32_t, or the result to uint16_t where it fits or the cut is meant"
RULES = {
    "product": "two values are multiplied in 16 bits: cast the first to the type of the product",
    "scaled": "a value is multiplied by a constant in a signed 16-bit int: cast it to the type of the product first",
    "assigned": "*= works in the type of its left side: write the product with its cast",
    "shift": "a signed value is shifted left: multiply by a power of two in a type that holds it",
    "lowered": f"{CUT} shifted right or divided: {WAY_OUT}",
    "divisor": f"{CUT} a divisor: {WAY_OUT}",
    "compared": f"{CUT} compared: {WAY_OUT}",
    "widened": f"{CUT} widened: {WAY_OUT}",
    "plain": "int and unsigned have another width on the PC: name the width (int16_t, uint16_t)",
    "index": f"{CUT} an index: {WAY_OUT}",
    "condition": f"{CUT} a condition: {WAY_OUT}",
}


def findings_of(text):
    """Each place of the tree (a system's header has its whole path) once, though a header is parsed with many files."""
    places = re.findall(r'^([^/\s]\S*:\d+:\d+): note: "(\w+)" binds here\n(.*)$', relative(text), re.M)
    broken = re.findall(r"^\S+:\d+:\d+: (?:fatal )?error: .*$", relative(text), re.M)
    return sorted({f"{where}: {RULES[rule]}: {line.strip()}" for where, rule, line in places}) + sorted(set(broken))


def check():
    all_groups = list(groups())
    wanted = set(chosen({p for _, paths, _ in all_groups for p in paths}))
    found, count = [], 0
    for _, paths, options in all_groups:
        paths = [p for p in paths if p in wanted]
        if paths:
            done = run(tool("clang-query"), "-f", "checks/int16.query", *paths, "--", *options, expect=None)
            found += findings_of(done.stdout)
            count += len(paths)
            if done.returncode != 0 and not found:
                found.append(f"clang-query gave status {done.returncode}: {done.stdout.strip()[-300:]}")
    return report("16-bit int", found, f"{count} files, every product and left shift fits")


if __name__ == "__main__":
    main(check)
