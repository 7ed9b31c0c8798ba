"""What the checks of `make check` share: lists of files, the table of deviations, jobs in parallel, the report."""
import concurrent.futures
import pathlib
import re
import subprocess
import sys

DEVIATIONS = pathlib.Path("docs/deviations.md")
BUDGETS = pathlib.Path("checks/budgets.txt")
FOLDERS = ["firmware", "nav", "lib", "hal", "sim", "host_tests"]
CORES = 2
# budgets of size and stack are for this compiler; elsewhere they are reported
FOR_COMPILER = "5.4.0"


class Stop(Exception):
    """A check that cannot be made, with the reason: a tool that fails, a file that cannot be read."""


def files(*suffixes, folders=FOLDERS):
    found = [p for folder in folders for suffix in suffixes for p in pathlib.Path(folder).rglob(f"*{suffix}")]
    return sorted(p for p in set(found) if p.is_file())


def chosen(paths):
    """Those of the files named on the command line (a header: all files), all when none is named."""
    named = [pathlib.Path(a) for a in sys.argv[1:]]
    if not named or any(p.suffix in (".h", ".hpp") for p in named):
        return list(paths)
    strangers = [str(p) for p in named if p not in paths]
    if strangers:
        raise Stop(f"{strangers[0]}: not among the files of this check")
    return named


def run(*command, expect=0):
    """Output of a command, both streams; its status must be the expected one unless that is None."""
    try:
        done = subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                              timeout=300, check=False)
    except FileNotFoundError as error:
        raise Stop(f"{command[0]} is not installed: sh tools/deps.sh check") from error
    if expect is not None and done.returncode != expect:
        raise Stop(f"{' '.join(map(str, command[:4]))} ... gave status {done.returncode}: {done.stdout.strip()[-400:]}")
    return done if expect is None else done.stdout


def parallel(function, items):
    """Results in the order of the items."""
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        return list(pool.map(function, items))


def deviations():
    """{(rule, where): (limit or empty, reason)} from the table."""
    table, inside = {}, False
    for number, line in enumerate(DEVIATIONS.read_text(encoding="utf-8").splitlines(), 1):
        cells = [c.strip().strip("`") for c in line.strip().strip("|").split("|")]
        inside = line.startswith("|") and (inside or cells[0] == "rule")  # other tables on the page are prose
        if not inside or cells[0] in {"rule", "---"}:
            continue
        if len(cells) != 4 or not all(cells[i] for i in (0, 1, 3)):
            raise Stop(f"{DEVIATIONS}:{number}: a line is | rule | where | limit | reason |, and only the limit may be empty")
        if (cells[0], cells[1]) in table:
            raise Stop(f"{DEVIATIONS}:{number}: {cells[0]} for {cells[1]} stands there twice")
        table[cells[0], cells[1]] = cells[2], cells[3]
    return table


def limit_for(rule, where, usual):
    """The usual limit, or the one that the table grants this place."""
    granted = deviations().get((rule, where), ("", ""))[0]
    return max(usual, int(granted)) if granted.isdigit() else usual


def budgets():
    """{name: limit}; each line is name, limit, reason."""
    found = {}
    for number, line in enumerate(BUDGETS.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#") or not line.strip():
            continue
        parts = re.fullmatch(r"(\w+)\s+(\d+)\s+(\S.*)", line)
        if not parts:
            raise Stop(f"{BUDGETS}:{number}: a line is NAME LIMIT REASON")
        found[parts.group(1)] = int(parts.group(2))
    return found


def budget(name):
    found = budgets()
    if name not in found:
        raise Stop(f"{BUDGETS}: has no budget {name}")
    return found[name]


def binding():
    """True when a breach of a size or stack budget counts: with the compiler that the budgets are for."""
    version = run("avr-gcc", "-dumpversion").strip()
    if version != FOR_COMPILER:
        print(f"reported only: the budgets are for avr-gcc {FOR_COMPILER}, this is {version}")
    return version == FOR_COMPILER


def report(name, findings, summary):
    """Prints the findings and the last line; the exit status."""
    for line in findings:
        print(line)
    print(f"{name}: {len(findings)} findings" if findings else f"{name}: {summary}")
    return 1 if findings else 0


def main(check):
    """Runs a check as a program."""
    try:
        sys.exit(check())
    except (Stop, OSError, subprocess.TimeoutExpired) as error:
        print(f"{pathlib.Path(sys.argv[0]).name}: {error}", file=sys.stderr)
        sys.exit(2)
