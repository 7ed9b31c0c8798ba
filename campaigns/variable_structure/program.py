"""The experiments of paper 004 (docs/variable-structure.md) for make papers."""
import papers_program

from .experiments import EXPERIMENTS


def of_program(experiment, function):
    """All rows are of that experiment, and in double."""
    return lambda options: ((experiment, rule, "double", metric, value, runs) for rule, metric, value, runs in function(options.runs, options.seed))


def main(words):
    experiments = {name: (work, of_program(name, function)) for name, (work, function) in EXPERIMENTS.items()}
    return papers_program.main("variable_structure", experiments, words)
