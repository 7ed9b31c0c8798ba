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
import queue
import subprocess
import sys
import tempfile
import types

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[3]
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
FILES = {"lib/tiny.c": PRODUCT, "lib/tiny.h": HEADER, "host_tests/room/test_tiny.c": JUDGE,
         "host_tests/support/none.c": "unsigned tiny_calls;\n", "unity.c": "extern int nothing;\n"}


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
    sys.path.insert(0, str(ROOT / "campaigns" / "mutants"))


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
    settings.supports, settings.references = ["host_tests/support/none.c"], []
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
    (tree / "host_tests/room/test_starts.c").write_text(STARTS, encoding="utf-8")
    (tree / "needy.c").write_text("extern unsigned tiny_calls; unsigned *needed = &tiny_calls;\n", encoding="utf-8")
    settings = Settings({"HOST_CC": "gcc", "HOST_CXX": "g++", "HOST_FLAGS": "-std=c11 -Ilib", "HOST_SRC": "lib/tiny.c",
                         "TESTS": "test_starts", "UNITY_DIR": "."})
    settings.supports, settings.references = ["host_tests/support/none.c"], []
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


def campaign_module():
    spec = importlib.util.spec_from_file_location("campaign", ROOT / "campaigns/mutants/__main__.py")
    campaign = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(campaign)
    return campaign


def reported(verdicts_of, accepted_keys, whole=("lib/tiny",), left=(), sources="", now="1a2b", share=0.5, **options):
    """(exit status, what is printed); left: mutants without a verdict; sources, now: digests as measured and as they are; share: may survive."""
    campaign = campaign_module()
    campaign.digests = lambda: {"lib/tiny": now}
    pathlib.Path("build").mkdir(exist_ok=True)
    pathlib.Path("campaigns/mutants").mkdir(parents=True, exist_ok=True)
    pathlib.Path("campaigns/mutants/goals.txt").write_text(f"# folder, goal, rate\nlib/tiny 50 - {sources}\n", encoding="utf-8")
    one = object.__new__(campaign.Campaign)
    one.options = campaign.options_of([])
    vars(one.options).update(options)
    one.accepted, one.mutants = set(accepted_keys), [*verdicts_of, *left]
    one.texts, one.whole, one.shares = {"lib/tiny/a.c": ""}, set(whole), {"lib/tiny": share}
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
    assert pathlib.Path("campaigns/mutants/goals.txt").read_text(encoding="utf-8").split("\n")[-2].split() == ["lib/tiny", "50", "50.0", "1a2b"]


@test
def a_folder_below_its_goal_fails():
    status, text = reported({"a": "killed", "b": "survived", "c": "survived"}, ["lib/tiny/a.c:b", "lib/tiny/a.c:c"])
    assert status == 1 and "lib/tiny: 1 of 3 killed, below the goal of 50 %" in text, text


@test
def a_campaign_cut_short_accepts_nothing():
    lists = [pathlib.Path("campaigns/mutants", name) for name in ("accepted.txt", "judges.txt")]
    for path in lists:
        path.write_text("lib/tiny/a.c: b\n", encoding="utf-8")
    status, text = reported({"a": "killed", "b": "survived"}, [], left=["c"], accept=True)
    assert status == 2 and "nothing is accepted: 1 of 3 mutants have no verdict yet" in text, text
    assert [path.read_text(encoding="utf-8") for path in lists] == ["lib/tiny/a.c: b\n"] * 2
    assert "lib/tiny 50 -" in pathlib.Path("campaigns/mutants/goals.txt").read_text(encoding="utf-8")


@test
def a_part_of_a_folder_neither_sets_nor_fails_its_rate():
    status, text = reported({"a": "survived"}, [], whole=(), accept=True)
    assert status == 0 and "below the goal" not in text, text
    assert "lib/tiny 50 -" not in text and pathlib.Path("campaigns/mutants/goals.txt").read_text(encoding="utf-8").split()[-1] == "-"
    campaign = campaign_module()
    campaign.product = lambda: ["lib/tiny/a.c", "lib/tiny/b.c", "lib/other/c.c"]
    assert campaign.whole_folders(["lib/tiny/a.c", "lib/other/c.c"]) == {"lib/other"}


@test
def a_sample_of_a_folder_that_has_changed_is_held_to_its_goal():
    """5 of 8 survive by chance in 36 % of the samples where half do and in 0.04 % where a tenth does, all 8 in 0.4 % where half do."""
    five = {f"m{n}": "survived" if n < 5 else "killed" for n in range(8)}
    assert reported(five, [], sample=8, sources="1a2b")[1].endswith("3 passed, 5 failed\n")
    for sources in ("", "9f9f"):
        for verdicts, share, status in ((five, 0.5, 0), (dict.fromkeys(five, "survived"), 0.5, 1), (five, 0.1, 1), (five, 0.0, 1)):
            got, text = reported(verdicts, [], sample=8, sources=sources, share=share)
            assert got == status and (f"of 8 survive, too many where the goal leaves {100 * share:.1f} %" in text) == bool(status), text


