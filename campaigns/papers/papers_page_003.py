"""The tables of docs/results/papers-003.md."""
from papers_page import BESIDE, grid, verdicts

CHANCE_FREE = ("tau", "covariance")
STATES = ("position_n", "position_e", "position_d", "velocity_n", "velocity_e", "velocity_d", "attitude_n", "attitude_e", "attitude_d",
          "drift_x", "drift_y", "drift_z")
TAU = tuple(f"tau_{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
ERRORS = (("heading 40..160 s, degrees", "heading_40_160"), ("without GPS", "heading_without_gps"), ("its rms", "heading_rms_without_gps"),
          ("level without GPS", "level_without_gps"), ("position after 60 s without GPS, m", "position_60_s"), ("120 s", "position_120_s"),
          ("239 s", "position_239_s"))
LOOPS = (("closed_loop", "Closed loop, nav/lib with its queue"), ("closed_loop_100_hz", "Closed loop, the field at 100 Hz, all scalars at once"))


def runs_of(runs):
    return f"{min(200, runs // 50)} flights of each kind, of one of 9 states with the field at 100 Hz and 25 q five times as many"


def tables(rows):
    """(heading, lines)."""
    yield BESIDE, verdicts(rows)
    yield "tau (3.34) of 17818, 1951, 41847 nT", grid(rows, [(name.replace("_", " "), "tau", [name]) for name in TAU])
    yield "Sigmas against the thesis' square root: largest difference over 500 s, relative; least element of D", grid(rows, [
        (title, "covariance", [metric]) for title, metric in (("difference", "largest_difference"), ("least D", "least_d"))])
    for second in (160, 399, 500):
        yield f"Sigmas at {second} s: m, m/s, rad, rad/s", grid(rows, [
            (name.replace("_", " "), "covariance", [f"{name}_{second}"]) for name in STATES])
    for experiment, title in LOOPS:
        yield f"{title}: median of the largest error of a flight", grid(rows, [
            (column, experiment, [metric]) for column, metric in ERRORS], intervals=True)
