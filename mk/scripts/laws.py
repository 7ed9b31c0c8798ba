"""What the filter library's descriptors, and the yardsticks beside them, declare about each law: the names stand only there.

    laws.py kalman|light      names of the filters of paper 002, or of the lightest, for make
"""
import functools
import pathlib
import re
import sys
from typing import NamedTuple

LIST = pathlib.Path("lib/filters/src/filter.h")
DESCRIPTOR = re.compile(r"^const filter_law_t filter_law_(\w+)(.*?)\};", re.M | re.S)
LIMITS = re.compile(r"\bbench: worst (\d+) cycles; float / ours ([\d.]+); rms ([\d.]+) LSB")


class Law(NamedTuple):
    """From a descriptor: worst cycles of an update, enforced by make bench; traits of tracker.h without LAW_."""
    worst_cycles: int
    traits: frozenset


class Limits(NamedTuple):
    """Limits of make bench: worst cycles, speed-up over float, difference from float in LSB rms."""
    worst: int
    ratio: float
    rms: float


@functools.cache
def names():
    """The names in the list's order: the firmware starts with the first."""
    found = re.findall(r"X\((\w+)\)", LIST.read_text(encoding="utf-8").split("#define FILTER_LAWS(X)")[-1])
    if not found:
        raise ValueError(f"{LIST}: no X(name) after #define FILTER_LAWS(X)")
    return tuple(found)


@functools.cache
def laws():
    """{name: Law} of all descriptors."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(LIST.parent.glob("*.c")))
    return {name: Law(int(re.search(r"\.worst_cycles = (\d+)", body)[1]), frozenset(re.findall(r"\bLAW_([A-Z_]+)\b(?!\()", body)))
            for name, body in DESCRIPTOR.findall(text)}


def kalman():
    """The filters of paper 002: Kalman filters of a position whose rate is driven by white acceleration of power density q."""
    files = [path.read_text(encoding="utf-8") for path in sorted(LIST.parent.glob("*.c"))]
    having = {name for text in files if "&filter_parameter_q" in text for name, _ in DESCRIPTOR.findall(text)}
    return [name for name in names() if name in having]


def worst_cycles():
    """{name: worst cycles of an update}."""
    return {name: law.worst_cycles for name, law in laws().items()}


def yardstick(name):
    return pathlib.Path(f"host_tests/chip/float_{name}.c")


def limits(name):
    """None if the yardstick has no line of limits."""
    path = yardstick(name)
    found = LIMITS.search(path.read_text(encoding="utf-8")) if path.is_file() else None
    return Limits(int(found[1]), float(found[2]), float(found[3])) if found else None


def first(wanted):
    """The first law in the list that has the property."""
    return next(name for name in names() if wanted(name, laws()[name].traits))


# The choices of programs that need some filter: the one an image starts with; a Kalman filter without a gate and one with it; those with
# the fewest and the most cycles; a long name of several words.
DEFAULT = names()[0]
PLAIN = first(lambda name, traits: "COVARIANCE" in traits and "GATED" not in traits)
ROBUST = first(lambda name, traits: {"COVARIANCE", "GATED"} <= traits)
LIGHT, SLOWEST = (choice(names(), key=worst_cycles().get) for choice in (min, max))
LONG = max(names(), key=len)


if __name__ == "__main__":
    print(*{"kalman": kalman(), "light": [LIGHT]}[sys.argv[1]])
