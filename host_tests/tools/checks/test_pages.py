"""Pages that commands write: a title that stands twice is refused; the cells of the page of navigation. And the list of what make proof does not
prove."""
import contextlib
import io
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import page_navigation
import page_sources
import proof
import results

from system_support import run_all, test

OUT = pathlib.Path("build/pages-test")


@test
def no_page_has_a_title_twice():
    for name in page_sources.table():
        text = pathlib.Path(name).read_text(encoding="utf-8")
        parts = re.findall(r"<!-- written by [^>]*begin -->\n(.*?)<!-- written by [^>]*end -->", text, re.S)
        for part in [text] if pathlib.Path(name).parent == results.FOLDER else parts:
            results.no_title_twice(name, part.splitlines())
    # the twin: a doubled table is named
    lines = ["### Roll", "", "| a | b |", "|---|---|", "| x | 1 |", "", "### Roll", "", "| a | b |", "|---|---|", "| x | 2 |"]
    try:
        results.no_title_twice("docs/any.md", lines)
    except results.Fault as fault:
        assert str(fault) == "docs/any.md: the title 'Roll' occurs 2 times", fault
    else:
        raise AssertionError("a title twice was taken")


CHIP = """call init: 1, mean 9000, most 9000 cycles
call imu: 500, mean 71000, most 150128 cycles
call gps: 3, mean 1589, most 1589 cycles
call down: 5, mean 678, most 678 cycles
call field: 50, mean 3427, most 3427 cycles
slot with take in: 10, mean 61378, most 73836 cycles
slot with scalar: 20, mean 119352, most 150128 cycles
slot with noise: 470, mean 71193, most 87375 cycles
load 51.4 %; static 1000, stack 336 bytes; 0 of 500 states differ from the PC
"""


@test
def the_page_of_navigation_holds_what_its_programs_say():
    rows = []
    for states in page_navigation.STATES:
        rows += [{"part": "image", "states": states, "seconds": 500.0, "records": 56267, "compared": 5000, "cpu_load": 0.582,
                  "pass_max_cycles": 153280, "frames_latest_us": 1830.0, "ram_used_bytes": 1666, "flash_bytes": 16298},
                 {"part": "flight", "states": states, "interval": "no GPS", "from_s": 160.0, "to_s": 400.0, "heading_deg": 0.95, "level_deg": 0.65,
                  "velocity_mps": 6.803, "position_m": 454.97},
                 *page_navigation.chip_rows(CHIP, states)]
        rows[-1]["flash_bytes"] = 14200
    lines = page_navigation.lines(rows)
    for line in ("| mean load | 58.2 % | 58.2 % |", "| longest pass of the main loop | 9.58 ms | 9.58 ms |",
                 "| static RAM and stack | 1,666 B | 1,666 B |", "| 12 | 160 to 400 | no | 0.95 | 0.65 | 6.803 | 454.97 |",
                 "| slot that uses a scalar | 119,352, 150,128 | 119,352, 150,128 |",
                 "| `nav_gps` | 1,589 | 1,589 |", "| static RAM, stack | 1,000 B, 336 B | 1,000 B, 336 B |",
                 "| states that differ from the PC | 0 of 500 | 0 of 500 |"):
        assert line in lines, (line, lines)
    for cut in (CHIP.rpartition("load")[0], CHIP.replace("call gps", "gps call:")):
        try:
            page_navigation.chip_rows(cut, 12)
        except results.Fault as fault:
            assert str(fault) == "nav_chip_12: it did not run to its end", fault
        else:
            raise AssertionError("a run that was cut short was taken")


@test
def a_line_of_deliberate_that_stands_twice_is_refused():
    lines = (proof.HERE / "deliberate.txt").read_text(encoding="utf-8").splitlines()
    assert len(proof.deliberate()) == len(lines) - 1 >= 50
    OUT.mkdir(parents=True, exist_ok=True)
    kept, text = proof.HERE, io.StringIO()
    proof.HERE = OUT
    (OUT / "deliberate.txt").write_text("\n".join([*lines, lines[1].split("|")[0] + "|" + lines[1].split("|")[1] + "| otherwise"]) + "\n")
    try:
        with contextlib.redirect_stderr(text):
            proof.deliberate()
    except SystemExit:
        first = " | ".join(part.strip() for part in lines[1].split("|")[:2])
        assert f"deliberate.txt: {first} stands twice: strike one" in text.getvalue(), text.getvalue()
    else:
        raise AssertionError("a line twice was taken")
    finally:
        proof.HERE = kept


if __name__ == "__main__":
    raise SystemExit(run_all())
