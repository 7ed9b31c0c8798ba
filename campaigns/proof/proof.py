#!/usr/bin/env python3
"""Proof with Frama-C's Eva (16-bit int): entries proof_NAME of host_tests/proof, then breakages that must be found.

    proof.py [PATTERN...]  all, or the entries and breakages in whose name a regular expression matches
    CHANGED=yes proof.py   one of the entries, and all of the files that are not as they were when host_tests/proof/proved.json was written

An entry calls NAME with any argument and any state within its bounds; law_NAME every function of that law (law.h). It
passes with no alarm and every contract, check and assertion proved. A function with a contract that says what it assigns
and with an entry of its own, which proves that contract, is taken by it in all other entries but those that say
`Whole: NAME` in their comment.
Unsigned wraps are looked for as well (Rte's assertions as checks, which do not narrow what follows); those that are
meant stand in deliberate.txt. What is compiled are the C twins of the primitives (no __AVR__); host_tests/chip/fx_twins.c ties the assembler twins to
them on the chip. Not covered: truncating unsigned casts, which the code means; right shifts of negative values, which
both compilers do arithmetically; |rate| <= rate_max, proved as |rate| <= 4608 LSB, because intervals keep no relation;
the assigns clauses of the contracts, which Eva takes as read.
"""
import concurrent.futures
import csv
import inspect
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import anchors
import proved
from sampled import by_commit

HERE = pathlib.Path("host_tests/proof")
BREAKAGES = pathlib.Path("campaigns/breakages/breakages.txt")
OUT = pathlib.Path("build/proof")
SOURCES = ["lib/machine/src", "lib/filters/src", "lib/tilt/src", "host_tests/proof"]
COMMON = ["-machdep", "gcc_x86_16", "-c11", "-no-unicode", "-kernel-warn-key", "asm:clobber=inactive"]
WRAPS = ["-rte", "-rte-no-mem", "-rte-no-div", "-rte-no-shift", "-rte-no-pointer-call", "-no-warn-signed-overflow",
         "-no-warn-invalid-bool", "-no-warn-left-shift-negative", "-warn-unsigned-overflow"]
