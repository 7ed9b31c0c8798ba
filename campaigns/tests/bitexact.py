#!/usr/bin/env python3
"""Builds the vector program (host_tests/bitexact) for both compilers, runs every build and compares the answers bit by bit.

    bitexact.py      all builds against the first, then two planted differences that must be found and named

Each build prints a CRC-32 per path and block. Where two builds differ, the block is run again in detail: path, index,
input, answers and the two states byte by byte (offset, both values; host states laid out as on the AVR). Compiler flags of
the chip come from the Makefile (AVR_SMALL, WARNINGS). Ends with a line in Unity's form; exit status 1 on any failure.
"""
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import laws

OUT = pathlib.Path("build/bitexact")
HERE = "host_tests/bitexact"
SIMRUN = "build/sim/simrun"
STREAM = "sim/streams/tilt-fast.csv"
STOPPED = 8          # simrun: the program slept with interrupts off
BLOCK = 200          # VECTORS_BLOCK of vectors.h
SHOWN = 3            # differences shown in detail
FIRMWARE = [f"firmware/{name}.c" for name in (
    "base/format", "base/text", "base/pass", "base/counters", "output/rows", "path/pipeline", "path/coast", "path/gravity", "path/silence",
    "settings/settings", "settings/settings_words", "base/choice")]
HEADERS = ["lib", "firmware", "hal", "host_tests"]
SANITIZE = "-O1 -fsanitize=address,undefined -fno-sanitize-recover=all"
# as the planted differences: name, file under lib, text, broken text, build, paths that must be named
TWINS = [
    ("one rounding bit dropped", "filters/src/fx.h",
     "return fx_product_u16((uint16_t)(a >> 16), b_uq16) + (low >> 16) + ((low >> 15) & 1U);",
     "return fx_product_u16((uint16_t)(a >> 16), b_uq16) + (low >> 16);", "gcc -O2", {"filter_fx_mul_uq16", laws.PLAIN}),
    ("product in 16-bit int", "tilt/src/tilt.c",
     "sum_q12 += (uint32_t)magnitude * magnitude;",
     "sum_q12 += (uint32_t)(magnitude * magnitude);", "avr-gcc -Os", {"tilt_gravity_plausible"}),
]


ROWS = laws.names()[:4]  # whose rows vectors_text.c compares


class Failure(Exception):
    """Something that stops the comparison, in one sentence."""


def linked(names):
    return "-DFILTER_LINKED(X)=" + " ".join(f"X({name})" for name in names)


def call(command):
    """Runs a command; what cannot be run is a Failure as well."""
    try:
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600)
    except FileNotFoundError:
        raise Failure(f"{command[0]} is not there (make bitexact builds or installs what is needed)") from None
    except subprocess.TimeoutExpired:
        raise Failure(f"{command[0]} was stopped after 300 s: {shlex.join(str(word) for word in command[:4])} ...") from None


def last_words(text):
    return (text.strip().splitlines() or ["no message"])[-1]


class Build:
    """A way to compile the vector program, and what it answered."""

    def __init__(self, name, command, chip=False, lib="lib"):
        self.name, self.command, self.chip, self.lib = name, command, chip, lib

    def compile(self, packed=False):
        """The programs that together answer for all paths: on the chip two for the filters and one for the rest, as its flash wants."""
        parts = {"": []}
        if self.chip:
            second = os.environ["CHIP_SECOND"].split()
            first = [name for name in laws.names() if name not in second]
            parts = {"first": ["-DVECTORS_FILTERS=1", linked(first)], "second": ["-DVECTORS_FILTERS=1", linked(second)],
                     "rest": ["-DVECTORS_FILTERS=0", linked(ROWS)]}
        return [self.compile_part(part, flags, packed) for part, flags in parts.items()]

    def compile_part(self, part, flags, packed):
        ends = ("-packed" if packed else "") + (f"-{part}.elf" if self.chip else "")
        exe = OUT / (re.sub(r"\W+", "_", self.name) + ends)
        if not fresh(exe, self.lib):
            command = self.command + flags + sources(self.chip, self.lib) + ["-o", str(exe), "-lm"]
            if packed and not self.chip:
                command += ["-include", f"{HERE}/packed_states.h", "-Wno-address-of-packed-member", "-fno-sanitize=alignment"]
            done = call(command)
            if done.returncode != 0:
                errors = [line for line in done.stderr.splitlines() if "error" in line]
                raise Failure(f"{self.name} does not compile: {errors[0] if errors else last_words(done.stderr)}")
        return exe

    def run(self, exes, path=None, block=None):
        """Lines that the programs print, without the last one of each."""
        return [line for exe in exes for line in self.run_part(exe, path, block)]

    def run_part(self, exe, path, block):
        if self.chip:
            lines = run_chip(exe, path, block)
        else:
            detail = [] if path is None else [str(path), str(block)]
            done = call([exe, *detail])
            if done.returncode != 0:
                raise Failure(f"{self.name} ends with status {done.returncode}: {last_words(done.stderr)}")
            lines = done.stdout.splitlines()
        if not lines or lines[-1] != "end":
            raise Failure(f"{self.name} printed no complete list")
        return lines[:-1]


