#!/usr/bin/env python3
"""Our own streams and what the firmware sends come through `tilt import` as they are: the shipped streams, the firmware in the simulator, and real
recordings (RECORDINGS=folder, else ../shared/streams)."""
import csv
import os
import pathlib
import subprocess
import sys
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import LSB, Case, every
from tilt.importing import source, text  # found by import_support

SIMRUN, FIRMWARE = pathlib.Path("build/sim/simrun"), pathlib.Path("build/uno/firmware.elf")
SHIPPED = sorted(pathlib.Path("sim/streams").glob("*.csv"))
RECORDINGS = pathlib.Path(os.environ.get("RECORDINGS", "../shared/streams"))
NO_RECORDINGS = "no ../shared/streams (RECORDINGS=folder)"
MISSING = 2 | 16
NAMES = {"x": ("x", "x_lsb"), "y": ("y", "y_lsb"), "z": ("z", "z_lsb")}


def stream_rows(path, *extra):
    """[(t_us, x, y, z, extra...)] of a stream, by the csv module alone."""
    lines = [line for line in path.read_text(encoding="ascii").splitlines() if line and line[0] != "#"]
    rows = list(csv.DictReader(lines))
    axes = [next(name for name in NAMES[axis] if name in rows[0]) for axis in "xyz"]
    return [tuple(int(row[name]) for name in ("t_us", *axes, *extra)) for row in rows]


class Shipped(Case):
    def test_every_row_stays_as_it_is(self):
        self.assertGreater(len(SHIPPED), 10)
        for path in SHIPPED:
            with self.subTest(path.name):
                status, said = self.run_tilt(path, "-o", self.out)
                self.assertEqual(status, 0, said)
                header, rows = self.rows()
                self.assertEqual(header, "t_us,x,y,z,roll_true_cdeg,pitch_true_cdeg")
                self.assertEqual(rows, stream_rows(path, "roll_true_cdeg", "pitch_true_cdeg"))


