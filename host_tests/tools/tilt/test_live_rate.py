"""The page of `tilt live` in a headless Chromium: a picture of the first rows that come; 20 s of 400 rows a second, faster than a board sends
them, without a loss; its twin, where a board leaves rows out, has exactly those counted; the firmware itself in simrun, none of whose rows is
lost. What the clock says of it is in desk_live.py. Run from the repository root."""
import contextlib
import os
import pathlib
import random
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import LIGHT  # noqa: E402
from browser import ABSENT, Browser  # noqa: E402
from fake_board import DEADLINE_S  # noqa: E402
from live_support import Talk, watched  # noqa: E402

RATE_HZ, SECONDS = 400, 20
COUNT = RATE_HZ * SECONDS
FASTER = 8  # than a board: the rows' times are its own
FEW = RATE_HZ // 4  # rows of which there must be a picture
SIMRUN, FIRMWARE, STREAM = (pathlib.Path(name) for name in ("build/sim/simrun", "build/uno/firmware.elf", "sim/streams/tilt-400hz.csv"))


def left_out():
    """Rows that the twin does not send: 1 % one by one, and three bursts; never the first or the last, beside which nothing tells a gap."""
    chance = random.Random(11)
    single = {number for number in range(1, COUNT - 1) if chance.random() < 0.01}
    return single | {begin + each for begin in (50, 4000, 7777) for each in range(37)}


@unittest.skipIf(ABSENT, ABSENT)
class TestRate(unittest.TestCase):
    def test_nothing_is_lost_and_what_is_left_out_is_counted(self):
        missing = left_out()
        whole, twin = Talk(RATE_HZ, COUNT, faster=FASTER, first=FEW), Talk(RATE_HZ, COUNT, missing, faster=FASTER, first=FEW)
        with Browser() as browser, watched(whole) as (server, _), watched(twin) as (twin_server, _):
            pages = [browser.open(each.address) for each in (server, twin_server)]
            for page in pages:
                page.until("tiltPage.figures().firstPictureMs")
            for talk in (whole, twin):
                talk.go_on.set()  # the picture came of the first rows alone
                self.assertTrue(talk.over.wait(DEADLINE_S))
                talk.say("# all sent")
            for page in pages:
                page.until("document.getElementById('log').innerText.includes('# all sent')")  # and with it all rows, none too many
            figures = [page.figures() for page in pages]
        print("rows", [each["rows"] for each in figures], "lost", [each["lost"] for each in figures])
        for each in figures:
            self.assertEqual((each["broken"], each["restarts"]), (0, 0))
        self.assertEqual((figures[0]["rows"], figures[0]["lost"]), (COUNT, 0))
        self.assertEqual((figures[1]["rows"], figures[1]["lost"]), (COUNT - len(missing), len(missing)))
        self.assertGreater(len(missing), 100)

    @unittest.skipUnless(SIMRUN.exists() and FIRMWARE.exists(), "no simrun or firmware built: make build/sim/simrun build/uno/firmware.elf")
    def test_the_firmware_in_the_simulator(self):
        """Over simrun's pseudo terminal, where simulated time waits for a reader that is late; the filter of the real firmware is switched."""
        with contextlib.ExitStack() as stack:
            sim = stack.enter_context(program([SIMRUN, "--fw", FIRMWARE, "--in", STREAM, "--out", os.devnull, "--pty", "--loop", "--max-ms", 6000000,
                                               "--baud", 500000, "--rate", RATE_HZ], stderr=subprocess.PIPE))
            port = re.search(r"/dev/\S+", sim.stderr.readline()).group()
            browser = stack.enter_context(Browser())
            live = stack.enter_context(program([sys.executable, "-m", "tilt", "live", port, "--no-browser", "--baud", 500000],
                                                stdout=subprocess.PIPE))
            page = browser.open(live.stdout.readline().strip())
            page.until("tiltPage.figures().firstPictureMs && tiltPage.figures().filters.length")
            page.until("tiltPage.figures().rate > 390")
            before = page.figures()
            page.value(f"document.querySelector('input[value={LIGHT}]').click()")
            page.until(f"tiltPage.figures().filter === '{LIGHT}'")
            page.until(f"tiltPage.figures().rows > {before['rows'] + 2 * RATE_HZ}")
            after = page.figures()
        print(f"simrun: {after['rows']} rows, {after['rate']:.1f} rows/s")
        self.assertEqual(after["filters"], FIRMWARE.with_name("filters.txt").read_text(encoding="ascii").split())
        self.assertEqual((after["lost"], after["broken"]), (before["lost"], before["broken"]))


@contextlib.contextmanager
def program(words, **pipes):
    environment = {**os.environ, "PYTHONPATH": "tools", "PYTHONDONTWRITEBYTECODE": "1"}
    with subprocess.Popen([str(word) for word in words], text=True, env=environment, **pipes) as running:
        try:
            yield running
        finally:
            running.terminate()


if __name__ == "__main__":
    from unity_line import main
    main()
