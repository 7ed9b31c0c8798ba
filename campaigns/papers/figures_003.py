"""Figures 3.2 to 3.11 of paper 003: errors of attitude, velocity and position of the flight of section 3.4 in closed loop, in the four cases that its
numbers belong to as far as they can be read (its words are lost). nav/lib in float with its queue, the field at 1 Hz."""
import numpy as np
from figures_style import AXES, Drawn, legend, panel, printed_level, printed_words
from pictures import GRID_COLOUR
from results import output_of
from synthesis.batch import run_seed

PROGRAM, SEED = "build/papers/flight_series", 2024
SECONDS, LOST, BACK = 500, 160, 400
DEGREE = 180.0 / np.pi
NAMES = ("x, north", "y, east", "z, down")
ANGLES = ("x, roll", "y, pitch", "z, heading")
# file, title, arguments, printed bounds of the heading: (what of it, from, to, degrees, words)
CASES = (("003-2-4", "Paper 003, Figs 3.2 to 3.4: 9 states, no drift", (9, "none", 1),
          (("largest", LOST, BACK, 1.0, "< 1"), ("rms", LOST, BACK, 0.5, "about 0.5"))),
         ("003-5", "Paper 003, Fig. 3.5: 9 states, a drift of the gyro that they do not know", (9, "gyro", 1),
          (("largest", 40, LOST, 3.5, "3.5"), ("largest", LOST, BACK, 6.0, "6"))),
         ("003-6-8", "Paper 003, Figs 3.6 to 3.8: 12 states, drift of the gyro, 25 q", (12, "gyro", 25), (("largest", LOST, BACK, 2.0, "< 2"),)),
         ("003-9-11", "Paper 003, Figs 3.9 to 3.11: 12 states, drift of gyro and accelerometer, 25 q", (12, "both", 25), ()))


def flown(arguments, flights):
    """Errors, flights x seconds x (attitude in degrees, velocity, position) x 3."""
    seeds = [run_seed(SEED, run) % 2 ** 32 for run in range(flights)]
    rows = np.array([line.split(",") for line in output_of([PROGRAM, *arguments, *seeds]).splitlines()], dtype=float)
    errors = rows[:, 2:11].reshape(flights, SECONDS, 3, 3)
    errors[:, :, 0] *= DEGREE
    return errors


def heading_of(errors, what, begin, end):
    """Median over the flights of the largest error of heading between two times, or of its rms."""
    heading = errors[:, begin:end - 1, 0, 2]
    each = np.max(np.abs(heading), axis=1) if what == "largest" else np.sqrt(np.mean(np.square(heading), axis=1))
    return float(np.median(each))


def draw_panel(axes, errors, title, unit, names, until=SECONDS):
    times = np.arange(1, SECONDS + 1)
    for number, (name, colour) in enumerate(zip(names, AXES)):
        low, high = np.quantile(errors[:, :, number], (0.0, 1.0), axis=0)
        axes.fill_between(times, low, high, color=colour, alpha=0.15, lw=0)
        axes.plot(times, errors[0, :, number], "-", lw=1.2, color=colour, label=name)
    axes.axvspan(LOST, BACK, color=GRID_COLOUR, alpha=0.5, lw=0, zorder=0)
    axes.axhline(0.0, lw=0.7, color="#555555")
    panel(axes, title, "time in seconds", unit)
    axes.set_xlim(0, until)
    most = 1.7 * float(np.max(np.abs(errors[:, 10:until])))
    axes.set_ylim(-most, most)


def draw(figure, what):
    errors, printed, wanted = what
    grid = figure.subplots(wanted, 2, squeeze=False)
    parts = (("attitude", "error in degrees", ANGLES), ("velocity", "error in m/s", NAMES), ("position", "error in m", NAMES))
    for row, number, (title, unit, names) in zip(grid, range(3), parts):
        draw_panel(row[0], errors[:, :, number], f"{title}, whole flight; grey: no GPS", unit, names)
        draw_panel(row[1], errors[:, :, number], f"{title}, while GPS is there", unit, names, LOST)
        legend(row[0])
    most = max([grid[0, 0].get_ylim()[1], *(2.0 * degrees for *_, degrees, _ in printed)])
    grid[0, 0].set_ylim(-most, most)
    words = []
    for what_of, begin, end, degrees, said in printed:
        ours = heading_of(errors, what_of, begin, end)
        printed_level(grid[0, 0], [begin, end], (degrees, -degrees))
        words.append(f"{what_of} heading {begin}-{end} s: printed {said}, ours {ours:.2f}")
    if words:
        printed_words(grid[0, 0], 5, 0.02, "\n".join(words), va="bottom")


def figures(runs):
    flights, found = max(2, runs // 25), []
    for name, title, arguments, printed in CASES:
        errors = flown(arguments, flights)
        beside = [(f"{title.partition(': ')[0].removeprefix('Paper 003, ')}, {what} error of heading in {begin} to {end} s, degrees", said,
                   f"{heading_of(errors, what, begin, end):.2f}") for what, begin, end, _, said in printed]
        words = f"{flights} flights: lines are the first, behind them the range of all; the verdicts are of 200. "
        words += "" if printed else "No number of these figures is readable. "
        wanted = 1 if name == "003-5" else 3
        found.append(Drawn(name, title, 1.4 if wanted == 1 else 3, draw, (errors, printed, wanted), __file__,
                           words + "The reading of the case is ours: the figures' words are lost.", beside))
    return found