class Own(Case):
    """Rules of docs/protocol.md, Streams."""

    def test_times_stay_and_wraps_are_undone(self):
        start = 2 ** 32 - 300000
        content = "t_us,x_lsb,y_lsb,z_lsb,flags\n" + "".join(f"{(start + 10000 * i) % 2 ** 32},{x},{y},{z},{16 * (i % 2)}\n"
                                                         for i, (x, y, z) in enumerate(LSB))
        status, said = self.run_tilt(self.file(content), "-o", self.out)
        self.assertEqual(status, 0, said)
        self.assertEqual(self.rows(), ("t_us,x,y,z,flags", [(start + 10000 * i, *LSB[i], 16 * (i % 2)) for i in range(60)]))
        self.assertIn("30 rows are flagged as missing samples by the file", said)

    def test_counts_are_taken_where_mg_stand_beside_them(self):
        rows = "".join(f"{10000 * i},7,8,900,{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
        self.gives("# banner\nt_us,x_mg,y_mg,z_mg,x_lsb,y_lsb,z_lsb\n" + rows, LSB, every(10000))

    def test_a_header_again_begins_a_segment_a_period_later(self):
        head = "t_us,x,y,z\n"
        rows = [f"{10000 * i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB)]
        again = [f"{7 + 10000 * i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB)]
        self.gives(head + "".join(rows[:20]) + "# reset: watchdog\n" + head + "".join(again[:40]), LSB[:20] + LSB[:40], every(10000))

    def test_a_step_back_is_no_wrap(self):
        content = "t_us,x,y,z\n5000000,1,2,3\n4000000,1,2,3\n"
        self.refused(content, "time goes backwards: 4000000 after 5000000", line=3)

    def test_a_log_that_begins_among_the_rows(self):
        rows = [f"{i * 10000 + 5},{x},{y},{z},1,2,1000,0,0,0\n" for i, (x, y, z) in enumerate(LSB)]
        self.gives("".join(rows), LSB, every(10000))

    def test_blocks_and_lines_give_the_same(self):
        """The quick reader of whole blocks against the one of lines, with blocks of every size around a line."""
        table = "#time,accel_x,accel_y,accel_z\n" + "".join(f"{100 + i * 0.01:.6f},{x * 39.2266:.6f},{y * 39.2266:.6f},{z * 39.2266:.6f}\n"
                                                            for i, (x, y, z) in enumerate(LSB))
        not_by_lines = mock.patch.object(text.Reader, "slow", side_effect=AssertionError("quick is enough"))
        with mock.patch.object(text, "QUICK_BYTES", 0), not_by_lines:
            self.gives(table, LSB, every(10000))
        with mock.patch.object(text.Reader, "quick", side_effect=AssertionError("small")):
            self.gives(table, LSB, every(10000))
        for size in range(200, 280, 3):  # the first block must hold rows
            with mock.patch.object(text, "QUICK_BYTES", 100), mock.patch.object(source, "BLOCK_BYTES", size):
                self.gives(table, LSB, every(10000))
        with mock.patch.object(source, "BLOCK_BYTES", 200), mock.patch.object(text, "QUICK_BYTES", 0):
            self.refused(table.replace("100.410000,", "100.410000,,"), "5 fields where the header has 4", line=43)


class Quick(Case):
    """Faults in blocks that are read at one go have their lines all the same."""

    def test_faults(self):
        rows = [f"{10 * i},{x},{y},{z}" for i, (x, y, z) in enumerate(LSB)]
        cases = ((20, "200,1,2,9999", "1, 2, 9999 LSB by raw of 1 per LSB: outside an ADXL345's -4096..4095"),
                 (20, "189,1,2,3", "time goes backwards: 189 after 190"), (20, "200,1,2,3x", "not a number: '3x'"),
                 (20, "200,1,inf,3", "not a number: 'inf'"), (20, ",1,2,3", "not a number: ''"), (20, "nan,1,2,3", "not a number: 'nan'"),
                 (20, "200,1,2", "3 fields where the header has 4"))
        for place, bad, reason in cases:
            with mock.patch.object(text, "QUICK_BYTES", 0):
                self.refused("\n".join(["t_ms,x,y,z", *rows[:place], bad, *rows[place + 1:]]) + "\n", reason, line=place + 2)

    def test_a_row_too_short_and_one_too_long(self):
        rows = [f"{10 * i},{x},{y},{z}" for i, (x, y, z) in enumerate(LSB)]
        for short, long in ((20, 30), (30, 20), (1, 0), (58, 59)):
            spoilt = list(rows)
            spoilt[short], spoilt[long] = f"{10 * short},1,2", f"{10 * long},1,2,3,4"
            first = min(short, long)
            with mock.patch.object(text, "QUICK_BYTES", 0):
                self.refused("\n".join(["t_ms,x,y,z", *spoilt]) + "\n", f"{3 if first == short else 5} fields where the header has 4", line=first + 2)

    def test_a_missing_reading(self):
        rows = [f"{10 * i},{x},{y},{z}" for i, (x, y, z) in enumerate(LSB)]
        rows[20] = "200,1,,3"
        with mock.patch.object(text, "QUICK_BYTES", 0):
            status, said = self.run_tilt(self.file("\n".join(["t_ms,x,y,z", *rows]) + "\n"), "-o", self.out)
        self.assertEqual(status, 0, said)
        self.assertEqual(self.rows()[1][19:22], [(190000, *LSB[19], 0), (200000, *LSB[19], 2), (210000, *LSB[21], 0)])


class Firmware(Case):
    def simulated(self, stream):
        """(what the firmware sent, served readings) at 100 Hz."""
        out, served = self.folder / "fw.csv", self.folder / "served.csv"
        subprocess.run([SIMRUN, "--fw", FIRMWARE, "--in", stream, "--out", out, "--served", served], check=True, capture_output=True, timeout=600)
        return out, stream_rows(served)

    def test_import_simulate_import(self):
        """A maker's file in g through the importer, the firmware and the importer again: the integers that were served, and no others."""
        if not (SIMRUN.exists() and FIRMWARE.exists()):
            self.skipTest("no build/sim/simrun and build/uno/firmware.elf (make sim)")
        lsb = LSB * 5
        first = self.folder / "first.csv"
        content = "time, x, y, z\n" + "".join(f"{i * 0.01:.5f}, {x / 256:.5f}, {y / 256:.5f}, {z / 256:.5f}\n" for i, (x, y, z) in enumerate(lsb))
        self.assertEqual(self.run_tilt(self.file(content), "-o", first)[0], 0)
        self.assertEqual(stream_rows(first), [(10000 * i, *row) for i, row in enumerate(lsb)])
        sent, served = self.simulated(first)
        self.assertEqual([row[1:] for row in served[:len(lsb)]], lsb)
        second, third = self.folder / "second.csv", self.folder / "third.csv"
        self.assertEqual(self.run_tilt(sent, "-o", second)[0], 0)
        rows = self.rows(second)[1]
        self.assertEqual(rows, stream_rows(sent, "flags"))
        begin = [row[1:] for row in served].index(rows[0][1:4])
        self.assertEqual([row[1:4] for row in rows if not row[4] & MISSING], [row[1:] for row in served[begin:begin + len(rows)]])
        self.assertGreaterEqual(len(rows), len(lsb) - 5)
        self.assertEqual(self.run_tilt(second, "-o", third)[0], 0)
        self.assertEqual(third.read_bytes(), second.read_bytes())


class Recorded(Case):
    """Samples of the formats as they were found, against the streams that were made of the same recordings by other programs."""
    # sample, options, stream, its first row, and how far times may differ, us (None: a rate was made up, there and here)
    SAMPLES = (("klipper.csv", [], "kl3200-pluck-a", 0, 199, 0),
               ("freeimu-space-magnitude.dat", ["--rate", "20"], "freeimu-orient-a", 0, 120, 0),
               ("edison-jsonl.json", ["--rate", "10"], "edison-sitting", 0, 60, 0),
               ("uraich-crlf-blank-lines.dat", ["--rate", "100"], "gest-100-2g-a", 3566, 157, 0),
               # its stamps are whole seconds, right to two samples: 11 of them give the rate to 4/1180, 0.34 %, the stream's 300 much better
               ("openmovement-11-blocks.cwa", [], "ax3-100-walk-a", 0, 1320, 20000 + 0.0034 * 13.4e6))

    def setUp(self):
        super().setUp()
        if not (RECORDINGS / "formats").is_dir():
            self.skipTest(NO_RECORDINGS)

    def test_every_sample_is_known(self):
        self.assertEqual(sorted(path.name for path in (RECORDINGS / "formats").iterdir()), sorted(sample[0] for sample in self.SAMPLES))

    def test_samples_give_the_integers_of_the_streams(self):
        for name, words, stream, first, count, off_us in self.SAMPLES:
            with self.subTest(name):
                status, said = self.run_tilt(RECORDINGS / "formats" / name, "-o", self.out, *words)
                self.assertEqual(status, 0, said)
                rows = self.rows()[1]
                wanted = stream_rows(RECORDINGS / "open" / f"{stream}.csv")[first:first + count]
                self.assertEqual([row[1:] for row in rows], [row[1:] for row in wanted])
                worst = max(abs(row[0] - (other[0] - wanted[0][0])) for row, other in zip(rows, wanted))
                self.assertLessEqual(worst, off_us)

    def test_samples_without_times_are_refused_without_a_rate(self):
        for name, words, *_ in self.SAMPLES:
            path = RECORDINGS / "formats" / name
            if words:
                reason = "no column of times: give the rate with --rate HZ"
                self.assertEqual(self.run_tilt(path, "-o", self.out), (2, f"tilt import: {path}: {reason}\n"))

    def test_every_recording_stays_as_it_is(self):
        paths = [RECORDINGS / folder / f"{row['name']}.csv" for folder in ("open", "test-only")
                 for row in csv.DictReader((RECORDINGS / folder / "index.csv").read_text(encoding="utf-8").splitlines())]
        self.assertGreater(len(paths), 30)
        for path in paths:
            with self.subTest(path.name):
                status, said = self.run_tilt(path, "-o", self.out)
                self.assertEqual(status, 0, said)
                lines = [line for line in path.read_text(encoding="ascii").splitlines() if line[0] != "#"]
                self.assertEqual(self.out.read_text(encoding="ascii").splitlines(), lines)


if __name__ == "__main__":
    from unity_line import main
    main()
