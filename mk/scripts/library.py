#!/usr/bin/env python3
"""library.py FOLDER: lib/filters, lib/tilt and the header of lib/machine as one library for the Arduino IDE and PlatformIO,
FOLDER/tilt-filters, and beside it as tilt-filters.zip (Sketch, Include Library, Add .ZIP Library).

Both build systems look for headers in src/ alone, so the sources stand side by side there; all else is that of lib/filters.
"""
import pathlib
import shutil
import sys
import zipfile

NAME = "tilt-filters"
ROOT = pathlib.Path("lib/filters")
SOURCES = (ROOT / "src", pathlib.Path("lib/tilt/src"), pathlib.Path("lib/machine/src"))
ANY_TIME = (1980, 1, 1, 0, 0, 0)  # the first that a zip can name: the same sources give the same file


def assemble(folder):
    """Writes the library anew."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT, folder, ignore=lambda where, names: {"src"} if pathlib.Path(where) == ROOT else set())
    (folder / "src").mkdir()
    for path in (path for source in SOURCES for path in sorted(source.glob("*.[ch]"))):
        target = folder / "src" / path.name
        if target.exists():
            raise SystemExit(f"{path}: another folder has a file of this name")
        shutil.copyfile(path, target)


def pack(folder, archive):
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            packed.writestr(zipfile.ZipInfo(str(path.relative_to(folder.parent)), ANY_TIME), path.read_bytes(), zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    place = pathlib.Path(sys.argv[1])
    assemble(place / NAME)
    pack(place / NAME, place / f"{NAME}.zip")
