#!/usr/bin/env python3
"""The stack: the frame of each function from the compiler, the deepest use of all from the painted RAM of the simulated chip.

    check_stack.py frames          stack of each function (build/check/avr/*.su), the five largest
    check_stack.py painted ELF...  static RAM and the deepest stack while every command is used and the sensor comes and goes
"""
import json
import pathlib
import subprocess
import sys

from avr_objects import FOLDER
from check_support import Stop, binding, budget, deviations, limit_for, main, report

SIMRUN = "build/sim/simrun"
STREAM = "sim/streams/outliers-15pct.csv"
RUN = pathlib.Path("build/check/painted")
SETTINGS = ["rate", "range", "every", "baud", "mode", "filter"]
RULE = "stack of a function"


def frames():
    """(bytes, file, line, function, kind), largest first. Naked functions have none: what they push stands in their assembler."""
    found = []
    for path in sorted(FOLDER.rglob("*.su")):
        for line in path.read_text(encoding="utf-8").splitlines():
            place, size, kind = line.split("\t")
            _, number, _, function = place.split(":", 3)
            found.append((int(size), str(path.relative_to(FOLDER).with_suffix(".c")), number, function, kind))
    if not found:
        raise Stop(f"no .su files in {FOLDER}: run the check by make")
    return sorted(found, key=lambda f: (-f[0], f[1:]))


def over_limit():
    """For the table of deviations."""
    usual = budget("stack_per_function_bytes")
    return {(RULE, f"{source}: {function}") for size, source, _, function, _ in frames() if size > usual}


def check_frames():
    usual, found, every = budget("stack_per_function_bytes"), [], frames()
    for size, source, number, function, kind in every:
        limit = limit_for(RULE, f"{source}: {function}", usual)
        if size > limit:
            found.append(f"{source}:{number}: {function} takes {size} bytes of stack (limit {limit})")
        if kind != "static":
            found.append(f"{source}:{number}: {function} has a stack frame whose size is not fixed ({kind})")
    largest = ", ".join(f"{function} {size}" for size, _, _, function, _ in every[:5])
    granted = sum(1 for rule, _ in deviations() if rule == RULE)
    summary = f"{len(every)} functions of at most {usual} bytes, {granted} granted more; largest: {largest}"
    return report("stack frames", found if found and binding() else [], summary)


def commands(filters):
    """Everything one can type, the longest replies, and each filter of the image at work on outliers."""
    typed = ["help", "status", *SETTINGS, *(f"{name} nonsense" for name in SETTINGS), "rate 123", "nonsense", "x" * 48, "mode plot", "help",
             "status", "mode csv", "rate 400", "rate 12.5", "rate 100", "range 2", "range 16", "every 3", "every 1", "stop", "status",
             "go", "settings", "odr", "level 0.5 0.5 0.7", "axes -yxz", "noise", "nonsense 1", "cal6", "cal6 stop", "stop", "save",
             "load", "go", "defaults"]
    typed += [f"filter {name}" for name in filters] + ["status"]
    return [word for at, text in enumerate(typed) for word in ("--cmd", f"{1000 + 400 * at}:{text}")], 1000 + 400 * len(typed)


def check_painted(elf):
    typed, end_ms = commands(pathlib.Path(elf).with_name("filters.txt").read_text(encoding="ascii").split())
    faults = [f"{end_ms}ms:unplug", f"{end_ms + 1500}ms:plug", f"{end_ms + 3000}ms:noint:500"]
    stats = RUN.with_suffix(".json")
    done = subprocess.run([SIMRUN, "--fw", elf, "--in", STREAM, "--out", str(RUN.with_suffix(".csv")), "--stats", str(stats), "--loop",
                           "--max-ms", str(end_ms + 5000), *typed, *(w for f in faults for w in ("--fault", f))],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120, check=False)
    suspects = ", ".join(f"{source}: {function} {size}" for size, source, _, function, _ in frames()[:5])
    if done.returncode != 0:
        print(f"{elf}: {done.stdout.strip()}\nstack: the run ended with status {done.returncode}; largest frames: {suspects}")
        return 1
    measured = json.loads(stats.read_text(encoding="utf-8"))
    said = RUN.with_suffix(".csv").read_text(encoding="ascii", errors="replace")
    if not all(words in said for words in ("# refused 1: unknown command", "# refused 2: line too long", "lines refused", "# fault")):
        raise Stop(f"the painted run did not get the replies it is for: {RUN.with_suffix('.csv')}")
    used, limit = measured["ram_used_bytes"], budget("ram_and_stack_bytes")
    found = []
    if used > limit and binding():
        found.append(f"{elf}: static RAM and stack take {used} bytes (budget {limit}); largest frames: {suspects}")
    return report(f"stack of {elf}, painted", found, f"static RAM {measured['ram_static_bytes']} and deepest stack "
                  f"{measured['stack_high_water_bytes']} bytes, together {used} (budget {limit})")


def check():
    arguments = sys.argv[1:]
    if arguments == ["frames"]:
        return check_frames()
    if len(arguments) >= 2 and arguments[0] == "painted":
        return max(check_painted(elf) for elf in arguments[1:])
    raise Stop("usage: check_stack.py frames | painted ELF...")


if __name__ == "__main__":
    main(check)
