"""tools/design/schedule.py: the gain schedules of synth_opt against the values and limits of the notes, the committed table against a new
one, and what bad words get."""
import pathlib
import random
import re
import subprocess
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
sys.path.insert(0, "tools/design")
import schedule  # noqa: E402
from system_support import run_all, test  # noqa: E402

TOOL = "tools/design/schedule.py"
(TABLE,) = pathlib.Path("lib/filters/src").glob("*_table.h")


def near(got, wanted, tolerance, what):
    assert abs(got - wanted) <= tolerance, f"{what} is {got}, not {wanted}"


def gains(variant, p0_over_r, steps):
    return schedule.SCHEDULES[variant](p0_over_r, steps)


@test
def committed_table_is_what_the_tool_makes():
    assert TABLE.read_text(encoding="utf-8") == schedule.library_table(), f"{TABLE} is not what {TOOL} --emit library writes: write it anew"


@test
def exact_begins_as_in_the_notes():
    # notes 2.1: P0 = 5 and R = 1, 0.5; a1 = 0 throughout, P = R b0
    for ratio, wanted in ((5.0, (0.83333, 0.83333, 0.78313, 0.72532, 0.69948, 0.68625)), (10.0, (0.90909, 0.90909, 0.80824, 0.73759))):
        for step, b0 in zip(gains("exact", ratio, len(wanted)), wanted):
            near(step.b0, b0, 1e-5, f"b0 of P0/R {ratio}")
            near(step.a1, 0.0, 0.0, "a1")
            near(step.p, step.b0, 1e-12, "P/R")
    # notes 1.1: from three raw samples
    raw = [[float(i == j) for j in range(3)] for i in range(3)]
    for step, b0 in zip(schedule.exact_schedule(1.0, 5, raw), (0.833333, 0.75, 0.714286, 0.694545, 0.682971)):
        near(step.b0, b0, 1e-6, "b0 from raw samples")


@test
def u_begins_as_in_the_notes():
    wanted = ((-1 / 6, 32.5, 0.970149), (-0.032338, 9.680014, 0.906367), (-1 / 3, 8.18508, 0.891128), (0.0, 4.470878, 0.817214))
    for step, (a1, pe, b0) in zip(gains("u", 5.0, 4), wanted):
        near(step.a1, a1, 1e-5, "a1")
        near(step.pe, pe, 1e-5 * pe, "Pe")
        near(step.b0, b0, 1e-5, "b0")
    for step, b0 in zip(gains("u", 5.0 / 0.6, 4), (0.981873, 0.928617, 0.897004, 0.81873)):
        near(step.b0, b0, 1e-5, "b0 of R = 0.6")


@test
def limits_are_reached_from_anywhere():
    for exponent in range(-5, 6):
        for variant, (a1, b0) in schedule.LIMIT.items():
            last = gains(variant, 10.0 ** exponent, 400)[-1]
            near(last.a1, a1, 1e-9, f"a1 of {variant} from 1e{exponent}")
            near(last.b0, b0, 1e-9, f"b0 of {variant} from 1e{exponent}")
            near(last.p, b0, 1e-9, f"P/R of {variant} from 1e{exponent}")
    near(gains("u", 0.0, 400)[-1].b0, 11 / 13, 1e-9, "b0 from a start of 0, a fixed point without the floor")
    generator = random.Random(5)
    for _ in range(200):
        root = [[generator.gauss(0, 1) for _ in range(3)] for _ in range(3)]
        start = [[sum(root[i][k] * root[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
        last = schedule.exact_schedule(1.0, 200, start)[-1]
        near(last.b0, 2 / 3, 1e-9, f"b0 from {start}")
        near(last.a1, 0.0, 1e-9, f"a1 from {start}")


@test
def every_gain_is_within_the_clamps():
    for variant in schedule.SCHEDULES:
        for ratio_class in range(len(schedule.RATIOS)):
            for a1, b0 in schedule.library_gains(variant, ratio_class):
                assert 0 <= a1 <= 21845 and 32768 <= b0 <= 65535, (variant, ratio_class, a1, b0)
    for ratio in (1e-4, 0.1, 1.0, 100.0, 1e9):
        for variant in schedule.SCHEDULES:
            assert all(-1 / 3 <= s.a1 <= 0 and 0.5 <= s.b0 <= 1 for s in gains(variant, ratio, 60)), (variant, ratio)


@test
def classes_are_the_nearest_and_cost_little():
    # the same numbers as test_synth_opt_reference.c finds with its own reference
    assert [schedule.class_of(r) for r in (0.01, 1.9, 2.1, 7.9, 8.1, 31, 33, 127, 129, 511, 513, 1e9)] == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    worst = mean = 1.0
    ratio = 0.5
    while ratio < 1e5:
        listed = [(-a1 / 65536, b0 / 65536) for a1, b0 in schedule.library_gains("exact", schedule.class_of(ratio))]
        own = schedule.true_variances(ratio, (listed + [listed[-1]] * 3)[:16])
        best = [step.p for step in gains("exact", ratio, 16)]
        worst = max([worst] + [o / b for o, b in zip(own, best)])
        mean = max(mean, sum(own) / sum(best))
        ratio *= 1.05
    near(worst, 1.15, 0.005, "largest excess of one sample")
    near(mean, 1.023, 0.003, "largest excess of the start's mean")


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
