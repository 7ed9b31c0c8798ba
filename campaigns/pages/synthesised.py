"""docs/results/synthesised-filters.md and its pictures, from the closed forms of tools/design and from the shipped filters
(build/papers/libbatch.so, build/host/test_adaptive_roll). Fails with the name of each number that does not come out again."""
import math
import pathlib
import re
import sys
from fractions import Fraction

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
try:
    import numpy as np
    import pictures
    import synthesised_pictures
    from design.configuration import kalman_for, steady_kalman
    from design.response import pole_radius, step
    from design.structure import Filter, alpha_beta
    from design.synthesis import by_formula, error_by_formula
    from synthesis import batch, roll
except ImportError as missing:
    sys.exit(f"synthesised: {missing.name} is missing: run make synthesised, which installs it")
from results import FOLDER, Fault, Results, output_of, run_as_program, table

ABOUT = """
Properties of the papers' filter (2, 1, 0): x_e = 2 x1 - x2 - a1 (x1 - 2 x2 + x3), x = x_e + b0 u, from closed forms; and what `adaptive` makes of the
roll of paper 000 (15 s at 10 Hz, at rest, a turn from 6 to 10 s, at rest), from the shipped C code. [Synthesised filters](../filters-synthesised.md)
has the meaning of the terms.

In the picture of the gate, and in its table, the same roll has 5 or 15 % of its samples with 20 times the noise.
"""
PAGE = Results(FOLDER / "synthesised-filters.md", "Synthesised filters: results", "make synthesised", ABOUT)
LEAST = ("Dynamic error D in second differences of the signal. `synth`: b0 = 1 / (1 + D), noise gain (1 + 2 D) / (1 + 4 D). Alpha-beta: beta = 2 / "
         "(1 + 2 sqrt D + 2 D), alpha = 1 - beta D, noise gain (1 + 4 sqrt D) / (1 + 2 sqrt D)^2. Steady Kalman: beta = alpha^2 / (2 - alpha), "
         "alpha = 4 / (3 + sqrt(1 + 8 D)).")
ROLL_TEST = "build/host/test_adaptive_roll"

# name, a1, b0
PRESETS = (("paper 001", Fraction(-3, 10), Fraction(1, 10)), ("what 001's figures belong to", Fraction(0), Fraction(1, 10)),
           ("`synth`", Fraction(0), Fraction(3, 10)), ("", Fraction(-1, 10), Fraction(3, 10)), ("", Fraction(-3, 10), Fraction(1, 2)),
           ("limit of `synth_opt`", Fraction(0), Fraction(2, 3)), ("limit of variant U", Fraction(-1, 6), Fraction(11, 13)),
           ("best next sample, a1 free", Fraction(1, 2), Fraction(1, 2)))
LAGS = (0.1, 0.25, 0.5, 1.0, 3.0, 9.0, 25.0, 100.0, 1000.0)
PROFILES = ("ramp30", "cos60", "bump30", "sine30")
WINDOWS = {name.replace("_", "-"): window for name, window in roll.WINDOWS.items() if name != "0_5"}
GATE_CHOSEN, GATES_SHOWN = 3.0, (2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0)
SHARES = (0.0, 0.05, 0.15)

RATE_DHZ, LSB_PER_DEGREE = 100, 16  # paper 000's roll, as the sensor has it
SHIFT_SIGMA, SHIFT_RUNS, SEED = 20.0, 2000, 2024


# --- closed forms -----------------------------------------------------------------------------------------------------


def predicted(noise_gain, b0):
    """Variance of x_e per R: P = (1 - b0)^2 Pe + b0^2 R."""
    return (noise_gain - b0 * b0) / (1 - b0) ** 2


def closed_rows():
    """(name, a1, b0, noise gain, Pe / R, dynamic error, pole radius, overshoot, sample from which it is within 2 %) of each preset."""
    for name, a1, b0 in PRESETS:
        f = Filter(2, (a1,), (b0,))
        response, gain = step(f), f.noise_gain()
        yield name, a1, b0, gain, predicted(gain, b0), f.dynamic_error(), pole_radius(f), response.overshoot, response.settled_at


def floor_rows():
    """(dynamic error, noise gain of the best synth with a1 = 0, of alpha-beta, of the steady Kalman filter)."""
    for lag in LAGS:
        yield lag, by_formula(2, 0, lag).noise_gain(), by_formula(2, 1, lag).noise_gain(), kalman_for(2, lag, None).noise_gain()


