"""The one exception that a person gets to see: it says what is wrong, and where."""


class TiltError(Exception):
    """Text: FILE:LINE: reason where there is a line, FILE: reason where there is a file, else the reason."""


def at(path, line, reason):
    """The error for one line of a file."""
    return TiltError(f"{path}:{line}: {reason}")
