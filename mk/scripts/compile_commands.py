#!/usr/bin/env python3
"""compile_commands.json for clangd and other tools: how each source is compiled, taken from what make would run.

    compile_commands.py [--out FILE] TARGET...     make's targets; FILE: compile_commands.json

Sources that no target compiles (programs for single experiments) have the options of make check-compile. A file that goes into the firmware and
into programs of the PC has two entries, the PC's first: clangd uses the first, and Clang cannot parse all of avr-libc. Options for machine
code only are left out, because Clang does not know avr-gcc's.
"""
import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import check_compile
from check_support import Stop, files

COMPILERS = ("gcc", "g++", "avr-gcc", "avr-g++")
SOURCES = (".c", ".cpp")
WITH_VALUE = ("-I", "-isystem", "-D", "-U", "-include")
KEPT = re.compile(r"-(std=|mmcu=|W(?!l,|a,|p,)|O|fshort-enums$)")

# independent of the make that called this program
OWN_MAKE = {name: value for name, value in os.environ.items() if name not in ("MAKELEVEL", "MAKEFLAGS", "MFLAGS")}


def planned(targets):
    """Every line that make would run for the targets if nothing were built."""
    done = subprocess.run(["make", "-nB", *targets], capture_output=True, text=True, check=False, env=OWN_MAKE)
    if done.returncode != 0:
        raise Stop(f"make -nB: {(done.stderr.strip() or '?').splitlines()[-1]}")
    return done.stdout.replace("\\\n", " ").splitlines()


def words_of(line):
    """The words of a shell command up to a redirection or the next command; $(...) is run, as make's shell would."""
    if "$(" in line:
        inner = re.compile(r"\$\(([^()]*)\)")
        line = inner.sub(lambda found: subprocess.run(["sh", "-c", found[1]], capture_output=True, text=True, check=True).stdout.strip(), line)
    lexer = shlex.shlex(line, posix=True, punctuation_chars=";|&<>")
    lexer.whitespace_split = True
    words = []
    for word in lexer:
        if re.fullmatch("[;|&<>]+", word):
            break
        words.append(word)
    return words


def meaning(words):
    """The options that determine the meaning of the source: macros, folders, language, warnings."""
    kept, following = [], iter(words)
    for word in following:
        if word in WITH_VALUE:
            kept += [word, next(following)]
        elif word.startswith(WITH_VALUE) or KEPT.match(word):
            kept.append(word)
    return kept


def entries_of(line):
    """(file, compiler, options) of each source on a line of make's output."""
    if line.split(None, 1)[:1] and line.split(None, 1)[0] in COMPILERS:
        compiler, *words = words_of(line)
        for word in words:
            if word.endswith(SOURCES) and not word.startswith("-") and pathlib.Path(word).is_file():
                yield word, compiler, meaning(words)


def side(compiler):
    return "chip" if compiler.startswith("avr-") else "PC"


def of_check(known):
    """The same for the sources that only make check-compile compiles."""
    for path, command in check_compile.jobs():
        compiler, *words = map(str, command)
        if path.suffix == ".c" and str(path) not in known:
            yield str(path), compiler, meaning(words)


def database(targets):
    found = {}
    for line in planned(targets):
        for file, compiler, options in entries_of(line):
            found.setdefault((file, side(compiler)), (compiler, options))
    for file, compiler, options in list(of_check({file for file, _ in found})):
        found.setdefault((file, side(compiler)), (compiler, options))
    own = set(map(str, files(*SOURCES)))
    here = str(pathlib.Path.cwd())
    return [{"directory": here, "file": file, "arguments": [compiler, *options, "-c", file]}
            for (file, _), (compiler, options) in sorted(found.items()) if file in own]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("--out", default="compile_commands.json")
    parser.add_argument("targets", nargs="+")
    options = parser.parse_args()
    entries = database(options.targets)
    if not entries:
        raise Stop(f"make -nB {' '.join(options.targets)[:80]}: compiles no source of this project")
    pathlib.Path(options.out).write_text(json.dumps(entries, indent=0) + "\n", encoding="utf-8")
    count = len({entry["file"] for entry in entries})
    print(f"{options.out}: {len(entries)} commands for {count} files")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Stop, OSError, subprocess.SubprocessError) as problem:
        sys.exit(f"compile_commands: {problem}")