LIMIT_S = 600  # of the processor's time: a busy machine proves as much
WALL_S = 4 * LIMIT_S
NOT_DONE = f"not done after {LIMIT_S} s"
PROVED = {"Valid", "Considered valid"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', re.M)
ENTRY = re.compile(r"(?:/\*((?:(?!\*/).)*)\*/\s*)?^(?:void proof_(\w+)\(void\)|PROVE_LAW\((\w+)\))", re.S | re.M)
CONTRACT = re.compile(r"^/\*@((?:(?!\*/).)*\bassigns\b(?:(?!\*/).)*)\*/\s*[^;{}/]*?\b(\w+)\([^;{}]*\);", re.S | re.M)

# of filter_list.c: the switch over the laws, and the look for a name, no arithmetic
SWITCH = re.compile(r"filter_listed(_name)?|filter_find|same_text")


def fail(text):
    print(f"proof: {text}", file=sys.stderr)
    sys.exit(1)


def frama_c(arguments, what):
    done = subprocess.run(["prlimit", f"--cpu={LIMIT_S}", "nice", "frama-c", *arguments], capture_output=True, text=True, timeout=WALL_S)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise subprocess.TimeoutExpired("frama-c", LIMIT_S)
    if done.returncode != 0:
        lines = [line for line in done.stdout.splitlines() if "rror" in line] or ["?"]
        raise RuntimeError(f"Frama-C refuses {what}: {' '.join(lines[:2])}")
    return done.stdout


def load_entries():
    """name -> (file, functions taken by contract, options)"""
    paths = sorted(HERE.glob("proof_*.c"))
    found = [(path, comment, f"law_{law}" if law else name) for path in paths
             for comment, name, law in ENTRY.findall(path.read_text(encoding="utf-8"))]
    names = {name for _, _, name in found}
    entries = {}
    for path, comment, name in found:
        comment = " ".join(comment.replace("*", " ").split())
        options = re.search(r"Options: (.*)", comment)
        whole = re.search(r"Whole: ([\w, ]+)", comment)
        uses = contracts(path) & names - {name} - set(re.findall(r"\w+", whole[1]) if whole else [])
        entries[name] = (path.name, sorted(uses), options[1].split() if options else [])
    return entries


def contracts(path):
    """Functions that a proof has a contract of with all that they assign, by the name that they have in it."""
    found = set()
    for file in {path} | {p for p in included(path, set()) if p.parent == HERE}:
        text = file.read_text(encoding="utf-8")
        others = dict(re.findall(r"^#define ([a-z]\w*) ([a-z]\w*)$", text, flags=re.M))
        found |= {others.get(name, name) for _, name in CONTRACT.findall(text)}
    return found


def annotate(file, out, overlay=None):
    """Preprocess, annotate every unsigned operation, and make the assertions checks."""
    roots = ([str(overlay / s) for s in SOURCES] if overlay else []) + SOURCES
    source = (overlay or pathlib.Path(".")) / HERE / file
    target = out / file
    frama_c([*COMMON, "-cpp-extra-args=" + " ".join("-I" + root for root in roots), str(source), *WRAPS, "-then", "-print",
             "-ocode", str(target)], file)
    text = target.read_text(encoding="utf-8")
    target.write_text(re.sub(r"assert(\s+)rte:", r"check\1rte:", text), encoding="utf-8")


def deliberate():
    lines = (HERE / "deliberate.txt").read_text(encoding="utf-8").splitlines()[1:]
    wraps = [tuple(part.strip() for part in line.split("|")[:2]) for line in lines]
    for wrap in wraps:
        if wraps.count(wrap) > 1:
            fail(f"{HERE / 'deliberate.txt'}: {' | '.join(wrap)} stands twice: strike one")
    return set(wraps)


def judge(name, entry, out):
    """(findings, proved, total, deliberate wraps met, functions analysed, seconds)"""
    file, uses, options = entry
    table = out / f"{name}.csv"
    start = time.monotonic()
    specified = ["-eva-use-spec", ",".join(uses)] if uses else []
    try:
        log = frama_c([*COMMON, str(out / file), "-eva", "-main", f"proof_{name}", *specified, "-eva-slevel", "50000",
                       "-warn-signed-downcast", *options, "-report-csv", str(table)], name)
    except subprocess.TimeoutExpired:
        return [NOT_DONE], 0, 1, set(), set(), LIMIT_S
    (out / f"{name}.log").write_text(log, encoding="utf-8")
    reached = set(re.findall(r"Values at end of function (\w+):", log))
    by_contract = set(uses) & set(re.findall(r"using specification for function (\w+)", log))
    findings, met, proved, total = [], set(), 0, 0
    if f"proof_{name}" not in reached:
        findings.append("the end of the entry is not reached")
    alarms = re.search(r"(\d+) alarms? generated", log)
    if alarms and int(alarms[1]):
        findings.append(f"{alarms[1]} alarms")
    allowed = deliberate()
    with table.open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows, delimiter="\t"):
            kind, status, text = row["property kind"], row["status"], " ".join(row["property"].split())
            where = row["function"]
            ours = row["directory"] != "FRAMAC_SHARE/libc" and not where.startswith(("Frama_C", "__builtin"))
            if not ours or kind == "user hypothesis" or "assigns" in kind or "from" in kind:
                continue
            if kind == "postcondition" and where in by_contract or where not in reached | by_contract:
                continue
            wrap = next((w for w in allowed if w[0] == where and w[1] in text), None)
            if wrap and status not in PROVED:
                met.add(wrap)
                continue
            total += 1
            if status in PROVED or (status in ("Dead", "Unreachable") and kind != "postcondition"):
                proved += 1
            else:
                findings.append(f"{where}: {kind} {status}: {text[:90]}")
    return findings, proved, total, met, reached, time.monotonic() - start


def missing_filters(entries):
    """Laws of FILTER_LIST without a proof."""
    names = subprocess.run(["gcc", "-E", "-P", "-x", "c", "-", "-Ilib/machine/src", "-Ilib/filters/src"], text=True, capture_output=True,
                           input='#include "filter_list.h"\n#define X(f) in_list:f;\nFILTER_LIST(X)\n', check=True).stdout
    filters = re.findall(r"in_list:(\w+);", names.replace(" ", ""))
    if not filters:
        fail("no filter found in lib/filters/src/filter_list.h")
    return [f"law_{f}" for f in filters if f"law_{f}" not in entries]


def included(path, seen):
    """The files that a proof is one translation unit with. Each is in SOURCES: what is elsewhere would be in no hash."""
    for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
        places = [place for source in SOURCES if (place := pathlib.Path(source) / name).exists()]
        if not places:
            fail(f"{path} includes {name}, which is in none of {' '.join(SOURCES)}")
        for found in places:
            if found not in seen:
                seen.add(found)
                included(found, seen)
    return seen


