"""The lines that tools/design prints to type: the firmware accepts every one, in that order, whatever was typed before, and then has those values;
and the tool says which filter they make."""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from design_support import BASE, answer
from system_support import STREAMS, image_with, needs, run_all, simrun, test

needs("design", "matplotlib", "scipy")

from design import configuration, typed  # noqa: E402

STEP_MS, FROM_MS, LINES_MOST = 60, 400, 64  # simrun types no more
OF_TWO, OF_THREE = (configuration.KALMAN[v][0] for v in (2, 3))


def designs():
    """(filter, lines to type) of designs far from one another."""
    found = []
    for rate, *more in (("25", "--a=-0.6", "--b", "0.55"), ("800", "--noise-gain", "0.55"), ("12.5", "--a=0.4", "--b", "0.9"),
                        ("400", "-k", "0", "-l", "2", "-v", "3", "--noise-gain", "0.4"), ("50", "-l", "2", "--a=-0.75", "--noise-gain", "0.31"),
                        ("200", "-k", "0", "-l", "1", "--noise-gain", "0.2"), ("100", "-k", "0", "-l", "2", "-v", "3", "--noise-gain", "0.33")):
        result, _ = answer("--rate", rate, "--sigma", "2.7", "--no-pictures", *more)
        found += [(one["filter"], one["commands"]) for one in result["configurations"] if one.get("commands")]
    return found


def answered(line, note):
    """The board's reply that it has this value, which it shows in four decimals, cut off."""
    (name, value), words = line.split(), re.split("[ :]", note.removeprefix("# "))
    if words[:1] != [name] or len(words) < 2:
        return False
    return words[1] == value if value.isalpha() or "_" in value or name == "filter" else abs(float(words[1]) - float(value)) < 1.2e-4


@test
def the_board_accepts_every_line_and_has_the_values():
    every = designs()
    for names in ((configuration.ONE_GAIN, OF_TWO), (configuration.TAPS, OF_THREE)):
        lines = [line for name, each in every if name in names for line in each][:LINES_MOST]
        assert all(f"filter {name}" in lines for name in names) and len(lines) >= 40, lines
        words = [word for number, line in enumerate(lines) for word in ("--cmd", f"{FROM_MS + STEP_MS * number}:{line}")]
        _, notes, _, _ = simrun(f"typed-{names[0]}", STREAMS / "rest-2lsb.csv", *words, "--loop", "--max-ms", FROM_MS + STEP_MS * len(lines) + 200,
                                fw=image_with(names[0]), judge=False)
        assert not [note for note in notes if note.startswith("# refused")], notes
        for line in lines:
            reply = next((i for i, note in enumerate(notes) if answered(line, note)), None)
            assert reply is not None, (line, notes[:4])
            del notes[:reply + 1]


@test
def what_is_typed_keeps_the_bound_and_is_told_where_it_is_another_filter():
    result, out = answer(*BASE, "--error", "1", "--at", "400")
    made = result["configurations"][0]
    assert made["commands"] == ["rate 100", f"filter {configuration.ONE_GAIN}", "a1 0", "b0 0.0385", "r 4", "ratemax 1000000"], made["commands"]
    f = configuration.gain_filter(typed.taken("0.0385", 16), 0)
    assert f"as typed, in four decimals: noise gain {float(f.noise_gain()):.7f}, dynamic error {float(f.dynamic_error()):.7g} per" in out, out
    assert float(f.dynamic_error()) <= 25.0
    assert "alone" not in out.partition("configuration")[2]


@test
def numbers_are_taken_as_the_board_takes_them():
    for text, stored in (("0.0385", 2523), ("-0.3", -19661), ("0.9999", 65529), ("-0.9999", -65529), ("0.5", 32768)):
        assert typed.taken(text, 16) == stored, text
    assert typed.taken("0.0117", 8) == 3 and typed.taken("4910", 0) == 4910
    assert typed.texts(2521, 16) == ["0.0384", "0.0385"] and typed.texts(0, 16) == ["0"]


@test
def at_a_rate_that_no_board_has_nothing_is_typed():
    result, out = answer("--rate", "90", "--sigma", "2", "--noise-gain", "0.6", "--no-pictures")
    assert all(not one.get("commands") for one in result["configurations"])
    assert "nothing to type: the firmware samples at 12.5, 25" in out and "nearest: --rate 100" in out


if __name__ == "__main__":
    sys.exit(run_all())
