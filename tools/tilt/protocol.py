"""The board's protocol (docs/protocol.md), for the tools that read it or draw its rows."""
import re
from typing import NamedTuple

from tilt.errors import TiltError

HEADER = "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags"
BAUDS = (9600, 19200, 38400, 57600, 115200, 250000, 500000, 1000000)
BAUD_AT_START = 115200
WRAP_US = 1 << 32      # t_us is a uint32
WRAP_STEP_US = 1 << 31  # a step back by more than this is a wrap
LINE_MAX = 512         # bytes; the board's longest line is less than half of this

# bits of the column `flags` in the order of the firmware's enum row_flag (firmware/path/pipeline.h)
FLAG_NAMES = dict(zip((1 << bit for bit in range(16)), ("gated", "coasted", "re-acquired", "clipped", "silence", "stuck", "integrity", "warming up",
                                                        "dropped", "not gravity", "roll undefined", "switched", "axis left out")))
(GATED, COASTED, REACQUIRED, CLIPPED, SILENCE, STUCK, INTEGRITY, WARMING_UP, DROPPED, NOT_GRAVITY, ROLL_UNDEFINED, SWITCHED,
 LEFT_OUT) = FLAG_NAMES
NO_SAMPLE = COASTED | SILENCE

LIMITS = {"t_us": (0, WRAP_US - 1), "x_lsb": (-4096, 4095), "y_lsb": (-4096, 4095), "z_lsb": (-4096, 4095), "roll_cdeg": (-18000, 18000),
          "pitch_cdeg": (-9000, 9000), "flags": (0, 65535)}
ANY_NUMBER = (-(1 << 31), WRAP_US - 1)
NEEDED = ("t_us", "x_lsb", "y_lsb", "z_lsb")
BANNER, RESET = "# tilt-uno ", "# reset: "  # one after the other at a start
PLOTTER_ROW = re.compile(r"roll_raw:-?\d+\.\d+,roll:")
NUMBER = re.compile(r"-?\d{1,10}\Z")


def check_baud(baud):
    """TiltError if the firmware has no such rate."""
    if baud not in BAUDS:
        raise TiltError(f"--baud {baud}: choose from {', '.join(map(str, BAUDS))}")


REFUSED = "# refused"
# how the answer to a command begins, where it is not "# " and the command's first word
ANSWERS = {"help": "# ", "?": "# ", "settings": "# filter", "status": "# state", "version": BANNER, "load": "# settings", "defaults": "# settings"}


def answers(command, text):
    """Whether a line is the board's answer to a command; a refusal is one too."""
    word = (command.split() or [""])[0].lower()
    return text.startswith((ANSWERS.get(word, f"# {word}"), REFUSED))


class Row(NamedTuple):
    """t_us: the board's counter (uint32); flags: 0 if the header has none."""
    t_us: int
    flags: int
    values: tuple


def is_header(text):
    return text.startswith("t_us,") and all(name in text.split(",") for name in NEEDED)


def row_of(text, header=HEADER):
    """The row; ValueError with what is wrong with it."""
    names, fields = header.split(","), text.split(",")
    if len(fields) != len(names):
        raise ValueError(f"{len(fields)} fields, the header has {len(names)}")
    values = []
    for name, field in zip(names, fields):
        if not NUMBER.match(field):
            raise ValueError(f"{name} is not a whole number: '{field}'")
        values.append(int(field))
        low, high = LIMITS.get(name, ANY_NUMBER)
        if not low <= values[-1] <= high:
            raise ValueError(f"{name} is outside {low}..{high}: {field}")
    found = dict(zip(names, values))
    return Row(found["t_us"], found.get("flags", 0), tuple(values))


def flags_in_words(flags):
    """'gated, clipped'; unknown bits as a number; '-' for none."""
    words = [name for bit, name in FLAG_NAMES.items() if flags & bit]
    unknown = flags & ~sum(FLAG_NAMES)
    return ", ".join(words + ([str(unknown)] if unknown else [])) or "-"