def alpha_beta_at(noise_gain):
    return by_formula(2, 1, error_by_formula(2, 1, noise_gain))


def fading(k):
    """adaptive with its memory held: x = x_e + (2 k - k^2) u, v += k^2 u."""
    return alpha_beta(2 * k - k * k, k * k)


# --- the shipped filters ----------------------------------------------------------------------------------------------


def replayed(runs_lsb, name):
    """Estimates of a filter with its defaults and told R, in degrees, runs x samples, each run from a start of its own."""
    estimates = batch.shipped(name, RATE_DHZ, {}, roll.R_DEG2 * LSB_PER_DEGREE ** 2, False, runs_lsb)
    return estimates / 65536.0 / LSB_PER_DEGREE


def measured_lsb(degrees):
    """Of each run, to whole LSB."""
    return np.clip(np.rint(np.atleast_2d(degrees) * LSB_PER_DEGREE), -4096, 4095)


def outlier_run(share=0.05):
    """(truth, samples in LSB) of one roll of cos60 of which `share` of the samples have 20 times the noise."""
    chance, truth = np.random.default_rng(SEED), roll.PROFILES["cos60"].truth()
    sigma = math.sqrt(roll.R_DEG2) * np.where(chance.random(roll.SAMPLES) < share, 20.0, 1.0)
    return truth, measured_lsb(truth + sigma * chance.normal(size=roll.SAMPLES))


def shifted(share):
    """Mean square errors of adaptive in the three windows of each profile, `share` of the samples shifted by 20 sigma to either side."""
    chance, found = np.random.default_rng(SEED), []
    for profile in PROFILES:
        truth, size = roll.PROFILES[profile].truth(), (SHIFT_RUNS, roll.SAMPLES)
        off = SHIFT_SIGMA * np.where(chance.random(size) < share, chance.choice((-1.0, 1.0), size), 0.0)
        estimates = replayed(measured_lsb(truth + math.sqrt(roll.R_DEG2) * (chance.normal(size=size) + off)), "adaptive")
        square = np.mean((estimates - truth) ** 2, axis=0)
        found.append([np.mean(square[part]) for part in WINDOWS.values()])
    return found


UNGUARDED = re.compile(r"^unguarded +(\w+) +0 %: ([\d.]+) ([\d.]+) ([\d.]+) deg\^2$", re.M)
WINS = re.compile(r"^a1 (\S+) b0 (\S+) lambda (\S+) wins (\w+) (\S+) s: ([\d.]+), adaptive ([\d.]+)$", re.M)
MEANS = re.compile(r"^mean of 12 cells: adaptive ([\d.]+), best fixed tuning ([\d.]+) deg\^2$", re.M)


def told_by_the_test():
    """(rows of the unguarded filter with R known and its scatter identified, winners, the two means)."""
    text = output_of([ROLL_TEST])
    rows, means = UNGUARDED.findall(text), MEANS.search(text)
    if [row[0] for row in rows[:8]] != [*PROFILES, *PROFILES] or not means:
        raise Fault(f"{ROLL_TEST}: its lines are not as this tool reads them")
    return rows[:4], rows[4:8], WINS.findall(text), means.groups()


def curve():
    """{(gate in sigmas, profile, share): (mse in 2-5, 6-10, 11-15 s)}"""
    lines = [line.split(",") for line in output_of([ROLL_TEST, "curve"]).splitlines()[1:]]
    return {(float(gate), profile, float(share)): tuple(map(float, mse)) for gate, profile, share, *mse in lines}


# --- page -------------------------------------------------------------------------------------------------------------


def closed_tables():
    rows = []
    for name, a1, b0, gain, before, lag, radius, overshoot, settled in closed_rows():
        cells = [f"{float(gain):.6f}", f"{float(before):.6f}", f"{float(lag):.6f}", f"{radius:.5f}", f"{100 * overshoot:.1f}", str(settled)]
        rows.append([str(a1), str(b0), name, *cells])
    lines = table("Closed forms of the structure", "Noise gain and Pe in R, dynamic error in second differences of the signal (acceleration x T^2).",
                  ["a1", "b0", "", "noise gain", "Pe / R", "dynamic error", "pole radius", "overshoot, %", "step within 2 % from sample"], rows)
    rows = [[f"{lag:g}", *(f"{gain:.4f}" for gain in gains)] for lag, *gains in floor_rows()]
    return lines + table("Least noise gain for a dynamic error", LEAST,
                         ["dynamic error", "`synth`, a1 = 0", "alpha-beta", "steady Kalman (`kf`)"], rows)


