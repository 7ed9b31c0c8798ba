#!/usr/bin/env python3
"""docs/live.png: the page of `tilt live` beside the firmware in the simulator, among 15 % outliers, after a sensor was unplugged and came back
(make pictures; 20 s of real time). Run from the repository root."""
import contextlib
import os
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import ROBUST  # noqa: E402
from browser import ABSENT, Browser  # noqa: E402
from test_live_rate import FIRMWARE, SIMRUN, program  # noqa: E402

PICTURE = pathlib.Path("docs/live.png")
STREAM = "sim/streams/outliers-15pct.csv"
UNPLUGGED = "11500ms:unplug:400"
ROWS = 1500


def main():
    if ABSENT:
        sys.exit(f"live_picture: {ABSENT}")
    with contextlib.ExitStack() as stack:
        sim = stack.enter_context(program([SIMRUN, "--fw", FIRMWARE, "--in", STREAM, "--out", os.devnull, "--pty", "--loop", "--max-ms", 60000,
                                           "--fault", UNPLUGGED], stderr=subprocess.PIPE))
        port = re.search(r"/dev/\S+", sim.stderr.readline()).group()
        live = stack.enter_context(program([sys.executable, "-m", "tilt", "live", port, "--no-browser"], stdout=subprocess.PIPE))
        page = stack.enter_context(Browser()).open(live.stdout.readline().strip())
        page.until("tiltPage.figures().filters.length")
        page.value(f"document.querySelector('input[value={ROBUST}]').click()")
        page.until(f"tiltPage.figures().rows >= {ROWS}")
        page.picture(PICTURE)
    print(f"{PICTURE} written")


if __name__ == "__main__":
    main()
