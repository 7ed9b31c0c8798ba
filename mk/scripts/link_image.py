#!/usr/bin/env python3
"""Links an image of the firmware and checks that it fits its board; otherwise reports in one line the excess bytes, and what would fit.

    link_image.py BOARD FLASH FILTERS COMMAND... -o ELF

FLASH: bytes that the boot loader of BOARD (mk/boards.txt) leaves; FILTERS: the names in the image. The linker only knows 32 KB and only reports
that a section does not fit, so a rejected image is linked again for a chip with more flash. With MEASURE in the environment nothing else happens:
that is how make measures each choice with one filter less, in a folder beside the image.
"""
import os
import pathlib
import shutil
import subprocess
import sys

import boards

LARGER = "-Wl,--defsym=__TEXT_REGION_LENGTH__=128K"
DOES_NOT_FIT = ("will not fit in region", "overflowed by")


def linked(command):
    """Why the linker fails; empty if it succeeds."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0:
        sys.stderr.write(done.stderr)
        return ""
    return done.stderr or f"{command[0]} ended with status {done.returncode}\n"


def flash_bytes(elf):
    """The size of an image in program memory: code, constants and initial values of variables."""
    sections = subprocess.run(["avr-size", "-A", str(elf)], capture_output=True, text=True, check=True).stdout.split("\n")
    sizes = {words[0]: int(words[1]) for words in map(str.split, sections) if len(words) == 3 and words[1].isdigit()}
    return sizes[".text"] + sizes.get(".data", 0)


def measured(board, names, folder):
    """The flash size of an image with these filters, whether it fits or not."""
    elf = folder / "firmware.elf"
    environment = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    command = ["make", "-s", "-j2", f"BOARD={board}", f"U={folder}", f"FILTERS={' '.join(names)}", str(elf)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**environment, "MEASURE": "1"})
    return flash_bytes(elf)


def listed(taken):
    return ", ".join(f"{name} ({taken[name]:,} bytes)" for name in taken)


def first_that_fit(board, flash, names, folder):
    """The longest prefix of the list that fits, perhaps empty. More filters never take less."""
    fit, too_many = 0, len(names) - 1
    while too_many - fit > 1:
        middle = (fit + too_many) // 2
        if measured(board, names[:middle], folder / f"first-{middle}") <= flash:
            fit = middle
        else:
            too_many = middle
    return names[:fit]


def remedy(board, flash, names, size, folder):
    """The filters to leave out, found by building without them."""
    if len(names) == 1:
        others = [each.name for each in boards.TABLE.values() if each.flash >= size]
        return f"{names[0]} does not fit even alone; boards with room for it: {' '.join(others) or 'none'}"
    print(f"measuring the {len(names)} choices with one filter less ...", flush=True)
    without = {name: [other for other in names if other != name] for name in names}
    takes = {name: size - measured(board, rest, folder / f"without-{name}") for name, rest in without.items()}
    enough = {name: bytes_ for name, bytes_ in takes.items() if bytes_ >= size - flash}
    if enough:
        return f'leave out one of {listed(enough)}; FILTERS="{" ".join(without[list(enough)[-1]])}" fits'
    fit = first_that_fit(board, flash, names, folder)
    return f"leave out more than one of {listed(takes)}" + (f'; FILTERS="{" ".join(fit)}" fits' if fit else "")


def main():
    board, flash, names, command = sys.argv[1], int(sys.argv[2]), sys.argv[3].split(), sys.argv[4:]
    elf = pathlib.Path(command[command.index("-o") + 1])
    if "MEASURE" in os.environ:
        refused = linked([*command, LARGER])
        sys.stderr.write(refused)
        return 1 if refused else 0
    refused = linked(command)
    if not refused and flash_bytes(elf) <= flash:
        return 0
    if refused and (not any(words in refused for words in DOES_NOT_FIT) or linked([*command, LARGER])):
        sys.stderr.write(refused)
        return 1
    size = flash_bytes(elf)
    elf.unlink()
    over = f"FILTERS: {size - flash:,} bytes too many for {boards.TABLE[board].what} ({size:,} where {flash:,} fit)"
    folder = elf.parent / "measured"
    try:
        advice = remedy(board, flash, names, size, folder)
    except subprocess.CalledProcessError:  # make has printed the reason
        advice = "leave some out"
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{over}: {advice}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
