#!/usr/bin/env python3
"""Coverage: of lib, the supervision and the navigation image's link on the PC (gcov, from the Unity tests), and of the unmodified AVR
binary (simrun's profiles, system tests; the lines that the fault campaign reaches are counted here too, for campaigns/faults/faults.py).

    coverage.py judge GCOVR.json ELF FOLDER     tables, uncovered lines, build/coverage.json; 1 when below a target
    coverage.py twins GCOVR.json ELF FOLDER     a line of lib and one of nav/lib not executed, a file of nav/lib left out, a profile of an
                                                earlier binary: must be seen; one run of the chip alone: must be below
    coverage.py check ELF PROFILE SOURCE        the tool itself: lines marked `ran` and `not reached` in a small program

A line of the binary is executable when at least one instruction is attributed to it (.debug_line: with inlining and
link-time optimisation the innermost source line), and executed when one of those instructions was, in whichever copy. A
loaded constant alone is no evidence, because the compiler moves it out of the branch that it belongs to. What stays: equal
ends of two branches are merged and then count for the line whose instructions were kept.

nav/lib is compiled in variants (campaigns/coverage/nav_lib_coverage.mk): a line or branch is executed when it was in one of them.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path.cwd()
EXCLUSIONS = pathlib.Path("campaigns/coverage/exclusions.txt")
# two calls, which link-time optimisation takes in line: the instructions may carry the lines of what is called alone; of the
# navigation image's, no program of the PC holds main()
CALLS_ONLY = {"firmware/app/main.c", "nav/image/main.c"}
# not in the image that is traced, but in that of `auto`: judged on the PC alone
NOT_TRACED = {"firmware/path/supervisor.c"}
# assembler, of which the PC's programs hold nothing: judged on the chip alone
CHIP_ONLY = {"lib/filters/src/fx_avr.c"}
NAVIGATION = ("nav/lib/", "nav/image/")
HOST_LINES, HOST_BRANCHES, AVR_LINES = 100.0, 95.0, 95.0
CAMPAIGN_LINES, WATCHING_BRANCHES = 95.0, 100.0
PLACES = ("host", "host-branch", "avr", "campaign")


def fail(reason):
    sys.exit(f"coverage: {reason}")


def tool(*command, text=None):
    done = subprocess.run([str(c) for c in command], input=text, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{command[0]}: {done.stderr.strip()[-300:]}")
    return done.stdout


# --- the AVR binary ---------------------------------------------------------------------------------------------------

def instructions(elf):
    """{address: loads a constant} of all instructions."""
    listing = tool("avr-objdump", "-d", elf)
    return {int(m.group(1), 16): m.group(2) == "ldi" for m in re.finditer(r"^\s+([0-9a-f]+):\t[0-9a-f ]+\t(\S+)", listing, re.M)}


def in_repository(path, memory={}):
    """A file's name relative to the repository, although the binary may have been built in a copy of it."""
    if path not in memory:
        tails = (pathlib.Path(*path.parts[n:]) for n in range(1, len(path.parts)))
        memory[path] = str(next((tail for tail in tails if (ROOT / tail).is_file()), path) if path.is_absolute() else path)
    return memory[path]


def line_of_each(elf, addresses):
    """{address: (file, line)} for those that have one, with files relative to the repository."""
    said = tool("avr-addr2line", "-e", elf, text="".join(f"0x{a:x}\n" for a in addresses)).splitlines()
    if len(said) != len(addresses):
        fail(f"avr-addr2line gave {len(said)} lines for {len(addresses)} addresses")
    lines = {}
    for address, text in zip(addresses, said):
        file, _, number = text.partition(" (")[0].rpartition(":")
        if number.isdigit() and number != "0" and file != "??":
            path = pathlib.Path(file)
            lines[address] = (in_repository(path), int(number))
    return lines


def executed(profiles):
    found = set()
    for profile in profiles:
        for row in pathlib.Path(profile).read_text(encoding="ascii").splitlines()[1:]:
            found.add(int(row.split(",")[0], 16))
    return found


