#!/usr/bin/env python3
"""Tests of `import tilt`: the page's blocks run, rows are those of the command and of the firmware with the same parameters, what is wrong is said
in one sentence. Run from the repository root with build/venv/bin/python."""
import contextlib
import inspect
import io
import pathlib
import re
import subprocess
import sys
import typing
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST  # noqa: E402
from tilt_case import InFolder, run_tilt  # noqa: E402
import tilt  # noqa: E402

PAGE = pathlib.Path("docs/python.md")
STREAM = "sim/streams/steps-outliers.csv"
FIRMWARE = pathlib.Path("build/host/pipeline_replay")


class Page(unittest.TestCase):
    def test_its_blocks_run_as_they_stand(self):
        text = PAGE.read_text(encoding="utf-8")
        blocks, names = re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S), {}
        self.assertEqual((len(blocks), len(text.split()) <= 500), (6, True))
        with contextlib.redirect_stdout(io.StringIO()) as out:
            for block in blocks:
                exec(compile(block, str(PAGE), "exec"), names)  # pylint: disable=exec-used
        self.assertRegex(out.getvalue(), r"\A5100 rows at 100 Hz, 51 s\n")
        self.assertIn("gate 99: ", out.getvalue())


class Interface(InFolder):
    def test_rows_are_those_of_the_command(self):
        import pandas as pd
        self.assertEqual(run_tilt("replay", STREAM, "--filter", ROBUST, "-o", self.folder / "o.csv")[0], 0)
        pd.testing.assert_frame_equal(tilt.replay(STREAM, ROBUST).astype("int64"), pd.read_csv(self.folder / "o.csv"))

    def test_parameters_act_as_in_the_firmware(self):
        if not FIRMWARE.exists():
            subprocess.run(["make", "-s", str(FIRMWARE)], check=True)
        for filter_, values in ((ROBUST, {"gate": 2.5, "q": 1250}), (PLAIN, {"q": 400}), (DEFAULT, {"guard": 0})):
            words = [f"{key}={value}" for key, value in values.items()]
            done = subprocess.run([FIRMWARE, STREAM, filter_, "1000", "16", "0", *words], capture_output=True, text=True, check=True)
            wanted = np.loadtxt(io.StringIO(done.stdout), delimiter=",", comments=("#", "t"), dtype=np.int64)
            found = tilt.replay(STREAM, filter_, **values)
            self.assertFalse(np.array_equal(found.roll_cdeg, tilt.replay(STREAM, filter_).roll_cdeg), values)
            np.testing.assert_array_equal(found[["roll_cdeg", "pitch_cdeg"]], wanted[:len(found), 7:9], str(values))

    def test_a_stream_and_its_table(self):
        stream = tilt.Stream.read(STREAM)
        frame = stream.frame()
        self.assertEqual(list(frame), ["t_us", "x_lsb", "y_lsb", "z_lsb", "flags", "roll_true_cdeg", "pitch_true_cdeg"])
        np.testing.assert_array_equal(frame[["x_lsb", "y_lsb", "z_lsb"]], stream.lsb)

    def test_what_is_wrong_is_one_sentence(self):
        for values, words in (({"gate": 99}, "gate 99: 0 or 1 to 16"), ({"foo": 1}, "choose from r q gate"),
                              ({"reacquire": 4}, "refuses reacquire 4"), ({"rate_hz": 90}, "rate 90: choose from 12.5"),
                              ({"rate_hz": np.nan}, "choose from 12.5"), ({"rate_hz": np.inf}, "choose from 12.5"), ({"gate": np.nan}, "gate nan: "),
                              ({"range_g": 3}, "choose from 2 4 8 16")):
            with self.assertRaisesRegex(tilt.TiltError, re.escape(words)):
                tilt.replay(STREAM, ROBUST, **values)
        for wrong in (lambda: tilt.replay(STREAM, "foo"), lambda: tilt.parameters("foo")):
            self.assertRaisesRegex(tilt.TiltError, "no filter 'foo': choose from", wrong)
        self.assertRaisesRegex(tilt.TiltError, "no/such.csv: cannot be read", tilt.Stream.read, "no/such.csv")

    def test_every_name_offered_has_type_hints(self):
        self.assertEqual(set(tilt.__all__), {"Stream", "TiltError", "filters", "parameters", "replay"})
        self.assertLessEqual(set(tilt.__all__), set(dir(tilt)))
        for name in ("filters", "parameters", "replay"):
            signature = inspect.signature(getattr(tilt, name))
            self.assertNotIn(inspect.Signature.empty, [signature.return_annotation, *(one.annotation for one in signature.parameters.values())])
        self.assertEqual(typing.get_type_hints(tilt.filters)["return"], list[str])


if __name__ == "__main__":
    from unity_line import main
    main()
