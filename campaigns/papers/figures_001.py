"""Figures 2 to 4 of paper 001: errors of altitude of the synthesised filter and of the Kalman filters of first and second order, by both readings of
"a polynomial of second order"."""
import numpy as np
from figures_style import BLUE, GREEN, ORANGE, Drawn, legend, panel, printed_level, printed_words
from pictures import RAW_COLOUR
from synthesis import batch, paper_001
from synthesis.estimators import steady_kalman, synthesised, white_acceleration, white_jerk
from synthesis.paper_001 import DOWN, FACTORS, PERIOD_S, SAMPLES, SIGMA_M, STRAIGHT, UP

SEED = 2024
TITLES = {"altitude_half_a_t2": "x = a t$^2$ / 2", "altitude_a_t2": "x = a t$^2$"}
# figure, filter, colour, printed sigma on the straight legs and lag of the others
ROWS = (("Fig. 2", "synthesised, a1 = -0.3, b0 = 0.1", GREEN, 0.37, 0.9),
        ("Fig. 3", "Kalman filter of first order", ORANGE, 0.3, 1.4),
        ("Fig. 4", "Kalman filter of second order", BLUE, 0.45, 0.0))


def estimators_of(reading):
    by_lag, _, second = paper_001.drives_of(reading)
    return [synthesised(-0.3, 0.1, 0.0), steady_kalman(white_acceleration(by_lag), 0.0), steady_kalman(white_jerk(second), 0.0)]


def errors_of(reading, runs):
    """Of each filter: (error of one run, mean over the runs, sigma on straight legs, mean error of 20 to 35 s)."""
    true = paper_001.truth(reading)
    normal, _ = batch.draws([batch.run_seed(SEED, run) for run in range(runs)], SAMPLES, uniform=False)
    found = []
    for of in estimators_of(reading):
        errors = true - of(true + SIGMA_M * normal)
        sigma = float(np.sqrt(np.mean(paper_001.straight(np.square(errors)))))
        found.append((errors[0], np.mean(errors, axis=0), sigma, float(np.mean(errors[:, UP:DOWN]))))
    return found


def draw_one(axes, title, row, found):
    figure, name, colour, sigma, lag = row
    times, (one, mean, ours, lagging) = PERIOD_S * np.arange(SAMPLES), found
    axes.plot(times, one, "-", lw=0.7, color=RAW_COLOUR, label="one run", zorder=1)
    axes.plot(times, mean, "-", lw=1.6, color=colour, label="mean of the runs", zorder=3)
    for begin, end in ((0, UP), (STRAIGHT, SAMPLES - 1)):
        printed_level(axes, [PERIOD_S * begin, PERIOD_S * end], (sigma, -sigma))
    printed_level(axes, [PERIOD_S * UP, PERIOD_S * DOWN], (lag,))
    printed_level(axes, [PERIOD_S * DOWN, PERIOD_S * STRAIGHT], (-lag,))
    words = f"sigma: printed {sigma:g}, ours {ours:.2f}\nlag: printed {lag:g}, ours {round(lagging, 2) + 0.0:.2f}"
    printed_words(axes, 69.5, 0.98, words, ha="right")
    panel(axes, f"{figure}: {name}, {title}", "time in seconds", "error of altitude in m")
    axes.set_xlim(0.0, 70.0)
    axes.set_ylim(-2.4, 2.9)


def draw(figure, what):
    grid = figure.subplots(3, 2, sharex=True, sharey=True)
    for column, reading in enumerate(FACTORS):
        for axes, row, found in zip(grid[:, column], ROWS, what[reading]):
            draw_one(axes, TITLES[reading], row, found)
    legend(grid[0, 0], loc="lower left")


def figures(runs):
    what = {reading: errors_of(reading, runs) for reading in FACTORS}
    beside = []
    for reading, short in zip(FACTORS, ("a t^2 / 2", "a t^2")):
        for (figure, _, _, sigma, lag), (_, _, ours, lagging) in zip(ROWS, what[reading]):
            beside += [(f"{figure}, x = {short}, sigma, m", f"{sigma:g}", f"{ours:.3f}"),
                       (f"{figure}, x = {short}, lag, m", f"{lag:g}", f"{lagging:.3f}")]
    words = ("The error of an altitude that is straight to 20 s, accelerated to 35 s, braked to 50 s and straight again. Both Kalman\n"
             "filters are solved for printed numbers: the first for its lag, the second for its sigma. Dashed: printed.")
    return [Drawn("001-2-4", "Paper 001, Figs 2 to 4", 3, draw, what, __file__, words, beside)]
