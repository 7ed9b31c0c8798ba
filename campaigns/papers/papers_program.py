"""The command line of the papers' programs in Python, that of the others' (host_tests/papers/program.cpp): rows that papers.py reads."""
import argparse
import sys

DEFAULT_RUNS, DEFAULT_SEED, MOST = 10000, 2024, 10_000_000


def whole_number(word):
    if not (word.isascii() and word.isdigit() and 1 <= int(word) <= MOST):
        raise argparse.ArgumentTypeError(f"takes a whole number from 1 to {MOST}")
    return int(word)


def cells(value):
    """value, low and high of a row; of what is no interval the last two are empty."""
    value = value[:3] if isinstance(value, tuple) else (value, None, None)
    return ["" if number is None else f"{number:.9g}" for number in value]


def sample(value):
    """The experiments that an interval is the spread of: a last cell, numbers with commas, or none."""
    return [",".join(f"{number:.9g}" for number in value.sample)] if hasattr(value, "sample") else []


def main(name, experiments, words, refusal=ValueError):
    """experiments: {name: (relative work, options -> rows (experiment, filter, arithmetic, metric, value or interval, runs))}"""
    parser = argparse.ArgumentParser(prog=f"campaigns/{name}", description="An experiment's rows: its name, filter, arithmetic, metric, value, low "
                                     "and high of its interval, number of runs it was made of, the experiments that the interval holds.")
    parser.add_argument("experiment", nargs="?", choices=list(experiments))
    parser.add_argument("--list", action="store_true", help="names of the experiments, and how much work each is")
    parser.add_argument("--runs", type=whole_number, default=DEFAULT_RUNS)
    parser.add_argument("--seed", type=whole_number, default=DEFAULT_SEED, help="of the noise")
    options = parser.parse_args(words)
    if options.list:
        print("\n".join(f"{experiment}\t{work:g}" for experiment, (work, _) in experiments.items()))
        return 0
    if not options.experiment:
        parser.error("names no experiment (--list shows them)")
    try:
        for experiment, filter_name, arithmetic, metric, value, runs in experiments[options.experiment][1](options):
            print("\t".join(["row", experiment, filter_name, arithmetic, metric, *cells(value), str(runs), *sample(value)]))
    except refusal as reason:
        print(f"{name}: {reason}", file=sys.stderr)
        return 2
    return 0
