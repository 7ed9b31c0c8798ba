"""make synthesised: its closed forms are what the structure does; its floor is one."""
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import synthesised
except ImportError as missing:
    sys.exit(f"test_synthesised: {missing.name} is missing: run it by `make test`")

from system_support import run_all, test

PEOPLE = pathlib.Path("docs/filters-synthesised.md")
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


@test
def closed_forms_are_what_the_difference_equation_does():
    for _, a1, b0, gain, before, lag, *_ in synthesised.closed_rows():
        for closed, measured in zip((gain, before, lag), responses(float(a1), float(b0))):
            assert abs(float(closed) - measured) < 2e-6, (a1, b0, closed, measured)


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
    assert "NG - 1/2 = (b0 (1 - 2 q) + 4 q + 4 q^2) / (2 (1 - 2 q)(4 - 3 b0 + 4 q))" in PEOPLE.read_text(encoding="utf-8")


if __name__ == "__main__":
    raise SystemExit(run_all())
