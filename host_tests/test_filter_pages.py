"""The pages on the filters, written by hand: a measured number is that of the results or of the test beside it, a default that of the library, an image
what make builds; links lead somewhere, tests that are named exist, and the pages stay short."""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, "tools")
import default_score  # noqa: E402
from design_support import Library
from laws import DEFAULT
import results

from system_support import run_all, test

DOCS = pathlib.Path("docs")
WORDS = {"choosing-a-filter": 900, "filters-gated": 1500, "filters-adaptive": 900, "filters-synthesised": 1300, "variable-structure": 800}
NUMBERS = 20  # measured ones, of a page
CLASSES = "RMSE by class"
STOP, MOVED = "A frozen sensor stuck at zero", "Troubles that last five windows, a frozen sensor at its last value"


def rolls(stream, *columns):
    return [("robust-filters", "Roll", stream, column) for column in columns]


def changed(stream, *rows):
    return [("robust-filters", "One parameter changed", row, stream) for row in rows]


def ruled(*cells):
    return [("variable-structure", STOP, row, column) for row, column in cells]


SHOWN = ("raw", "`adaptive`", "`kf`", "`sprf`")
SAMPLE_GATE, WORST, MEDIAN = "3 sigma gate at each sample", "95 % of the runs", "median rms, m/s"
# page: (words with a {} for each number, where the numbers are: a cell of a page of results, or (file, text in it))
HELD = {
    "choosing-a-filter": (
        ("| slow tilt, nothing wrong | {} | {} | {} | {} |", rolls("tilt-slow", *SHOWN)),
        ("| 15 % outliers | {} | {} | {} | {} |", rolls("outliers-15pct", *SHOWN)),
        ("| the tilt jumps | {} | {} | {} | {} |", rolls("steps", *SHOWN)),
        ("it wins in {} of {} draws", [("docs/results/default-filter.md", r"the same in (\d+) of \d+ draws"),
                                       ("docs/results/default-filter.md", r"the same in \d+ of (\d+) draws")]),
        ("`adaptive` has an error of {} LSB, `synth_plus` {} (256", [("default-filter", "RMSE by class and rate", "walking, 25 Hz", name)
                                                                     for name in ("`adaptive`", "`synth_plus`")])),
    "filters-gated": (
        ("its roll error is {} degrees rms (`sprf` {})", rolls("steps", "`sprf_paper`", "`sprf`")),
        ("leaves {} degrees rms at rest in place of {},", changed("rest-2lsb", "`kf` q=1000", "`kf` as shipped")),
        ("and {} in fast motion in place of {}.", changed("tilt-fast", "`kf` q=1000", "`kf` as shipped")),
        ("2 refuses {} % of the rows at rest", changed("gated at rest, %", "`sprf` gate=2")),
        ("3 costs `sprf` {} degrees in place of {},", changed("steps", "`sprf` reacquire=3", "`sprf` as shipped")),
        ("0 costs {}: locked out", changed("steps", "`sprf` reacquire=0")),
        ("in fast motion an error of {} degrees", rolls("tilt-fast", "`lrf`")),
        ("`sprf` refuses {} % of the rows at rest; with a quarter of R {} %", changed("gated at rest, %", "`sprf` as shipped", "`sprf` R=0.25")),
        ("(`pbf`: {} degrees on the jumps)", rolls("steps", "`pbf`")),
        ("`kf` has {} degrees in place of {} (", [("robust-filters", "The same vibration at 100 / 400 Hz", "100 Hz", "`kf`", part) for part in (1, 0)])),
    "filters-adaptive": (
        ("it has the least error, {} LSB on average (`soft`: {})", [("default-filter", CLASSES, name, "mean") for name in ("`adaptive`", "`soft`")]),
        ("On the roll of paper 000 it has {} degree^2, the best of 83 fixed tunings {} (",
         [("synthesised-filters", "Mean of the twelve cells", row, "mean square error") for row in ("`adaptive`", "the best fixed tuning")]),
        ("cost {} degree^2,", [("synthesised-filters", "What the width of the gate trades", "3", "sine30 clean, 6-10 s")]),
        ("{} without guard", [("synthesised-filters", "`adaptive` on paper 000's roll", "unguarded, scatter identified", "sine30", 1)])),
    "filters-synthesised": (
        ("For an error of 9 second differences `synth` leaves {} of the variance, alpha-beta {}, the steady `kf` {};",
         [("synthesised-filters", "Least noise gain for a dynamic error", "9", name) for name in ("`synth`, a1 = 0", "alpha-beta", "steady Kalman (`kf`)")]),
        ("for 100 it is {} against {}.",
         [("synthesised-filters", "Least noise gain for a dynamic error", "100", name) for name in ("`synth`, a1 = 0", "alpha-beta")])),
    "variable-structure": (
        ("Median error {} m/s, no window", ruled((SAMPLE_GATE, MEDIAN))),
        ("it can be led astray: {} m/s in one", [("variable-structure", MOVED, SAMPLE_GATE, WORST)]),
        ("the least normalised innovation, {} m/s ({} in one", ruled(*(("normalised innovation, may coast", column) for column in (MEDIAN, WORST)))),
        ("and then the degree, {}, where", ruled(("acceptor's gate, then the degree", MEDIAN))),
        ("its result, {} m/s, is worse than any sensor taken blindly ({} to {})",
         ruled(*((rule, MEDIAN) for rule in ("degree of observability (14) alone", "sensor 3 always (0.25 m/s)", "sensor 2 always (0.4 m/s)")))),
        ("{} m/s against", [("variable-structure", MOVED, "acceptor's gate, then the degree", "median, chosen by the window before")]),
        ("against {} for the best fixed sensor", [("variable-structure", MOVED, "sensor 1 always (0.15 m/s)", MEDIAN)]),
        ("misses by {} m/s over 20 s, the linear trend by {}, the choice among three by {}.",
         [("variable-structure", "Trends: the 20 s after 40 s of estimates", row, "rms error in m/s, median")
          for row in ("the filter's own model", "linear (18)", "self-organised choice by (24) + (25)")])),
}


