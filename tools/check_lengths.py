#!/usr/bin/env python3
"""Files of at most about 400 lines, functions of at most 60: prints what is longer and exits 1 on any."""
import pathlib
import re
import sys

FILE_MAX, FUNCTION_MAX = 450, 60
FOLDERS = ["firmware", "lib", "hal", "sim", "host_tests"]


def functions(lines):
    """(first line, length) of each top-level brace block that follows a line ending with ')'."""
    start = None
    for number, line in enumerate(lines, 1):
        if line == "{" and number > 1 and re.search(r"\)\s*$", lines[number - 2]):
            start = number
        elif line == "}" and start is not None:
            yield start, number - start - 1
            start = None


def main():
    found = 0
    for folder in FOLDERS:
        for path in sorted(pathlib.Path(folder).rglob("*.[ch]*")):
            if path.suffix not in {".c", ".h", ".cpp"}:
                continue
            lines = path.read_text().splitlines()
            if len(lines) > FILE_MAX:
                print(f"{path}:1: {len(lines)} lines (limit {FILE_MAX})")
                found += 1
            for start, length in functions(lines):
                if length > FUNCTION_MAX:
                    print(f"{path}:{start}: function of {length} lines (limit {FUNCTION_MAX})")
                    found += 1
    print(f"lengths: {found} too long")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
