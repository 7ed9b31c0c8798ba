"""What make proof CHANGED=yes takes as proved: a proof whose sources, Frama-C and options are those of its line, and no other."""
import pathlib
import shutil
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import proof  # noqa: E402
import proved

from system_support import OUT, Skip, refused, run_all, test

WORK = OUT / "proved"


def source(text):
    WORK.mkdir(parents=True, exist_ok=True)
    path = WORK / "law.c"
    path.write_text(text, encoding="utf-8")
    return {path}


@test
def code_and_contracts_count_and_comments_do_not():
    plain = proved.digest(source("int f(void)\n{\n    return 1; /* why */\n}\n"), ["-slevel 5"])
    assert proved.digest(source("int f(void) {\n    return 1; // because\n}\n"), ["-slevel 5"]) == plain
    for other in ("int f(void) { return 2; }", "int f(void) { /*@ assert 1; */ return 1; }", "int f(void) { //@ check 1;\n return 1; }"):
        assert proved.digest(source(other), ["-slevel 5"]) != plain, other
    assert proved.digest(source("int f(void) { return 1; }"), ["-slevel 6"]) != plain


@test
def what_stands_in_a_proof_counts_whole():
    here = proved.LEDGER.parent
    files = {here / "proof_rest.c"}
    kept, text = proved.digest(files, []), (here / "proof_rest.c").read_text(encoding="utf-8")
    assert "/*" in text
    original = pathlib.Path.read_text
    with mock.patch.object(pathlib.Path, "read_text", lambda path, encoding: original(path, encoding=encoding).replace("/*", "/* Options: none ", 1)):
        assert proved.digest(files, []) != kept


@test
def how_a_proof_is_asked_and_judged_counts_and_so_does_what_it_takes_by_contract():
    if shutil.which("frama-c") is None:
        raise Skip("frama-c is not installed: sh tools/deps.sh proof")
    entries = {"a": ("proof_rest.c", ["filter_kalman_step"], []), "b": ("proof_fx.c", [], [])}
    plain = proof.inputs_of(entries)
    assert proof.inputs_of(dict(reversed(entries.items()))) == plain
    for entry in (("proof_rest.c", [], []), ("proof_rest.c", ["filter_kalman_step"], ["-eva-slevel", "1"])):
        other = proof.inputs_of(entries | {"a": entry})
        assert other["proof_rest.c"] != plain["proof_rest.c"] and other["proof_fx.c"] == plain["proof_fx.c"], entry
    with mock.patch.object(proof, "PROVED", proof.PROVED | {"Unknown"}):
        assert proof.inputs_of(entries)["proof_rest.c"] != plain["proof_rest.c"]


@test
def an_include_from_elsewhere_is_refused():
    WORK.mkdir(parents=True, exist_ok=True)
    path = WORK / "proof_lost.c"
    path.write_text('#include "fx.h"\n  #  include "of_no_folder.h"\n', encoding="utf-8")
    try:
        proof.included(path, set())
    except SystemExit as end:
        assert end.code == 1, end.code
    else:
        raise AssertionError("not refused")


@test
def lines_come_back_as_written():
    with mock.patch.object(proved, "LEDGER", WORK / "proved.json"):
        rows = {"proof_b.c": ("00ff", {"f", "g"}, {("f", "a + b")}), "proof_a.c": ("11ee", {"h"}, set())}
        proved.write(rows)
        assert proved.read() == rows
        assert len(proved.LEDGER.read_text(encoding="utf-8").splitlines()) == 4


@test
def every_proof_has_its_line_and_a_change_takes_it_away():
    inputs = {"proof_rest.c": "1", "proof_fx.c": "other"}
    rows = {"proof_rest.c": ("1", {"f"}, set()), "proof_fx.c": ("2", {"g"}, set()), "proof_gone.c": ("3", set(), set())}
    with mock.patch.object(proved, "read", lambda: rows), mock.patch.dict(proof.os.environ, {"CHANGED": "yes"}):
        assert list(proof.unchanged(inputs, [])) == ["proof_rest.c"]
        assert not proof.unchanged(inputs, ["rest"])
        proof.os.environ["CHANGED"] = ""
        assert not proof.unchanged(inputs, [])
    named = {file for file, _, _ in proof.load_entries().values()}
    assert set(proved.read()) == named, set(proved.read()) ^ named


if __name__ == "__main__":
    raise SystemExit(run_all())
