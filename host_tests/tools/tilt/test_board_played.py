#!/usr/bin/env python3
"""The twenty checks of `tilt board` with the firmware itself in the simulator: hands pull the cable, and begin a fault of simrun for each deed.
What no simulator has: nobody looks at the LED, no baud rate is ever wrong."""
import contextlib
import io
import json
import os
import pathlib
import random
import sys
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from board_support import FIRMWARE, SIMRUN, Cable, Hands, Simulated, faults  # noqa: E402
from tilt_case import InFolder  # noqa: E402
from tilt import cli  # noqa: E402
from tilt.realboard import judges_alone, judges_starts, judges_wires, owner, watch  # noqa: E402
from tilt.realboard.checks import CHECKS  # noqa: E402

REST = "sim/streams/rest-2lsb.csv"
# shorter; longer or wider where simulated time may wait for a PC that is busy
SHORTER = ((judges_alone, "RATE_S", 3.0), (judges_alone, "CLOCK_PPM", 10**6), (judges_alone, "FAST_S", 2.0), (judges_alone, "BAUD_S", 0.8),
           (judges_alone, "BAUD_ROWS", 3), (judges_wires, "INT1_S", 1.0), (judges_wires, "FINGER_S", 1.5), (judges_starts, "KEPT_OFF_S", 0.5),
           (judges_starts, "SAVED_S", 60.0), (watch, "EDGE_S", 0.2), (watch, "HEARD_SHARE", 0.1), (watch, "QUIET_S", 0.6), (watch, "STRETCH_S", 0.6))
PLAYED = set()


def stream(path, parts):
    """A stream at 100 Hz of parts (seconds, x, y, z, noise in LSB)."""
    chance, lines, n = random.Random(1), ["t_us,x,y,z"], 0
    for seconds, *lsb, noise in parts:
        for n in range(n + 1, n + 1 + round(seconds * 100)):
            lines.append(",".join(map(str, (n * 10_000, *(max(-4096, min(4095, round(chance.gauss(each, noise)))) for each in lsb)))))
    path.write_text("\n".join(lines) + "\n")
    return path


