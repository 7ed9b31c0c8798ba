"""The pictures of docs/results/comparison.md."""
import numpy as np
from comparison_filters import words
from comparison_runs import MOVES, RATE_HZ, TILTS, answers, roll_of, tilt_runs
from laws import DEFAULT, PLAIN
from pictures import RAW_COLOUR, TRUTH_COLOUR, Picture, plain
from results import PICTURES

SHOWN = {DEFAULT: ("#0b5394", 2.6), PLAIN: ("#e08e0b", 1.4), "median5_ema": ("#1b7f3b", 1.4), "one_euro": ("#c0187a", 1.2),
         "student_t": ("#7a4fb5", 1.4), "imm3": ("#8a5a2b", 1.2)}
FROM_S, TO_S, RUN = 12.0, 16.0, 1
LIMITS = (-12.0, 30.0)


def contents(lost):
    """lost: {class: (filter that is best of all compared, LSB, the default's LSB)}"""
    wrong = {tilt: shown_tilt(tilt) for tilt in TILTS[2:]}
    moves = {move: (*MOVES[move], {name: x[RUN] for name, x in answers(move, SHOWN, RUN + 1).items()}) for move in MOVES}
    wanted = (("outliers", "15 % outliers of 20 times the noise, each by itself and in runs", 6.4, draw_outliers, wrong),
              ("moves", "A step, a ramp and a sine at 100 Hz", 3.6, draw_moves, moves),
              ("classes", "Error of the default by that of the best other filter, class by class", 3.2, draw_classes, lost))
    return [Picture(PICTURES / f"comparison-{name}.png", title, (10.0, inches), draw, data, __file__, 0.97)
            for name, title, inches, draw, data in wanted]


def shown_tilt(tilt):
    roll, y, z = tilt_runs(tilt, RUN + 1)
    rows = slice(round(FROM_S * RATE_HZ), round(TO_S * RATE_HZ))
    return roll[rows], roll_of("raw", RATE_HZ, y, z)[RUN, rows], {name: roll_of(name, RATE_HZ, y, z)[RUN, rows] for name in SHOWN}


# --- drawing ----------------------------------------------------------------------------------------------------------


def draw_outliers(figure, wrong):
    for axes, (tilt, (roll, raw, estimates)) in zip(figure.subplots(2, 1, sharex=True), wrong.items()):
        times = FROM_S + np.arange(len(roll)) / RATE_HZ
        axes.plot(times, raw, ".", ms=3, color=RAW_COLOUR, label="measured")
        for name, estimate in estimates.items():
            colour, width = SHOWN[name]
            axes.plot(times, estimate, "-", lw=width, color=colour, label=words(name).strip("`"), zorder=4 if name == DEFAULT else 3)
        axes.plot(times, roll, "-", lw=0.9, color=TRUTH_COLOUR, label="truth", zorder=5)
        plain(axes, "time in seconds", "roll in degrees")
        beyond = int(np.sum((raw < LIMITS[0]) | (raw > LIMITS[1])))
        axes.set_title(tilt, fontsize=9, loc="left", pad=3)
        axes.set_title(f"{beyond} measurements beyond the panel", fontsize=8, loc="right", pad=3, color="#555555")
        axes.set_xlim(FROM_S, TO_S)
        axes.set_ylim(*LIMITS)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper right", bbox_to_anchor=(1.0, 0.965), ncol=4, fontsize=8, frameon=False)


def draw_moves(figure, moves):
    spans = {"step": (-0.1, 0.7), "ramp": (-0.1, 1.6), "sine": (1.0, 2.2)}
    for axes, (move, (times, roll, estimates)) in zip(figure.subplots(1, 3), moves.items()):
        for name, estimate in estimates.items():
            colour, width = SHOWN[name]
            axes.plot(times, estimate, "-", lw=width, color=colour, label=words(name).strip("`"))
        axes.plot(times, roll, "--", lw=0.9, color=TRUTH_COLOUR, label="truth", drawstyle="steps-post" if move == "step" else "default")
        plain(axes, "time in seconds", "roll in degrees")
        axes.set_title(move, fontsize=9, loc="left", pad=3)
        axes.set_xlim(*spans[move])
    figure.axes[1].legend(fontsize=8, frameon=False, loc="lower right")


def draw_classes(figure, lost):
    axes, groups = figure.subplots(), list(lost)
    ratios = [ours / best for _, best, ours in lost.values()]
    axes.barh(range(len(groups)), ratios, color=["#0b5394" if ratio <= 1.0 else "#d1495b" for ratio in ratios], height=0.6)
    for number, (group, ratio) in enumerate(zip(groups, ratios)):
        name = words(lost[group][0]).strip("`")
        # behind the line at 1, too
        axes.annotate(f"{ratio:.2f}, best other: {name}", (max(ratio, 1.0), number), xytext=(4, 0), textcoords="offset points",
                      va="center", fontsize=8)
    axes.axvline(1.0, lw=0.8, color=TRUTH_COLOUR)
    axes.set_yticks(range(len(groups)), groups)
    axes.set_ylim(len(groups) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.5 * max(ratios))
    axes.set_axisbelow(True)
    plain(axes, f"rms error of {DEFAULT} by that of the best other, ratio", "class")
