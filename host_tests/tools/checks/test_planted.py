#!/usr/bin/env python3
"""checks/planted.py: what counts as a planted fault that its check found, and what does not; anchors.py of
campaigns/breakages: how a breakage finds its place."""
import pathlib
import re
import sys
import tempfile

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import anchors  # noqa: E402
import planted  # noqa: E402
from system_support import refused, run_all, test  # noqa: E402

LIST = """# a comment

a division
    lib/filters/src/planted.c | symbols, tidy
    symbols says: divides
    tidy does not say: .
    | int planted;
"""
CODE = """/* f(1) */
static int f(int a)
{
    int b = g(a, h(2)); /* g */
    return (a <= b) ? a : b;
}

static int f2(int a)
{
    return a <= 3;
}
"""


def loaded(text, load=planted.load):
    with tempfile.NamedTemporaryFile("w", suffix=".txt", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        return load(pathlib.Path(file.name))


FAULT = loaded(LIST)[0]
RIGHT = "lib/filters/src/planted.c: planted divides for every sample"


def counts(status, output, check="symbols"):
    return planted.judged(check, FAULT, status, output)[1]


@test
def what_counts_is_the_right_finding_about_the_right_file_in_one_line():
    assert (FAULT.says, FAULT.silent, FAULT.new) == ({"symbols": ["divides"]}, {"tidy": ["."]}, "int planted;\n")
    assert counts(2, f"something else\n{RIGHT}\n")
    unknown = "lib/filters/src/planted.c:1:1: error: unknown type name 'this'\n"
    for status, output in ((2, unknown), (2, RIGHT.replace("planted.c", "other.c")), (2, f"{unknown}other.c divides\n"), (0, RIGHT), (None, RIGHT),
                           (2, f"make: *** [{RIGHT}] Error 1")):
        assert not counts(status, output), (status, output)


@test
def every_finding_that_is_stated_must_come():
    two = loaded(LIST.replace("    tidy does", "    symbols says: by three\n    tidy does"))[0]
    assert not planted.judged("symbols", two, 2, RIGHT)[1] and planted.judged("symbols", two, 2, RIGHT + " by three")[1]


@test
def check_that_is_blind_may_fail_for_another_file_but_not_speak_of_this_one():
    assert counts(0, "", "tidy") and counts(2, "other.c: unknown type", "tidy") and not counts(2, RIGHT, "tidy")


@test
def entry_without_words_or_not_in_form_is_refused():
    for old, new, why in (("    symbols says: divides\n", "", "nothing states what the finding must be: symbols says"),
                          (" | symbols, tidy", "", "an entry is NAME"), ("    | int planted;\n", "", "either lines OLD"),
                          ("says: divides", "says divides", "is neither OLD => NEW")):
        refused(SystemExit, lambda: loaded(LIST.replace(old, new)), "'a division'", why)


def broken(place, *edits):
    lines = "".join(f"    {edit}\n" for edit in edits)
    return anchors.broken(loaded(f"x\n    {place} | test_x\n{lines}", anchors.load)[0], {"lib/a.c": CODE})[1]


@test
def breakage_is_found_by_its_tokens_in_its_definition_alone():
    assert broken("f", "(a<=b) => (a < b)") == CODE.replace("(a <= b)", "(a < b)")
    assert broken("a.c:f2", "a <= => a >=") == CODE.replace("a <= 3", "a >= 3")
    assert broken("a.c", "<= 3 =>") == CODE.replace("<= 3", "")
    assert broken("f", "g(...) => ... + 1") == CODE.replace("g(a, h(2))", "a, h(2) + 1")
    assert broken("f", "g(a => k(a", "k(a, => l(a,") == CODE.replace("g(a", "l(a")


@test
def breakage_that_stands_twice_or_not_at_all_is_lost():
    for place, edit, why in (("f", "b => c", "occurs 3 times"), ("f", "a < => a >", "occurs 0 times"), ("f", "f(1) =>", "occurs 0 times"),
                             ("f3", "a => b", "f3 is defined in 0 files"), ("b.c:f", "a => b", "there is no file b.c"),
                             ("f", "g(...; => k(", "occurs 0 times")):
        refused(anchors.Lost, lambda: broken(place, edit), why)


@test
def words_of_every_fault_refuse_text_that_is_not_c():
    """What compilers and clang-tidy say of it: with any failure that names the file, most checks would have found it."""
    said = ["error: unknown type name ‘this’", "error: expected ‘=’, ‘,’, ‘;’, ‘asm’ or ‘__attribute__’ before ‘not’",
            "error: unknown type name 'this' [clang-diagnostic-error,-warnings-as-errors]", "syntax error [syntaxError]",
            "In function ‘planted’:"]
    for fault in planted.load(planted.LIST):
        for check, words in ((check, words) for check, many in fault.says.items() for words in many):
            for text in said:
                assert not re.search(words, f"{planted.file_of(fault)}:1:1: {text}"), f"{fault.name}: {check}: {words}"


if __name__ == "__main__":
    sys.exit(run_all())
