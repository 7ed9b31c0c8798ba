#!/usr/bin/env python3
"""make mutants on a product of one file: each operator makes the mutants that it should and no others; a mutant that no test notices
survives, one that hangs or breaks C's rules is killed, one of the same code or that does not compile is dropped, nothing stays broken."""
import collections
import concurrent.futures
import contextlib
import importlib.util
import io
import os
import pathlib
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
TESTS = []
PRODUCT = """#include "tiny.h"
#define STEP 4U
enum { LIMIT = 10 };

/* if (a < b) in a comment is no code */
unsigned tiny_sum(unsigned n)
{
    unsigned sum = 0U;
    for (unsigned i = 0U; i < n; i++) {
        sum += i * STEP;
    }
    return sum;
}

int tiny_inside(int x)
{
    if (x >= -LIMIT && x <= LIMIT) {
        return 1;
    }
    return 0;
}

unsigned tiny_low(const unsigned char *p)
{
    uint8_t state = hal_irq_save();
    unsigned low = *p & 7U;
    hal_irq_restore(state);
    tiny_calls++;
    return low;
}

int tiny_unseen(int x)
{
    return x + 1;
}

unsigned tiny_equal(unsigned x)
{
    return x != 0U ? x : 0U;
}
"""
HEADER = """#ifndef TINY_H
#define TINY_H
#include <stdint.h>
extern unsigned tiny_calls;
static inline uint8_t hal_irq_save(void) { return 1; }
static inline void hal_irq_restore(uint8_t state) { (void)state; }
unsigned tiny_sum(unsigned n);
int tiny_inside(int x);
unsigned tiny_low(const unsigned char *p);
int tiny_unseen(int x);
unsigned tiny_equal(unsigned x);
#endif
"""
JUDGE = """#include "tiny.h"
int main(void)
{
    const unsigned char seven = 0x0F;
    return !(tiny_sum(0U) == 0U && tiny_sum(3U) == 12U && tiny_inside(10) && tiny_inside(-10) && !tiny_inside(11) && !tiny_inside(-11)
             && tiny_low(&seven) == 7U && tiny_calls == 1U && tiny_equal(5U) == 5U && tiny_equal(0U) == 0U && tiny_unseen(1) != 7);
}
"""
STARTS = """#include "tiny.h"
#include <stdlib.h>
int main(void) { return system("exit 0") != 0 || tiny_sum(0U) != 0U; }
"""
FILES = {"lib/tiny.c": PRODUCT, "lib/tiny.h": HEADER, "host_tests/test_tiny.c": JUDGE,
         "host_tests/support_none.c": "unsigned tiny_calls;\n", "unity.c": "extern int nothing;\n"}


def test(function):
    TESTS.append(function)
    return function


