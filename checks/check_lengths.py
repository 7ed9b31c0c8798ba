#!/usr/bin/env python3
"""Files of at most 400 lines of at most 120 columns (Python: 150), comments too, which clang-format leaves as they are; C functions of
at most 60 lines and a cyclomatic complexity of at most 10, where a switch counts once (15 with every case counted). What is granted
more stands in docs/deviations.md. Needs lizard (build/venv).

    check_lengths.py [FILE...]     only these files
"""
import pathlib
import re
import sys

from check_support import Stop, chosen, deviations, files, limit_for, main, report

try:
    import lizard
except ImportError:
    sys.exit(f"check_lengths.py: lizard is not installed for {sys.executable}: sh tools/deps.sh check, then `make check-lengths`")

FILE_MAX, FUNCTION_MAX, COMPLEXITY_MAX, COMPLEXITY_CASES_MAX = 400, 60, 10, 15
COLUMNS_MAX, COLUMNS_MAX_PYTHON = 120, 150
LISTED_TEST = re.compile(r"TEST\((\w+)\)")  # host_tests/support/test.h: its function has the test's name


def of_c():
    return files(".c", ".h", ".cpp", ".hpp", ".ino")


def all_files():
    return of_c() + files(".py", folders=["tools", "mk", "checks", "campaigns", "host_tests", "nav"])


def measured(path):
    """(rule, where, line, value, usual limit) of everything measured in a file."""
    text = path.read_text(encoding="utf-8")
    yield "file length", str(path), 1, text.count("\n"), FILE_MAX
    columns_max = COLUMNS_MAX_PYTHON if path.suffix == ".py" else COLUMNS_MAX
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > columns_max:
            yield "line width", str(path), number, len(line), columns_max
    if path.suffix == ".py":
        return
    cases_once = lizard.analyze_files([str(path)], exts=lizard.get_extensions(["modified"]))
    every_case = lizard.analyze_files([str(path)], exts=lizard.get_extensions([]))
    for once, each in zip(next(iter(cases_once)).function_list, next(iter(every_case)).function_list):
        line = once.start_line
        listed = LISTED_TEST.match(text.splitlines()[line - 1])
        where = f"{path}: {listed[1] if listed else once.name}"
        yield "function length", where, line, once.length, FUNCTION_MAX
        yield "complexity", where, line, once.cyclomatic_complexity, COMPLEXITY_MAX
        yield "complexity of cases", where, line, each.cyclomatic_complexity, COMPLEXITY_CASES_MAX


def over_limits():
    """{(rule, where)} of what is above the usual limits, for the table of deviations."""
    return {(rule, where) for path in all_files() for rule, where, _, value, limit in measured(path) if value > limit}


def check():
    findings, functions = [], 0
    paths = chosen(all_files())
    for path in paths:
        for rule, where, line, value, usual in measured(path):
            functions += rule == "complexity"
            limit = limit_for(rule, where, usual)
            if value > limit:
                place = f"{path}:{line}:" + (where.partition(":")[2] or "")
                findings.append(f"{place} {rule} {value} (limit {limit})")
    granted = sum(1 for rule, _ in deviations() if rule.split()[0] in {"file", "line", "function", "complexity"})
    if not functions and len(paths) > 1:
        raise Stop("lizard found no function in any file")
    return report("lengths and complexity", findings, f"{functions} functions in {len(paths)} files within the limits, {granted} granted more")


if __name__ == "__main__":
    main(check)
