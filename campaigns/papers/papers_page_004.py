"""The tables of docs/results/papers-004.md."""
from papers_page import BESIDE, grid, verdicts

CHANCE_FREE = ("observability",)
FLIGHTS = (("windows_stuck_at_zero", "Frozen output is zero: the window's own data choose"),
           ("windows_frozen_at_last", "Frozen output is the last value: the window's own data choose"),
           ("next_window_stuck_at_zero", "Frozen output is zero: the window before chooses"),
           ("next_window_frozen_at_last", "Frozen output is the last value: the window before chooses"),
           ("windows_lasting", "Troubles of five windows: the window's own data choose"),
           ("next_window_lasting", "Troubles of five windows: the window before chooses"))
COLUMNS = (("rms of dV in m/s, median", "rms_median"), ("95 % of the runs", "rms_p95"), ("mean square", "mse"), ("exact", "exact_mse"),
           ("rms of the tilt in rad", "rms_tilt_median"),
           ("best sensor chosen", "best_sensor"), ("within twice the best", "within_2x"), ("frozen sensor taken, if there is one", "frozen_taken"))
PHASES = ("still", "ramp", "sine", "vibration", "drop", "burst", "acceleration", "mixed")


def runs_of(runs):
    return f"{runs // 20:,} flights of each kind"


def tables(rows):
    """(heading, lines)."""
    yield BESIDE, verdicts(rows)
    yield "The channel of the inertial system: (9) to (12)", grid(rows, [
        (metric, "observability", [metric]) for metric in ("sum_a2_1", "sum_a2_2", "sum_a2_3", "condition")])
    yield "Trends: the 20 s after 40 s of estimates", grid(rows, [
        (title, "trends", [metric]) for title, metric in (("rms error in m/s, median", "error_median"), ("mean square", "mse"),
                                                          ("exact", "exact_mse"), ("chosen by self-organisation", "picked"))], intervals=True)
    for experiment, title in FLIGHTS:
        yield title, grid(rows, [(column, experiment, [metric]) for column, metric in COLUMNS], intervals=True)
    yield "On the board: tilt streams of sixteen phases, rms in degrees", grid(rows, [
        ("all", "board_phases", ["rmse"]), *((phase, "board_phases", [f"rmse_{phase}"]) for phase in PHASES)])
    yield "On the board: `auto` over filters tuned on other runs", grid(rows, [
        (f"over {name.replace('_', ' ')}", "board_phases", [f"over_{name}"])
        for name in ("sprf_fixed", "sprf_guarded_double", "pbf_fixed", "pbf_double")], intervals=True)
