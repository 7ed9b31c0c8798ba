"""Files that sub-commands write."""
import contextlib
import os
import stat

from tilt.errors import TiltError


@contextlib.contextmanager
def whole_file(path, mode="w"):
    """The open text file (mode "wb": bytes). It takes its name only after all is written, so an older file of that name stays intact until
    then; a pipe or a device is written directly. TiltError: it cannot be written."""
    path = os.fspath(path)
    try:
        in_place = os.path.exists(path) and not stat.S_ISREG(os.stat(path).st_mode)
        place = path if in_place else f"{path}.part"
        text = {} if "b" in mode else {"encoding": "utf-8", "newline": "\n"}
        with open(place, mode, **text) as file:
            try:
                yield file
            except BaseException:
                if not in_place:
                    os.unlink(place)
                raise
        if not in_place:
            os.replace(place, path)
    except BrokenPipeError:  # handled in cli.py
        raise
    except OSError as error:
        raise TiltError(f"{path}: cannot write it: {error.strerror}") from error
