#!/usr/bin/env python3
"""tools/planted.py: what counts as a planted fault that its check found, and what does not."""
import importlib.util
import pathlib
import re
import sys

from system_support import run_all, test

spec = importlib.util.spec_from_file_location("planted", pathlib.Path("tools/planted.py"))
planted = importlib.util.module_from_spec(spec)
spec.loader.exec_module(planted)

BLOCK = """
=== a division
lib/filters/src/planted.c
symbols: divides
blind: compile tidy
---

---
int planted;
"""
FAULT = planted.load(BLOCK)[0]
RIGHT = "lib/filters/src/planted.c: planted divides for every sample"


def counts(status, output):
    return planted.judged("symbols", FAULT, status, output)[1]


@test
def right_finding_counts():
    assert (FAULT["checks"], FAULT["blind"]) == ({"symbols": "divides"}, ["compile", "tidy"])
    assert counts(2, f"something else\n{RIGHT}\n")


@test
def wrong_finding_about_the_file_does_not_count():
    assert not counts(2, "lib/filters/src/planted.c:1:1: error: unknown type name 'this'\n")


@test
def right_finding_about_another_file_does_not_count():
    assert not counts(2, RIGHT.replace("planted.c", "other.c"))


@test
def file_and_words_on_different_lines_do_not_count():
    assert not counts(2, "lib/filters/src/planted.c:1:1: error: unknown type name 'this'\nother.c divides\n")


@test
def finding_of_a_check_that_passes_or_hangs_does_not_count():
    assert not counts(0, RIGHT) and not counts(None, RIGHT)


@test
def words_of_make_do_not_count():
    assert not counts(2, f"make: *** [{RIGHT}] Error 1")


@test
def block_without_words_is_refused():
    for line in ("symbols", "symbols:", "symbols: ", "symbols tidy"):
        try:
            planted.load(BLOCK.replace("symbols: divides", line))
        except SystemExit as stop:
            assert "'a division'" in str(stop) and "does not state what the finding must say" in str(stop), stop
        else:
            raise AssertionError(f"taken: {line}")


@test
def words_of_every_fault_refuse_text_that_is_not_c():
    """What compilers and clang-tidy say of it: with any failure that names the file, most checks would have found it."""
    said = ["error: unknown type name ‘this’", "error: expected ‘=’, ‘,’, ‘;’, ‘asm’ or ‘__attribute__’ before ‘not’",
            "error: unknown type name 'this' [clang-diagnostic-error,-warnings-as-errors]", "syntax error [syntaxError]",
            "In function ‘planted’:"]
    for fault in planted.load(planted.LIST.read_text(encoding="utf-8")):
        for check, words in fault["checks"].items():
            for text in said:
                assert not re.search(words, f"{fault['file']}:1:1: {text}"), f"{fault['name']}: {check}: {words}"


if __name__ == "__main__":
    sys.exit(run_all())
