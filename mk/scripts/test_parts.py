#!/usr/bin/env python3
"""What each host test is linked with, as makefile rules: test_parts.py FOLDER > FOLDER/parts.mk

A test needs the archive of each folder whose headers it includes, whatever the sources of that folder include in turn, and the objects of single
sources (references, helpers of nav/lib, the judge of simrun) whose headers it includes. A folder's archive holds all its sources, so all of
them are followed; of the helpers in host_tests/support, whose archive every test has, only those whose header is included.
"""
import functools
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)
# archive: its folder; hal's headers are the contracts, its sources the host's side
ARCHIVES = {"filters": "lib/filters/src", "tilt": "lib/tilt/src", "adxl345": "lib/adxl345/src", "hal": "hal/host"}
ROOMS = "firmware"  # an archive of all its folders
SINGLE = ("host_tests/reference", "host_tests/support", "nav/tests", "sim/model", "sim/judge")
FOLDERS = [*ARCHIVES.values(), f"{ROOMS}/*", "hal", *SINGLE]
MODEL = {"adxl345_model", "adxl345_variants", "stream"}
# nav/lib is linked as variants with a table of functions each (nav/nav_lib.mk); test_nav_link has a rule of its own
OWN_RULE = {"test_nav_link"}


def headers():
    """name -> file of every header that a test can include; those of host_tests by their room: support/board.h"""
    found = {}
    for folder in FOLDERS:
        for path in matching(f"{folder}/*.h*"):
            found.setdefault("/".join(path.parts[1:]) if path.parts[0] == "host_tests" else path.name, path)
    return found


@functools.cache
def included(path):
    """Names of what a file includes."""
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


@functools.cache
def matching(pattern):
    return sorted(pathlib.Path(".").glob(pattern))


class Parts:
    """The archives and objects of one test."""

    def __init__(self, known):
        self.known, self.archives, self.objects, self.seen = known, set(), set(), set()

    def follow(self, path):
        if path in self.seen:
            return
        self.seen.add(path)
        for name in included(path):
            header = self.known.get(name) or self.known.get(pathlib.PurePath(name).name)
            if header is not None:
                self.meet(header)

    def meet(self, header):
        """Handles a header that something in the test includes: adds its implementation, and what that needs."""
        self.follow(header)
        folder = str(header.parent)
        for archive, home in ARCHIVES.items():
            if folder == home or (archive == "hal" and folder == "hal"):
                self.take(archive, matching(f"{home}/*.c"))
        if folder.startswith(f"{ROOMS}/"):
            self.take(ROOMS, matching(f"{ROOMS}/*/*.c"))
        if header.stem in MODEL:
            self.take("model", [header.with_suffix(".c")])
        elif folder in SINGLE:
            self.single(header)

    def take(self, archive, sources):
        self.archives.add(archive)
        for source in sources:
            if source.name != "main.c":
                self.follow(source)

    def single(self, header):
        for source in (header.with_suffix(".c"), header.with_suffix(".cpp")):
            if source.is_file():
                self.follow(source)
                if source.parent.name != "support":
                    self.objects.add(str(source.with_suffix(".o")))


def of(test, known):
    """The parts of a test, by its source."""
    parts = Parts(known)
    parts.follow(pathlib.Path(test))
    return parts


def main():
    build = sys.argv[1]
    known = headers()
    for test in sorted([*pathlib.Path("host_tests").glob("*/test_*.c"), *pathlib.Path("nav/tests").glob("test_*.c")], key=lambda path: path.name):
        if test.stem in OWN_RULE:
            continue
        parts = of(test, known)
        words = sorted(f"{build}/{name}" for name in parts.objects) + [f"{build}/lib{name}.a" for name in sorted(parts.archives)]
        print(f"{build}/{test.stem}: {' '.join(words)}")


if __name__ == "__main__":
    main()
