#!/usr/bin/env python3
"""Tests of `tilt replay`: its rows are those of the firmware, which is run natively (build/host/native_replay, made here when it is missing) and,
where it is built, in the simulator."""
import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, LIGHT, PLAIN, ROBUST, SLOWEST  # noqa: E402
import images  # noqa: E402
from tilt_case import InFolder, run_tilt  # noqa: E402
from tilt import cli, errors, native, stream  # noqa: E402
from tilt.commands import replay as command  # noqa: E402

SHIPPED = sorted(pathlib.Path("sim/streams").glob("*.csv"))
FIRMWARE = "build/host/native_replay"
SIMRUN = pathlib.Path("build/sim/simrun")
HEADER = "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags"
COASTED, CLIPPED, FAULT, STUCK, INTEGRITY = 2, 8, 16, 32, 64


def columns(rows):
    """Everything of a row but its time."""
    return np.column_stack([rows["lsb"], rows["mg"], rows["roll_cdeg"], rows["pitch_cdeg"], rows["flags"]]).astype(np.int64)


def read_rows(path):
    """[t_us, ...] of what the firmware sent."""
    lines = [line for line in pathlib.Path(path).read_text(encoding="ascii").splitlines() if line[:1].isdigit()]
    whole = [line for line in lines if line.count(",") == HEADER.count(",")]
    return np.array([line.split(",") for line in whole], np.int64)


class Case(InFolder):
    @classmethod
    def setUpClass(cls):
        subprocess.run(["make", "-s", FIRMWARE], check=True)

    def firmware(self, path, name, *options):
        subprocess.run([FIRMWARE, "--in", path, "--out", self.folder / "fw.csv", "--served", self.folder / "served.csv", "--filter", name, *options],
                       check=True)
        return read_rows(self.folder / "fw.csv")

    def assert_same(self, sent, rows, message):
        """The firmware goes on for 300 ms after the end of a stream, with predictions."""
        own = columns(rows)
        self.assertGreaterEqual(len(sent), len(own), message)
        differ = np.flatnonzero(np.any(sent[:len(own), 1:] != own, axis=1))
        if len(differ):
            self.fail(f"{message}: row {differ[0]} of {len(own)}: firmware {sent[differ[0], 1:]}, replay {own[differ[0]]}")

    def made(self, lsb, flags=None, step_us=10000, t_us=None):
        path = self.folder / "made.csv"
        stream.write(path, np.arange(len(lsb)) * step_us if t_us is None else t_us, lsb, flags=flags)
        return path


