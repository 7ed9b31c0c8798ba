"""The command line of paper 004's experiments: the one of the other papers' programs (host_tests/papers/program.cpp)."""
import sys

from .experiments import EXPERIMENTS
from .intervals import Interval

DEFAULT_RUNS, DEFAULT_SEED = 10000, 2024
MOST = 10_000_000
NAME = "variable_structure"
HELP = ("-h", "--help")
USAGE = f"""usage: python campaigns/{NAME} --list | EXPERIMENT [--runs N] [--seed N]

The experiments of paper 004 (docs/variable-structure.md), as rows that campaigns/papers/papers.py reads.

  --list      names of the experiments, and how much work each is
  EXPERIMENT  one of them: rows of filter, metric, value, low and high of its interval, number it was made of
  --runs N    how many runs, 1 to {MOST} (default {DEFAULT_RUNS})
  --seed N    of the noise, 1 to {MOST} (default {DEFAULT_SEED})
  -h, --help  this text
"""


class Refused(Exception):
    """One sentence about a word of the command line."""


def whole_number(option, words):
    word = next(words, "")
    if not (word.isascii() and word.isdigit() and 1 <= int(word) <= MOST):
        raise Refused(f"{option}: takes a whole number from 1 to {MOST}")
    return int(word)


def options_of(words):
    """(runs, seed)"""
    options, words = {"--runs": DEFAULT_RUNS, "--seed": DEFAULT_SEED}, iter(words)
    for word in words:
        if word not in options:
            raise Refused(f"{word}: unknown option (--runs N, --seed N)")
        options[word] = whole_number(word, words)
    return options["--runs"], options["--seed"]


def cells(value):
    """value, low and high of a row; None is an empty cell."""
    value = value if isinstance(value, Interval) else Interval(value, None, None)
    return ["" if number is None else f"{number:.9g}" for number in value]


class Progress:
    """A line for each percent, as the other papers' programs print."""

    def __init__(self, out):
        self.out, self.told = out, 0

    def at(self, part):
        if int(100 * part) > self.told:
            self.told = int(100 * part)
            self.out.write(f"progress\t{part:.2f}\n")
            self.out.flush()


def run(arguments, out):
    word = arguments[0] if arguments else ""
    if any(help_word in arguments for help_word in HELP):
        out.write(USAGE)
        return
    if not word:
        raise Refused("names no experiment (--list tells them, --help the options)")
    if word == "--list":
        if len(arguments) > 1:
            raise Refused(f"{arguments[1]}: --list stands alone")
        for name, (work, _) in EXPERIMENTS.items():
            out.write(f"{name}\t{work:g}\n")
        return
    if word.startswith("-"):
        raise Refused(f"{word}: unknown option; the experiment stands first (--help)")
    if word not in EXPERIMENTS:
        raise Refused(f"'{word}': no such experiment (--list tells them)")
    runs, seed = options_of(arguments[1:])
    for name, metric, value, made in EXPERIMENTS[word][1](runs, seed, Progress(out).at):
        out.write("\t".join(["row", word, name, "double", metric, *cells(value), str(made)]) + "\n")


def main(arguments, out=sys.stdout):
    try:
        run(arguments, out)
    except Refused as reason:
        print(f"{NAME}: {reason}", file=sys.stderr)
        return 2
    return 0
