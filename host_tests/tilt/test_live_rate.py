"""The numbers of `tilt live`, measured in a headless Chromium at once: a picture within 2 s of connecting; 400 rows a second for 20 s without
a loss; its twin, where a board leaves rows out, has exactly those counted; the firmware itself in simrun. Run from the repository root."""
import contextlib
import os
import pathlib
import random
import re
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, "tools")
from browser import ABSENT, Browser  # noqa: E402
from live_support import Talk, watched  # noqa: E402

RATE_HZ, SECONDS, FIRST_PICTURE_MS = 400, 20, 2000
COUNT = RATE_HZ * SECONDS
SIMRUN, FIRMWARE, STREAM = (pathlib.Path(name) for name in ("build/sim/simrun", "build/uno/robust/firmware.elf", "sim/streams/tilt-400hz.csv"))


def left_out():
    """Rows that the twin does not send: 1 % one by one, and three bursts; never the first or the last, beside which nothing tells a gap."""
    chance = random.Random(11)
    single = {number for number in range(1, COUNT - 1) if chance.random() < 0.01}
    return single | {begin + each for begin in (50, 4000, 7777) for each in range(37)}


@unittest.skipIf(ABSENT, ABSENT)
class TestRate(unittest.TestCase):
    def test_nothing_is_lost_and_what_is_left_out_is_counted(self):
        missing = left_out()
        whole, twin = Talk(RATE_HZ, COUNT), Talk(RATE_HZ, COUNT, missing)
        with Browser() as browser, watched(whole) as (server, _), watched(twin) as (twin_server, _):
            pages = [browser.open(each.address) for each in (server, twin_server)]
            for page in pages:
                page.until("tiltLive.figures().firstPictureMs")
            for talk in (whole, twin):
                self.assertTrue(talk.over.wait(SECONDS + 20))
            for page, count in zip(pages, (COUNT, COUNT - len(missing))):
                page.until(f"tiltLive.figures().rows >= {count}")
            time.sleep(0.3)  # none too many
            figures = [page.figures() for page in pages]
        print("first picture after", [round(each["firstPictureMs"]) for each in figures], "ms of the page; rows", [each["rows"] for each in figures],
              "lost", [each["lost"] for each in figures])
        for each in figures:
            self.assertLessEqual(each["firstPictureMs"], FIRST_PICTURE_MS)  # from the begin of the page's loading
            self.assertEqual((each["broken"], each["restarts"]), (0, 0))
        self.assertEqual((figures[0]["rows"], figures[0]["lost"]), (COUNT, 0))
        self.assertEqual((figures[1]["rows"], figures[1]["lost"]), (COUNT - len(missing), len(missing)))
        self.assertGreater(len(missing), 100)

    @unittest.skipUnless(SIMRUN.exists() and FIRMWARE.exists(), "no simrun or firmware built: make build/sim/simrun build/uno/robust/firmware.elf")
    def test_the_firmware_in_the_simulator(self):
        """From the start of the command to the picture, over simrun's pseudo terminal; the filter of the real firmware is switched."""
        with contextlib.ExitStack() as stack:
            sim = stack.enter_context(program([SIMRUN, "--fw", FIRMWARE, "--in", STREAM, "--out", os.devnull, "--pty", "--loop", "--max-ms", 60000,
                                               "--baud", 500000, "--rate", RATE_HZ], stderr=subprocess.PIPE))
            port = re.search(r"/dev/\S+", sim.stderr.readline()).group()
            browser = stack.enter_context(Browser())
            browser.call("Target.getTargets")
            began = time.monotonic()
            live = stack.enter_context(program([sys.executable, "-m", "tilt", "live", port, "--no-browser", "--baud", 500000],
                                                stdout=subprocess.PIPE))
            page = browser.open(live.stdout.readline().strip())
            page.until("tiltLive.figures().firstPictureMs && tiltLive.figures().filters.length")
            took_s = time.monotonic() - began
            page.until("tiltLive.figures().rate > 390", 15)
            before = page.figures()
            page.value("document.querySelector('input[value=kf]').click()")
            page.until("tiltLive.figures().filter === 'kf'")
            page.until(f"tiltLive.figures().rows > {before['rows'] + 2 * RATE_HZ}")
            after = page.figures()
        print(f"simrun: picture and filters {took_s:.2f} s after the command was started, {after['rate']:.1f} rows/s")
        self.assertLessEqual(before["firstPictureMs"], FIRST_PICTURE_MS)
        self.assertEqual(after["filters"], FIRMWARE.with_name("filters.txt").read_text(encoding="ascii").split())
        # simrun does not wait for a reader that a loaded machine keeps from running, as a board would not: its terminal holds 0.15 s
        self.assertLessEqual(after["lost"] + after["broken"] - before["lost"] - before["broken"], 2 * RATE_HZ // 100)


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
