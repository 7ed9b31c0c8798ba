#!/usr/bin/env python3
"""What the clock says of `tilt live` (make desk, on an idle machine; no part of make test): a picture within 2 s of connecting and of the start
of the command, 400 rows a second for 20 s in real time without a loss. Run from the repository root."""
import contextlib
import os
import pathlib
import re
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from browser import ABSENT, Browser  # noqa: E402
from fake_board import DEADLINE_S  # noqa: E402
from live_support import Talk, watched  # noqa: E402
from test_live_rate import COUNT, FIRMWARE, RATE_HZ, SIMRUN, STREAM, program  # noqa: E402

FIRST_PICTURE_MS = 2000


@unittest.skipIf(ABSENT, ABSENT)
class TestClock(unittest.TestCase):
    def test_400_rows_a_second_in_real_time(self):
        talk = Talk(RATE_HZ, COUNT)
        with Browser() as browser, watched(talk) as (server, _):
            page = browser.open(server.address)
            self.assertTrue(talk.over.wait(DEADLINE_S))
            page.until(f"tiltPage.figures().rows >= {COUNT}")
            figures = page.figures()
        print(f"first picture after {figures['firstPictureMs']:.0f} ms of the page")
        self.assertLessEqual(figures["firstPictureMs"], FIRST_PICTURE_MS)  # from the begin of the page's loading
        self.assertEqual((figures["rows"], figures["lost"], figures["broken"], figures["restarts"]), (COUNT, 0, 0, 0))

    def test_from_the_start_of_the_command(self):
        with contextlib.ExitStack() as stack:
            sim = stack.enter_context(program([SIMRUN, "--fw", FIRMWARE, "--in", STREAM, "--out", os.devnull, "--pty", "--loop", "--max-ms", 600000,
                                               "--baud", 500000, "--rate", RATE_HZ], stderr=subprocess.PIPE))
            port = re.search(r"/dev/\S+", sim.stderr.readline()).group()
            browser = stack.enter_context(Browser())
            browser.call("Target.getTargets")
            began = time.monotonic()
            live = stack.enter_context(program([sys.executable, "-m", "tilt", "live", port, "--no-browser", "--baud", 500000],
                                                stdout=subprocess.PIPE))
            page = browser.open(live.stdout.readline().strip())
            page.until("tiltPage.figures().firstPictureMs")
            took_s, figures = time.monotonic() - began, page.figures()
        print(f"simrun: picture {took_s:.2f} s after the command was started, {figures['firstPictureMs']:.0f} ms of the page")
        self.assertLessEqual(figures["firstPictureMs"], FIRST_PICTURE_MS)


if __name__ == "__main__":
    from unity_line import main
    main()
