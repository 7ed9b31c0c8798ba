#!/usr/bin/env python3
"""What a release consists of, from what make has built. Equal contents give equal bytes.

    release.py judge                                 the first section of CHANGELOG.md is the version's, and all is committed
    release.py pack FOLDER EPOCH ARGUMENTS DEMO LIBRARY SET-CLOCK=HEX...
                                                     writes FOLDER again: images, demo, libraries, simulator, licences, notes and SHA256SUMS

EPOCH: the time that archives carry. ARGUMENTS: file with the compiler's arguments for the wheel's C. An image that fits no board of its clock is
left out.
"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

import boards
import images
import packed
import wheel
from library import VERSION

SIMULATOR = ("sim/README.md", "sim/*/*.[ch]", "sim/streams/*.csv", "lib/adxl345/src/adxl345_registers.h", "LICENSE")
HEX_DATA = re.compile(r"^:(..)....00", re.M)


def changes():
    """(heading, text) of the first section of the change log."""
    return re.search(r"^## (.*)\n((?:(?!## ).*\n)*)", pathlib.Path("CHANGELOG.md").read_text(encoding="utf-8"), re.M).groups()


def judge():
    heading, found = changes()[0], []
    if heading != VERSION:
        found.append(f"CHANGELOG.md begins with '{heading}', the version in firmware/console/version.h is {VERSION}: rename one")
    status = subprocess.run(["git", "status", "--porcelain"], capture_output=True, text=True, check=False)
    changed = status.stdout.splitlines()
    if status.returncode != 0:
        found.append(f"no git checkout ({status.stderr.splitlines()[0]}): make dist packs any tree")
    elif changed:
        found.append(f"not committed: {changed[0][3:]}" + (f" and {len(changed) - 1} more" if changed[1:] else ""))
    for sentence in found:
        print(f"release: {sentence}", file=sys.stderr)
    return 1 if found else 0


def size(path):
    return sum(int(count, 16) for count in HEX_DATA.findall(pathlib.Path(path).read_text(encoding="ascii")))


def boards_for(name, path):
    """The boards that take an image, by clock and flash."""
    clock_hz = int(re.search(r"-(\d+)mhz$", name)[1]) * 1_000_000
    return [board.name for board in boards.TABLE.values() if board.clock_hz == clock_hz and size(path) <= board.flash]


def judge_nameless(path):
    """An image whose debug information names this folder is another one in another folder (AVR_DEBUG in the Makefile)."""
    elf = pathlib.Path(path).with_suffix(".elf")
    if elf.is_file() and os.fsencode(os.getcwd()) in elf.read_bytes():
        sys.exit(f"release: {elf} has this folder's name in it, so its code depends on the name (AVR_DEBUG in the Makefile)")


def notes(hexes):
    rows = []
    for name, path in hexes.items():
        held = " ".join(images.HOLDS.get(name.split("-")[0], ["navigation, 12 states"]))
        rows.append(f"| `tilt-uno-{VERSION}-{name}.hex` | {held} | {size(path):,} | {', '.join(boards_for(name, path))} |")
    table = "\n".join(["| image | filters | bytes | boards |", "|---|---|---:|---|", *rows])
    how = "How to install each file: docs/install.md. `sha256sum -c SHA256SUMS` checks all of them."
    return f"# tilt-uno {VERSION}\n\n{how}\n\n{table}\n\n## Changes\n{changes()[1]}"


def pack(folder, epoch, arguments, demo, library, *named):
    if not epoch.isdigit():
        sys.exit(f"release: '{epoch}' is no time for the archives: give SOURCE_DATE_EPOCH=, seconds since 1970, where git has none")
    folder, hexes = pathlib.Path(folder), dict(word.split("=", 1) for word in named)
    hexes = {name: path for name, path in hexes.items() if boards_for(name, path)}
    for path in hexes.values():
        judge_nameless(path)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for name, path in hexes.items():
        shutil.copyfile(path, folder / f"tilt-uno-{VERSION}-{name}.hex")
    shutil.copyfile(demo, folder / f"tilt-demo-{VERSION}.html")
    shutil.copyfile(library, folder / f"tilt-filters-{VERSION}.zip")
    wheel.write(folder, VERSION, epoch, pathlib.Path(arguments).read_text(encoding="ascii"), hexes)
    simulator = packed.files(".", *SIMULATOR) | {"Makefile": pathlib.Path("mk/simrun/Makefile").read_bytes()}
    packed.tar_to(folder / f"simrun-{VERSION}.tar.gz", {f"simrun-{VERSION}/{name}": data for name, data in simulator.items()}, epoch)
    (folder / "LICENSES.txt").write_bytes(b"\n".join(pathlib.Path(path).read_bytes() for path in ("LICENSE", wheel.AVR_LIBC)))
    (folder / "NOTES.md").write_text(notes(hexes), encoding="utf-8")
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in sorted(folder.iterdir())]
    (folder / "SHA256SUMS").write_text("".join(sums), encoding="ascii")
    print(f"release: {len(sums) + 1} files, {sum(path.stat().st_size for path in folder.iterdir()) // 1000} kB, in {folder}")
    return 0


if __name__ == "__main__":
    os.umask(0o022)
    if sys.argv[1:] == ["judge"]:
        sys.exit(judge())
    if len(sys.argv) < 8 or sys.argv[1] != "pack":
        sys.exit(__doc__)
    sys.exit(pack(*sys.argv[2:]))
