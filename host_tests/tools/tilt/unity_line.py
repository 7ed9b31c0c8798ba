"""Ends a test program of Python with the lines that campaigns/tests/run_tests.py reads, as Unity's do."""
import pathlib
import sys
import unittest

from unity_report import failure, reason_in


def report(result, file):
    """The reason of each test that failed or was skipped, and the line that is counted."""
    for test, trace in [*result.errors, *result.failures]:
        print(failure(file, test.id().removeprefix("__main__."), reason_in(trace)))
    for test, reason in result.skipped:
        print(f"{test.id()}:IGNORE: {reason}")
    print(f"{result.testsRun} Tests {len(result.failures) + len(result.errors)} Failures {len(result.skipped)} Ignored")


def main():
    result = unittest.main(module="__main__", exit=False, verbosity=1).result
    sys.stderr.flush()
    report(result, pathlib.Path(sys.argv[0]).name)
    sys.exit(not result.wasSuccessful())