def run_chip(exe, path, block):
    out = exe.with_suffix(".txt")
    detail = [] if path is None else ["--fault", f"1ms:poke:detail_path={path}", "--fault", f"1ms:poke:detail_block={block}"]
    done = call([SIMRUN, "--fw", exe, "--in", STREAM, "--out", out, "--max-ms", "100000", *detail])
    if done.returncode != STOPPED:
        raise Failure(f"{exe.name} did not run to its end: {last_words(done.stderr)}")
    return out.read_text(encoding="ascii", errors="replace").splitlines()


def sources(chip, lib):
    includes = ["hal", "hal/avr" if chip else "hal/host", "firmware", "lib/machine/src", f"{lib}/filters/src", f"{lib}/tilt/src",
                f"{lib}/adxl345/src", "host_tests", HERE]
    files = sorted(pathlib.Path(HERE).glob("vectors*.c"))
    files += [f"{HERE}/crc32.c", f"{HERE}/output.c", f"{HERE}/output_{'chip' if chip else 'pc'}.c"]
    files += [path for name in ("random32", "filter*", "law_*") for path in sorted(pathlib.Path("host_tests/support").glob(f"{name}.c"))]
    files += FIRMWARE + sorted(pathlib.Path(lib).glob("filters/src/*.c"))
    files += [f"{lib}/tilt/src/{name}.c" for name in ("tilt", "tilt_axis", "calibration")]
    return [f"-I{folder}" for folder in includes] + [str(file) for file in files]


def fresh(exe, lib):
    """Newer than all that it may be made of."""
    if not exe.exists():
        return False
    made = exe.stat().st_mtime
    inputs = [p for folder in HEADERS + [lib] for p in pathlib.Path(folder).rglob("*.[ch]")]
    return all(p.stat().st_mtime < made for p in inputs + [pathlib.Path("Makefile"), pathlib.Path(__file__)])


def clang():
    """The newest clang there is, or None."""
    names = ["clang"] + [f"clang-{version}" for version in range(25, 9, -1)]
    return next((name for name in names if shutil.which(name)), None)


def builds():
    strict = shlex.split(os.environ["WARNINGS"])
    host = ["-std=c11", *strict]
    chip = ["avr-gcc", "-std=gnu11", "-mmcu=atmega328p", "-DF_CPU=16000000UL", "-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections",
            *strict]
    found = [Build(f"gcc {level}", ["gcc", level, *host]) for level in ("-O2", "-O0", "-O1", "-O3", "-Os")]
    found.append(Build("gcc sanitized", ["gcc", *SANITIZE.split(), *host]))
    if clang():
        found.append(Build("clang -O2", [clang(), "-O2", *host]))
    found.append(Build("avr-gcc -Os", [*chip, "-Os"], chip=True))
    found.append(Build("avr-gcc -Os -flto", [*chip, *shlex.split(os.environ["AVR_SMALL"])], chip=True))
    return found


def table(lines):
    """{(path, first index): CRC} in the order of the program."""
    found = {}
    for line in lines:
        match = re.fullmatch(r"(\w+) (\d+) ([0-9a-f]{8})", line)
        if not match:
            raise Failure(f"unexpected line '{line}'")
        found[match.group(1), int(match.group(2))] = match.group(3)
    return found


def parse_item(line):
    """An item in detail: index, inputs, answers, state."""
    index, *words = line.split()
    state = [w[1:] for w in words if w[0] == "="]
    return int(index), [w for w in words if w[0] not in "=>"], [w[1:] for w in words if w[0] == ">"], bytes.fromhex("".join(state))


def items(build, exes, path, block):
    return [parse_item(line) for line in build.run(exes, path, block) if re.match(r"\d", line)]


def compare_states(a, b):
    if len(a) != len(b):
        return [f"states of {len(a)} and {len(b)} bytes"]
    return [f"state byte {offset}: {x:02x} {y:02x}" for offset, (x, y) in enumerate(zip(a, b)) if x != y]


