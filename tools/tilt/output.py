"""Files that sub-commands write."""
import contextlib
import os
import stat

from tilt.errors import TiltError


@contextlib.contextmanager
def whole_file(path, mode="w"):
    """The open file of text (mode "wb": of bytes). It takes its name at the end, when all went well, so that what had the name is not
    lost before; a pipe or a device is written as it is. TiltError: it cannot be written."""
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
    except BrokenPipeError:  # cli.py knows what it means
        raise
    except OSError as error:
        raise TiltError(f"{path}: cannot be written: {error.strerror}") from error
