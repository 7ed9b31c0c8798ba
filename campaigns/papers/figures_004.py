"""Figures 5 and 6 of paper 004: the degree of observability of the velocity's error by three sensors, window by window, and the error of the system
that changes its structure beside those of each sensor alone. The paper's flight is lost: this one is of campaigns/variable_structure."""
import numpy as np
from figures_style import AXES, Drawn, legend, panel, printed_words
from pictures import GRID_COLOUR, TRUTH_COLOUR
from variable_structure.rules import RULES
from variable_structure.scenario import SENSORS, WINDOW_S, fly
from variable_structure.structure import fly_by

SEED, FREEZING = 2024, "last"  # a frozen sensor repeats its last value: at zero its degree would be infinite
RULE, RUN = "gate_then_degree", 7
LEAST_M_S = 0.01
ORDER = "TRNS from 640 to 660 s, then CVNS, then GNSS"


def flown(runs):
    flights, degrees = fly(max(runs, RUN + 1), SEED, FREEZING), []

    def watched(evidence):
        degrees.append(evidence.degree)
        return RULES[RULE](evidence)

    ours = fly_by(watched, flights)
    alone = [fly_by(RULES[f"fixed_{number + 1}"], flights) for number in range(len(SENSORS))]

    def error(which):
        return np.abs(which.estimates[RUN, :, 0] - flights.true[RUN, :, 0])

    rms = [float(np.sqrt(np.mean(np.square((which.estimates - flights.true)[:, 40:, 0])))) for which in (ours, *alone)]
    best = np.argmin(flights.sensor_error(), axis=2)
    chosen = np.argmax(ours.chosen, axis=2)
    return {"degree": np.array(degrees)[:, RUN], "best": best[RUN], "chosen": chosen[RUN], "error": error(ours),
            "alone": [error(which) for which in alone], "rms": rms, "hit": float(np.mean(chosen == best))}


def draw(figure, what):
    top, bottom = figure.subplots(2, 1, sharex=True)
    begins = WINDOW_S * np.arange(len(what["degree"]))
    whole = np.sum(what["degree"], axis=1, keepdims=True)
    share = 100.0 * what["degree"] / np.maximum(whole, 1e-300)  # the first window has no estimate to begin from
    below = np.zeros(len(share))
    for number, (name, colour) in enumerate(zip(SENSORS, AXES)):
        top.bar(begins, share[:, number], WINDOW_S, below, align="edge", color=colour, alpha=0.75, ec="white", lw=0.6, label=name)
        below += share[:, number]
    for begin, best in zip(begins, what["best"]):
        top.annotate(SENSORS[best], (begin + WINDOW_S / 2, 102), fontsize=6, ha="center", color=AXES[best])
    panel(top, "Fig. 5: degree of observability of the velocity's error; above: the best sensor in truth", "time in seconds", "share of the sum in %")
    top.set_ylim(0.0, 135.0)
    legend(top, ncol=4)
    times = np.arange(len(what["error"]))
    for name, colour, values in zip(SENSORS, AXES, what["alone"]):
        bottom.semilogy(times, np.maximum(values, LEAST_M_S), "-", lw=0.9, color=colour, label=f"{name} alone")
    bottom.semilogy(times, np.maximum(what["error"], LEAST_M_S), "-", lw=2.0, color=TRUTH_COLOUR, label="variable structure")
    for begin, chosen in zip(begins, what["chosen"]):
        bottom.axvline(begin, lw=0.6, color=GRID_COLOUR, zorder=0)
        bottom.annotate(SENSORS[chosen], (begin + WINDOW_S / 2, LEAST_M_S / 2.0), fontsize=6, ha="center", color=AXES[chosen])
    panel(bottom, "Fig. 6: error with each sensor alone and with the sensor that is chosen (named below)", "time in seconds",
          "error of velocity in m/s")
    bottom.set_ylim(LEAST_M_S / 2.5, 300.0)
    bottom.set_xlim(0, begins[-1] + WINDOW_S)
    legend(bottom, ncol=4)
    printed_words(bottom, 4, 0.82, f"printed: windows of {WINDOW_S} s, {ORDER}; its flight is not this one", va="top")


def figures(runs):
    what = flown(max(8, runs // 5))
    beside = [("Fig. 6, rms error of velocity from 40 s on, m/s: variable structure, GNSS, TRNS, CVNS alone", "best of all",
               " / ".join(f"{value:.2f}" for value in what["rms"])),
              ("Fig. 6, windows in which the best sensor is chosen", ORDER, f"{100 * what['hit']:.0f} %")]
    return [Drawn("004-5-6", "Paper 004, Figs 5 and 6", 2.6, draw, what, __file__,
                  "Three sensors whose troubles are drawn for each window of 20 s; the acceptor's gate, then the degree of observability,\n"
                  "chooses with the window's own data, as the paper's Fig. 6 appears to.", beside)]