def avr_lines(elf, ran):
    """{file: {line: executed}} and {file: [instructions, executed]}; ran: the addresses of what was executed."""
    addresses = instructions(elf)
    strange = ran - addresses.keys()
    if len(strange) > len(ran) // 100:
        fail(f"{len(strange)} of {len(ran)} executed addresses are no instructions of {elf}: are the profiles of this binary?")
    evidence = collections.defaultdict(list)
    count = collections.defaultdict(lambda: [0, 0])
    for address, place in line_of_each(elf, addresses).items():
        evidence[place].append((addresses[address], address in ran))
        count[place[0]][0] += 1
        count[place[0]][1] += address in ran
    lines = collections.defaultdict(dict)
    for (file, line), found in evidence.items():
        only_constants = all(constant for constant, _ in found)
        lines[file][line] = any(was and (only_constants or not constant) for constant, was in found)
    return lines, count


# --- lib on the PC ----------------------------------------------------------------------------------------------------

def host_lines(report):
    """{file: {line: (executed, branches, branches taken)}}; several rows of one line, as of macros, count together."""
    lines = collections.defaultdict(dict)
    for file in json.loads(pathlib.Path(report).read_text(encoding="utf-8"))["files"]:
        for row in file["lines"]:
            if row.get("gcovr/noncode"):
                continue
            before = lines[file["file"]].get(row["line_number"], (False, 0, 0))
            branches = row.get("branches", [])
            lines[file["file"]][row["line_number"]] = (before[0] or row["count"] > 0, before[1] + len(branches),
                                                       before[2] + sum(b["count"] > 0 for b in branches))
    return lines


# --- exclusions -------------------------------------------------------------------------------------------------------

def exclusions():
    """Rows `where | file | text of the line | reason`; where is one of PLACES."""
    rows = []
    for number, row in enumerate(EXCLUSIONS.read_text(encoding="ascii").splitlines(), 1):
        if not row.strip() or row.startswith("#"):
            continue
        fields = [f.strip() for f in row.split(" | ")]
        if len(fields) != 4 or fields[0] not in PLACES or not fields[3]:
            fail(f"{EXCLUSIONS}:{number}: not `{'|'.join(PLACES)} | file | text | reason`")
        rows.append((number, *fields))
    return rows


class Excluder:
    """Says which lines count as excluded, and which rows of the table excluded none: those are stale."""

    def __init__(self, rows):
        self.rows = rows
        self.used = set()
        self.source = {}

    def excludes(self, where, file, line):
        if file not in self.source:
            path = pathlib.Path(file)
            self.source[file] = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
        text = self.source[file][line - 1].strip() if line <= len(self.source[file]) else ""
        for number, at, name, wanted, _ in self.rows:
            if at == where and name == file and wanted == text:
                self.used.add(number)
                return True
        return False

    def stale(self, *places):
        return [f"{EXCLUSIONS}:{row[0]}: nothing uncovered in {row[2]} reads '{row[3]}'" for row in self.rows
                if row[1] in places and row[0] not in self.used]


# --- tables -----------------------------------------------------------------------------------------------------------

def percent(part, whole):
    return 100.0 if whole == 0 else 100.0 * part / whole


def host_rows(report, excluder):
    rows, uncovered, half = [], [], []
    for file, lines in sorted(host_lines(report).items()):
        missed = [n for n, (ran, _, _) in sorted(lines.items()) if not ran and not excluder.excludes("host", file, n)]
        open_branches = {n: b - t for n, (ran, b, t) in sorted(lines.items()) if b > t and not excluder.excludes("host-branch", file, n)}
        branches = sum(b for _, b, _ in lines.values())
        rows.append({"file": file, "where": "host", "lines": len(lines), "lines_executed": len(lines) - len(missed),
                     "branches": branches, "branches_taken": branches - sum(open_branches.values()), "uncovered": missed})
        uncovered += [f"{file}:{n}: not executed by the unit tests" for n in missed]
        half += [f"{file}:{n}: {count} branches not taken" for n, count in open_branches.items()]
    return rows, uncovered, half


def avr_rows(elf, ran, excluder, apart="lib/", where="avr"):
    """Rows of the files, and what did not run; apart: of which files that is not asked."""
    rows, uncovered = [], []
    lines_of, count_of = avr_lines(elf, ran)
    for file, lines in sorted(lines_of.items()):
        if not file.startswith(("firmware/", "hal/", "lib/")):
            continue
        judged = file in CHIP_ONLY or not file.startswith(apart)
        missed = [n for n, was in sorted(lines.items()) if not was and not (judged and excluder.excludes(where, file, n))]
        rows.append({"file": file, "where": "avr", "lines": len(lines), "lines_executed": len(lines) - len(missed),
                     "instructions": count_of[file][0], "instructions_executed": count_of[file][1], "uncovered": missed})
        if judged:
            uncovered += [f"{file}:{n}: not executed on the simulated chip" for n in missed]
    return rows, uncovered


