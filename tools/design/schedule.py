"""Off-line gain schedules of the synthesised filter (paper 000, equation 22 made to work), for the filter synth_opt.

  x_e = 2 x1 - x2 - a1 (x1 - 2 x2 + x3),  x = x_e + b0 (z - x_e),  errors of the three estimates at the start equal, variance P0

Only P0 / R matters, and only for the start: the steady gains do not depend on R.
  exact  a1 minimises Pe = h S h', S the covariance of the last three errors (rank one at the start), h = (2 - a1, -(1 - 2 a1), -a1)
  u      closest working relative of the paper's (20), (21): a1 by (21) from P(n-1)..P(n-5); Pe as if the errors were uncorrelated
Both: a1 clamped to [-1/3, 0], b0 = Pe / (Pe + R) to [1/2, 1): switching between any of these gains is stable. After `steps` of them
the filter goes on with the limit (0, 2/3), or (-1/6, 11/13) for u.
"""
import argparse
import math
import pathlib
import sys
from collections import namedtuple

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from tilt.options import Parser  # noqa: E402

Step = namedtuple("Step", "a1 pe b0 p")  # pe, p in units of R

A1_MIN, A1_MAX = -1.0 / 3.0, 0.0
B0_MIN = 0.5
P_FLOOR = 2.0 ** -16  # all zero is a fixed point of u
LIMIT = {"exact": (0.0, 2.0 / 3.0), "u": (-1.0 / 6.0, 11.0 / 13.0)}
STRAIGHT, BEND = (2.0, -1.0, 0.0), (-1.0, 2.0, -1.0)  # h = STRAIGHT + a1 BEND

# of the library's table: classes of P0/R, the steps that each has for itself, and those that all share, made for COMMON
RATIOS = (1, 4, 16, 64, 256, 1024)
OWN_STEPS, COMMON_STEPS, COMMON = 4, 8, 16


def clamped(value, low, high):
    """Limits a quotient; a non-finite one (denominator 0) gives the straight line, a1 = 0."""
    return min(max(value, low), high) if math.isfinite(value) else 0.0


def quotient(above, below, size):
    """NaN if the denominator is only rounding: below 1e-12 of its terms."""
    return above / below if abs(below) > 1e-12 * size else math.nan


def bilinear(left, matrix, right):
    return sum(left[i] * matrix[i][j] * right[j] for i in range(3) for j in range(3))


def gain_of(pe):
    return clamped(pe / (pe + 1.0), B0_MIN, 1.0)


def exact_schedule(p0_over_r, steps):
    """Steps of the greedy optimum with the exact covariance."""
    s = [[max(p0_over_r, P_FLOOR)] * 3 for _ in range(3)]  # three identical errors
    result = []
    for _ in range(steps):
        a1 = clamped(quotient(-bilinear(BEND, s, STRAIGHT), bilinear(BEND, s, BEND), max(s[i][i] for i in range(3))), A1_MIN, A1_MAX)
        step, s = advance(s, a1)
        result.append(step)
    return result


def advance(s, a1):
    """One step of the covariance with a1 and the optimal b0: (Step, new covariance)."""
    h = [STRAIGHT[i] + a1 * BEND[i] for i in range(3)]
    pe = bilinear(h, s, h)
    b0 = gain_of(pe)
    p = (1.0 - b0) ** 2 * pe + b0 ** 2
    first = [(1.0 - b0) * sum(h[k] * s[k][j] for k in range(3)) for j in range(2)]
    return Step(a1, pe, b0, p), [[p, first[0], first[1]], [first[0], s[0][0], s[0][1]], [first[1], s[1][0], s[1][1]]]


def u_schedule(p0_over_r, steps):
    p = [max(p0_over_r, P_FLOOR)] * 5
    result = []
    for _ in range(steps):
        below = 8.0 * p[1] + 4.0 * p[2] - 8.0 * p[3] + 2.0 * p[4]
        a1 = clamped(quotient(-(p[0] + 6.0 * p[1] - 8.0 * p[2] + 2.0 * p[3]), below, max(p)), A1_MIN, A1_MAX)
        pe = (2.0 - a1) ** 2 * p[0] + (1.0 - 2.0 * a1) ** 2 * p[1] + a1 ** 2 * p[2]
        b0 = gain_of(pe)
        result.append(Step(a1, pe, b0, (1.0 - b0) ** 2 * pe + b0 ** 2))
        p = [result[-1].p] + p[:4]
    return result


SCHEDULES = {"exact": exact_schedule, "u": u_schedule}


# --- fixed point ---

def quantised(gains):
    """(magnitude of a1, b0) in 1 / 65536, within the clamps."""
    return min(round(-gains[0] * 65536.0), 21845), min(max(round(gains[1] * 65536.0), 32768), 65535)


