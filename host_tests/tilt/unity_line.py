"""Ends a test program of Python with the line that tools/run_tests.py counts, as Unity's do."""
import sys
import unittest


def main():
    result = unittest.main(module="__main__", exit=False, verbosity=1).result
    print(f"{result.testsRun} Tests {len(result.failures) + len(result.errors)} Failures {len(result.skipped)} Ignored")
    for test, reason in result.skipped:
        print(f"{test.id()}:IGNORE: {reason}")
    sys.exit(not result.wasSuccessful())