def table(rows, columns):
    for row in rows:
        cells = "".join(f"{row[done]:>7} of {row[all_]:>5} {name} {percent(row[done], row[all_]):6.1f} %"
                        for name, done, all_ in columns)
        print(f"  {row['file']:<38}{cells}")


def total(rows, key):
    return sum(row[key] for row in rows)


def left_out(rows, pattern):
    """A file that the data leave out would count as covered."""
    return {str(path) for path in pathlib.Path(".").glob(pattern)} - {row["file"] for row in rows} - CALLS_ONLY


def complete(rows, pattern, source, exempt=frozenset()):
    missing = left_out(rows, pattern) - exempt
    if missing:
        fail(f"{source} says nothing of {' '.join(sorted(missing))}")


def complete_on_avr(rows, source):
    complete(rows, "firmware/*/*.c", source, NOT_TRACED)
    for pattern in ("hal/avr/*.c", *CHIP_ONLY):
        complete(rows, pattern, source)


def judge_one(what, value, target):
    good = value >= target - 1e-9
    print(f"{what}: {value:.1f} % (target {target:.0f} %){'' if good else ': BELOW'}")
    return good


def profiles_of(elf, folder):
    """The profiles below this folder, all of them of this binary."""
    found = sorted(pathlib.Path(folder).rglob("*.csv"))
    if not found:
        fail(f"{folder} holds no profiles: did the system tests run?")
    if min(path.stat().st_mtime for path in found) < pathlib.Path(elf).stat().st_mtime:
        fail(f"{folder} holds profiles older than {elf}: delete the folder and run the system tests with PROFILES={folder} again")
    return found


def judge(report, elf, folder):
    profiles = profiles_of(elf, folder)
    excluder = Excluder(exclusions())
    host, host_missed, half = host_rows(report, excluder)
    avr, avr_missed = avr_rows(elf, executed(profiles), excluder)
    ours = [row for row in avr if row["file"] in CHIP_ONLY or not row["file"].startswith("lib/")]
    flying = [row for row in host if row["file"].startswith(NAVIGATION)]
    watching = [row for row in host if row["file"].startswith(("lib/adxl345/", "firmware/")) and row not in flying]
    for pattern in ("lib/*/src/*.c", *(f"{folder}*.c" for folder in NAVIGATION), *NOT_TRACED):
        complete(host, pattern, report, CHIP_ONLY)
    complete_on_avr(ours, elf)
    print("lib, supervision and the navigation image's link on the PC, unit tests:")
    table(host, [("lines", "lines_executed", "lines"), ("branches", "branches_taken", "branches")])
    print(f"the AVR binary, {len(profiles)} runs of the system tests (not in it, judged on the PC alone: "
          f"{' '.join(sorted(NOT_TRACED))}, {NAVIGATION[1]}):")
    table(avr, [("lines", "lines_executed", "lines"), ("instructions", "instructions_executed", "instructions")])
    print("\n".join(["uncovered:"] + host_missed + half + avr_missed + excluder.stale(*PLACES[:3])))
    results = [judge_one("lib lines on the PC", percent(total(host, "lines_executed"), total(host, "lines")), HOST_LINES),
               judge_one("lib branches on the PC", percent(total(host, "branches_taken"), total(host, "branches")), HOST_BRANCHES),
               judge_one("branches of nav/lib and nav/image on the PC",
                         percent(total(flying, "branches_taken"), total(flying, "branches")), HOST_BRANCHES),
               judge_one("branches of bus master, driver and supervision on the PC",
                         percent(total(watching, "branches_taken"), total(watching, "branches")), WATCHING_BRANCHES),
               judge_one("firmware, hal and assembler lines on the AVR binary", percent(total(ours, "lines_executed"), total(ours, "lines")),
                         AVR_LINES),
               not excluder.stale(*PLACES[:3])]
    pathlib.Path("build/coverage.json").write_text(json.dumps(host + avr, indent=1) + "\n", encoding="ascii")
    print("build/coverage.json written; lib in HTML: build/coverage/html/index.html")
    print(f"{sum(results)} passed, {len(results) - sum(results)} failed")
    return 0 if all(results) else 1


