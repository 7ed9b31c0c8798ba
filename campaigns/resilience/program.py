"""The experiments of paper 002 by name, with their relative work."""
import papers_program
from synthesis.batch import Refused

from . import experiments as of
from . import three_axes

EXPERIMENTS = {"lockout": (30, of.lockout), "steps_with_outliers": (20, of.steps_with_outliers), "wrong_r": (15, of.wrong_r),
               "steps_clean": (10, of.steps_clean), "table1_start": (6, of.table1_start), "first_sample_clean": (6, of.first_sample_clean),
               "median_start": (6, of.median_start), "shipped_start": (6, of.shipped_start), "outliers_in_runs": (6, of.outliers_in_runs),
               "learning": (2, of.learning), "gate_width": (6, of.gate_width), "printed_readings": (6, of.printed_readings),
               "clean_data": (4, of.clean_data), "bursts": (4, of.bursts), "three_axes": (6, three_axes.rows),
               "covariance": (0.1, of.covariance), "steady_gain": (0.1, of.steady_gain),
               "table2": (0.1, of.table2), "matrix_step": (0.1, of.matrix_step)}


def main(words):
    return papers_program.main("resilience", EXPERIMENTS, words, Refused)
