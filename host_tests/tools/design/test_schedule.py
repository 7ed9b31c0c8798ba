"""tools/design/schedule.py: the committed table against a new one, which test_synth_opt_reference.c holds against double; what is emitted, and
what bad words get."""
import pathlib
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
sys.path.insert(0, "tools/design")
import schedule  # noqa: E402
from system_support import run_all, test  # noqa: E402

TOOL = "tools/design/schedule.py"
(TABLE,) = pathlib.Path("lib/filters/src").glob("*_table.h")


@test
def committed_table_is_what_the_tool_makes():
    assert TABLE.read_text(encoding="utf-8") == schedule.library_table(), f"{TABLE} is not what {TOOL} --emit library writes: write it anew"


@test
def what_is_emitted_is_what_was_made():
    def said(*words):
        return subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True, timeout=600, check=True).stdout
    text = said("--p0-over-r", "8.33", "--variant", "u")
    assert "-0.333333" in text and "limit -0.166667, b0 0.846154" in text, text
    tables = said("--p0-over-r", "5", "--emit", "c", "--steps", "3")
    numbers = [[int(n) for n in row.split(",") if n.strip()] for row in re.findall(r"\{([^}]*)\}", tables)]
    assert numbers == [[0, 0, 0, 0], [54613, 54613, 51323, 43691]], tables
    assert said("--emit", "library") == schedule.library_table()


@test
def bad_words_give_one_sentence():
    for words, sentence in ((["--p0-over-r", "0"], "P0/R is 0, but must be finite and at least 1.52588e-05"),
                            (["--p0-over-r", "inf"], "P0/R is inf"), (["--p0-over-r", "five"], "'five' is not a number"),
                            (["--p0-over-r", "5", "--steps", "0"], "the number of steps is '0', but must be 1..1000"),
                            ([], "--p0-over-r is missing")):
        done = subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True, timeout=600)
        assert done.returncode == 2 and sentence in done.stderr, done


if __name__ == "__main__":
    raise SystemExit(run_all())
