"""What make refuses before it does anything: a variable that no makefile knows, a folder of OUT that is not there."""
import os
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import misspelt  # noqa: E402

from system_support import run_all, test

HELP = re.compile(r"\b([A-Z][A-Z_]+)=")
ALONE = {name: value for name, value in os.environ.items() if name not in ("MAKELEVEL", "MAKEFLAGS", "MFLAGS", "MAKEOVERRIDES")}


def make(*arguments):
    """(status, what it prints to its error stream). A dry run: nothing is built. Not a part of the make that runs this test, which looks at
    what was typed itself."""
    done = subprocess.run(["make", "-n", *arguments], capture_output=True, text=True, check=False, env=ALONE)
    return done.returncode, done.stderr


@test
def a_misspelt_variable_names_the_right_one():
    for typed, meant in (("STREM=a.csv", "STREAM"), ("FLTER=x", "FILTER"), ("rate=50", "RATE"), ("BORD=nano", "BOARD"), ("FILTER5=x", "FILTERS?"),
                         ("CC=clang", "HOST_CC")):
        status, text = make("sim", typed)
        assert status == 2 and re.search(rf"no variable {typed.split('=')[0]}: did you mean {meant}", text), (typed, text)
    status, text = make("sim", "XYZZY=1")
    assert status == 2 and "no variable XYZZY: `make help`" in text, text


@test
def every_variable_that_help_and_ci_name_is_known():
    text = subprocess.run(["make", "help"], capture_output=True, text=True, check=True).stdout
    named = set(HELP.findall(text)) | set(HELP.findall(pathlib.Path(".ci/run").read_text(encoding="utf-8")))
    named |= set(HELP.findall(pathlib.Path("README.md").read_text(encoding="utf-8")))
    assert len(named) >= 15, named
    unknown = {name for name in named if misspelt.complaint([name], misspelt.known())}
    assert not unknown, unknown


@test
def variables_that_are_right_pass():
    status, text = make("help", "STREAM=x.csv", "FILTER=x", "RATE=50", "OUT=build/x.csv", "HOST_CC=gcc")
    assert (status, text) == (0, ""), text


@test
def what_cannot_be_read_or_written_is_refused_before_anything_is_built():
    nowhere = "build/no-such-folder/run.csv"
    for stream, out, words in (("sim/streams/steps.csv", nowhere, f"sim: no folder build/no-such-folder for OUT={nowhere}"),
                               ("sim/streams/no.csv", "build/sim/run.csv", "sim: cannot read the stream sim/streams/no.csv")):
        done = subprocess.run(["sh", "tools/sim.sh", "check", stream, out], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and words in done.stderr, done.stderr
    assert not pathlib.Path(nowhere).parent.exists()
    rules = pathlib.Path("Makefile").read_text(encoding="utf-8")
    first = rules[rules.index("\nsim:\n"):].splitlines()[2]
    assert "tools/sim.sh check" in first, first


@test
def make_pictures_takes_every_picture_of_the_pages():
    """Those of docs/results are written with their pages; a drawing (.svg) is no picture of the firmware."""
    shown = {match for page in (pathlib.Path("README.md"), *pathlib.Path("docs").glob("*.md"))
             for match in re.findall(r"!\[[^]]*\]\((?:docs/)?([\w/-]+\.png)\)", page.read_text(encoding="utf-8")) if not match.startswith("results/")}
    taken = subprocess.run(["make", "-n", "pictures"], capture_output=True, text=True, check=False, env=ALONE).stdout
    scripts = [pathlib.Path(name).read_text(encoding="utf-8") for name in re.findall(r"host_tests/\S+_picture\.py", taken)]
    assert len(shown) >= 5 and len(scripts) >= 2, (shown, scripts)
    missing = {name for name in shown if f"docs/{name}" not in taken + "".join(scripts)}
    assert not missing, missing


if __name__ == "__main__":
    raise SystemExit(run_all())
