#!/usr/bin/env python3
"""`tilt record --send` by the firmware on the simulator's pseudo terminal, however busy the machine: status 0 only if the board took every command
and the rows have the rate asked for. make loaded ROUNDS=20 ONLY=tilt_record_sent runs it under load. Run from the repository root."""
import contextlib
import io
import os
import pathlib
import statistics
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import InFolder, port_of  # noqa: E402
from tilt import cli  # noqa: E402

SIMRUN, FIRMWARE = "build/sim/simrun", "build/uno/firmware.elf"


@unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), "no simulator or firmware: make system_images")
class Sent(InFolder):
    def recorded(self, *commands):
        """(status, what the command printed, median step of the rows in us) of a recording of a second."""
        command = [SIMRUN, "--fw", FIRMWARE, "--in", "sim/streams/tilt-fast.csv", "--out", str(self.folder / "all.csv"), "--pty", "--loop"]
        out, err, file = io.StringIO(), io.StringIO(), self.folder / "recorded.csv"
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as board:
            try:
                name = port_of(board)
                with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                    status = cli.main(["record", name, "-o", str(file), "--seconds", "2", *(word for text in commands for word in ("--send", text))])
            finally:
                board.terminate()
        times = [int(line.split(",")[0]) for line in file.read_text().splitlines() if line[:1].isdigit()][-50:]
        return status, out.getvalue() + err.getvalue(), statistics.median(b - a for a, b in zip(times, times[1:]))

    def test_status_0_is_the_rate_asked_for(self):
        status, said, step_us = self.recorded("baud 500000", "rate 400")
        print(f"status {status}, {step_us:.0f} us a row", file=sys.stderr)
        if status == 0:
            self.assertNotIn("refused", said)
            self.assertAlmostEqual(step_us, 2500, delta=100, msg=said)
        else:
            self.assertRegex(said, "something is missing|the board (refused|did not answer) '|not sent: '")

    def test_a_refusal_is_never_status_0(self):
        status, said, step_us = self.recorded("rate 90", "every 2")
        self.assertEqual(status, 1, said)
        self.assertRegex(said, "the board (refused 'rate 90': refused 4: rate is one of|did not answer 'rate 90')")
        self.assertGreaterEqual(step_us, 9000, said)


if __name__ == "__main__":
    from unity_line import main
    main()