def product():
    os.chdir(tempfile.mkdtemp(prefix="mutants-"))
    for name, text in FILES.items():
        path = pathlib.Path("tree", name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    os.chdir("tree")
    sys.path.insert(0, str(HERE.parent / "campaigns" / "mutants"))


def mutants():
    import operators
    return operators.mutants_of("lib/tiny.c", PRODUCT)


def changes(operator):
    found = collections.defaultdict(list)
    for mutant in mutants():
        if mutant.operator == operator:
            found[mutant.owner].append(mutant.change)
    return {owner: sorted(those) for owner, those in found.items()}


@test
def each_operator_makes_its_mutants_and_no_others():
    assert changes("relational") == {"tiny_sum": ["< -> <=", "< -> >"], "tiny_inside": ["<= -> <", "<= -> >", ">= -> <", ">= -> >"],
                                     "tiny_equal": ["!= -> ==", "!= -> >"]}, changes("relational")
    assert changes("arithmetic") == {"tiny_sum": ["* -> +", "++ -> --", "+= -> -="], "tiny_low": ["++ -> --"],
                                     "tiny_unseen": ["+ -> -"]}, changes("arithmetic")
    assert changes("logical") == {"tiny_inside": ["&& -> ||"], "tiny_low": ["& -> |"]}, changes("logical")
    assert changes("negated") == {"tiny_sum": ["for -> !"], "tiny_inside": ["if -> !"], "tiny_equal": ["? -> !"]}, changes("negated")
    assert changes("statement") == {"tiny_sum": ["sum+= -> ;"], "tiny_low": ["tiny_calls++ -> ;"]}, changes("statement")
    assert changes("critical") == {"tiny_low": ["section -> ;"]}, changes("critical")
    assert changes("constant") == {
        "#STEP": ["4U -> 3U", "4U -> 5U", "4U -> 8U"], "LIMIT": ["10 -> 11", "10 -> 20", "10 -> 9"], "tiny_sum": ["0U -> 1U", "0U -> 1U"],
        "tiny_inside": ["0 -> (-1)", "0 -> 1", "1 -> 0", "1 -> 2"], "tiny_low": ["7U -> 14U", "7U -> 6U", "7U -> 8U"],
        "tiny_unseen": ["1 -> 0", "1 -> 2"], "tiny_equal": ["0U -> 1U", "0U -> 1U"]}, changes("constant")


@test
def a_section_goes_as_a_whole():
    section = next(m for m in mutants() if m.operator == "critical").apply(PRODUCT)
    assert "uint8_t state = 0;" in section and "(void)(state);" in section


@test
def keys_name_no_line_and_stay_when_code_before_them_grows():
    import operators
    keys = {m.key for m in mutants()}
    assert len(keys) == len(mutants())
    longer = PRODUCT.replace("int tiny_inside", "int tiny_new(int a)\n{\n    return a < 5;\n}\n\nint tiny_inside", 1)
    assert keys < {m.key for m in operators.mutants_of("lib/tiny.c", longer)}


def verdicts():
    """key without file -> (verdict, by), judged as make mutants does."""
    from host import Host, Settings
    from judge import Judge, Worker
    from reach import Reach
    tree = pathlib.Path.cwd()
    settings = Settings({"HOST_CC": "gcc", "HOST_CXX": "g++", "HOST_FLAGS": "-std=c11 -g -O1 -Ilib", "HOST_SRC": "lib/tiny.c",
                         "TESTS": "build/host/test_tiny", "UNITY_DIR": "."})
    settings.supports, settings.references = ["host_tests/support_none.c"], []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        hosts = [Host(settings, variant, tree) for variant in ("ubsan", "asan")]
        for host in hosts:
            host.compile(pool)
        reach = Reach(hosts[0], ["lib/tiny.c"])
        reach.measure(pool, settings.tests, 60, lambda _: None)
        judge = Judge(hosts, lambda m, _: reach.tests_of(m.file, m.line(PRODUCT), set(), []), {})
        worker = Worker(0, tree)
        return {m.key.split(":")[1]: judge.verdict(m, worker) for m in mutants()}


@test
def verdicts_are_right():
    found = verdicts()
    killed, survived, same = ("killed", "test_tiny"), ("survived", ""), ("same", "")
    assert found["tiny_unseen arithmetic + -> - #1"] == survived
    assert found["tiny_sum arithmetic ++ -> -- #1"] == killed  # takes 2^32 steps or never ends: the limit of time
    assert found["tiny_sum relational < -> <= #1"] == killed
    assert found["LIMIT constant 10 -> 11 #1"] == killed and found["#STEP constant 4U -> 5U #1"] == killed
    assert found["tiny_equal relational != -> > #1"] == same  # of an unsigned number
    assert found["tiny_inside constant 1 -> 2 #1"] == survived  # any true will do
    assert found["tiny_low critical section -> ; #1"] == same  # empty on the PC
    assert found["tiny_low statement tiny_calls++ -> ; #1"] == killed
    assert pathlib.Path("lib/tiny.c").read_text(encoding="utf-8") == PRODUCT


@test
def what_a_test_starts_loads_no_library_of_the_campaign():
    from host import Host, Settings
    tree = pathlib.Path.cwd()
    (tree / "host_tests/test_starts.c").write_text(STARTS, encoding="utf-8")
    (tree / "needy.c").write_text("extern unsigned tiny_calls; unsigned *needed = &tiny_calls;\n", encoding="utf-8")
    settings = Settings({"HOST_CC": "gcc", "HOST_CXX": "g++", "HOST_FLAGS": "-std=c11 -Ilib", "HOST_SRC": "lib/tiny.c",
                         "TESTS": "test_starts", "UNITY_DIR": "."})
    settings.supports, settings.references = ["host_tests/support_none.c"], []
    host = Host(settings, "ubsan", tree)
    host.linked(["gcc", "-shared", "-fPIC", "needy.c", "-o", tree / "needy.so"], tree / "needy.so")
    assert host.run_test("test_starts", tree, [tree / "needy.so"])[0]  # without the constructor the shell ends with "undefined symbol"


@test
def what_does_not_compile_is_dropped():
    from host import Host, Settings
    from judge import Judge, Worker
    from operators import Mutant
    settings = Settings({"HOST_CC": "gcc", "HOST_CXX": "g++", "HOST_FLAGS": "-std=c11 -Ilib", "HOST_SRC": "lib/tiny.c",
                         "TESTS": "test_tiny", "UNITY_DIR": "."})
    judge = Judge([Host(settings, "ubsan", pathlib.Path.cwd())], lambda m, _: [], {})
    at = PRODUCT.index("unsigned sum")
    mutant = Mutant("lib/tiny.c", "tiny_sum", "statement", "", 1, ((at, at + 8, ""),))
    assert judge.verdict(mutant, Worker(0, pathlib.Path.cwd())) == ("uncompiled", "")


def reported(verdicts_of, accepted_keys, **options):
    """(exit status, what a campaign with these results prints)"""
    spec = importlib.util.spec_from_file_location("campaign", HERE.parent / "campaigns/mutants/__main__.py")
    campaign = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(campaign)
    pathlib.Path("build").mkdir(exist_ok=True)
    pathlib.Path("campaigns/mutants").mkdir(parents=True, exist_ok=True)
    pathlib.Path("campaigns/mutants/goals.txt").write_text("# folder, goal, rate\nlib/tiny 50 -\n", encoding="utf-8")
    one = object.__new__(campaign.Campaign)
    one.options = campaign.options_of([])
    vars(one.options).update(options)
    one.accepted, one.mutants = set(accepted_keys), list(verdicts_of)
    rows = [{"key": f"lib/tiny/a.c:{key}", "file": "lib/tiny/a.c", "line": 1, "verdict": verdict, "by": "test_tiny" if verdict == "killed" else ""}
            for key, verdict in verdicts_of.items()]
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        status = one.report(rows)
    return status, out.getvalue()


@test
def a_new_survivor_fails_and_an_accepted_one_does_not():
    status, text = reported({"a": "killed", "b": "survived"}, [])
    assert status == 1 and text.endswith("1 passed, 1 failed\n"), text
    status, text = reported({"a": "killed", "b": "survived"}, ["lib/tiny/a.c:b"])
    assert status == 0 and text.endswith("2 passed, 0 failed\n") and "50.0 %" in text, text


@test
def an_accepted_one_that_is_killed_is_named_and_leaves_the_list():
    status, text = reported({"a": "killed", "b": "survived"}, ["lib/tiny/a.c:a"], accept=True)
    assert status == 0 and "killed now, so it can leave the list: lib/tiny/a.c:a" in text, text
    lines = [x for x in pathlib.Path("campaigns/mutants/accepted.txt").read_text(encoding="utf-8").splitlines() if x[0] != "#"]
    assert lines == ["lib/tiny/a.c:b"], lines
    assert pathlib.Path("campaigns/mutants/goals.txt").read_text(encoding="utf-8").split("\n")[-2].split() == ["lib/tiny", "50", "50.0"]


@test
def a_folder_below_its_goal_fails():
    status, text = reported({"a": "killed", "b": "survived", "c": "survived"}, ["lib/tiny/a.c:b", "lib/tiny/a.c:c"])
    assert status == 1 and "lib/tiny: 1 of 3 killed, below the goal of 50 %" in text, text


def main():
    product()
    failed = 0
    for function in TESTS:
        try:
            function()
            print(f"{function.__name__}:PASS")
        except AssertionError as why:
            failed += 1
            print(f"{function.__name__}:FAIL: {why}")
    print(f"{len(TESTS)} Tests {failed} Failures 0 Ignored")
    return failed != 0


if __name__ == "__main__":
    sys.exit(main())