def winning_cells(wins):
    """Rows of the cells that a fixed tuning wins, with the best of them."""
    rows = []
    for profile, window in ((p, w) for p in PROFILES for w in WINDOWS):
        won = sorted((float(win[5]), win) for win in wins if win[3:5] == (profile, window))
        if won:
            a1, b0, drive, _, _, error, ours = won[0][1]
            name = f"`synth` ({float(a1) + 0:.1f}, {b0})" if float(drive) == 0 else f"Kalman, lambda {drive}"
            rows.append([f"{profile}, {window} s", str(len(won)), name, error, ours])
    return rows


def adaptive_tables(grid):
    known, identified, wins, means = told_by_the_test()
    rows = [[name, *(" ".join(f"{float(x):.3f}" for x in row[1:]) for row in cells)] for name, cells in
            (("unguarded, R known", known), ("unguarded, scatter identified", identified))]
    for share in SHARES:
        cells = [grid[GATE_CHOSEN, profile, share] for profile in PROFILES]
        rows.append([f"guarded, {100 * share:g} % with 20 times the noise", *(" ".join(f"{x:.3f}" for x in cell) for cell in cells)])
    for share in SHARES[1:]:
        rows.append([f"guarded, {100 * share:g} % shifted by +-20 sigma", *(" ".join(f"{x:.3f}" for x in cell) for cell in shifted(share))])
    lines = table("`adaptive` on paper 000's roll", "Mean square error in 2-5, 6-10, 11-15 s, degree^2; 2,000 runs, 16 LSB per degree, R = 0.6 "
                  "degree^2, shipped C code.", ["", *PROFILES], rows)
    rows = [[f"{gate:g}", *(f"{grid[gate, 'sine30', share][1]:.3f}" for share in SHARES), f"{grid[gate, 'bump30', 0.05][1]:.3f}",
             f"{max(grid[gate, profile, 0.05][2] for profile in PROFILES[:3]):.3f}"] for gate in GATES_SHOWN]
    lines += table("What the width of the gate trades", "degree^2; the last column is the worst of ramp30, cos60, bump30.",
                   ["gate, sigma", "sine30 clean, 6-10 s", "5 % outliers", "15 %", "bump30, 5 %, 6-10 s", "5 %, 11-15 s"], rows)
    lines += table("Cells in which a fixed tuning has less error than `adaptive`", "Unguarded, mean square error in degree^2; of 83 fixed "
                   "tunings, 72 of `synth` and 11 of a Kalman filter.",
                   ["cell", "tunings that win", "the best of them", "its error", "`adaptive`"], winning_cells(wins))
    return lines + table("Mean of the twelve cells", "Unguarded, degree^2.", ["filter", "mean square error"],
                         [["`adaptive`", means[0]], ["the best fixed tuning", means[1]]])


def pictures_of(grid):
    truth, samples = outlier_run()
    estimates = np.array([replayed(samples, name)[0] for name in synthesised_pictures.FILTERS]).T
    steps = []
    for a1, b0 in ((-0.3, 0.1), (0.0, 0.3), (0.0, 2 / 3)):
        f = Filter(2, (a1,), (b0,))
        steps.append((a1, b0, f.noise_gain(), f, alpha_beta_at(f.noise_gain())))
    lags = np.logspace(math.log10(0.05), 3, 200)
    curves = {"synth": [by_formula(2, 0, lag).noise_gain() for lag in lags], "alpha-beta": [by_formula(2, 1, lag).noise_gain() for lag in lags]}
    kalman = [(f.dynamic_error(), f.noise_gain()) for f in (steady_kalman(2, drive) for drive in np.logspace(-6.3, 2.2, 200))]
    held = [(f.dynamic_error(), f.noise_gain()) for f in map(fading, np.linspace(0.1, 0.6, 60))]
    marks = [(float(row[5]), float(row[3]), f"({float(row[1]):.2g}, {float(row[2]):.2g})") for row in closed_rows() if row[1] <= 0]
    return synthesised_pictures.contents(steps, (lags, curves, kalman, held, marks), (truth, samples[0] / LSB_PER_DEGREE, estimates),
                                         (grid, GATE_CHOSEN))


def main():
    grid = curve()
    shown = pictures_of(grid)
    return PAGE.publish(pictures.on_page(shown) + closed_tables() + adaptive_tables(grid), shown)


if __name__ == "__main__":
    run_as_program("synthesised", main)