def explain(pair, exes, path, number, first):
    """The first item of the block that differs, as lines."""
    sides = [items(build, exe, number, first // BLOCK) for build, exe in zip(pair, exes)]
    for (index, given, answers_a, state_a), (_, _, answers_b, state_b) in zip(*sides):
        if answers_a != answers_b or state_a != state_b:
            lines = [f"{path}, index {index}, input {' '.join(given) or '-'}: {pair[0].name} / {pair[1].name}"]
            lines += [f"answer {n}: {x} {y}" for n, (x, y) in enumerate(zip(answers_a, answers_b)) if x != y]
            if len(answers_a) != len(answers_b):
                lines.append(f"{len(answers_a)} and {len(answers_b)} answers")
            lines += compare_states(state_a, state_b)
            lines += [f"state of {build.name}: {state.hex()}" for build, state in zip(pair, (state_a, state_b)) if state]
            return lines
    return [f"{path}, block from {first}: differs, but not when run again in detail"]


def differences(pair, tables):
    """(paths that differ, lines about the first of them)."""
    paths = list(dict.fromkeys(path for path, _ in tables[0]))
    if set(tables[0]) != set(tables[1]):
        raise Failure(f"{pair[0].name} and {pair[1].name} do not have the same blocks")
    first = {}
    for (path, index), crc in tables[0].items():
        if tables[1][path, index] != crc:
            first.setdefault(path, index)
    lines = []
    if first:
        exes = [build.compile(packed=True) for build in pair]
        for path, index in list(first.items())[:SHOWN]:
            lines += explain(pair, exes, path, paths.index(path), index)
    return list(first), lines


def missing_paths(answers):
    """Filters of the list and public functions of fx.h without a path."""
    have = {path for path, _ in answers}
    wanted = set(laws.names())
    text = pathlib.Path("lib/filters/src/fx.h").read_text(encoding="utf-8")
    wanted |= set(re.findall(r"^(?:(?:static inline|MACHINE_INLINE) )?\w+ ((?:filter_)?fx_\w+)\(", text, re.M))
    assert len(wanted) > 20, "the list of functions in fx.h was not found"
    return sorted(wanted - have)


def plant(name, file, text, broken):
    """A copy of lib with one place broken."""
    lib = OUT / "twins" / re.sub(r"\W+", "_", name) / "lib"
    shutil.rmtree(lib, ignore_errors=True)
    shutil.copytree("lib", lib, copy_function=shutil.copy)
    whole = (lib / file).read_text(encoding="utf-8")
    if whole.count(text) != 1:
        raise Failure(f"the text to break occurs {whole.count(text)} times in lib/{file}: bring TWINS in campaigns/tests/bitexact.py up to date")
    (lib / file).write_text(whole.replace(text, broken), encoding="utf-8")
    return str(lib)


class Report:
    def __init__(self):
        self.count = self.failed = self.skipped = 0

    def tell(self, what, problem=None, lines=()):
        self.count += 1
        self.failed += problem is not None
        print(f"bitexact.py:{what}:" + ("PASS" if problem is None else f"FAIL: {problem}"), flush=True)
        for line in lines:
            print(f"    {line}")

    def skip(self, what, reason):
        self.count += 1
        self.skipped += 1
        print(f"bitexact.py:{what}:IGNORE: {reason}")


def judge_twin(report, twin, reference, answers, by_name):
    name, file, text, broken, build_name, wanted = twin
    honest = by_name[build_name]
    try:
        build = Build(f"{honest.name} with {name}", honest.command, honest.chip, plant(name, file, text, broken))
        found, lines = differences((reference, build), (answers, table(build.run(build.compile()))))
    except Failure as problem:
        report.tell(f"planted {name} is found", str(problem))
        return
    explained = any(re.match(r"answer \d+: ", line) for line in lines)
    in_states = laws.PLAIN not in wanted or any(re.match(r"state byte \d+: ", line) for line in lines)
    if wanted <= set(found) and explained and in_states:
        report.tell(f"planted {name} is found in {', '.join(found[:5])}", None, lines)
    else:
        report.tell(f"planted {name} is found in {', '.join(sorted(wanted))}", f"found in {', '.join(found) or 'nothing'}", lines)


def prepare(build):
    try:
        return table(build.run(build.compile())), None
    except Failure as problem:
        return None, str(problem)


def main():
    if not {"WARNINGS", "AVR_SMALL", "CHIP_SECOND"} <= set(os.environ):
        print("bitexact.py: WARNINGS, AVR_SMALL, CHIP_SECOND are missing from the environment: run it by make bitexact", file=sys.stderr)
        return 2
    OUT.mkdir(parents=True, exist_ok=True)
    report = Report()
    all_builds = builds()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = list(pool.map(prepare, all_builds))
    reference, (answers, problem) = all_builds[0], results[0]
    if problem is not None:
        report.tell(reference.name, problem)
    else:
        missing = missing_paths(answers)
        report.tell("every filter and primitive has a path", f"none for {', '.join(missing)}" if missing else None)
        for build, (other, problem) in list(zip(all_builds, results))[1:]:
            lines = []
            if problem is None:
                found, lines = differences((reference, build), (answers, other))
                problem = f"differs in {', '.join(found)}" if found else None
            report.tell(f"{build.name} equals {reference.name}", problem, lines)
        if clang() is None:
            report.skip("clang -O2 equals gcc -O2", "no clang here")
        by_name = {build.name: build for build in all_builds}
        for twin in TWINS:
            judge_twin(report, twin, reference, answers, by_name)
    print(f"\n{report.count} Tests {report.failed} Failures {report.skipped} Ignored")
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
