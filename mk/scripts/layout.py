#!/usr/bin/env python3
"""layout.py: the order of the functions in the UNO's flash, from build/uno/firmware.elf and .map, to hal/avr/functions.ld.

A call or jump within 4 KB takes two bytes, a longer one four, and in the compiler's order two thirds are long. This program reorders the
functions (annealing with a fixed seed) until few calls are. hal/avr/uno.ld uses that order and puts functions that are not listed after the
others, so the list does not have to be rewritten after each change: do it when bytes are short.
"""
import bisect
import math
import pathlib
import random
import re
import subprocess
import sys

BUILT, OUT = pathlib.Path("build/uno/firmware"), pathlib.Path("hal/avr/functions.ld")
REACH = 4094  # bytes, from the end of a short call
MOVES = 400_000
WARM = 1.0  # long calls that a move may add at the start


def unit_of(section):
    """Sections with equal names apart from the compiler's numbers are one unit: a list cannot distinguish them."""
    return re.sub(r"\.(lto_priv|constprop|isra|part)\b.*", "", section)


def sections(map_file):
    """[(address, size, unit)] of .text.* in map order."""
    text = pathlib.Path(map_file).read_text(encoding="utf-8")
    text = text[text.index("Linker script and memory map"):]
    found = re.findall(r"^ (\.text\S*)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) ", text, re.MULTILINE)
    return [(int(at, 16), int(size, 16), unit_of(name)) for name, at, size in found if int(size, 16) and name != ".text"]


def calls(elf):
    """[(address, target)] of all calls and jumps."""
    listing = subprocess.run(["avr-objdump", "-d", elf], capture_output=True, text=True, check=True).stdout
    found = []
    for at, target in re.findall(r"^\s*([0-9a-f]+):\t[0-9a-f ]+\tr?(?:call|jmp)\t[^;\n]*;?\s*0x([0-9a-f]+)", listing, re.MULTILINE):
        found.append((int(at, 16), int(target, 16)))
    return found


def graph(elf, map_file):
    """Sizes of the units, and [(unit, offset of the call, unit, offset of its target)]."""
    placed = sorted(sections(map_file))
    starts = [at for at, _, _ in placed]
    names, sizes, base = [], [], {}
    number = {}
    for at, size, name in placed:
        if name not in number:
            number[name] = len(names)
            names.append(name)
            sizes.append(0)
        base[at] = sizes[number[name]]
        sizes[number[name]] += size

    def where(address):
        i = bisect.bisect_right(starts, address) - 1
        if i < 0 or address >= placed[i][0] + placed[i][1]:
            return None
        return number[placed[i][2]], base[starts[i]] + address - starts[i]

    edges = []
    for at, target in calls(elf):
        a, b = where(at), where(target)
        if a and b and a[0] != b[0]:
            edges.append((*a, *b))
    return names, sizes, edges


def long_calls(order, sizes, edges):
    place, at = [0] * len(sizes), 0
    for unit in order:
        place[unit] = at
        at += sizes[unit]
    return sum(1 for a, i, b, j in edges if not -REACH <= place[b] + j - place[a] - i - 2 <= REACH)


def anneal(order, sizes, edges):
    rng = random.Random(1)
    now = best = long_calls(order, sizes, edges)
    best_order = order
    for move in range(MOVES):
        warmth = WARM * (1 - move / MOVES) + 0.02
        block = rng.choice((1, 1, 1, 2, 4, 8, 16))
        at, to = rng.randrange(len(order)), rng.randrange(len(order))
        rest = order[:at] + order[at + block:]
        tried = rest[:to] + order[at:at + block] + rest[to:]
        cost = long_calls(tried, sizes, edges)
        if cost <= now or rng.random() < math.exp((now - cost) / warmth):
            order, now = tried, cost
            if now < best:
                best, best_order = now, order
    return best_order, best


def main():
    names, sizes, edges = graph(BUILT.with_suffix(".elf"), BUILT.with_suffix(".map"))
    before = long_calls(range(len(names)), sizes, edges)
    order, after = anneal(list(range(len(names))), sizes, edges)
    lines = [f"*({names[unit]} {names[unit]}.*)" for unit in order]
    head = "/* Written by mk/scripts/layout.py: functions in an order that makes most calls short. */"
    OUT.write_text("\n".join([head, *lines, ""]), encoding="ascii")
    print(f"{OUT}: {len(names)} functions, {len(edges)} calls between them, {after} of them far, {before} before")


if __name__ == "__main__":
    main()
