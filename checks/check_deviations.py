#!/usr/bin/env python3
"""docs/deviations.md against the tree: what is suppressed or above a limit must stand there, and what stands there must exist."""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import check_lengths
import check_names
import check_stack
from check_support import DEVIATIONS, FOLDERS, deviations, main, report
from clang_avr import STAND_INS

TIDY = pathlib.Path(".clang-tidy")
# what silences a tool, wherever it stands; the group says which words name it
SILENCERS = [
    ("clang-tidy silenced", re.compile(r"(NOLINT(?:NEXTLINE|BEGIN)?(?:\([^)]*\))?)")),
    ("cppcheck silenced", re.compile(r"(cppcheck-suppress(?:-\w+)?[ \[]*[\w,]*|--suppress\S*)")),
    ("compiler silenced", re.compile(r"(#\s*pragma\s+\w+\s+diagnostic\s+ignored\s+\S+|_Pragma\(.*diagnostic ignored|(?<![\w-])-Wno-[\w=-]+|"
                                     r"#\s*pragma\s+GCC\s+system_header|(?<![\w-])-w(?=\s|$))")),
    ("sanitizer silenced", re.compile(r"(no_sanitize\w*)")),
    ("formatter silenced", re.compile(r"(clang-format off)")),
]
WHERE = re.compile(r"^(firmware|lib|hal|sim|nav|host_tests|mk)/.*\.(c|h|cpp|ino|mk|sh)$|"
                   r"^(tools|checks|campaigns|second|web)/.*\.(mk|sh)$|^Makefile$|^platformio\.ini$|^\.clang-tidy$")


def tree():
    """Walked, not asked of git: the check also runs in copies that git does not know."""
    tops = [pathlib.Path(n) for n in ("Makefile", "platformio.ini", ".clang-tidy")]
    paths = tops + [p for f in (*FOLDERS, "mk", "tools", "checks", "campaigns", "second", "web") for p in pathlib.Path(f).rglob("*")]
    return sorted(str(p) for p in paths if WHERE.match(str(p)) and p.is_file())


def silenced():
    """{(rule, where)}: the file and the words that silence a tool in it."""
    for name in tree():
        text = pathlib.Path(name).read_text(encoding="utf-8")
        for rule, pattern in SILENCERS:
            for words in pattern.findall(text):
                yield rule, f"{name}: {' '.join(words.split())}"


def tidy_checks_off():
    """Checks that .clang-tidy takes out again; `-*` only begins the list. Its rules for names and options are no deviations."""
    for name in re.findall(r"^\s*-([a-zA-Z][\w.,*-]*?),?\s*$", TIDY.read_text(encoding="utf-8"), re.M):
        yield "clang-tidy check off", f"{TIDY}: {name}"


def departures():
    found = set(silenced()) | set(tidy_checks_off())
    found |= check_lengths.over_limits() | check_stack.over_limit() | check_names.over_limits()
    if STAND_INS:
        found.add(("stand-ins for clang", "hal/avr"))
    return found


def check():
    table, tree_has = deviations(), departures()
    found = [f"{where.split(':')[0]}: {rule}: {where}: not in {DEVIATIONS}" for rule, where in sorted(tree_has - set(table))]
    found += [f"{DEVIATIONS}: {rule}: {where}: the tree has no such departure" for rule, where in sorted(set(table) - tree_has)]
    return report("deviations", found, f"{len(table)} in the tree, each with its reason in {DEVIATIONS}")


if __name__ == "__main__":
    main(check)