class EqualsFirmware(Case):
    def test_every_shipped_stream_and_every_filter(self):
        """That at 400 Hz is sampled at 100 Hz here. That with gaps has silences that restart the sensor: see below."""
        compared = 0
        for path in SHIPPED:
            tables = native.replay(stream.read(path), native.filters(), 1000)
            for name, rows in tables.items():
                sent = self.firmware(path, name)
                silent = np.flatnonzero(rows["flags"] & FAULT)
                end = silent[0] if len(silent) else len(rows)
                self.assert_same(sent, rows[:end], f"{path.stem} {name}")
                compared += end
        # 86,031 rows (sim/streams/README.md); of the 4,000 at 400 Hz, 10 s, 1,000; of gaps-jitter those before the first silence, 300 at least
        self.assertGreater(compared, 13 * (86031 - 5531 - 4000 + 1000 + 300) - 1)

    def test_a_silence_leaves_the_filters_as_it_leaves_the_boards(self):
        """Which sample a restarted sensor meets first is a matter of microseconds, so the replay gets what was served. Now and then the silence
        has a row more or less then: compared up to there, and ten silences at least."""
        for name in native.filters():
            sent = self.firmware(SHIPPED[[path.stem for path in SHIPPED].index("gaps-jitter")], name)
            rows = native.replay(stream.read(self.folder / "served.csv"), [name], 1000)[name]
            length = min(len(sent), len(rows))
            differ = np.flatnonzero((sent[:length, 9] ^ rows["flags"][:length]) & COASTED)
            end = differ[0] if len(differ) else length
            self.assert_same(sent, rows[:end], name)
            silences = np.flatnonzero(np.diff((rows["flags"][:end] & FAULT).astype(int)) > 0)
            self.assertGreater(len(silences), 9, name)

    def from_cold_start(self, path, name, *commands):
        """(rows that the firmware sends after `stop`, these commands and `go`, file of what the sensor served from there on)"""
        typed = [f"{200 + 50 * i}:{text}" for i, text in enumerate(("stop", *commands, "go"))]
        sent = self.firmware(path, name, *(word for text in typed for word in ("--cmd", text)), "--max-ms", "6000", "--loop")
        skip = np.flatnonzero(np.diff(sent[:, 0]) > 100_000)[0] + 1
        lines = (self.folder / "served.csv").read_text(encoding="ascii").splitlines()
        served = [line for line in lines[1:] if int(line.split(",")[1]) >= sent[skip, 0] - 1000]
        (self.folder / "tail.csv").write_text("\n".join([lines[0], *served]) + "\n", encoding="ascii")
        return sent[skip:], self.folder / "tail.csv"

    def test_at_400_hz(self):
        for name in (DEFAULT, ROBUST, SLOWEST):
            sent, tail = self.from_cold_start("sim/streams/tilt-400hz.csv", name, "baud 500000", "rate 400")
            rows = native.replay(stream.read(tail), [name], 4000)[name]
            length = min(len(rows), len(sent))
            self.assertGreater(length, 2000)  # 5.5 s of 400 Hz, the last row cut by the end of the run
            self.assert_same(sent, rows[:length], name)

    def test_at_the_rails_of_2_g(self):
        for name in (DEFAULT, ROBUST, SLOWEST):
            sent, tail = self.from_cold_start("sim/streams/clipping.csv", name, "range 2")
            rows = native.replay(stream.read(tail), [name], 1000, 2)[name]
            length = min(len(rows), len(sent))
            self.assert_same(sent, rows[:length], name)
            self.assertGreater(int(((rows["flags"] & CLIPPED) != 0).sum()), 4)  # a shock of 20 ms at least each 3 s

    @unittest.skipUnless(SIMRUN.exists() and all(pathlib.Path(image).exists() for image in images.SET_IMAGES),
                         "the simulator is not built: make system_images")
    def test_the_chip(self):
        for stem, name in (("outliers-15pct", DEFAULT), ("bad-reads", ROBUST), ("clipping", PLAIN), ("through-roll-180", LIGHT)):
            out = self.folder / "chip.csv"
            subprocess.run([SIMRUN, "--fw", images.image_with(name), "--in", f"sim/streams/{stem}.csv", "--out", out, "--filter", name], check=True,
                           capture_output=True)
            sent = read_rows(out)
            rows = native.replay(stream.read(f"sim/streams/{stem}.csv"), [name], 1000)[name]
            self.assertGreaterEqual(len(sent), len(rows) - 2)  # the simulator ends some ms after the stream
            self.assert_same(sent, rows[:len(sent)], f"{stem} {name}")

    def test_readings_that_repeat_fail_and_clip(self):
        rng = np.random.default_rng(5)
        lsb = np.round(rng.normal([40, -60, 240], 2.5, (900, 3))).astype(int)
        lsb[0] = lsb[200] = -1                      # nobody there
        lsb[203] = [-1, -1, 5]                      # a reading like others
        lsb[300:318] = lsb[300]                     # 18 equal ones on end: from the tenth on they count as stuck
        lsb[400:403] = [4095, -4096, 240]
        lsb[500:530] = [0, 0, 0]
        path = self.made(lsb)
        for name in native.filters():
            rows = native.replay(stream.read(path), [name], 1000)[name]
            self.assert_same(self.firmware(path, name), rows, name)
        self.assertEqual(np.flatnonzero(rows["flags"] & STUCK).tolist(), [*range(308, 317), *range(508, 529)])  # 899 rows: the first made none
        self.assertEqual(np.flatnonzero(rows["flags"] & INTEGRITY).tolist(), [0, 199])
        self.assertEqual((np.flatnonzero(rows["flags"] & COASTED).tolist(), rows["source"][199], rows["source"][200]), ([199], -1, 201))
        self.assertEqual(np.flatnonzero(rows["flags"] & CLIPPED).tolist(), [399, 400, 401])

    def test_two_samples_missing_are_predicted(self):
        rng = np.random.default_rng(6)
        lsb = np.round(rng.normal([0, 0, 256], 2, (400, 3))).astype(int)
        flags = np.zeros(400, int)
        flags[[50, 51, 90]] = [2, 18, 16]
        keep = np.delete(np.arange(400), [200, 201, 300])  # and there without a row
        path = self.made(lsb[keep], flags[keep], t_us=keep * 10000)
        rows = native.replay(stream.read(path), [ROBUST], 1000)[ROBUST]
        self.assert_same(self.firmware(path, ROBUST), rows, ROBUST)
        self.assertEqual(np.flatnonzero(rows["flags"] & COASTED).tolist(), [50, 51, 90, 200, 201, 300])
        self.assertEqual(rows["t_us"].tolist(), [10000 * i for i in range(400)])

    def test_a_smaller_range_clips(self):
        lsb = np.tile([[0, 0, 256], [1, 0, 600], [0, 1, -600]], (40, 1))
        path = self.made(lsb)
        rows = native.replay(stream.read(path), [PLAIN], 1000, 2)[PLAIN]
        self.assertEqual(rows["lsb"][:, 2].tolist(), [256, 511, -512] * 40)
        self.assertEqual((rows["flags"] & CLIPPED != 0).tolist(), [False, True, True] * 40)


