"""The one exception shown to the user: what is wrong, and where."""


class TiltError(Exception):
    """Text: FILE:LINE: reason if a line is known, FILE: reason if only a file is, else the reason."""


def at(path, line, reason):
    """The error for a line of a file."""
    return TiltError(f"{path}:{line}: {reason}")
