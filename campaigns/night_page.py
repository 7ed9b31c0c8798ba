"""night_page.py PAGE COMMIT STEP PASSED FAILED SKIPPED SECONDS: puts the result of a step of `make nightly` into a page, with the commit that it
judged. Rows of other steps stay: each is of that step's last whole run."""
import os
import pathlib
import re
import sys

STEPS = pathlib.Path("campaigns/nightly.sh")
HEAD = """# The last whole run of each campaign
Written by `make nightly`, a row after each step. `+` after a commit: with changes that were not committed. `never`: not run whole yet. Minutes are
for two cores.

| make | commit | passed | failed | skipped | minutes |
|---|---|---:|---:|---:|---:|
"""
NEVER = ("never", "-", "-", "-", "-")


def steps():
    """The steps of the night in its order, each once."""
    found = re.findall(r"^(?:step|counted) (.+)$", STEPS.read_text(encoding="utf-8"), re.M)
    return list(dict.fromkeys(found))


def rows(text):
    """{step: its cells}"""
    lines = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| `")]
    return {step.strip("`"): tuple(cells) for step, *cells in lines}


def page(text, step, result):
    """The page with this step's row; rows of steps that are gone are left out."""
    have = {**rows(text), step: result}
    lines = [f"| `{name}` | {' | '.join(have.get(name, NEVER))} |\n" for name in steps()]
    return HEAD + "".join(lines)


def main(path, commit, step, passed, failed, skipped, seconds):
    if step not in steps():
        sys.exit(f"night_page: {STEPS} has no step '{step}'")
    path = pathlib.Path(path)
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    new = path.with_suffix(".new")  # an interrupted night leaves a whole page
    new.write_text(page(text, step, (commit, passed, failed, skipped, f"{int(seconds) / 60:.1f}")), encoding="utf-8")
    os.replace(new, path)


if __name__ == "__main__":
    main(*sys.argv[1:])