class Itself(Case):
    def test_filters_do_not_know_of_each_other(self):
        given = stream.read("sim/streams/steps-outliers.csv")
        together = native.replay(given, native.filters(), 1000)
        with mock.patch.object(native, "FORK_FROM_ROWS", 1):
            shared = native.replay(given, native.filters(), 1000)
        for name in reversed(native.filters()):
            alone = native.replay(given, [name], 1000)[name]
            np.testing.assert_array_equal(alone, together[name])
            np.testing.assert_array_equal(alone, shared[name])
        self.assertTrue(np.any(together[PLAIN]["mg"] != together[ROBUST]["mg"]))

    def test_times_are_those_of_the_recording(self):
        """At 97 Hz, which a sensor at 100 Hz takes as a row a tick; 50 rows are missing. Time goes on throughout."""
        keep = np.delete(np.arange(600), np.arange(300, 350))
        path = self.made(np.tile([3, 4, 250], (550, 1)) + keep[:, None] % 3, t_us=7_000_000_000 + keep * 10309)
        given = stream.read(path)
        rows = native.replay(given, [DEFAULT], 1000)[DEFAULT]
        taken = rows["source"] >= 0
        self.assertEqual(rows["t_us"][taken].tolist(), (keep * 10309).tolist())
        self.assertEqual(rows["t_us"].tolist(), (np.arange(600) * 10309).tolist())

    def test_a_night_of_silence(self):
        """8 h without a sample: a row each tick for a second, then ten a second."""
        at = np.arange(200)
        path = self.made(np.tile([0, 1, 256], (200, 1)) + at[:, None] % 2, t_us=at * 10000 + (at >= 100) * 28_800_000_000)
        rows = native.replay(stream.read(path), [PLAIN], 1000)[PLAIN]
        silent = int(((rows["flags"] & COASTED) != 0).sum())
        # ticks 1..101 (100 ms more than a second: the long step follows the row that finds it long), then each 10th of 2,880,000
        self.assertAlmostEqual(silent, 100 + 2_879_900 / 10, delta=3)
        self.assertTrue(np.all(np.diff(rows["t_us"]) > 0))


class Command(Case):
    def run_it(self, *words):
        return run_tilt("replay", *words)

    def test_one_filter_has_the_columns_of_the_firmware_and_its_output_is_a_stream(self):
        out = self.folder / "out.csv"
        status, said, _ = self.run_it("sim/streams/gaps-jitter.csv", "--filter", ROBUST, "-o", out)
        self.assertEqual(status, 0)
        self.assertTrue(out.read_text(encoding="ascii").startswith(HEADER + ",roll_true_cdeg,pitch_true_cdeg\n"))
        self.assertRegex(said, r"1 filter in [0-9.]+ s, reading included: [0-9,]+ times real time\n")
        again = stream.read(out, ["roll_cdeg"])
        rows = native.replay(stream.read("sim/streams/gaps-jitter.csv"), [ROBUST], 1000)[ROBUST]
        np.testing.assert_array_equal(again.columns["roll_cdeg"], rows["roll_cdeg"])
        np.testing.assert_array_equal(again.missing, (rows["flags"] & (COASTED | FAULT)) != 0)
        np.testing.assert_array_equal(again.t_us, rows["t_us"])
        given = stream.read("sim/streams/gaps-jitter.csv")
        np.testing.assert_array_equal(again.roll_true_cdeg[~again.missing], given.roll_true_cdeg)

    def test_several_have_columns_each_and_flags_in_common(self):
        out = self.folder / "out.csv"
        status, said, _ = self.run_it("sim/streams/outliers-15pct.csv", "--filter", f"{PLAIN},{ROBUST}", "--rate", "100", "-o", out)
        self.assertEqual(status, 0)
        self.assertIn(f"{out}: 6000 rows written", said)
        again = stream.read(out, [f"x_mg_{PLAIN}", f"flags_{ROBUST}", f"flags_{PLAIN}"])
        self.assertFalse(np.any(again.columns[f"flags_{PLAIN}"] & 1))
        self.assertTrue(np.any(again.columns[f"flags_{ROBUST}"] & 1))
        np.testing.assert_array_equal(again.flags, again.columns[f"flags_{PLAIN}"] & again.columns[f"flags_{ROBUST}"])
        self.assertIn("times real time", said)

    def test_what_cannot_be_is_told(self):
        good = "sim/streams/steps.csv"
        dead = self.made(np.full((20, 3), -1))
        for words, said in (([good, "--filter", f"{PLAIN},kx"], f"--filter: no filter 'kx': choose from {DEFAULT} {PLAIN} "),
                            ([good, "--filter", f"{PLAIN},{PLAIN}"], f"--filter: {PLAIN} is given twice: give it once"),
                            ([good, "--rate", "101"], "tilt replay: rate 101: choose from 12.5 25 50 "),
                            ([dead], "made.csv: no usable row: every row is missing or reads -1,-1,-1"),
                            (["absent.csv"], "absent.csv: cannot be read: ")):
            status, out, err = self.run_it(*words)
            self.assertEqual((status, out), (2, ""))
            self.assertIn(said, err)

    def test_the_recording_is_never_replaced(self):
        """Nor by another name of it: it holds what the rows do not, as the board's words."""
        mine, other = self.folder / "mine.csv", self.folder / "other.csv"
        mine.write_text("# a word of the board\nt_us,x,y,z\n" + "".join(f"{10000 * n},1,2,256\n" for n in range(30)), encoding="ascii")
        other.symlink_to(mine)
        before = mine.read_bytes()
        for out in (mine, other):
            err = io.StringIO()
            with contextlib.redirect_stderr(err):
                self.assertEqual(cli.main(["replay", str(mine), "--filter", PLAIN, "-o", str(out)]), 2)
            self.assertIn("would replace the recording", err.getvalue())
            self.assertEqual(mine.read_bytes(), before)

    def test_one_row_has_no_rate(self):
        path = self.made(np.array([[0, 0, 256]]))
        self.assertIn("all rows have the same time", self.run_it(path)[2])
        self.assertEqual(self.run_it(path, "--rate", "50", "--filter", PLAIN)[0], 0)


