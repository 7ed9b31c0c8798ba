"""What .ci/run and make nightly make of their steps: sums, a step that fails, is silent, is skipped or takes too long; the page of the night; and
that each is a target."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import misspelt  # noqa: E402
from system_support import OUT, run_all, test

os.environ.pop("SLOWER", None)  # of a CI that runs this

# in place of make: fails, says nothing or skips where the words of a step begin with $FAILS, $SILENT or $SKIPS
MAKE = """#!/bin/sh
echo "$*" >> "$CALLS"
case "$*" in
    "$FAILS"*) echo "4 passed, 2 failed"; exit 2 ;;
    "$SILENT"*) exit 0 ;;
    "$SKIPS"*) echo "skipped: 3 (as said above)"; exit 0 ;;
esac
echo "2 passed, 0 failed"
"""
SCRIPTS = (".ci/run", "campaigns/nightly.sh")
PAGE = OUT.resolve() / "nightly.md"


def tree():
    """A folder with the scripts and what they call: they remove profiles and results, which must not be those of the checkout."""
    folder = OUT.resolve() / "tree"
    for path in (*SCRIPTS, "campaigns/steps.sh", "campaigns/night_page.py"):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, folder / path)
    (folder / "tools").mkdir(exist_ok=True)
    (folder / "tools/deps.sh").write_text("", encoding="ascii")
    return folder


def run_with_make(script, fails="-", silent="-", skips="-", steps=""):
    """(status, what it prints, the steps that it takes)."""
    folder = tree()
    make, calls = OUT / "make", (OUT / "calls").resolve()
    make.write_text(MAKE, encoding="ascii")
    make.chmod(0o755)
    calls.unlink(missing_ok=True)
    done = subprocess.run(["bash", script], capture_output=True, text=True, check=False, cwd=folder, env={
        **os.environ, "PATH": f"{OUT.resolve()}:{os.environ['PATH']}", "CALLS": str(calls), "FAILS": fails, "SILENT": silent, "SKIPS": skips,
        "STEPS": steps, "NIGHT_PAGE": str(PAGE)})
    return done.returncode, done.stdout + done.stderr, calls.read_text(encoding="ascii").splitlines() if calls.exists() else []


def night_rows():
    lines = [line.strip("| ").split(" | ") for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    return {name.strip("`"): cells for name, *cells in lines}


@test
def sums_are_those_of_the_steps():
    for script in SCRIPTS:
        status, text, calls = run_with_make(script)
        assert status == 0 and len(calls) >= 10 and text.endswith(f"{2 * len(calls)} passed, 0 failed\n"), text
        status, text, calls = run_with_make(script, skips="soak")
        assert status == 0 and ": 3 skipped, " in text and text.endswith(f"{2 * len(calls) - 2} passed, 0 failed\n"), text


@test
def what_an_earlier_run_left_is_removed_in_the_script_s_own_tree():
    for script, path in zip(SCRIPTS, ("build/profiles/earlier.csv", "build/mutants/results.jsonl")):
        left = tree() / path
        left.parent.mkdir(parents=True, exist_ok=True)
        left.write_text("", encoding="ascii")
        run_with_make(script)
        assert not left.exists(), left


@test
def a_step_that_fails_or_is_silent_fails_the_whole():
    for script in SCRIPTS:
        status, text, calls = run_with_make(script, fails="soak")
        assert status == 1 and "make soak HOURS=" in text and text.endswith(f"{2 * len(calls) + 2} passed, 2 failed\n"), text
        status, text, calls = run_with_make(script, silent="soak")
        assert status == 1 and "it prints nothing passed, failed or skipped" in text, text
        assert text.endswith(f"{2 * len(calls) - 2} passed, 1 failed\n"), text


@test
def the_night_begins_and_ends_with_the_pages_and_leaves_no_measurement_out():
    calls = run_with_make("campaigns/nightly.sh")[2]
    assert calls[0] == calls[-1] == "check-pages STRICT=yes", calls
    pages = re.findall(r"^docs/\S+ \| make (\w+)", pathlib.Path("checks/pages.txt").read_text(encoding="utf-8"), re.M)
    assert len(pages) >= 9 and set(pages) <= set(calls), set(pages) - set(calls)


@test
def each_step_of_the_night_has_its_row_and_keeps_it():
    PAGE.unlink(missing_ok=True)
    assert run_with_make("campaigns/nightly.sh", steps="soak faults")[2] == ["faults", "soak HOURS=24"]
    rows = night_rows()
    assert list(rows)[:2] == ["check-pages STRICT=yes", "test"] and rows["test"][0] == "never", rows
    assert re.fullmatch(r"[0-9a-f]{8}\+?|no git", rows["faults"][0]) and rows["faults"][1:] == ["2", "0", "0", "0.0"], rows
    run_with_make("campaigns/nightly.sh", fails="soak", steps="soak")
    assert night_rows()["soak HOURS=24"][1:4] == ["4", "2", "0"] and night_rows()["faults"] == rows["faults"]
    run_with_make("campaigns/nightly.sh", skips="recordings", steps="recordings")
    assert night_rows()["recordings"][1:4] == ["0", "0", "3"], night_rows()["recordings"]
    PAGE.write_text(PAGE.read_text(encoding="utf-8") + "| `gone` | 01234567 | 1 | 0 | 0 | 0.1 |\n", encoding="utf-8")
    run_with_make("campaigns/nightly.sh", steps="soak")
    assert "gone" not in night_rows() and night_rows()["soak HOURS=24"][1:4] == ["2", "0", "0"]
    status, text, calls = run_with_make("campaigns/nightly.sh", steps="soak nothing")
    assert status == 1 and calls == [] and text.startswith("nightly: STEPS: no step nothing; choose from: arduino bench "), text
    assert run_with_make("campaigns/nightly.sh", steps=".")[0] == 1


@test
def every_step_of_ci_has_a_budget_and_half_over_it_fails():
    lines = pathlib.Path(".ci/run").read_text(encoding="utf-8").splitlines()
    steps = [line for line in lines if re.match(r"\S* ?(step|counted|within) ", line)]
    assert len(steps) >= 10 and all(re.match(r"(\w+=\S+ )?within \d+ (step|counted) ", line) for line in steps), steps

    def over(limit_s, took_s, slower="1"):
        command = f". campaigns/steps.sh; limit_s={limit_s}; over_budget {took_s}"
        return subprocess.run(["bash", "-c", command], check=False, env={**os.environ, "SLOWER": slower}).returncode == 0
    assert [over(60, 90), over(60, 91), over(60, 180, "2"), over(60, 181, "2"), over(0, 1000)] == [False, True, False, True, False]
    for took_s, failures in ((90, 0), (91, 1)):
        script = f"who=x; . campaigns/steps.sh; make() {{ true; }}; elapsed() {{ echo {took_s}; }}; within 1 step soak; step faults; ended"
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)
        assert done.returncode == failures and done.stdout.endswith(f" of 60 s\n2 passed, {failures} failed\n"), done


@test
def a_machine_s_slowness_is_a_whole_number_and_no_step_is_no_success():
    for slower in ("1.5", "0", "-1", "x", "1e3"):
        done = subprocess.run(["bash", ".ci/run"], capture_output=True, text=True, check=False, cwd=tree(), env={**os.environ, "SLOWER": slower})
        assert done.returncode == 1 and done.stderr.startswith(f"ci: SLOWER={slower}: ") and not done.stdout, done
    done = subprocess.run(["bash", "-c", "who=x; . campaigns/steps.sh; ended"], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and re.search(r"x: no step was taken\nx: 0 skipped, \d+ s\n0 passed, 1 failed\n\Z", done.stdout), done


@test
def what_is_typed_makes_no_step_of_the_night_smaller():
    calls = OUT / "sizes"
    (OUT / "make").write_text('#!/bin/sh\necho "$*|$SAMPLE$ONLY$RUNS$MAKEFLAGS" >> "$CALLS"\necho "1 passed, 0 failed"\n', encoding="ascii")
    calls.unlink(missing_ok=True)
    subprocess.run(["bash", "campaigns/nightly.sh"], capture_output=True, check=True, cwd=tree(), env={
        **os.environ, "PATH": f"{OUT.resolve()}:{os.environ['PATH']}", "CALLS": str(calls.resolve()), "NIGHT_PAGE": str(PAGE),
        "STEPS": "faults papers", "SAMPLE": "60", "ONLY": "x", "RUNS": "9", "MAKEFLAGS": " -- SAMPLE=60"})
    assert calls.read_text(encoding="ascii") == "papers|\npapers PAPER_SEED=2025|\nfaults|\n", calls.read_text(encoding="ascii")


@test
def each_step_is_a_target():
    rules = "".join(path.read_text(encoding="utf-8") for path in misspelt.makefiles())
    for script in SCRIPTS:
        for step in re.findall(r"^(?:.*within \d+ )?(?:step|counted) ([a-z][\w-]*)", pathlib.Path(script).read_text(encoding="utf-8"), re.M):
            assert re.search(rf"^{step}:", rules, re.M), f"{script}: {step}"


if __name__ == "__main__":
    raise SystemExit(run_all())
