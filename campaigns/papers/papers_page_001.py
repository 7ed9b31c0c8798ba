"""The tables of docs/results/papers-001.md."""
from papers_page import BESIDE, grid, verdicts

CHANCE_FREE = ("altitude_kalman", "ratios")


def runs_of(runs):
    return f"{runs // 5:,} runs"


def tables(rows):
    yield BESIDE, verdicts(rows)
    for name, title in (("altitude_half_a_t2", "x = a t^2 / 2"), ("altitude_a_t2", "x = a t^2")):
        yield f"{title}: metres", grid(rows, [
            ("sigma, straight legs", name, ["sigma"]), ("of one run +-", name, ["sigma_one_run_sd"]), ("sigma, 10-20 s", name, ["sigma_stationary"]),
            ("mean error 20-35 s", name, ["lag_20_35"]), ("35-50 s", name, ["lag_35_50"]), ("settled, 30-35 s", name, ["lag_settled"]),
            ("largest without noise", name, ["peak_bias"])])
    yield "Kalman filters, solved for the published lag or sigma", grid(rows, [
        (metric, "altitude_kalman", [metric]) for metric in ("alpha", "beta", "gamma", "q")])
