"""The page of the recordings, whose program may fail, that of navigation, whose program may be cut short; and the list of what make proof does not
prove."""
import contextlib
import io
import pathlib
import re
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from images import HOLDS  # noqa: E402
from laws import PLAIN, ROBUST, names  # noqa: E402
import page_navigation
import proof
import recordings
import results

from system_support import refused, run_all, test

OUT = pathlib.Path("build/pages-test")


def recorded(status):
    """(status, what it prints, its page) of make recordings' command over a program that ends so after the rows of one recording and two filters."""
    counts, lines = "1000,20,1,0,30,0,900,0,0.5,0,0,0.0", ["stream,walk,100.0,16,100.0,1000,0,0,0,0"]
    for name in (PLAIN, ROBUST):
        lines += [f"{kind},{name},{axis},{counts},10,12.0" for kind in ("filter,walk", "rest,walk,0") for axis in "xyz"]
        lines += [f"fault,{pool},bad reads 1e-3,{name},0.001,1.500,2.500,1.600,2.600,1.500" for pool in ("at rest", "moving")]
    lines += [f"tails,walk,0,{axis},1000,2.00,0.01,0.001" for axis in "xyz"]
    OUT.mkdir(parents=True, exist_ok=True)
    program, page, text = OUT.resolve() / "program.sh", OUT.resolve() / "page.md", io.StringIO()
    program.write_text("#!/bin/sh\ncat <<'END'\n" + "\n".join(lines) + f"\nEND\nexit {status}\n", encoding="ascii")
    program.chmod(0o755)
    page.unlink(missing_ok=True)
    made = results.Results(page, "Of the test", "make recordings", "What.")
    try:
        with mock.patch.multiple(recordings, PAGE=made, CSV=OUT / "rows.csv", PROGRAM=str(program)), \
                contextlib.redirect_stderr(text), contextlib.redirect_stdout(text):
            status = recordings.main()
    except (SystemExit, results.Fault) as end:
        status = getattr(end, "code", str(end))
    return status, text.getvalue(), page.read_text(encoding="utf-8") if page.is_file() else None


@test
def a_page_is_written_where_the_program_ran_to_its_end():
    status, text, page = recorded(0)
    assert status == 0 and "1 passed, 0 failed" in text and page, text
    status, text, page = recorded(1)
    assert status == 1 and "an estimate left its bounds" in text and "0 passed, 1 failed" in text and page, text
    assert recorded(recordings.SAID) == (recordings.SAID, "", None)
    status, text, page = recorded(recordings.ABSENT)
    assert status == 0 and text.startswith("skipped: 1 (") and page is None, text
    status, text, page = recorded(9)
    assert status.endswith("program.sh gave status 9") and page is None, status


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
def a_run_of_navigation_that_is_cut_short_is_refused():
    assert page_navigation.chip_rows(CHIP, 12)
    for cut in (CHIP.rpartition("load")[0], CHIP.replace("call gps", "gps call:")):
        refused(results.Fault, lambda: page_navigation.chip_rows(cut, 12), "nav_chip_12: it did not run to its end")


@test
def a_line_of_deliberate_that_stands_twice_is_refused():
    lines = (proof.HERE / "deliberate.txt").read_text(encoding="utf-8").splitlines()
    assert len(proof.deliberate()) == len(lines) - 1 >= 50
    OUT.mkdir(parents=True, exist_ok=True)
    text = io.StringIO()
    (OUT / "deliberate.txt").write_text("\n".join([*lines, lines[1].split("|")[0] + "|" + lines[1].split("|")[1] + "| otherwise"]) + "\n")
    with mock.patch.object(proof, "HERE", OUT), contextlib.redirect_stderr(text):
        refused(SystemExit, proof.deliberate)
    first = " | ".join(part.strip() for part in lines[1].split("|")[:2])
    assert f"deliberate.txt: {first} stands twice: strike one" in text.getvalue(), text.getvalue()


@test
def pages_measured_at_night_alone_have_every_filter_and_the_default_and_show_every_picture():
    """Between two nights a new filter, another default or a picture that no page shows any more would else go unseen."""
    held = {name: pathlib.Path(f"docs/results/{name}.md").read_text(encoding="utf-8") for name in ("default-filter", "benchmarks")}
    lacking = [(page, name) for page, text in held.items() for name in names() if not re.search(rf"^\| `?{name}`? \|", text, re.M)]
    assert not lacking, lacking
    assert f"The rule chooses **`{HOLDS['everyday'][0]}`**" in held["default-filter"]
    pages = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("docs").rglob("*.md"))
    assert set(re.findall(r"pictures/([\w-]+\.png)", pages)) == {path.name for path in results.PICTURES.iterdir()}


if __name__ == "__main__":
    raise SystemExit(run_all())
