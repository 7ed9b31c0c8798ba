"""host_tests/support/documented_limits.h: what pages promise, what the product holds and what is tried are the same number."""
import math
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import run_all, test

TABLE = pathlib.Path("host_tests/support/documented_limits.h")
ROW = re.compile(r'\bX\((\w+), (\d+), "([^"]+)", "([^"]+)", "([^"]+)"\)')
WORDS = dict(enumerate("zero one two three four five six seven eight nine ten".split())) | {16: "sixteen"}
NTH = {3: "third", 8: "eighth", 9: "ninth", 10: "tenth"}


def rows():
    """(name, value, promises, holders, test) of each limit; of the first two (file, text)."""
    text = re.sub(r'"\s+"', "", re.sub(r"\s*\\\s+", " ", TABLE.read_text(encoding="utf-8")))
    found = ROW.findall(text.partition("#define LIMITS(X)")[2])
    assert len(found) == text.count(" X(") + text.count(")X(") >= 45, f"{len(found)} rows are read"
    return [(name, int(value), places(promises), places(holders), tried) for name, value, promises, holders, tried in found]


def places(cell):
    return [tuple(place.split(": ", 1)) for place in re.split(r" \| (?=\S+: )", cell)]


def filled(text, value):
    names = {"v": value, "word": WORDS.get(value, str(value)), "nth": NTH.get(value, str(value)), "ceil": math.ceil}
    return re.sub(r"\{([^}:]*)(:g)?\}", lambda part: format(eval(part[1] or "v", {}, names), (part[2] or ":")[1:]), text)


def missing(value, named):
    """Those of (file, text) that do not stand there with this value."""
    texts = [(file, filled(text, value)) for file, text in named]
    return [f"{file}: {text}" for file, text in texts if text not in " ".join(pathlib.Path(file).read_text(encoding="utf-8").split()) + " "]


@test
def pages_promise_what_the_product_holds():
    wrong = [f"{name}: {text}" for name, value, promises, holders, _ in rows() for text in missing(value, promises + holders)]
    assert not wrong, "\n".join(wrong)


@test
def another_number_stands_in_no_place():
    """The twin: words that would hold with any number promise none."""
    for name, value, promises, holders, _ in rows():
        for place in promises + holders:
            assert missing(2 * value, [place]), f"{name}: {place} holds with {2 * value} too"


@test
def each_limit_is_tried_by_a_test_that_takes_it_from_the_table():
    for name, _, _, _, tried in rows():
        file, function = tried.split(": ")
        (path,) = pathlib.Path("host_tests").glob(f"*/{file}.c")
        text = path.read_text(encoding="utf-8")
        assert f"\nTEST({function})\n" in text, f"{name}: no {function} runs in {file}.c"
        assert re.search(rf"\bLIMIT_{name}\b", text), f"{name}: {file}.c does not use LIMIT_{name}"


def without_a_row(page):
    """Settings of the firmware's table that have no row in the table of commands of this page."""
    table = pathlib.Path("firmware/settings/settings_table.c").read_text(encoding="utf-8")
    names = re.findall(r'^    X\("(\w+)", ', table, re.M)
    assert {"filter", "every", "level"} <= set(names), names
    return [name for name in names if f"\n| `{name} " not in page]


@test
def each_setting_has_its_row_in_the_protocol():
    page = pathlib.Path("docs/protocol.md").read_text(encoding="utf-8")
    assert not without_a_row(page), f"docs/protocol.md: no row `| `NAME ...` |` for {without_a_row(page)}"
    assert without_a_row(page.replace("\n| `every N`", "\n| `each N`")) == ["every"]


if __name__ == "__main__":
    raise SystemExit(run_all())
