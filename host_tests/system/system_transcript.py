"""What a program that reads the console may rest on stays byte for byte: the header, `# refused N:` and `# fault N:`, `NAME VALUE` and what
verbs begin with. host_tests/system/transcript/0.1.0.txt is what version 0.1.0 said to commands.txt; words after a colon may be others, and lines may
come in addition. Part of system_tests.py."""
import pathlib
import re

from system_support import STREAMS, simrun, test

HERE = pathlib.Path("host_tests/system/transcript")
NUMBER = r"-?\d+(?:\.\d+)?"
STATUS = ("# state", "# samples", "# rows", "# lost")  # what follows is of this run


def runs():
    """For each run [(ms, text)]."""
    blocks = (HERE / "commands.txt").read_text(encoding="ascii").split("\n\n")
    return [[line.split(" ", 1) for line in block.splitlines() if not line.startswith("#")] for block in blocks]


def said():
    """The lines of the runs, rows left out."""
    lines = []
    for typed in runs():
        options = [word for ms, text in typed for word in ("--cmd", f"{ms}:{text}")]
        end_ms = int(typed[-1][0]) + 3000
        lines += simrun("transcript", STREAMS / "rest-2lsb.csv", "--loop", *options, "--max-ms", end_ms, judge=False)[1]
    return lines


def kept(line):
    """What of a line must not change: None where nothing must."""
    fault = re.match(r"# (?:refused|fault) \d+(?: over)?:", line)
    if fault:
        return fault[0]
    if line.startswith("t_us,"):
        return line
    words = re.fullmatch(rf"(# [a-z0-9]+)( (?:{NUMBER}(?: {NUMBER})*|[-a-z0-9_]+)(?: [A-Za-z0-9/^]+)?)?(?:[:,].*)?", line)
    if not words or not words[2]:
        return words and words[1]
    return words[1] if words[1] in STATUS else words[1] + words[2]


def missing(old, new):
    """The first line of the old ones, in their order, that the new ones do not have."""
    rest = iter(new)
    return next((line for line in old if line not in rest), None)


@test
def what_the_console_said_it_still_says():
    recorded = (HERE / "0.1.0.txt").read_text(encoding="ascii").splitlines()
    old = [line for line in map(kept, recorded) if line]
    new = [line for line in map(kept, said()) if line]
    assert len(old) > 90, len(old)
    line = missing(old, new)
    assert line is None, f"not said any more, or not in this place: {line}"
    # a twin that must fail: a word that is another
    assert missing(old, [line.replace("every 2", "every: 2") for line in new]) == "# every 2"
