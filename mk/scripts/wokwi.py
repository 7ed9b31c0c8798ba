#!/usr/bin/env python3
"""wokwi.py FOLDER ELF HEX: writes a Wokwi project: wokwi/ with the firmware, and the chip as one source file, which its editor wants."""
import pathlib
import re
import shutil
import sys

SOURCES = ("sim/model/adxl345_variants.c", "sim/model/adxl345_model.c", "wokwi/adxl345.chip.c")
FOLDERS = ("sim/model", "lib/adxl345/src")
INCLUDE = re.compile(r'^#include "([\w.]+)"\n', re.M)


def whole(path, seen):
    """A file with the project's headers in place of their first #include."""
    def put_in(found):
        place = next((place for place in (pathlib.Path(folder, found[1]) for folder in FOLDERS) if place.is_file()), None)
        if place is None:
            return found[0]  # Wokwi's own
        if place in seen:
            return ""
        seen.add(place)
        return whole(place, seen)
    return INCLUDE.sub(put_in, pathlib.Path(path).read_text(encoding="utf-8"))


def main(folder, elf, image):
    folder, seen = pathlib.Path(folder), set()
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree("wokwi", folder)
    (folder / "adxl345.chip.c").write_text("\n".join(whole(path, seen) for path in SOURCES), encoding="utf-8")
    shutil.copyfile(elf, folder / "firmware.elf")
    shutil.copyfile(image, folder / "firmware.hex")


if __name__ == "__main__":
    main(*sys.argv[1:])
