#!/usr/bin/env python3
"""How many files name a filter: code, build and test files, without comments, pages and data, that are not its own. Its own are those whose
name holds the filter's. Adding a filter touches these: at most 8 for each.

    check_names.py [FILTER...]     also lists the files of these filters
"""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import comments
import laws
from check_support import deviations, limit_for, main, report

MOST, RULE = 8, "files that name a filter"
PLACES = ["Makefile", "platformio.ini", "mk", "tools", "checks", "campaigns", "second", "firmware", "nav", "lib", "hal", "sim",
          "host_tests", "web", "wokwi"]
# pages, and what programs recorded, drew or read as data
NO_CODE = {".md", ".csv", ".png", ".svg", ".json", ".hex", ".pyc"}
DATA = ("host_tests/fuzz/corpus", "host_tests/system/transcript")
WRITTEN = {"lib/filters/keywords.txt",  # by host_tests/tools/scripts/arduino_rules.py, of the headers
           "hal/avr/functions.ld"}      # by mk/scripts/layout.py, of the image
# `auto` is a word of these languages too: there it counts in quotes
HAVE_AUTO = {".cpp", ".hpp", ".html", ".css", ".js"}
# and a value of the settings address and i2c, of the compiler's and of the plotter's options
NO_FILTER = re.compile(r'address auto|auto 53 1D|i2c auto|auto 100 400|-flto=auto|aspect="auto"')


def named(words):
    """The filters in words: whole parts between underscores, of nested names the longest."""
    parts = re.compile("|".join(rf"(?:^|(?<=_)){name}(?=_|$)" for name in sorted(laws.names(), key=len, reverse=True)), re.I)
    return {found.lower() for word in words for found in parts.findall(word) if found in (found.lower(), found.upper())}


def code(path):
    text = path.read_text(encoding="utf-8", errors="replace")
    text = NO_FILTER.sub(" ", comments.without(text, path.suffix))
    return re.sub(r"""(?<!["'\w])auto(?!["'\w])""", " ", text) if path.suffix in HAVE_AUTO else text


def files_by_filter():
    found = {name: [] for name in laws.names()}
    places = [path for place in map(pathlib.Path, PLACES) for path in ([place] if place.is_file() else sorted(place.rglob("*")))]
    for path in places:
        if path.is_file() and path.suffix not in NO_CODE and not str(path).startswith(DATA) and str(path) not in WRITTEN:
            for name in named(set(re.findall(r"\w+", code(path)))):
                if not re.search(rf"(?:^|[-_]){name}\d*(?:[-_]|$)", path.stem):
                    found[name].append(str(path))
    return found


def over_limits():
    """For the table of deviations."""
    return {(RULE, name) for name, paths in files_by_filter().items() if len(paths) > MOST}


def check():
    found, wanted = files_by_filter(), sys.argv[1:]
    print("files that name a filter: " + ", ".join(f"{name} {len(paths)}" for name, paths in found.items()))
    for name in wanted:
        print(f"{name}:", *found.get(name, ["is not in the list"]), sep="\n    ")
    said = [f"{path}: names {name}, as {len(paths)} files do that are not its own (limit {limit_for(RULE, name, MOST)})"
            for name, paths in found.items() if len(paths) > limit_for(RULE, name, MOST) for path in paths]
    granted = sum(1 for rule, _ in deviations() if rule == RULE)
    return report("names", said, f"at most {MOST} files for each filter, {granted} granted more")


if __name__ == "__main__":
    main(check)