def other_names(paths):
    """What the proofs call a function whose name two sources have: name -> the other ones."""
    found = {}
    for path in paths:
        for name, other in re.findall(r"^#define ([a-z]\w*) ([a-z]\w*)$", path.read_text(encoding="utf-8"), flags=re.M):
            found.setdefault(name, set()).add(other)
    return found


def functions_of(path):
    """Functions with a body in a source that is proved, without the assembler twins."""
    text = re.sub(r"^#ifdef (?:__AVR__|FX_ASSEMBLER)\n.*?^#(?:else|endif)", "", path.read_text(encoding="utf-8"), flags=re.S | re.M)
    found = set(re.findall(r"^(?!.*;$)[A-Za-z_][\w *]*?\b(\w+)\([^;{}]*\)\n\{", text, flags=re.M))
    return {name for name in found if not SWITCH.fullmatch(name)}


def unreached(reached):
    """Functions of filters and tilt that no entry of a proof with their file in it reaches."""
    proofs = {path: included(path, set()) for path in HERE.glob("proof_*.c")}
    missing = []
    for path in sorted(p for source in SOURCES[1:3] for p in pathlib.Path(source).glob("*.[ch]")):
        with_it = [proof for proof, files in proofs.items() if path in files]
        names = set().union(*(reached.get(proof.name, set()) for proof in with_it))
        others = other_names(with_it + sorted(HERE.glob("*.h")))
        missing += [f"{path.name}: {name}" for name in sorted(functions_of(path)) if not names & ({name} | others.get(name, set()))]
    return missing


def load_plants():
    """[(breakage, entries that judge it)] of the list's judge `proof`."""
    return [(entry, judge.split()[1:]) for entry in anchors.load(BREAKAGES) for judge in entry.judges if judge.split()[0] == "proof"]


def try_plant(number, plant, entries):
    """What finds the breakage, or None."""
    breakage, judges = plant
    try:
        file, text = anchors.broken(breakage)
    except anchors.Lost as why:
        return None, str(why)
    overlay = OUT / f"plant{number}"
    shutil.rmtree(overlay, ignore_errors=True)
    for source in SOURCES:
        shutil.copytree(source, overlay / source)
    (overlay / file).write_text(text, encoding="utf-8")
    for entry in judges:
        annotate(entries[entry][0], overlay, overlay)
        findings = judge(entry, entries[entry], overlay)[0]
        if NOT_DONE in findings:  # of a slow machine, not of the breakage
            return None, f"{entry}: {NOT_DONE}"
        if findings:
            return findings[-1][:100], ""  # the number of alarms comes before what they are
    return None, "SURVIVED " + " ".join(judges)


def run_entries(pool, entries, wanted):
    """(entries that fail, {file: (functions reached, deliberate wraps met)})"""
    for file in sorted({entries[name][0] for name in wanted}):
        annotate(file, OUT)
    print(f"{'function':<32} {'alarms and unproved':>20} {'proved':>10} {'s':>6}")
    jobs = {name: pool.submit(judge, name, entries[name], OUT) for name in wanted}
    failed, seen = set(), {}
    for name, job in jobs.items():
        findings, passed, total, wraps, reached, seconds = job.result()
        note(seen, entries[name][0], reached, wraps)
        if total == 0:
            findings.append("nothing to prove")
        print(f"{name:<32} {len(findings):>20} {f'{passed}/{total}':>10} {seconds:>6.1f}", flush=True)
        for finding in findings[:6]:
            print(f"    {finding}")
        if findings:
            failed.add(name)
    return failed, seen


def note(seen, file, reached, wraps):
    """Adds to what was seen of a file."""
    functions, met = seen.setdefault(file, (set(), set()))
    functions.update(reached)
    met.update(wraps)


def inputs_of(entries):
    """file -> the digest of all that its proof rests on: sources, Frama-C, how it is asked and judged, and what is taken by contract, which
    the entries of other files decide too."""
    version = subprocess.run(["frama-c", "-version"], capture_output=True, text=True, check=True).stdout.strip()
    rules = [version, *COMMON, *WRAPS, *sorted(PROVED), *map(inspect.getsource, (frama_c, annotate, judge))]
    return {file: proved.digest({HERE / file, HERE / "deliberate.txt"} | included(HERE / file, set()),
                                [*rules, *sorted(f"{name} {entry}" for name, entry in entries.items() if entry[0] == file)])
            for file in {entry[0] for entry in entries.values()}}


