#!/usr/bin/env python3
"""misspelt.py NAME...: of the variables typed after `make`, reports the first that no makefile knows, with the probable one.

Prints one sentence, or nothing if all are known. Make itself would ignore such a variable.
"""
import difflib
import pathlib
import re
import sys

# where a makefile uses, sets or explains a variable
USED = re.compile(r"\$[({](?:value |origin )?([A-Z]\w*)|^(?:[\w %-]+:)? ?(?:export )?([A-Z]\w*) *[:?+]?=|(?<![-\w])([A-Z]\w*)=", re.MULTILINE)
FOLDERS = ("mk", "checks", "nav", "second", "web", "tools", "campaigns", "host_tests")
OF_MAKE = {"SHELL", "MAKEFLAGS"}
# names in other projects
ELSEWHERE = {"CC": "HOST_CC", "CXX": "HOST_CXX"}


def makefiles():
    """The Makefile and its parts."""
    return [pathlib.Path("Makefile"), *(path for folder in FOLDERS for path in sorted(pathlib.Path(folder).rglob("*.mk")))]


def known():
    """Names of all variables that a person may type."""
    found = {name for path in makefiles()
             for groups in USED.findall(path.read_text(encoding="utf-8")) for name in groups if name}
    return found | OF_MAKE


def complaint(names, legal):
    """One sentence about the first name that is not legal; empty if there is none."""
    for name in names:
        if name not in legal:
            near = [ELSEWHERE[name]] if name in ELSEWHERE else difflib.get_close_matches(name.upper(), sorted(legal), 1, 0.6)
            return f"no variable {name}: " + (f"did you mean {near[0]}?" if near else "`make help` lists the targets and their variables")
    return ""


if __name__ == "__main__":
    print(complaint(sys.argv[1:], known()), end="")
