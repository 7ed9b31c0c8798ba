"""docs/synthesised-filters.md: its closed forms are what the structure does, its floor is one, its text holds what its tables hold, its example is
what the synthesiser says, its links lead somewhere."""
import pathlib
import re
import subprocess
import sys
from fractions import Fraction

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import synthesised
    from page import INLINE
except ImportError as missing:
    sys.exit(f"test_synthesised: {missing.name} is missing: run it by `make test`")

from system_support import run_all, test

TEXT = synthesised.DOCUMENT.read_text(encoding="utf-8")
SAMPLES = 3000


def responses(a1, b0):
    """(noise gain, Pe / R, error under a second difference of 1) by running the papers' difference equation, no closed form."""
    power = before = 0.0
    x1 = x2 = x3 = 0.0
    for n in range(SAMPLES):
        predicted = (2 - a1) * x1 - (1 - 2 * a1) * x2 - a1 * x3
        x1, x2, x3 = predicted + b0 * ((1.0 if n == 0 else 0.0) - predicted), x1, x2
        power, before = power + x1 * x1, before + predicted * predicted
    x1 = x2 = x3 = 0.0
    for n in range(SAMPLES):
        signal = n * (n + 1) / 2
        predicted = (2 - a1) * x1 - (1 - 2 * a1) * x2 - a1 * x3
        x1, x2, x3 = predicted + b0 * (signal - predicted), x1, x2
    return power, before, signal - x1


def row_of(title):
    rows = {}
    for found, row, column, cell in synthesised.PAGE.cells(TEXT):
        if found == title:
            rows.setdefault(row, []).append((column, cell))
    return rows


def closed_rows():
    lines = TEXT[TEXT.index("### Closed forms of the structure"):].split("###")[1].splitlines()
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if re.match(r"\| -?\d", line)]


@test
def closed_forms_are_what_the_difference_equation_does():
    rows = closed_rows()
    assert len(rows) == len(synthesised.PRESETS)
    for a1, b0, _, gain, before, lag, *_ in rows:
        for cell, measured in zip((gain, before, lag), responses(float(Fraction(a1)), float(Fraction(b0)))):
            assert abs(float(cell) - measured) < 2e-6, (a1, b0, cell, measured)


@test
def no_filter_with_a1_below_0_is_under_the_floor():
    for i in range(1, 40):
        for j in range(0, 40):
            a1, b0 = -j / 40, i / 40
            q = -a1 * (1 - b0)
            if not 1 - 2 * q > 1e-9:
                continue
            gain = synthesised.Filter(2, (a1,), (b0,)).noise_gain()
            above = (b0 * (1 - 2 * q) + 4 * q + 4 * q * q) / (2 * (1 - 2 * q) * (4 - 3 * b0 + 4 * q))
            assert gain > 0.5 and abs(gain - 0.5 - above) < 1e-9 * gain, (a1, b0, gain)
    assert "NG - 1/2 = (b0 (1 - 2 q) + 4 q + 4 q^2) / (2 (1 - 2 q)(4 - 3 b0 + 4 q))" in TEXT


@test
def closed_tables_and_the_numbers_of_the_text_are_those_of_a_new_run():
    values = {}
    synthesised.declared(values)
    lines = synthesised.closed_tables(values)
    assert "\n".join(lines) in TEXT, "make synthesised writes the tables"
    told = [(key.strip(), number) for key, number in INLINE.findall(TEXT) if key.strip() in values]
    assert len(told) >= 15
    for key, number in told:
        assert number == values[key], f"'{key}': {number} on the page, {values[key]} in this run"


@test
def the_text_on_adaptive_holds_what_its_tables_hold():
    roll, gate = row_of("`adaptive` on paper 000's roll"), row_of("What the width of the gate trades")
    told = dict((key.strip(), number) for key, number in INLINE.findall(TEXT))
    checked = 0
    for key, number in told.items():
        if key.startswith("guarded "):
            _, profile, share, window = key.split()
            cell = dict(roll[f"guarded, {100 * float(share):g} % with 20 times the noise"])[profile]
            assert cell.split()[synthesised.WINDOWS.index(window)] == number, key
            checked += 1
    assert checked >= 5
    chosen = dict(gate[f"{synthesised.GATE_CHOSEN:g}"])
    assert chosen["sine30 clean, 6-10 s"] == told["guarded sine30 0 6-10"]


@test
def the_example_is_what_the_synthesiser_says():
    block = TEXT[TEXT.index("$ make design ARGS="):].split("```")[0].splitlines()
    words = re.search(r'ARGS="([^"]*)"', block[0])[1].split()
    done = subprocess.run([sys.executable, "tools/design", *words, "--out", "build/synthesised-design"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    said = done.stdout.splitlines()
    assert len(block) > 15
    for line in block[1:]:
        assert line in said, line


def anchors(path):
    """The headings of a page as GitHub links to them."""
    seen, found = {}, set()
    for heading in re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.M):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.add(f"{anchor}-{seen[anchor]}" if anchor in seen else anchor)
        seen[anchor] = seen.get(anchor, 0) + 1
    return found


@test
def every_link_leads_somewhere_and_every_test_named_exists():
    for target in re.findall(r"\]\(([^)]+)\)", TEXT):
        name, _, anchor = target.partition("#")
        path = synthesised.DOCUMENT.parent / name if name else synthesised.DOCUMENT
        assert path.is_file(), target
        assert not anchor or anchor in anchors(path), target
    sources = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("host_tests").glob("*/test_*.c"))
    for name in re.findall(r"`([a-z]+(?:_[a-z0-9]+){3,})`", TEXT):
        assert f"RUN_TEST({name})" in sources, name


if __name__ == "__main__":
    raise SystemExit(run_all())
