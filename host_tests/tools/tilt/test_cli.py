#!/usr/bin/env python3
"""Tests of the command `tilt` itself: what is listed, what a wrong word or file says, exit statuses."""
import pathlib
import subprocess
import sys
import unittest
from types import SimpleNamespace
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import run_tilt as run  # noqa: E402
from tilt import cli, errors  # noqa: E402

INSTALLED = pathlib.Path("build/venv/bin/tilt")


def job(raises=None, status=None):
    """A sub-command `job` that takes a word and raises, or returns, this."""
    def work(_):
        if raises is not None:
            raise raises
        return status
    return {"job": SimpleNamespace(NAME="job", SUMMARY="does it", __doc__="Does it.", run=work, arguments=lambda parser: None)}


class Test(unittest.TestCase):
    def test_each_command_has_help_of_its_own(self):
        for name, module in cli.modules().items():
            status, out, _ = run(name, "--help")
            self.assertEqual(status, 0, name)
            self.assertIn(f"usage: tilt {name}", out)
            self.assertIn(module.SUMMARY, run("--help")[1].replace("\n                        ", " "))

    def test_no_command_and_a_wrong_one_are_told(self):
        for words in ([], ["grow"]):
            status, _, err = run(*words)
            self.assertEqual(status, 2)
            self.assertRegex(err, r"\Atilt: .*(see tilt --help|choose from .*)\n\Z")

    def test_what_python_alone_takes_for_a_number_is_none(self):
        options = (("replay", "--rate"), ("replay", "--range"), ("plot", "--from"), ("plot", "--to"), ("record", "--seconds"),
                   ("record", "--baud"), ("live", "--baud"), ("live", "--port-http"), ("import", "--rate"), ("import", "--sensor"))
        for name, option in options:
            for slip in ("1_0", "\u0661\u0660", "8x"):
                status, _, err = run(name, "file", option, slip)
                self.assertEqual(status, 2, (name, option, slip))
                self.assertIn(f"tilt {name}: {option}: ", err)
                self.assertIn(slip, err)

    def test_what_a_command_raises_is_one_line(self):
        with mock.patch.object(cli, "modules", lambda: job(errors.at("my.csv", 7, "3 fields"))):
            self.assertEqual(run("job"), (2, "", "tilt job: my.csv:7: 3 fields\n"))

    def test_status(self):
        for given, expected in ((job(), 0), (job(status=1), 1), (job(KeyboardInterrupt()), 130)):
            with mock.patch.object(cli, "modules", lambda given=given: given):
                self.assertEqual(run("job")[0], expected)

    @unittest.skipUnless(INSTALLED.exists(), "tilt is not installed: sh tools/deps.sh tools")
    def test_installed(self):
        answer = subprocess.run([INSTALLED, "--help"], capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("usage: tilt", answer.stdout)


if __name__ == "__main__":
    from unity_line import main
    main()
