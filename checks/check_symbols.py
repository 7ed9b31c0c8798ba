#!/usr/bin/env python3
"""What the firmware must not use: float, 64-bit arithmetic, the heap, printf; no division helper on a filter's way per sample; no
recursion; no call through a pointer but into a law's descriptor. Looks into the objects, which name the file, and into the linked image.

    check_symbols.py ELF
"""
import re
import sys

from avr_objects import called_slots, chain, graph, reach, symbols
from check_support import Stop, main, report, run

FORBIDDEN = {
    "float": r"__(add|sub|mul|div|cmp|eq|ne|lt|le|gt|ge|neg|unord|float|fix|fixuns|floatun|extend|trunc|pow)[a-z]*[sd]f[0-9a-z]*|"
             r"__fp_\w+|(sin|cos|tan|asin|acos|atan|atan2|sqrt|exp|log|pow|floor|ceil|fabs|fmod|round|lround|square|hypot)f?",
    "64-bit arithmetic": r"__\w*di[23]?\d?|__\w+_di3|__(u?mul|add|sub|cmp|ashl|ashr|lshr|neg|sdiv|udiv|umod|adddi|subdi)\w*di\w*",
    "heap": r"malloc|free|calloc|realloc|alloca|__brkval",
    "printf": r"\w*(printf|scanf)\w*|puts|fputs|puts_P|dtostrf|dtostre|strto[dl]\w*|ltoa|itoa|ultoa|utoa|__\w*toa_ncheck",
}
DIVISION = re.compile(r"__u?divmod[qhps]+i4(_\w+)?|__(u?div|u?mod)[qhs]i3|filter_fx_scaled_div|\w*divide")
# what runs per sample: the tracker with all that laws do there, the noise estimate and the angles
STEADY = ["filter_update", "filter_missing", "filter_restart", "filter_noise_update", "tilt_angles"]


def kind_of(name):
    return next((kind for kind, pattern in FORBIDDEN.items() if re.fullmatch(pattern, name)), None)


def forbidden(elf):
    for s in symbols():
        if s.section == "*UND*" and kind_of(s.name):
            yield f"{s.source}: uses {s.name} ({kind_of(s.name)})"
    for name in sorted({line.split()[-1] for line in run("avr-nm", elf).splitlines()}):
        if kind_of(name):
            yield f"{elf}: holds {name} ({kind_of(name)})"


def divisions(every, edges, outside):
    for root in STEADY:
        starts = [key for key in every if key[1] == root]
        if len(starts) != 1:
            raise Stop(f"{root}: is defined {len(starts)} times in the objects")
        caller = reach(edges, starts[0])
        for key in caller:
            for name in sorted(outside[key] | {target[1] for target in edges[key]}):
                if DIVISION.fullmatch(name):
                    yield f"{key[0]}: divides per sample: {chain(caller, key)} -> {name}"


def recursions(edges):
    """Each cycle once."""
    told = set()
    for key in sorted(edges):
        for target in sorted(edges[key]):
            caller = reach(edges, target)
            if key in caller and key not in told:
                told.update(k for k in caller if key in reach(edges, k))
                yield f"{key[0]}: recursion: {key[1]} -> {chain(caller, key)}"


def check():
    if len(sys.argv) != 2:
        raise Stop("usage: check_symbols.py ELF")
    every, edges, outside = graph()
    found = list(forbidden(sys.argv[1])) + list(divisions(every, edges, outside)) + list(recursions(edges))
    through = [f for f in every.values() if f.indirect]
    found += [f"{f.source}: {f.name} calls through a pointer" for f in through if not called_slots(f)]
    return report("forbidden symbols", found, f"none; no division on {len(STEADY)} ways per sample, no recursion, {len(through)} of "
                  f"{len(every)} functions call a law, none another pointer")


if __name__ == "__main__":
    main(check)