@unittest.skipUnless(os.path.exists(SIMRUN) and os.path.exists(FIRMWARE), "no simulator or firmware: make system_images")
class Played(InFolder):
    def setUp(self):
        super().setUp()
        self.record = self.folder / "board.jsonl"

    @contextlib.contextmanager
    def board(self, stream_path, *options):
        with Cable(self.folder) as self.cable:
            self.cable.lead_to(Simulated(self.folder, stream_path, *(options or faults())))
            yield self.cable

    def press(self):
        self.cable.board.press()

    def checks(self, keys, deeds=None, *words):
        """key -> line of the record; all must have passed."""
        hands = Hands(deeds or {}, first={"reset_typing"})
        out, err = io.StringIO(), io.StringIO()
        with contextlib.ExitStack() as stack:
            for module, name, value in SHORTER:
                stack.enter_context(mock.patch.object(module, name, value))
            stack.enter_context(mock.patch.object(owner, "Owner", lambda: hands))
            stack.enter_context(contextlib.redirect_stdout(out))
            stack.enter_context(contextlib.redirect_stderr(err))
            status = cli.main(["board", self.cable.name, "--only", ",".join(keys), *(words or ("-o", str(self.record)))])
        text = "\n".join(hands.said) + out.getvalue() + err.getvalue()
        lines = [json.loads(line) for line in self.record.read_text().splitlines()] if self.record.exists() else []
        found = {line["key"]: line for line in lines if line["kind"] == "check"}
        for key in keys:
            self.assertEqual(found.get(key, {}).get("verdict"), "pass", text)
        self.assertEqual(status, 0, text)
        PLAYED.update(keys)
        return found

    def test_alone(self):
        with self.board(REST):
            found = self.checks(["identity", "rate", "selftest", "fast_bus", "baud_rates"])
        self.assertIn("0.1.0", found["identity"]["numbers"]["version"])
        self.assertAlmostEqual(found["rate"]["numbers"]["rate_hz"], 100, delta=1)
        self.assertEqual(found["selftest"]["numbers"]["z_says"], "pass")
        self.assertEqual(found["fast_bus"]["numbers"]["khz"], 400.0)
        self.assertGreater(found["baud_rates"]["numbers"]["rows_at_1000000"], 2)

    def test_motion_in_one_record(self):
        faces = [(1.8, *(sign * g if axis == each else 0 for each, g in enumerate((265, 265, 256))), 1) for axis in range(3) for sign in (1, -1)]
        with self.board(stream(self.folder / "faces.csv", faces)):
            found = self.checks(["six_faces"])
        self.assertEqual({key for key in found["six_faces"]["numbers"]}, {f"{sign}{axis}_mg" for axis in "xyz" for sign in "+-"})
        with self.board(stream(self.folder / "shaken.csv", [(3, 0, 0, 256, 1), (1.5, 0, 0, 256, 120), (2.5, 0, 0, 256, 1)])):
            found = self.checks(["shake"], {}, "--resume", str(self.record))
        self.assertIn("six_faces", found)

    def test_wires(self):
        # a finger on an open wire: INT1 does not come through, hum does
        kinds = {"int1_wire": "noint:3000", "int1_finger": "noint:3500 storm:300:3000", "sda_pulled": "unplug:800", "scl_pulled": "scl:800",
                 "sda_short": "sda:800", "scl_short": "scl:800", "sensor_power": "power:800"}
        with self.board(REST, *faults(*kinds.values())):
            found = self.checks(list(kinds), {key: [self.press] for key in kinds})
        told = {key: line["numbers"]["fault"] for key, line in found.items()}
        self.assertEqual((told["sda_pulled"], told["sda_short"], told["scl_short"]), (1, 8, 7), told)
        self.assertGreater(found["sda_short"]["numbers"]["samples_lost"], 50)

    def test_resets(self):
        """The second one comes as the last byte of half a command has been received."""
        at, half = 500, len(judges_starts.TYPED)
        with self.board(REST, *faults("reset"), "--fault", f"pc:{Simulated.BYTE}#{at}:reset"):
            found = self.checks(["reset_button", "reset_typing"], {
                "reset_button": [self.press], "reset_typing": [lambda: self.cable.board.fill(at - half)]})
        self.assertEqual(found["reset_button"]["numbers"]["cause"], "reset button or serial port opened")
        self.assertIn("# refused 1: unknown command", "\n".join(found["reset_typing"]["lines"]))

    def pull_the_plug(self):
        """The board loses its supply with the port."""
        self.cable.unplug()
        self.press()
        time.sleep(1.0)
        self.cable.plug()

    def wait_for_the_cut(self):
        """The supply goes in the middle of a save, and with it the port."""
        self.cable.unplug_on(b"# reset: power on")
        self.cable.unplugged()
        self.cable.plug()

    def test_supply(self):
        options = faults("mcupower", "reset", "reset", "mcupower", "reset")
        with self.board(REST, *options, "--fault", "eeprom:150:mcupower:random"):
            found = self.checks(["power_second", "eeprom_cut", "kept"], {
                "power_second": [self.pull_the_plug], "eeprom_cut": [self.wait_for_the_cut], "kept": [lambda: None, self.pull_the_plug]})
        self.assertGreater(found["eeprom_cut"]["numbers"]["saves"], 1)
        self.assertIn("as saved", found["eeprom_cut"]["numbers"]["settings"])
        self.assertEqual(found["kept"]["numbers"]["every"], "7")

    def restart_with(self, *options):
        """D4 cannot be connected within a run: the next one begins with the EEPROM of this one."""
        with self.cable.lock:
            self.cable.lead_to(None)
            self.cable.lead_to(Simulated(self.folder, REST, *faults(), *options))
            self.press()  # resets it

    def test_strap(self):
        with self.board(REST):
            found = self.checks(["strap"], {"strap": [lambda: self.restart_with("--strap"), self.restart_with]})
        self.assertEqual(found["strap"]["numbers"]["with_d4"], "defaults, saved ones not read")

    @classmethod
    def tearDownClass(cls):
        left = [check.key for check in CHECKS if check.key not in PLAYED]
        print("not played here:", *left or ["none"])


if __name__ == "__main__":
    from unity_line import main
    main()
