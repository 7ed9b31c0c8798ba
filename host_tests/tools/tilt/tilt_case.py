"""What the tests of `tilt` share: a folder of their own, and the command with what it prints."""
import contextlib
import io
import pathlib
import tempfile
import unittest


def printed(main, words):
    """(status, stdout, stderr) of a command's main with these words."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(list(map(str, words)))
        except SystemExit as stop:
            status = stop.code
    return status, out.getvalue(), err.getvalue()


def run_tilt(*words):
    from tilt import cli  # needs numpy, which the tests of other commands may not have
    return printed(cli.main, words)


def port_of(simrun):
    """The terminal of a running `simrun --pty`, as soon as it is there."""
    return next(line for line in simrun.stderr if "UART on" in line).split()[-1]


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
