"""Numbers as users type them. Python accepts more (1_0, digits of other scripts): a slip, better rejected than guessed."""
import argparse
import re

REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?|[+-]?(nan|inf|infinity)", re.ASCII | re.IGNORECASE)
WHOLE = re.compile(r"[+-]?[0-9]{1,18}", re.ASCII)


def real(text):
    """ValueError: not a number."""
    if not REAL.fullmatch(text.strip()):
        raise ValueError(f"'{text}' is not a number")
    return float(text)


def real_option(text):
    """Type of an argparse option."""
    try:
        return real(text)
    except ValueError as why:
        raise argparse.ArgumentTypeError(str(why)) from None


def whole_option(text):
    if not WHOLE.fullmatch(text.strip()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number")
    return int(text)
