#!/usr/bin/env python3
"""pack_texts.py OUT: packs the replies (firmware/base/replies.h, firmware/console/reply_texts.h) for program memory: firmware/console/reply_packed.h.

Byte pair encoding: the most frequent pair of neighbours gets a byte of its own, repeatedly, until a pair saves no more than the two bytes
of its entry in the list of pairs. reply_lines.c unpacks them with a stack of PACKED_DEPTH bytes.
"""
import collections
import pathlib
import re
import shutil
import subprocess
import sys

ALONE, PAIR_FIRST, PAIRS_MAX = 0x7B, 0x8F, 0x71  # smaller bytes are characters, or stand for values; from ALONE on (enum say) in no pair
STEP = 16                           # every STEP-th text has its start stored; the firmware counts ends from there
COLUMNS = 110


def texts():
    """[(name, bytes)] in the order of the list."""
    compiler = next((name for name in ("gcc", "cc", "avr-gcc") if shutil.which(name)), None)
    if compiler is None:
        sys.exit("pack_texts: no C compiler found: install one with sh tools/deps.sh firmware")
    source = ('#include "console/reply_texts.h"\n#define TEXT(name, words) @name words\n#define COMMAND(name, typed, words) @name words\n'
              'REPLY_TEXTS(TEXT, COMMAND)\n')
    command = [compiler, "-E", "-P", "-mmcu=atmega328p"][:4 if compiler == "avr-gcc" else 3]
    includes = ["-Ifirmware", "-Ilib/machine/src", "-Ihal", "-Ihal/avr" if compiler == "avr-gcc" else "-Ihal/host"]
    done = subprocess.run([*command, *includes, "-x", "c", "-"], input=source, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"pack_texts: {done.stderr}")
    found = re.findall(r'@(\w+)((?:\s*"(?:[^"\\]|\\.)*")+)', done.stdout)
    return [(name, "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', words)).encode().decode("unicode_escape").encode("latin-1")) for name, words in found]


def occurrences(rows):
    """How often each pair of neighbours can be replaced: of three equal bytes in a row once."""
    count = collections.Counter()
    for row in rows:
        before = None
        for pair in zip(row, row[1:]):
            if any(ALONE <= code < PAIR_FIRST for code in pair):
                continue
            if pair == before and pair[0] == pair[1]:
                before = None
                continue
            count[pair] += 1
            before = pair
    return count


def replaced(row, pair, code):
    out, at = [], 0
    while at < len(row):
        whole = tuple(row[at:at + 2]) == pair
        out.append(code if whole else row[at])
        at += 1 + whole
    return out


def pack(rows):
    """(pairs, rows with the pairs replaced)"""
    pairs = []
    while len(pairs) < PAIRS_MAX:
        pair, count = max(occurrences(rows).items(), key=lambda item: (item[1], item[0]))
        if count <= 2:
            break
        rows = [replaced(row, pair, PAIR_FIRST + len(pairs)) for row in rows]
        pairs.append(pair)
    return pairs, rows


def depth_of(code, pairs):
    """Stack bytes needed to unpack a code."""
    if code < PAIR_FIRST:
        return 0
    first, second = pairs[code - PAIR_FIRST]
    return max(1 + depth_of(first, pairs), depth_of(second, pairs))


def unpacked(row, pairs):
    out = []
    for code in row:
        out += unpacked(pairs[code - PAIR_FIRST], pairs) if code >= PAIR_FIRST else [code]
    return out


def lines(numbers):
    """Numbers in rows of an initialiser, formatted as by clang-format."""
    text, line = [], "   "
    for number in numbers:
        word = f" {number},"
        if len(line) + len(word) > COLUMNS:
            text.append(line)
            line = "   "
        line += word
    return "\n".join([*text, line])


def header(named):
    rows = [list(text) for _, text in named]
    pairs, packed = pack(rows)
    assert [unpacked(row, pairs) for row in packed] == rows
    ends = [0]
    for row in packed:
        ends.append(ends[-1] + len(row) + 1)
    flat = [code for row in packed for code in [*row, 0]]
    depth = max(depth_of(code, pairs) for code in flat)
    plain = sum(len(row) + 1 for row in rows)
    return f"""/*
 * Written by mk/scripts/pack_texts.py from replies.h and reply_texts.h: {len(rows)} texts of {plain} bytes in {len(flat)}, and
 * {len(pairs)} pairs. A byte from PACKED_PAIR_FIRST on is the two of its pair, which may be such bytes again,
 * PACKED_DEPTH deep at most.
 */
#ifndef REPLY_PACKED_H
#define REPLY_PACKED_H

#include <stdint.h>

#include "machine.h"

#define PACKED_PAIR_FIRST 0x{PAIR_FIRST:02X}u
#define PACKED_DEPTH {depth}
#define PACKED_STEP {STEP}u

/* clang-format off */
static const uint8_t packed_pairs[] IN_FLASH = {{
{lines([code for pair in pairs for code in pair])}
}};

/* Where every PACKED_STEP-th text begins. */
static const uint16_t packed_starts[] IN_FLASH = {{
{lines(ends[0:-1:STEP])}
}};

static const uint8_t packed_texts[] IN_FLASH = {{
{lines(flat)}
}};
/* clang-format on */

#endif
"""


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: pack_texts.py OUT")
    pathlib.Path(sys.argv[1]).write_text(header(texts()), encoding="utf-8")


if __name__ == "__main__":
    main()