def campaign_lines(elf, ran):
    """(lines that ran, lines, those that did not) of the whole binary, by the addresses that a campaign executed."""
    excluder = Excluder(exclusions())
    rows, missed = avr_rows(elf, ran, excluder, "-", "campaign")
    complete_on_avr(rows, elf)
    return total(rows, "lines_executed"), total(rows, "lines"), missed + excluder.stale("campaign")


def spoilt_is_seen(report, part):
    """The same data with one line of the longest file of a part of the tree not executed."""
    host = host_lines(report)
    file = max((name for name in host if name.startswith(part)), key=lambda name: len(host[name]))
    spoilt = json.loads(pathlib.Path(report).read_text(encoding="utf-8"))
    lines = next(f for f in spoilt["files"] if f["file"] == file)["lines"]
    row = next(r for r in lines if r["count"] > 0 and not r.get("gcovr/noncode"))
    for same in (r for r in lines if r["line_number"] == row["line_number"]):
        same["count"] = 0
    path = pathlib.Path("build/coverage/spoilt.json")
    path.write_text(json.dumps(spoilt), encoding="utf-8")
    rows, missed, _ = host_rows(path, Excluder([]))
    executed_now = sum(r["lines_executed"] for r in rows if r["file"] == file)
    seen = f"{file}:{row['line_number']}: not executed by the unit tests" in missed and executed_now < len(host[file])
    print(f"twins: a line of {file} not executed: {'seen' if seen else 'NOT SEEN'}")
    return seen


def stale_is_refused(elf, folder):
    """A profile of an earlier binary among the others."""
    old = pathlib.Path(folder, "stale.csv")
    old.write_text("pc,count,cycles,symbol\n", encoding="ascii")
    os.utime(old, (0, 0))
    try:
        profiles_of(elf, folder)
    except SystemExit as refusal:
        seen = "older than" in str(refusal)
    else:
        seen = False
    old.unlink()
    print(f"twins: a profile of an earlier binary: {'seen' if seen else 'NOT SEEN'}")
    return seen


def twins(report, elf, folder):
    """The judge must see what is missing: a line, a file, all runs of the chip but one."""
    seen = [spoilt_is_seen(report, part) for part in ("lib/", *NAVIGATION)]
    rows = [row for row in host_rows(report, Excluder([]))[0] if row["file"] != "nav/lib/nav_ud.c"]
    seen.append(left_out(rows, "nav/lib/*.c") == {"nav/lib/nav_ud.c"})
    print(f"twins: nav/lib/nav_ud.c not in the data: {'seen' if seen[-1] else 'NOT SEEN'}")
    seen.append(stale_is_refused(elf, folder))
    one = profiles_of(elf, folder)[:1]
    ours = [r for r in avr_rows(elf, executed(one), Excluder([]))[0] if not r["file"].startswith("lib/")]
    share = percent(total(ours, "lines_executed"), total(ours, "lines"))
    print(f"twins: one run alone: {share:.1f} % of the AVR lines")
    return 0 if all(seen) and share < AVR_LINES else 1


def check(elf, profile, source):
    """Every executable line of the program says in a comment whether it must have run."""
    lines, _ = avr_lines(elf, executed([profile]))
    found = lines[str(source)]
    text = pathlib.Path(source).read_text(encoding="ascii").splitlines()
    wanted = {n: "/* ran" in row for n, row in enumerate(text, 1) if "/* ran" in row or "/* not reached" in row}
    wrong = [f"{source}:{n}: {'ran' if found[n] else 'did not run'}, as the tool has it" for n in wanted
             if n in found and found[n] != wanted[n]]
    wrong += [f"{source}:{n}: no instruction has this line" for n in wanted if n not in found]
    print("\n".join(wrong + [f"self-check: {len(wanted) - len(wrong)} of {len(wanted)} marked lines as known"]))
    return 1 if wrong or not any(wanted.values()) or all(wanted.values()) else 0


def main():
    arguments = sys.argv[1:]
    if len(arguments) == 4 and arguments[0] == "judge":
        return judge(*arguments[1:])
    if len(arguments) == 4 and arguments[0] == "twins":
        return twins(*arguments[1:])
    if len(arguments) == 4 and arguments[0] == "check":
        return check(*arguments[1:])
    fail("usage: coverage.py judge|twins GCOVR.json ELF FOLDER, or check ELF PROFILE SOURCE")
    return 2


if __name__ == "__main__":
    sys.exit(main())
