"""Figures 1 to 3 of paper 000: the roll, what the synthesised filter and the Kalman filter make of it. The paper's roll, noise and gains are not
printed: these are the nearest to its Table 1 that the search of campaigns/synthesis/table1.py finds with a smooth roll."""
import types

import numpy as np
from figures_style import GREEN, ORANGE, PINK, Drawn, legend, panel, printed_words, readings, truth
from synthesis import batch, table1
from synthesis.estimators import scheduled, steady_gains, steady_kalman, synthesised, white_rate
from synthesis.paper_000 import gains_of
from synthesis.roll import PERIOD_S, PROFILES, SAMPLES, WINDOWS

SEED, WORLD = 2024, "table1_smooth"
INTERVALS = dict(zip(("0-5 s", "6-10 s", "11-15 s"), table1.COLUMNS))
LIMIT_DEG = 9.0  # of the panels of errors: the start is beyond


def world():
    """(turn, {name: value}) of the search's row."""
    rows = [row for row in table1.table1_search(types.SimpleNamespace()) if row[0] == WORLD]
    model, turn = rows[0][1].split("/")
    if model != "kf2_rate_steady":
        raise batch.Refused(f"{WORLD}: the nearest Kalman filter is {model}, this figure draws kf2_rate_steady")
    return turn, {metric: value for _, _, _, metric, value, _ in rows}


def kalman_like(alpha):
    """Of the search's filters that with this gain."""
    spaces = [white_rate(10.0 ** (0.1 * i)) for i in range(-40, 41)]
    return min(spaces, key=lambda space: abs(steady_gains(space)[0] - alpha))


def estimators_of(found):
    start = found["start_error"]
    gains = gains_of(0, False, found["r"])
    return {"constant": synthesised(found["a1"], found["b0"], start), "printed": scheduled(gains),
            "kalman": steady_kalman(kalman_like(found["kalman_alpha"]), start)}


def flown(runs):
    turn, found = world()
    profile = PROFILES[turn]
    true = profile.truth() * (found["amplitude"] / profile.amplitude_deg)
    normal, _ = batch.draws([batch.run_seed(SEED, run) for run in range(runs)], SAMPLES, uniform=False)
    measured = true + np.sqrt(found["r"]) * normal
    estimates = {name: of(measured) for name, of in estimators_of(found).items()}
    squares = {name: [float(np.mean(np.square(x - true)[:, WINDOWS[window]])) for window in INTERVALS.values()] for name, x in estimates.items()}
    return {"true": true, "measured": measured[0], "squares": squares, "found": {name: float(value) for name, value in found.items()},
            **{name: x[0] for name, x in estimates.items()}}


def interval_words(axes, printed, ours):
    for at, number, value in zip((0.2, 6.0, 11.0), printed, ours):
        printed_words(axes, at, 0.98, f"printed {number:.3f}\nours {value:.3f}")


def draw_pair(pair, what, title, lines, printed):
    times = PERIOD_S * np.arange(SAMPLES)
    roll, error = pair
    readings(roll, times, what["measured"])
    for name, label, colour, width in lines:
        roll.plot(times, what[name], "-", lw=width, color=colour, label=label, zorder=3)
        error.plot(times, what[name] - what["true"], "-", lw=width, color=colour, label=label, zorder=3)
    truth(roll, times, what["true"])
    if not lines:
        readings(error, times, what["measured"] - what["true"])
    if printed is not None:
        interval_words(error, printed, what["squares"][lines[-1][0]])
    panel(roll, title, "time in seconds", "roll in degrees")
    panel(error, "" if printed is None else "mean square errors in degree$^2$", "time in seconds", "error of roll in degrees")
    error.set_ylim(-LIMIT_DEG, LIMIT_DEG)
    error.axhline(0.0, lw=0.7, color="#555555")
    for axes in pair:
        axes.set_xlim(0.0, 15.0)
    low, high = float(np.min(what["true"])), float(np.max(what["true"]))
    roll.set_ylim(low - 12.0, high + 0.6 * (high - low))
    legend(roll, ncol=2)


def draw(figure, what):
    rows, found = figure.subplots(3, 2, sharex=True), what["found"]
    draw_pair(rows[0], what, "Fig. 1: the roll as measured", [], None)
    draw_pair(rows[1], what, "Fig. 2: the synthesised filter",
              [("printed", "gains by (22) as printed", PINK, 1.0),
               ("constant", f"a1 = {abs(found['a1']):g}, b0 = {found['b0']:g}", GREEN, 1.6)],
              table1.SYNTH_ROW)
    draw_pair(rows[2], what, "Fig. 3: the Kalman filter, N = 1", [("kalman", f"gain {found['kalman_alpha']:.2f}", ORANGE, 1.6)],
              table1.KALMAN_ROW)


def figures(runs):
    what = flown(runs)
    names = (("Fig. 2", "constant", table1.SYNTH_ROW), ("Fig. 3", "kalman", table1.KALMAN_ROW))
    beside = [(f"{figure}, {interval}, degree^2", f"{number:g}", f"{value:.3f}") for figure, name, row in names
              for interval, number, value in zip(INTERVALS, row, what["squares"][name])]
    beside += [(f"Fig. 2, {interval}, gains by (22) as printed, degree^2", "", f"{value:.3g}")
               for interval, value in zip(INTERVALS, what["squares"]["printed"])]
    words = ("The roll of a UAV, and two filters on it. Roll, noise and gains are lost with the figures' data: these are the ones that\n"
             "the search for Table 1 finds nearest, so the synthesised row is met by choice and the Kalman row is what comes of it.")
    return [Drawn("000-1-3", "Paper 000, Figs 1 to 3", 3, draw, what, __file__, words, beside)]
