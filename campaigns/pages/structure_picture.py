"""The picture of docs/results/variable-structure.md: prediction and measurements of one flight, and the sensor of each 20 s window."""
from dataclasses import dataclass

import numpy as np
from pictures import GRID_COLOUR, TRUTH_COLOUR, Picture
from results import PICTURES
from variable_structure.rules import RULES
from variable_structure.scenario import BIASED, DEGRADED, FROZEN, SENSORS, SOUND, WINDOW_S, fly
from variable_structure.structure import fly_by

SEED, RUN, FROM_WINDOW, WINDOWS = 2024, 28, 2, 12
SENSOR_COLOURS = ("#0b5394", "#e08e0b", "#1b7f3b")
PREDICTED_COLOUR, ESTIMATE_COLOUR = "#c0187a", "#6d7680"
TROUBLES = {SOUND: ("#ffffff", ""), DEGRADED: ("#fbe3c0", "noise"), FROZEN: ("#d9dde2", "stuck at 0"), BIASED: ("#f6d0d5", "bias")}
LIMIT_M_S = 7.0


@dataclass
class Shown:
    """Of one flight, the windows that are drawn: samples in m/s, chosen sensors by rule."""

    measured: np.ndarray
    true: np.ndarray
    predicted: np.ndarray
    estimate: np.ndarray
    trouble: np.ndarray
    chosen: dict


def shown():
    flights, seen = fly(RUN + 1, SEED), []

    def watched(evidence):
        seen.append(evidence.predicted[RUN])
        return RULES["gate_then_degree"](evidence)

    flown = fly_by(watched, flights)
    windows = slice(FROM_WINDOW, FROM_WINDOW + WINDOWS)
    samples = slice(FROM_WINDOW * WINDOW_S, (FROM_WINDOW + WINDOWS) * WINDOW_S)
    chosen = {"acceptor, then degree": flown.chosen[RUN, windows],
              "degree of observability alone": fly_by(RULES["degree_only"], flights).chosen[RUN, windows]}
    return Shown(flights.measured[RUN, samples], flights.true[RUN, samples, 0], np.concatenate(seen)[samples], flown.estimates[RUN, samples, 0],
                 flights.trouble[RUN, windows], chosen)


# --- drawing ----------------------------------------------------------------------------------------------------------


def draw_flight(axes, what):
    times = FROM_WINDOW * WINDOW_S + np.arange(len(what.true))
    for number, (name, colour) in enumerate(zip(SENSORS, SENSOR_COLOURS)):
        within = np.clip(what.measured[:, number], -LIMIT_M_S, LIMIT_M_S)
        axes.plot(times, within, ".", ms=3, color=colour, alpha=0.55, label=f"sensor {number + 1} ({name})")
    axes.plot(times, what.estimate, "-", lw=2.2, color=ESTIMATE_COLOUR, label="estimate (acceptor, then degree)")
    for window in range(WINDOWS):
        span = slice(window * WINDOW_S, (window + 1) * WINDOW_S)
        axes.plot(times[span], what.predicted[span], "-", lw=1.6, color=PREDICTED_COLOUR, label="predicted by the trend" if window == 0 else None)
        axes.axvline(times[span.start], color=GRID_COLOUR, lw=0.8, zorder=0)
    axes.plot(times, what.true, "-", lw=0.8, color=TRUTH_COLOUR, label="truth")
    axes.set_ylim(-LIMIT_M_S - 0.3, LIMIT_M_S + 3.0)  # room for the legend
    axes.set_ylabel(f"error of velocity in m/s\n(beyond {LIMIT_M_S:g}: at the edge)", fontsize=9)
    axes.legend(fontsize=8, frameon=False, ncol=3, loc="upper left")


def draw_choices(axes, what):
    marks = dict(zip(what.chosen, (("o", "none", TRUTH_COLOUR, 11), ("x", "#d1495b", "#d1495b", 8))))
    for window in range(WINDOWS):
        left = (FROM_WINDOW + window) * WINDOW_S
        for sensor in range(len(SENSORS)):
            colour, word = TROUBLES[int(what.trouble[window, sensor])]
            axes.fill_between([left, left + WINDOW_S], sensor - 0.5, sensor + 0.5, color=colour, lw=0)
            axes.annotate(word, (left + 1, sensor + 0.42), fontsize=6.5, color="#555555")
        for name, chosen in what.chosen.items():
            shape, face, edge, size = marks[name]
            label = name if window == 0 else None
            axes.plot(left + WINDOW_S / 2, np.argmax(chosen[window]), shape, ms=size, mfc=face, mec=edge, mew=1.8, label=label)
        axes.axvline(left, color="#c4cad1", lw=0.8)
    axes.set_ylim(len(SENSORS) - 0.5, -0.5)
    axes.set_yticks(range(len(SENSORS)), [f"sensor {number + 1}" for number in range(len(SENSORS))])
    axes.set_xlabel("time in seconds", fontsize=9)
    axes.legend(fontsize=8, frameon=False, ncol=2, loc="upper left", bbox_to_anchor=(0.0, -0.22))


def draw(figure, what):
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    draw_flight(top, what)
    draw_choices(bottom, what)
    top.set_xlim(FROM_WINDOW * WINDOW_S, (FROM_WINDOW + WINDOWS) * WINDOW_S)
    for axes in (top, bottom):
        axes.tick_params(labelsize=8)


def picture():
    return Picture(PICTURES / "variable-structure.png", "What is predicted, what is measured, and the sensor of each window of 20 s",
                   (10.0, 6.4), draw, shown(), __file__)
