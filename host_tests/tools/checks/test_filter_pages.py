"""The pages on the filters, written by hand: a measured number is that of the results (filter_pages.csv) or of the test beside it, a default
that of the library, an image what make builds; tests that are named exist, and the pages stay short."""
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import default_score  # noqa: E402
from design_support import Library
import laws
import results

from system_support import run_all, test

DOCS = pathlib.Path("docs")
WORDS = {"choosing-a-filter": 900, "../README": 900, "filters-gated": 1500,
         "filters-adaptive": 900, "filters-synthesised": 1300, "variable-structure": 800, "comparison": 900}
NUMBERS = 20  # measured ones, of a page
TABLE = pathlib.Path("host_tests/tools/checks/filter_pages.csv")


def held():
    """{page: [(words, [place])]}"""
    found = {name: [] for name in WORDS}
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            name, words, *places = line.split(" ;; ")
            assert words.count("{}") == len(places) > 0, line
            found[name].append((words, places))
    return found


HELD = held()


def text_of(name):
    return (DOCS / f"{name}.md").read_text(encoding="utf-8")


def one_line(text):
    return " ".join(text.split())


def number_at(place):
    """The number of a cell (without its range in brackets), of its N-th part, or what an expression finds in the page."""
    page, _, key = place.partition(": ")
    text = (results.FOLDER / f"{page}.md").read_text(encoding="utf-8")
    if key.startswith("~"):
        return re.search(key[1:], one_line(text))[1]
    key, _, part = key.partition(" #")
    cell = re.split(r" [(\[]", results.numbers_of(text)[key])[0]
    return re.split(r" / | ", cell)[int(part)] if part else cell


def lost(name, text):
    """Sentences with the numbers of the results that a page does not have."""
    said = [words.format(*map(number_at, places)) for words, places in HELD[name]]
    return [sentence for sentence in said if sentence not in one_line(text)]


@test
def measured_numbers_are_those_of_the_results():
    for name in WORDS:
        assert lost(name, text_of(name)) == [], f"{name}.md does not say: {lost(name, text_of(name))}"
        assert sum(len(places) for _, places in HELD[name]) <= NUMBERS, name


@test
def a_number_that_is_not_that_of_the_results_is_found():
    for name in WORDS:
        for words, places in HELD[name]:
            sentence = words.format(*map(number_at, places))
            text = one_line(text_of(name))
            assert lost(name, text.replace(sentence, sentence.replace(number_at(places[0]), "9.99"))), sentence


@test
def the_default_is_ahead_where_the_page_says():
    found = results.cells((results.FOLDER / "default-filter.md").read_text(encoding="utf-8"))
    best = {group for title, group, column, name in found if title == "Verdict" and column == "best" and name == f"`{laws.DEFAULT}`"}
    assert best == {"rest", "slow tilt", "vibration", "bad reads", "outliers"}, best
    assert "It is the best at rest, on slow tilts, in vibration, among bad reads and among outliers." in one_line(text_of("choosing-a-filter"))
    assert "In handling, walking and runs of outliers others are as good or better." in one_line(text_of("choosing-a-filter"))
    assert len(default_score.CLASSES) == 8 and "over eight kinds of motion" in one_line(text_of("choosing-a-filter"))


@test
def pages_stay_short():
    for name, most in WORDS.items():
        words, lines = len(text_of(name).split()), text_of(name).splitlines()
        assert words <= most, f"{name}.md: {words} words, at most {most}"
        long = [line for line in lines if len(line) > 160 and not line.startswith(("|", "[", "!"))]
        assert long == [], f"{name}.md: more than 160 columns: {long}"


# --- parameters -------------------------------------------------------------------------------------------------------


def table_rows(text, first):
    """The rows of the tables whose head begins with this, as lists of cells."""
    rows, inside = [], False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|"):
            inside = False
        elif cells[:len(first)] == first:
            inside = True
        elif inside and not line.startswith("|---"):
            rows.append(cells)
    return rows


def defaults_of(library, name):
    """{parameter: (unit, default at 100 Hz)}"""
    law = library.law(name)
    config = library.c.filter_defaults(law, 1000)
    return {p.name.decode(): (p.unit.decode().replace("LSB2", "LSB^2").replace("/s3", "/s^3"), config.value[i] / 2 ** p.fraction_bits)
            for i, p in enumerate(library.parameters(law))}


