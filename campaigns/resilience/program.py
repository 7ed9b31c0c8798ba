"""The experiments of paper 002 by name, with their work in about seconds."""
import papers_program
from synthesis.batch import Refused

from . import experiments as of
from . import three_axes

EXPERIMENTS = {"lockout": (62, of.lockout), "steps_with_outliers": (42, of.steps_with_outliers), "wrong_r": (70, of.wrong_r),
               "steps_clean": (40, of.steps_clean), "table1_start": (18, of.table1_start), "first_sample_clean": (18, of.first_sample_clean),
               "median_start": (18, of.median_start), "shipped_start": (18, of.shipped_start), "outliers_in_runs": (30, of.outliers_in_runs),
               "learning": (4, of.learning), "gate_width": (15, of.gate_width), "printed_readings": (22, of.printed_readings),
               "clean_data": (15, of.clean_data), "bursts": (9, of.bursts), "three_axes": (14, three_axes.rows),
               "covariance": (0.1, of.covariance), "steady_gain": (0.1, of.steady_gain),
               "table2": (0.1, of.table2), "matrix_step": (0.1, of.matrix_step)}


def main(words):
    return papers_program.main("resilience", EXPERIMENTS, words, Refused)