def text_of(name):
    return (DOCS / f"{name}.md").read_text(encoding="utf-8")


def one_line(text):
    return " ".join(text.split())


def number_at(place):
    """The number of a cell (or of its N-th part), or what an expression finds in a file."""
    if len(place) == 2:
        return re.search(place[1], pathlib.Path(place[0]).read_text(encoding="utf-8"))[1]
    page, title, row, column, *part = place
    cell = results.numbers_of((results.FOLDER / f"{page}.md").read_text(encoding="utf-8"))[f"{title}, {row}, {column}"].split(" (")[0]
    return re.split(r" / | ", cell)[part[0]] if part else cell


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
    best = {group for title, group, column, name in found if title == "Verdict" and column == "best" and name == f"`{DEFAULT}`"}
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


def compared(library, filters, names, unit, shown):
    """How many defaults of a row are the library's; a row that says in words what it is holds no number."""
    count = 0
    for name in filters:
        has = defaults_of(library, name)
        for parameter in names:
            if parameter not in has:
                continue
            own = re.search(rf"`{name}` ([\d.]+)", shown)
            number = own[1] if own else (re.match(r"-?[\d.]+", shown) or [""])[0]
            assert unit == has[parameter][0], (name, parameter, unit)
            if number:
                assert abs(float(number) - has[parameter][1]) < 1e-4, (name, parameter, number, has[parameter][1])
                count += 1
    return count


