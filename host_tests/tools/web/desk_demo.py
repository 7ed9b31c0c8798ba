#!/usr/bin/env python3
"""What the clock says of the demo (make desk, on an idle machine; no part of make test): a picture within 2 s of loading, 60 s of 100 rows a second
at the pace of the clock without a lost row, the worker on at most half of a core; then 400 rows a second. Run from the repository root."""
import os
import pathlib
import sys
import time
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from demo_support import WHY_NOT, DemoCase  # noqa: E402

FIRST_PICTURE_MS, SECONDS, MOST_OF_A_CORE = 2000, 60, 0.5
TICKS = os.sysconf("SC_CLK_TCK")


def worker_s():
    """Processor seconds of all threads that run a Web Worker."""
    total = 0
    for name in pathlib.Path("/proc").glob("[0-9]*/task/*/comm"):
        try:
            if name.read_text(encoding="ascii", errors="replace").startswith("DedicatedWorker"):
                fields = name.with_name("stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
                total += (int(fields[11]) + int(fields[12])) / TICKS
        except OSError:
            continue  # the thread has ended
    return total


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestClock(DemoCase):
    def paced(self, page, seconds):
        """(rows a second, pace, share of a core) over so many seconds by this machine's clock."""
        clock = "[performance.now(), tiltPage.figures().rows, tiltPage.protocol.losses.last.t_us, tiltPage.figures().lost]"
        begin, used = page.value(clock), worker_s()
        time.sleep(seconds)
        end, used = page.value(clock), worker_s() - used
        passed_s = (end[0] - begin[0]) / 1000
        self.assertEqual((end[3], page.figures()["broken"]), (0, 0))
        return (end[1] - begin[1]) / passed_s, (end[2] - begin[2]) / 1e6 / passed_s, used / passed_s

    def test_a_minute_in_real_time(self):
        page = self.demo()
        first = page.until("tiltPage.figures().firstPictureMs")
        page.until("tiltPage.figures().rows >= 300")
        rate, pace, share = self.paced(page, SECONDS)
        print(f"first picture {first:.0f} ms after loading began; {SECONDS} s: {rate:.1f} rows/s, {pace:.3f} x real time, {share:.0%} of a core")
        self.assertLessEqual(first, FIRST_PICTURE_MS)
        self.assertAlmostEqual(pace, 1, delta=0.005)
        self.assertLessEqual(share, MOST_OF_A_CORE)

    def test_400_rows_a_second(self):
        page = self.demo()
        for command, answer in (("stop", "# stopped"), ("baud 500000", "# baud 500000"), ("rate 400", "# rate 400"), ("go", "# going")):
            page.value(f"tiltPage.send('{command}')")
            page.until(f"heard.text.includes('{answer}')")
        page.until("tiltPage.figures().rate > 390")
        rate, pace, share = self.paced(page, 20)
        print(f"400 Hz: {rate:.1f} rows/s, {pace:.3f} x real time, {share:.0%} of a core")
        self.assertAlmostEqual(pace, 1, delta=0.005)


if __name__ == "__main__":
    from unity_line import main
    main()
