#!/usr/bin/env python3
"""library.py FOLDER: writes lib/filters, lib/tilt and the header of lib/machine as one library for the Arduino IDE and PlatformIO to
FOLDER/tilt-filters and, beside it, tilt-filters.zip (Sketch, Include Library, Add .ZIP Library).

Both build systems search headers only in src/, so all sources are there; everything else is that of lib/filters, and the version is the
firmware's.
"""
import pathlib
import re
import shutil
import sys

import packed

NAME = "tilt-filters"
ROOT = pathlib.Path("lib/filters")
SOURCES = (ROOT / "src", pathlib.Path("lib/tilt/src"), pathlib.Path("lib/machine/src"))
VERSION = re.search(r'FIRMWARE_VERSION "(.*)"', pathlib.Path("firmware/console/version.h").read_text(encoding="ascii"))[1]


def assemble(folder):
    """Writes the library again."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT, folder, ignore=lambda where, names: {"src"} if pathlib.Path(where) == ROOT else set())
    (folder / "src").mkdir()
    for path in (path for source in SOURCES for path in sorted(source.glob("*.[ch]"))):
        target = folder / "src" / path.name
        if target.exists():
            raise SystemExit(f"{path}: file name exists in another folder too: rename one")
        shutil.copyfile(path, target)
    after_name(folder / "library.properties", r"^name=.*\n", f"version={VERSION}\n")
    after_name(folder / "library.json", r'^ *"name": .*\n', f'  "version": "{VERSION}",\n')


def after_name(path, name, line):
    text, there = re.subn(name, lambda found: found[0] + line, path.read_text(encoding="utf-8"), count=1, flags=re.M)
    if not there:
        raise SystemExit(f"{path}: no name")
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    place = pathlib.Path(sys.argv[1])
    assemble(place / NAME)
    packed.zip_to(place / f"{NAME}.zip", packed.files(place, f"{NAME}/**/*"), packed.EARLIEST)