@test
def a_sample_is_drawn_from_folders_with_a_goal_or_as_they_were_measured_and_accepted_survivors_leave_less_room():
    """Of 20 mutants 10 may survive where the goal is 50 %: 6 are accepted, so 4 of the other 14; or all ten and more, so none."""
    from verdicts import may_survive, sampled
    pathlib.Path("campaigns/mutants/goals.txt").write_text("lib/a 50 -\nlib/b 0 80.0 1a2b\nlib/c 0 80.0 1a2b\nlib/d 0 -\n", encoding="utf-8")
    assert sampled({"lib/a": "x", "lib/b": "1a2b", "lib/c": "2", "lib/d": "y"}) == ["lib/a", "lib/b"]
    twenty = [types.SimpleNamespace(file="lib/a/a.c", key=f"m{n}") for n in range(20)]
    for known, share in ((6, 4 / 14), (10, 0.0), (12, 0.0), (0, 0.5)):
        assert may_survive(twenty, {f"m{n}" for n in range(known)} | {"of another folder"}) == {"lib/a": share}


@test
def a_folder_of_the_goals_is_that_one_alone_and_other_words_begin_a_path():
    campaign = campaign_module()
    campaign.product = lambda: ["firmware/a.c", "nav/image/b.c", "hal/c.h"]
    campaign.goals = lambda: {"firmware": (0.0, None)}

    def chosen(only):
        return campaign.sources(types.SimpleNamespace(only=only, sample=0))
    assert chosen("firmware") == ["firmware/a.c"] and chosen("nav/") == ["nav/image/b.c"] and chosen("h") == ["hal/c.h"]


@test
def what_is_known_holds_while_its_judge_is_the_same_and_not_for_a_sample():
    from verdicts import ROOT, Results
    (ROOT / "results.jsonl").unlink(missing_ok=True)
    killed, survived, *_ = mutants()
    results = Results("all")
    results.put(killed, "file", 1, "killed", "test_tiny", 0)
    results.put(survived, "file", 1, "survived", "", 0)
    results.put(survived, "file", 1, "killed", "test_tiny", 0, keep=False)  # a sample's
    results = Results("all")
    assert results.get(killed, "file")["by"] == "test_tiny" and results.get(survived, "file")["verdict"] == "survived"
    assert results.get(killed, "other") is None and Results("more").get(survived, "file") is None
    assert Results("more").get(killed, "file")
    judge = pathlib.Path("host_tests/room/test_tiny.c")
    judge.write_text(JUDGE + "\n", encoding="utf-8")
    try:
        assert Results("all").get(killed, "file") is None
    finally:
        judge.write_text(JUDGE, encoding="utf-8")


@test
def a_sample_is_judged_whatever_is_known():
    campaign = campaign_module()
    one = object.__new__(campaign.Campaign)
    mutant, kept = mutants()[0], []
    one.options, one.began, one.hashes, one.texts = campaign.options_of(["--sample=1"]), 0, {"lib/tiny.c": "x"}, {"lib/tiny.c": PRODUCT}
    one.results = campaign.Results("all")
    one.results.get = lambda *_: {"verdict": "killed"}
    one.results.put = lambda *words, keep: kept.append((words[3], keep)) or {"verdict": words[3]}
    one.workers = queue.SimpleQueue()
    one.workers.put(None)
    learner = types.SimpleNamespace(learn=lambda *_: None)
    one.judge_of = lambda _: (types.SimpleNamespace(verdict=lambda *_: ("survived", "")), learner)
    assert one.one(mutant)["verdict"] == "survived" and kept == [("survived", False)]
    one.options = campaign.options_of([])
    assert one.one(mutant)["verdict"] == "killed"


@test
def bad_words_are_refused_in_a_sentence():
    campaign = campaign_module()
    for words, said in ((["--sample=-5"], "SAMPLE=-5 is no whole number above 0"), (["--sample=0"], "SAMPLE=0 is no whole number above 0"),
                        (["--sample=2.5"], "SAMPLE=2.5"), (["--seconds=soon"], "STOP_AFTER=soon is no number of seconds above 0"),
                        (["--patience=nan"], "PATIENCE=nan"), (["--accept", "--sample=5"], "leave SAMPLE out")):
        try:
            campaign.options_of(words)
        except campaign.Stop as why:
            assert said in str(why), why
        else:
            raise AssertionError(f"{words} is taken")
    assert campaign.options_of(["--sample=", "--seconds=", "--patience="]).sample == 0


@test
def make_takes_yes_and_no_and_nothing_else():
    alone = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "ACCEPT", "NAMED", "SAMPLE")}
    for words, status, said in ((["NAMED=maybe"], 2, "NAMED=maybe is neither yes nor no"), (["ACCEPT=perhaps"], 2, "ACCEPT=perhaps is neither"),
                                (["NAMED=no"], 0, "campaigns/mutants "), (["NAMED=yes"], 0, "campaigns/breakages/breakages.py"),
                                (["ACCEPT=1"], 0, "--accept")):
        done = subprocess.run(["make", "-n", "mutants", *words], cwd=ROOT, env=alone, capture_output=True, text=True)
        assert done.returncode == status and said in done.stdout + done.stderr, (words, done)
    done = subprocess.run(["make", "-n", "mutants", "ACCEPT=0"], cwd=ROOT, env=alone, capture_output=True, text=True)
    assert done.returncode == 0 and "--accept" not in done.stdout, done


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
