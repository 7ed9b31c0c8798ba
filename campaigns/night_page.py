"""night_page.py PAGE STEP PASSED FAILED SKIPPED SECONDS: puts what a step of `make nightly` came to into a page, with the commit that it judged.
Rows of other steps stay: each is of that step's last whole run."""
import pathlib
import re
import subprocess
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
    """{step: the cells behind it}"""
    lines = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| `")]
    return {step.strip("`"): tuple(cells) for step, *cells in lines}


def commit():
    def git(*words):
        return subprocess.run(["git", *words], capture_output=True, text=True, check=False).stdout.strip()
    changes = git("status", "--porcelain", "--", ".", ":!docs/results", ":!docs/papers.md")
    return (git("rev-parse", "--short=8", "HEAD") or "no git") + ("+" if changes else "")


def page(text, step, result):
    """The page with this step's row; rows of what is no step any more are left out."""
    have = {**rows(text), step: result}
    lines = [f"| `{name}` | {' | '.join(have.get(name, NEVER))} |\n" for name in steps()]
    return HEAD + "".join(lines)


def main(path, step, passed, failed, skipped, seconds):
    if step not in steps():
        sys.exit(f"night_page: {STEPS} has no step '{step}'")
    path = pathlib.Path(path)
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    path.write_text(page(text, step, (commit(), passed, failed, skipped, f"{int(seconds) / 60:.1f}")), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