@test
def defaults_and_units_are_those_of_the_library():
    library, count = Library(), 0
    for names, filters, unit, shown, *_ in table_rows(text_of("filters-gated"), ["name", "filters"]):
        named = re.findall(r"`(\w+)`", filters) or ["kf", "lrf", "sprf", "soft", "pbf", "af", "shrf", "sprf_paper"]
        assert set(named) <= library.names, named
        if names != "`gate`":
            missing = [name for name in named if names.strip("`") not in defaults_of(library, name)]
            assert missing == [], (names, missing)
        count += compared(library, named, re.findall(r"`(\w+)`", names), unit, shown)
    for names, name, unit, shown, *_ in table_rows(text_of("filters-synthesised"), ["name", "filter"]):
        named = ["synth"] if "alpha of" in shown else re.findall(r"`(\w+)`", name)
        count += compared(library, named, re.findall(r"`(\w+)`", names), unit, shown)
    adaptive, auto = text_of("filters-adaptive").split("## auto")
    for name, text in (("adaptive", adaptive), ("auto", auto)):
        rows = table_rows(text, ["name", "unit"])
        told = [parameter for row in rows for parameter in re.findall(r"`(\w+)`", row[0])]
        assert set(told) == set(defaults_of(library, name)), (name, told)
        count += sum(compared(library, [name], re.findall(r"`(\w+)`", row[0]), row[1], row[2]) for row in rows if row[2] != "")
    assert count >= 30, count
    assert f"300000 as shipped" in one_line(adaptive) and defaults_of(library, "kf3")["q"][1] == 300000


@test
def every_filter_has_its_page_and_its_image():
    library = Library()
    pages = "".join(text_of(name) for name in WORDS if name.startswith("filters-"))
    assert all(f"`{name}`" in pages or f"## {name}\n" in pages for name in library.names)
    found = {}
    for line in pathlib.Path("mk/images.mk").read_text(encoding="utf-8").splitlines():
        match = re.match(r"FILTERS_(\w+) +:= (.*)", line)
        if match:
            found[match[1]] = match[2].split()
    rows = table_rows(text_of("choosing-a-filter"), ["image", "filters"])
    told = {image: re.findall(r"`(\w+)`", filters) for image, filters in rows}
    wanted = {"`make flash`" if name == "everyday" else f"`make flash FILTERS={name}`": names for name, names in found.items() if name != "small"}
    assert told == wanted, (told, wanted)


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


# --- links and tests --------------------------------------------------------------------------------------------------


def anchors(path):
    """The headings of a page as GitHub links to them."""
    seen, found = {}, set()
    for heading in re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.M):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.add(f"{anchor}-{seen[anchor]}" if anchor in seen else anchor)
        seen[anchor] = seen.get(anchor, 0) + 1
    return found


def broken(path, text):
    """Links of a page that lead nowhere."""
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.S)):
        name, _, anchor = target.partition("#")
        file = path.parent / name if name else path
        if not name.startswith("http") and (not file.exists() or (anchor and anchor not in anchors(file))):
            yield target


@test
def every_link_leads_somewhere():
    pages = [*(DOCS / f"{name}.md" for name in WORDS), *sorted(results.FOLDER.glob("*.md"))]
    for path in pages:
        assert list(broken(path, path.read_text(encoding="utf-8"))) == [], f"{path}: {list(broken(path, path.read_text(encoding='utf-8')))}"
    assert list(broken(pages[0], "[a](filters-gated.md#no-such) [b](nowhere.md) [c](tools.md)")) == ["filters-gated.md#no-such", "nowhere.md"]


@test
def every_test_that_is_named_exists():
    sources = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("host_tests").rglob("test_*.[cp]*") if path.suffix in (".c", ".py"))
    count = 0
    for name in WORDS:
        for named in re.findall(r"`([a-z0-9]+(?:_[a-z0-9]+){3,})`", text_of(name)):
            assert f"void {named}(" in sources or f"def {named}()" in sources, (name, named)
            count += 1
    assert count >= 14, count
    for line, file, words in (("filters-adaptive", "test_tilt_partial.c", "1.365"), ("filters-adaptive", "test_tilt_partial.c", "0.228")):
        assert words in text_of(line) and words in (pathlib.Path("host_tests") / file).read_text(encoding="utf-8"), words


if __name__ == "__main__":
    raise SystemExit(run_all())
