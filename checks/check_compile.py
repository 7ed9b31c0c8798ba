#!/usr/bin/env python3
"""Both compilers over every C file that each can compile, and every header alone, with the warnings of the Makefile as errors.

    check_compile.py [FILE...]     only these files; WARNINGS and UNITY_DIR come from the Makefile by the environment
"""
import os
import pathlib
import re
import shlex
import sys

from check_support import Stop, chosen, files, main, parallel, report, run

LIBRARIES = ["lib/machine/src", "lib/filters/src", "lib/tilt/src", "lib/adxl345/src", "nav/lib"]
PORTABLE = ["hal", "firmware", "nav/image", *LIBRARIES]
# which compiler takes what; a folder below one of these goes with it, the longest name decides
FOLDERS_OF = {
    "firmware": ("host", "avr"),
    "nav": ("host", "avr"),
    "lib": ("host", "avr"),
    "nav/tests": ("host",),
    "nav/tests/chip": ("avr",),
    "hal": ("host", "avr"),
    "hal/host": ("host",),
    "hal/avr": ("avr",),
    "sim": ("host",),
    "host_tests": ("host",),
    "host_tests/chip": ("avr",),
    "host_tests/chip/peers": (),  # adapters to libraries that are in no folder of this repository; make bench compiles them
    "host_tests/tools/comparison": (),  # partly such adapters; make comparison compiles them
    "host_tests/bitexact": ("host", "avr"),
    "host_tests/proof": (),  # speaks to the prover in its own built-in functions; make proof parses it
}
C_ONLY = {"-Wstrict-prototypes", "-Wmissing-prototypes"}
# what is put before a file when it is built
BEFORE = {"host_tests/chip/unity_chip.c": ["-include", "host_tests/chip/unity_chip.h"]}
# pieces of a program that mean nothing alone
NOT_ALONE = {"host_tests/chip/seam_body.h", "lib/filters/src/fx_avr.h", "host_tests/papers/operations/counting.hpp"}


def compilers(path):
    homes = [folder for folder in FOLDERS_OF if folder in map(str, path.parents)]
    if not homes:
        raise Stop(f"{path}: no compiler is named for its folder (FOLDERS_OF in checks/check_compile.py)")
    # files of one side only say so in their name
    wanted = {"_pc": ("host",), "_chip": ("avr",)}
    side = next((names for end, names in wanted.items() if path.stem.endswith(end)), ("host", "avr"))
    return [name for name in FOLDERS_OF[max(homes, key=len)] if name in side]


def warnings():
    if not os.environ.get("WARNINGS"):
        raise Stop("WARNINGS is not set: run it by `make check-compile`")
    return os.environ["WARNINGS"].split()


def unity():
    return os.environ.get("UNITY_DIR") or "build/unity"


def host_flags(path):
    # what the library needs of the system: strict C11 there; simrun uses more of it
    standard = "gnu11" if path.parts[0] == "sim" else "c11"
    own = ["hal/host", *(f"sim/{part}" for part in ("model", "run", "faults", "judge")), "host_tests", "host_tests/bitexact", "nav/tests",
           str(path.parent)]
    simavr = shlex.split(run("pkg-config", "--cflags", "simavr").replace("-I", "-isystem "))
    return [f"-std={standard}", "-D_POSIX_C_SOURCE=200809L", "-DHANG_TEST=1", "-DUNITY_INCLUDE_DOUBLE", *(f"-I{d}" for d in PORTABLE + own),
            "-isystem", unity(), *simavr, "-isystem", "/usr/include/simavr"]


def avr_flags(path):
    own = ["hal/avr", "host_tests", "host_tests/chip", "host_tests/bitexact", str(path.parent)]
    return ["-std=gnu11", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-fshort-enums", *(f"-I{d}" for d in PORTABLE + own), "-isystem",
            unity()]


def jobs():
    """(file, command) of everything there is to compile."""
    to_object = ["-c", "-o", "/dev/null"]
    for path in files(".c"):
        if "host" in compilers(path):
            yield path, ["gcc", "-O2", *host_flags(path), *warnings(), *to_object, path]
        if "avr" in compilers(path):
            yield path, ["avr-gcc", "-Os", *avr_flags(path), *BEFORE.get(str(path), []), *warnings(), *to_object, path]
    for path in files(".h"):
        if str(path) not in NOT_ALONE:
            yield from header_jobs(path)
    for path in files(".hpp"):  # of the references and experiments, which are C++ on the PC only
        if str(path) not in NOT_ALONE:
            yield path, ["g++", "-std=gnu++20", "-Ihost_tests", "-Inav/tests", f"-I{path.parent}", "-Ilib/machine/src", "-Ilib/filters/src",
                         "-isystem", "/usr/include/eigen3", *(w for w in warnings() if w not in C_ONLY), "-fsyntax-only", "-include", path,
                         "-x", "c++", "/dev/null"]


def header_jobs(path):
    alone = ["-fsyntax-only", "-include", path, "/dev/null"]
    for name in compilers(path):
        prefix, flags = ("", host_flags(path)) if name == "host" else ("avr-", avr_flags(path))
        library = path.parts[0] == "lib" or path.parts[:2] == ("nav", "lib")
        yield path, [f"{prefix}gcc", *flags, "-std=c11" if library else flags[0], *warnings(), "-x", "c", *alone]
        if library:  # a sketch includes it
            yield path, [f"{prefix}g++", *flags[1:], "-std=gnu++11", *(w for w in warnings() if w not in C_ONLY), "-x", "c++", *alone]


def compiled(job):
    path, command = job
    done = run(*command, expect=None)
    return None if done.returncode == 0 else f"{command[0]} {path}:\n{done.stdout.rstrip()}"


def named_alone():
    """The headers named, if no file includes one of them: then nothing else need be compiled."""
    named = [pathlib.Path(a) for a in sys.argv[1:]]
    if not named or any(path.suffix not in (".h", ".hpp") for path in named):
        return set()
    included = re.compile("|".join(rf'#\s*include "(?:\S*/)?{re.escape(path.name)}"' for path in named))
    users = (path for path in files(".c", ".h", ".cpp", ".hpp", ".ino") if included.search(path.read_text(encoding="utf-8", errors="replace")))
    return set() if any(users) else set(named)


def check():
    everything = list(jobs())
    wanted = named_alone() or set(chosen({path for path, _ in everything}))
    todo = [job for job in everything if job[0] in wanted]
    findings = [f for f in parallel(compiled, todo) if f]
    count = {name: sum(1 for _, c in todo if c[0] == name) for name in ("gcc", "g++", "avr-gcc", "avr-g++")}
    return report("compile", findings, ", ".join(f"{name} {n} files" for name, n in count.items() if n) + ": no warning")


if __name__ == "__main__":
    main(check)