def library_gains(variant, ratio_class):
    """The gains of the library's filter for that class: [(a1, b0) quantised...], the limit last."""
    own = SCHEDULES[variant](RATIOS[ratio_class], OWN_STEPS)
    common = SCHEDULES[variant](COMMON, OWN_STEPS + COMMON_STEPS)[OWN_STEPS:]
    return [quantised((step.a1, step.b0)) for step in own + common] + [quantised(LIMIT[variant])]


def c_rows(name, values):
    lines = [", ".join(str(v) for v in values[i:i + 12]) for i in range(0, len(values), 12)]
    return f"static const uint16_t {name}[{len(values)}] IN_FLASH = {{\n" + "".join(f"    {line},\n" for line in lines) + "};\n"


def library_table():
    """Text of lib/filters/src/synth_opt_table.h."""
    ratios = ", ".join(map(str, RATIOS))
    text = [f"""/*
 * Gains of synth_opt, UQ0.16, made by tools/design/schedule.py --emit library; do not edit. For each class of P0/R
 * ({ratios}) its first {OWN_STEPS} steps; then the {COMMON_STEPS} further ones of all classes (those of {COMMON}), and the limit.
 * a1 of variant U; exact has 0.
 */
#ifndef SYNTH_OPT_TABLE_H
#define SYNTH_OPT_TABLE_H

#include "fx.h"

enum {{ SYNTH_OPT_CLASSES = {len(RATIOS)}, SYNTH_OPT_OWN_STEPS = {OWN_STEPS}, SYNTH_OPT_STEPS = {OWN_STEPS + COMMON_STEPS} }};

/* Index of step n >= SYNTH_OPT_OWN_STEPS: n + SYNTH_OPT_COMMON. */
enum {{ SYNTH_OPT_COMMON = {(len(RATIOS) - 1) * OWN_STEPS} }};

/* clang-format off */"""]
    for variant in ("exact", "u"):
        gains = [library_gains(variant, i) for i in range(len(RATIOS))]
        listed = [g for of_class in gains for g in of_class[:OWN_STEPS]] + gains[0][OWN_STEPS:]
        if variant == "exact" and any(a1 for a1, _ in listed):
            raise ValueError("the exact schedule has an a1 other than 0: the table must hold it")
        if variant == "u":
            text.append(c_rows("u_a1_uq16", [a1 for a1, _ in listed]))
        text.append(c_rows(f"{variant}_b0_uq16", [b0 for _, b0 in listed]))
    return "\n".join(text) + "\n#endif\n"


def single_table(variant, p0_over_r, steps):
    """C tables of one schedule and its limit."""
    gains = [quantised((s.a1, s.b0)) for s in SCHEDULES[variant](p0_over_r, steps)] + [quantised(LIMIT[variant])]
    return (f"/* {variant}, P0/R = {p0_over_r:g}: |a1| and b0 in 1/65536, the limit last. */\n" +
            c_rows(f"{variant}_a1_uq16", [a1 for a1, _ in gains]) + c_rows(f"{variant}_b0_uq16", [b0 for _, b0 in gains]))


def readable(variant, p0_over_r, steps):
    lines = [f"{variant}, P0/R = {p0_over_r:g}", " n         a1       Pe/R         b0        P/R"]
    lines += [f"{n:2d} {s.a1:10.6f} {s.pe:10.6f} {s.b0:10.6f} {s.p:10.6f}" for n, s in enumerate(SCHEDULES[variant](p0_over_r, steps), 1)]
    return "\n".join(lines + [f"limit {LIMIT[variant][0]:.6f}, b0 {LIMIT[variant][1]:.6f}"]) + "\n"


def positive(text):
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None
    if not math.isfinite(value) or value < P_FLOOR:
        raise argparse.ArgumentTypeError(f"P0/R is {text}, but must be finite and at least {P_FLOOR:g} (with 0, variant u would stay at 0 for ever)")
    return value


def count(text):
    if not text.isdecimal() or not 1 <= int(text) <= 1000:
        raise argparse.ArgumentTypeError(f"the number of steps is '{text}', but must be 1..1000")
    return int(text)


def main(arguments=None):
    parser = Parser(prog="design schedule", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--p0-over-r", type=positive,
                        help="variance of the initial error over that of the measurement, e.g. 8.33 (paper 000: 5 over 0.6)")
    parser.add_argument("--variant", choices=sorted(SCHEDULES), default="exact")
    parser.add_argument("--steps", type=count, default=OWN_STEPS + COMMON_STEPS, help="default %(default)s")
    parser.add_argument("--emit", choices=("text", "c", "library"), default="text",
                        help="text: a table to read; c: C tables of this schedule; library: lib/filters/src/synth_opt_table.h (needs no P0/R)")
    options = parser.parse_args(arguments)
    if options.emit == "library":
        sys.stdout.write(library_table())
        return 0
    if options.p0_over_r is None:
        parser.error("--p0-over-r is missing: the schedule depends on it, such as --p0-over-r 8.33")
    write = single_table if options.emit == "c" else readable
    sys.stdout.write(write(options.variant, options.p0_over_r, options.steps))
    return 0


if __name__ == "__main__":
    sys.exit(main())
