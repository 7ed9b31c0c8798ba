#!/usr/bin/env python3
"""The program-memory rule: no constant object, no string literal and no more than the budgeted initialised variables in RAM.

    check_memory.py ELF

On the AVR every plain const and every string is copied into the 2 KB of RAM at start. The objects name file, symbol and text.
"""
import re
import subprocess
import sys

from avr_objects import FOLDER, objects, sections, source_of, symbols
from check_support import Stop, budget, main, report, run

CONSTANT = re.compile(r"\.rodata|\.data\.rel\.ro")


def named_constants():
    """{(source, section)} -> words, of constant objects that have a name."""
    found = {}
    for s in symbols():
        if CONSTANT.match(s.section) and s.size:
            words = f"constant {s.name} ({s.size} bytes) lies in RAM: place it with IN_FLASH"
            found.setdefault((s.source, s.section), []).append(words)
    return found


def texts(path, section):
    """What stands in a section, as words."""
    data = subprocess.run(["avr-objcopy", "-O", "binary", "-j", section, str(path), "/dev/stdout"], stdout=subprocess.PIPE, check=True).stdout
    words = [w.decode("ascii") for w in re.findall(rb"[\x20-\x7e\n\t]{2,}", data)]
    return ", ".join(repr(w) for w in words[:3]) + (", ..." if len(words) > 3 else "") or f"{len(data)} bytes"


def users(path, section):
    """Functions and variables that refer to a section."""
    found, current = set(), "?"
    for line in run("avr-objdump", "-r", path).splitlines():
        title = re.match(r"RELOCATION RECORDS FOR \[(\S+)\]:", line)
        if title:
            current = re.sub(r"^\.(text|data|rodata)\.", "", title.group(1))
        elif re.search(rf"\s{re.escape(section)}([+-]|$)", line) and not current.startswith(".debug"):
            found.add(current)
    return ", ".join(sorted(found)) or "nobody"


def constants_in_ram():
    named = named_constants()
    of_source = {source_of(p): p for p in objects()}
    for source, section, size in sections():
        if not CONSTANT.match(section) or size == 0:
            continue
        for words in named.get((source, section), []):
            yield f"{source}: {words}"
        if (source, section) not in named:
            path = of_source[source]
            yield (f"{source}: text or constant without a name lies in RAM ({size} bytes, used by {users(path, section)}): "
                   f"{texts(path, section)}: use FLASH_TEXT or IN_FLASH")


def check():
    if len(sys.argv) != 2:
        raise Stop("usage: check_memory.py ELF")
    limit = budget("data_bytes")
    size = sum(int(line.split()[1]) for line in run("avr-size", "-A", sys.argv[1]).splitlines() if line.startswith(".data "))
    found = list(constants_in_ram())
    if size > limit:
        found.append(f"{sys.argv[1]}: .data is {size} bytes (budget {limit})")
        found += [f"{s.source}: {s.name} ({s.size} bytes) is an initialised variable" for s in symbols()
                  if s.section.startswith(".data") and s.size]
    return report("program memory", found, f"no constant in RAM, .data {size} bytes (budget {limit}), {len(objects())} objects of {FOLDER}")


if __name__ == "__main__":
    main(check)