class Library(unittest.TestCase):
    def test_without_make_or_compiler_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            with mock.patch.dict(os.environ, {"PATH": folder}), self.assertRaisesRegex(errors.TiltError, "cannot run make"):
                native.library(root)
            (root / "Makefile").write_text("build/host/libtilt.so:\n\t@no-such-compiler -o $@\n", encoding="ascii")
            with self.assertRaisesRegex(errors.TiltError, r"make could not build .*libtilt.so: .*no-such-compiler: .*install the compiler"):
                native.library(root)

    def test_it_is_built_again_when_a_source_is_newer(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "build/host").mkdir(parents=True)
            (root / native.LIBRARY).touch()
            (root / "firmware/path").mkdir(parents=True)
            (root / "firmware/path/pipeline.c").touch()
            os.utime(root / native.LIBRARY, (2000, 2000))
            for at, stale in ((1000, False), (3000, True)):
                os.utime(root / "firmware/path/pipeline.c", (at, at))
                self.assertEqual(native._stale(root), stale)

    def test_what_is_watched_is_what_make_builds_it_from(self):
        with open("tools/tilt/tilt.mk", encoding="ascii") as file:
            self.assertIn("$(wildcard host_tests/tools/libtilt/*.c) $(HOST_SRC)", file.read())
        listed = subprocess.run(["make", "-n", "-B", str(native.LIBRARY)], capture_output=True, text=True, check=True).stdout
        watched = {str(path.relative_to(native.ROOT)) for pattern in native.SOURCES for path in native.ROOT.glob(pattern)}
        sources = set(re.findall(r"\S+\.c\b", listed))
        self.assertGreater(len(sources), 50)
        self.assertEqual(sources - watched, set())

    def test_parameters_are_those_of_the_descriptors(self):
        q, gate = (native.parameters(ROBUST, 1000)[name] for name in ("q", "gate"))
        self.assertEqual((q.unit, q.low, q.high, q.default, q.step), ("LSB2/s3", 1, 1e9, 10000, 1))  # parameters.c
        self.assertEqual((gate.unit, gate.low, gate.high, gate.default, gate.text(3.5), gate.text(2.999)), ("sigma", 1, 16, 3, "3.5", "3"))
        self.assertEqual((q.text(1234.4), q.text(0)), ("1234", "1"))

    def test_parameters_that_a_filter_refuses(self):
        with self.assertRaisesRegex(errors.TiltError, f"{ROBUST} rejects its parameters: the values contradict each other"):
            native.axis(ROBUST, 1000, [0], [1], {"reacquire": 4})

    def test_command_summary_counts(self):
        rows = np.zeros(4, native.ROW)
        rows["flags"] = [1, 1 | 4, 2, 0]
        given = stream.read("sim/streams/steps.csv")
        self.assertRegex(command.summary(given, {PLAIN: rows}, 1000)[2], fr"^{PLAIN} +4 +50\.00 +1 +25\.00 +0\.00 +0\.00$")


if __name__ == "__main__":
    from unity_line import main
    main()