def compared(library, row, everyone):
    """How many defaults of a row are the library's; a row that says in words what it is holds no number. `NAME` N is of that filter alone, a cell
    with a comma of the first."""
    names, filters, unit, shown, *_ = row
    named = re.findall(r"`(\w+)`", filters) or everyone
    count = 0
    for name in named[:1] if "," in shown else named:
        for parameter in re.findall(r"`(\w+)`", names):
            own = re.search(rf"`{name}` ([\d.]+)", shown) or re.match(r"(-?[\d.]+)", shown)
            library_unit, value = defaults_of(library, name)[parameter]
            assert unit == library_unit, (name, parameter, unit)
            assert own is None or abs(float(own[1]) - value) < 1e-4, (name, parameter, own[1], value)
            count += own is not None
    return count


@test
def defaults_and_units_are_those_of_the_library():
    library, count = Library(), 0
    rows = table_rows(text_of("filters-gated"), ["name", "filters"])
    count += sum(compared(library, row, laws.kalman()) for row in rows)
    rows = table_rows(text_of("filters-synthesised"), ["name", "filter"])
    family = sorted({name for row in rows for name in re.findall(r"`(\w+)`", row[1])})
    count += sum(compared(library, row, family) for row in rows)
    for section in text_of("filters-adaptive").split("\n## ")[1:]:
        name, has = section.split()[0], defaults_of(library, section.split()[0])
        rows = [[row[0], "", *row[1:]] for row in table_rows(section, ["name", "unit"])]
        assert {parameter for row in rows for parameter in re.findall(r"`(\w+)`", row[0])} == set(has) or not rows, name
        assert rows or f"{has['q'][1]:.0f} as shipped" in one_line(section), name
        count += sum(compared(library, row, [name]) for row in rows if row[3])
    assert count >= 35, count


@test
def every_filter_has_its_page_and_its_image():
    pages = "".join(text_of(name) for name in WORDS if name.startswith("filters-"))
    lacking = [name for name in laws.names() if f"`{name}`" not in pages and f"## {name}\n" not in pages]
    assert not lacking, f"no page docs/filters-*.md describes {lacking}"
    makefile = pathlib.Path("mk/images.mk").read_text(encoding="utf-8")
    for name, filters in re.findall(r"^FILTERS_(\w+) +:= (.*)$", makefile, re.M):
        line = f"- `{name}`: " + " ".join(f"`{each}`" for each in filters.split())
        assert f"\n{line}\n" in text_of("protocol"), f"docs/protocol.md, Images: no line {line}"
    first, *sets = re.search(r"^FILTER_SETS +:= (.*)$", makefile, re.M)[1].split()
    rows = table_rows(text_of("choosing-a-filter"), ["image", "filters"])
    for name, (image, filters) in zip([first, *sets], rows, strict=True):
        assert image == ("`make flash`" if name == first else f"`make flash FILTERS={name}`"), image
        assert re.findall(r"`(\w+)`", filters) == re.search(rf"^FILTERS_{name} +:= (.*)$", makefile, re.M)[1].split(), name


# --- the design tool --------------------------------------------------------------------------------------------------


@test
def the_example_is_what_the_synthesiser_prints():
    block = text_of("filters-synthesised").split("$ make design ")[1].split("```")[0].splitlines()
    words = re.search(r'ARGS="([^"]*)"', block[0])[1].split()
    done = subprocess.run([sys.executable, "tools/design", *words, "--out", "build/filter-pages-design"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    printed = done.stdout.splitlines()
    assert len(block) >= 8
    for line in block[1:]:
        assert line in printed, line


# --- tests -----------------------------------------------------------------------------------------------------------


@test
def every_test_that_is_named_exists():
    sources = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("host_tests").rglob("test_*.[cp]*") if path.suffix in (".c", ".py"))
    count = 0
    for name in WORDS:
        for named in re.findall(r"`([a-z0-9]+(?:_[a-z0-9]+){3,})`", text_of(name)):
            assert f"TEST({named})" in sources or f"def {named}()" in sources, (name, named)
            count += 1
    assert count >= 14, count
    source = pathlib.Path("host_tests/tilt/test_tilt_partial.c").read_text(encoding="utf-8")
    assert all(number in text_of("filters-adaptive") and number in source for number in ("1.365", "0.228"))


if __name__ == "__main__":
    raise SystemExit(run_all())
