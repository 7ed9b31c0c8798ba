"""Numbers as a user writes them: what Python takes beside (1_0, digits of other scripts) is a slip, and to guess at it would be worse than to ask."""
import argparse
import re

REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?|[+-]?(nan|inf|infinity)", re.ASCII | re.IGNORECASE)
WHOLE = re.compile(r"[+-]?[0-9]{1,18}", re.ASCII)


def real(text):
    """ValueError: it is none."""
    if not REAL.fullmatch(text.strip()):
        raise ValueError(f"'{text}' is no number")
    return float(text)


def real_option(text):
    """For argparse."""
    try:
        return real(text)
    except ValueError as why:
        raise argparse.ArgumentTypeError(str(why)) from None


def whole_option(text):
    if not WHOLE.fullmatch(text.strip()):
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number")
    return int(text)
