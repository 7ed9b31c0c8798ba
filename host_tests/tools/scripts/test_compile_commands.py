"""make compile_commands: every C file is in it, and every command of it compiles its file."""
import functools
import json
import os
import pathlib
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, Skip, run_all, test

from laws import PLAIN, ROBUST  # noqa: E402

import bitexact  # noqa: E402
import check_compile  # noqa: E402
import check_support  # noqa: E402
import compile_commands  # noqa: E402

DATABASE = OUT / "compile_commands.json"
# what is built for which side; the longest name decides. A test is built for one at least.
SIDES = {"firmware": {"PC", "chip"}, "firmware/app/main.c": {"chip"}, "nav/image/main.c": {"chip"}, "lib": {"PC", "chip"},
         "nav/lib": {"PC", "chip"}, "hal/avr": {"chip"}, "hal/host": {"PC"}, "sim": {"PC"}}


@functools.cache
def entries():
    """Made anew by each run of these tests."""
    DATABASE.unlink(missing_ok=True)
    done = subprocess.run(["make", "-s", "compile_commands", f"COMPILE_COMMANDS={DATABASE}"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(DATABASE.read_text(encoding="utf-8"))


def own_files():
    """The C files that a compiler takes; those of host_tests/proof speak to the prover in its own built-in functions."""
    return [path for path in check_support.files(".c") if check_compile.compilers(path)]


def missing(found):
    """Files without a command for a side that they are built for."""
    sides = {}
    for entry in found:
        sides.setdefault(entry["file"], set()).add(compile_commands.side(entry["arguments"][0]))
    said = []
    for path in map(str, own_files()):
        home = max((name for name in SIDES if path.startswith(name)), key=len, default=None)
        wanted = SIDES.get(home) or sides.get(path) or {"any side"}
        said += [f"{path}: no command for {side}" for side in sorted(wanted - sides.get(path, set()))]
    return said


def compiles(entry, *more, compiler=None):
    """What the compiler says of the entry's file; empty: nothing."""
    words = [compiler or entry["arguments"][0], *entry["arguments"][1:], "-fsyntax-only", *more]
    done = subprocess.run(words, cwd=entry["directory"], capture_output=True, text=True, check=False)
    return done.stderr if done.returncode or done.stderr else ""


@test
def every_c_file_is_in_it_for_each_side_that_it_is_built_for():
    found = entries()
    assert len(own_files()) > 200 and missing(found) == [], missing(found)
    lone = [entry for entry in found if entry["file"] not in ("sim/model/stream.c", "host_tests/filters/test_fx.c")]
    assert missing(lone) == ["host_tests/filters/test_fx.c: no command for any side", "sim/model/stream.c: no command for PC"], missing(lone)
    assert all(pathlib.Path(entry["directory"], entry["file"]).is_file() and entry["arguments"][-1] == entry["file"] for entry in found)


@test
def every_command_compiles_its_file():
    """Those of C; the references and experiments in C++ with Eigen take a minute and are compiled by make."""
    in_c = [entry for entry in entries() if entry["file"].endswith(".c")]
    said = [text for text in check_support.parallel(compiles, in_c) if text]
    print(f"    {len(in_c)} commands")
    assert said == [], said[0]
    # one that lacks its folders does not
    entry = next(entry for entry in in_c if entry["file"] == "firmware/output/rows.c")
    bare = entry | {"arguments": [word for word in entry["arguments"] if not word.startswith("-Ihal")]}
    assert "fatal error" in compiles(bare)


@test
def clang_understands_the_first_command_of_each_file():
    """Every fourth file: no option that Clang does not know, and no error. It warns of more than gcc does."""
    if not bitexact.clang():
        raise Skip("no clang here")
    first = {}
    for entry in entries():
        ours = entry["file"].startswith(("firmware/", "lib/", "nav/lib/", "sim/", "hal/host/")) or "/test_" in entry["file"]
        if ours and entry["file"].endswith(".c"):
            first.setdefault(entry["file"], entry)
    first = [entry for entry in first.values() if entry["arguments"][0] == "gcc"]
    quiet = ("-w", "-Wno-error", "-Werror=unknown-warning-option")
    said = [text for text in check_support.parallel(lambda entry: compiles(entry, *quiet, compiler=bitexact.clang()), first[::4]) if text]
    assert len(first) > 100 and said == [], said[0]
    foreign = first[0] | {"arguments": ["gcc", "-mcall-prologues", *first[0]["arguments"][1:]]}
    assert "unknown argument" in compiles(foreign, *quiet, compiler=bitexact.clang())


@test
def words_are_those_that_the_shell_would_see():
    line = (f"avr-gcc -std=gnu11 -Os '-DFILTER_LIST(X)=X({PLAIN}) X({ROBUST})' -flto -mrelax -Wl,--gc-sections -I $(echo hal) -MMD "
            "-c firmware/output/rows.c "
            "-o x.o 2> x.log || true")
    assert list(compile_commands.entries_of(line)) == [
        ("firmware/output/rows.c", "avr-gcc", ["-std=gnu11", "-Os", f"-DFILTER_LIST(X)=X({PLAIN}) X({ROBUST})", "-I", "hal"])]
    assert list(compile_commands.entries_of("mkdir -p build")) == [] and list(compile_commands.entries_of("")) == []


@test
def a_target_that_is_none_is_one_sentence():
    done = subprocess.run([sys.executable, "mk/scripts/compile_commands.py", "--out", str(OUT / "none.json"), "no_such_target"], capture_output=True,
                          text=True, check=False, env=os.environ | {"WARNINGS": "-Wall"})
    assert done.returncode == 1 and "compile_commands: make -nB: make: *** No rule to make target 'no_such_target'" in done.stderr, done.stderr
    assert done.stderr.count("\n") == 1 and not (OUT / "none.json").exists()


if __name__ == "__main__":
    raise SystemExit(run_all())