def unchanged(inputs, patterns):
    """{file: its line of proved.json} of the files that need no proof: with CHANGED=yes those whose inputs are the line's."""
    if patterns or os.environ.get("CHANGED") != "yes":
        return {}
    known = proved.read()
    return {file: known[file] for file in sorted(set(inputs) & set(known)) if known[file][0] == inputs[file]}


def keep(entries, inputs, wanted, broken, seen, known):
    """Writes the lines of the files of which each entry was proved, and of those unchanged of which none failed."""
    whole = {file for file in seen if all(name in wanted and name not in broken for name in entries if entries[name][0] == file)}
    spared = {file: line for file, line in known.items() if not any(entries[name][0] == file for name in broken)}
    proved.write(spared | {file: (inputs[file], *seen[file]) for file in whole})


def gaps(entries, seen):
    """What a whole run must cover besides the entries themselves."""
    reached = {file: functions for file, (functions, _) in seen.items()}
    met = set().union(*(wraps for _, wraps in seen.values()))
    found = [f"{name}: in FILTER_LIST, but no entry proof_{name} in {HERE}" for name in missing_filters(entries)]
    found += [f"{name}: no entry reaches it" for name in unreached(reached)]
    found += [f"{wrap[0]}: `{wrap[1]}` of deliberate.txt is proved or gone: strike it" for wrap in sorted(deliberate() - met)]
    return found


def chosen(patterns, entries):
    """Names of the entries, and the breakages, that the patterns (none: all) leave over; a breakage brings its judges."""
    try:
        expressions = [re.compile(pattern) for pattern in patterns or [""]]
    except re.error as error:
        fail(f"'{' '.join(patterns)}' is no regular expression: {error}")
    plants = [p for p in load_plants() if any(e.search(p[0].name) for e in expressions)]
    judges = {name for plant in plants for name in plant[1]}
    if not judges <= set(entries):
        fail(f"{BREAKAGES} names entries that do not exist: {' '.join(sorted(judges - set(entries)))}")
    wanted = [name for name in entries if name in judges or any(e.search(name) for e in expressions)]
    if not wanted:
        fail(f"no entry and no breakage has a name that matches: {' '.join(patterns)}")
    return wanted, plants


def sampled(plants):
    """As many of the breakages as BREAKAGES says (empty: all), others for each commit; the proofs themselves are never fewer."""
    wanted = os.environ.get("BREAKAGES", "")
    if not wanted:
        return plants
    if not wanted.isdigit() or int(wanted) == 0:
        fail(f"BREAKAGES={wanted}: not a number of breakages")
    return by_commit(plants, int(wanted), "proof", "breakages")


def main():
    patterns = sys.argv[1:]
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    entries = load_entries()
    wanted, plants = chosen(patterns, entries)
    plants = sampled(plants)
    inputs = inputs_of(entries)  # as they are now: an edit during the run is of the next one
    known = unchanged(inputs, patterns)
    if known:
        print(f"proof: {len(known)} files are as they were proved ({proved.LEDGER}): {' '.join(known)}")
        spared = [name for name in wanted if entries[name][0] in known]
        wanted = [name for name in wanted if name not in spared] + by_commit(spared, 1, "proof", "entries of these")
    wanted.sort(key=lambda name: name != "filter_kalman_step" and not name.startswith("law_"))  # the longest first
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        broken, seen = run_entries(pool, entries, wanted)
        failed, passed = len(broken), len(wanted) - len(broken)
        jobs = [(p, pool.submit(try_plant, i, p, entries)) for i, p in enumerate(plants)]
        for (breakage, judged_by), job in jobs:
            finding, reason = job.result()
            if broken & set(judged_by):
                finding, reason = None, "its judge fails on the unbroken code"
            print(f"breakage {'found' if finding else 'MISSED'}: {breakage.name}: {finding or reason}")
            passed, failed = passed + bool(finding), failed + (not finding)
    if not patterns:
        keep(entries, inputs, wanted, broken, seen, known)
        for file, (_, reached, wraps) in known.items():
            note(seen, file, reached, wraps)
        for gap in gaps(entries, seen):
            print(gap)
            failed += 1
    print("skipped: 0")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RuntimeError as error:
        fail(str(error))
