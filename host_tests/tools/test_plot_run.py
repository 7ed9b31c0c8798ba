#!/usr/bin/env python3
"""Tests of tools/plot_run.py on runs made here, whose errors, counts and matches are known."""
import json
import math
import pathlib
import struct
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import InFolder, printed  # noqa: E402
import plot_run  # noqa: E402

HEADER = ",".join(plot_run.RUN_COLUMNS)
SERVED_HEADER = "served,t_us,row,line,x_lsb,y_lsb,z_lsb,roll_true_cdeg,pitch_true_cdeg"
START_US = 23_456  # of the firmware's clock at the first sample


class Case(InFolder):
    def write(self, name, lines, end="\n"):
        (self.folder / name).write_text("\n".join(lines) + end)
        return str(self.folder / name)

    def plot(self, *options):
        """(exit status, stdout, stderr) of the command with a picture run.png."""
        return printed(plot_run.main, [*options, "--png", self.folder / "run.png"])


def reading(i):
    """A vector of about 1 g whose triple differs from row to row: roll sweeps 0..360 degrees."""
    turn = 2.0 * math.pi * i / 400.0
    return round(20.0 * math.sin(7.0 * turn)), round(265.0 * math.sin(turn)), round(256.0 * math.cos(turn))


def angles_cdeg(x, y, z):
    x, y, z = x / 265.0, y / 265.0, z / 256.0
    return 100.0 * math.degrees(math.atan2(y, z)), 100.0 * math.degrees(math.atan2(-x, math.hypot(y, z)))


def wrap_cdeg(value):
    return (value + 17999) % 36000 - 17999


def made_run(count=400, bias_cdeg=100, start_us=START_US, flags=lambda i: 0):
    """(run lines, served lines): filtered angles are truth plus bias, the true roll is 2 degrees off the raw one."""
    run, served = ["# tilt-uno", HEADER], [SERVED_HEADER]
    for i in range(count):
        x, y, z = reading(i)
        roll, pitch = angles_cdeg(x, y, z)
        true_roll, true_pitch = wrap_cdeg(round(roll) - 200), round(pitch)
        t_us = START_US + 10_000 * i
        served.append(f"{i},{t_us},{i},{i + 2},{x},{y},{z},{true_roll},{true_pitch}")
        shown_us = (t_us + start_us - START_US + 6) % 2 ** 32
        roll_cdeg, pitch_cdeg = wrap_cdeg(true_roll + bias_cdeg), true_pitch + bias_cdeg
        run.append(f"{shown_us},{x},{y},{z},0,0,0,{roll_cdeg},{pitch_cdeg},{flags(i)}")
    return run, served


class Summary(Case):
    def result(self, run, served):
        table, _ = plot_run.read_numbers(self.write("run.csv", run), plot_run.RUN_COLUMNS)
        path = self.write("served.csv", served)
        source, _ = plot_run.read_numbers(path, ["t_us", *plot_run.READING], plot_run.TRUTH)
        return plot_run.analyse(table, source)

    def test_errors_are_the_ones_put_in_across_the_180_seam(self):
        result = self.result(*made_run())
        self.assertEqual(0, result.unmatched)
        raw, filtered = result.rmse["roll"]
        self.assertAlmostEqual(2.0, raw, delta=0.005)      # truth columns are rounded to 0.01 degree
        self.assertAlmostEqual(1.0, filtered, delta=1e-9)
        raw, filtered = result.rmse["pitch"]
        self.assertLessEqual(raw, 0.005)
        self.assertAlmostEqual(1.0, filtered, delta=1e-9)

    def test_warm_up_and_coasted_rows_are_not_scored(self):
        flags = {0: 128, 1: 128, 50: 2, 51: 18}
        run, served = made_run(flags=lambda i: flags.get(i, 0))
        for i in flags:
            fields = run[2 + i].split(",")
            run[2 + i] = ",".join([*fields[:7], "9000", "9000", fields[9]])
        result = self.result(run, served)
        self.assertAlmostEqual(1.0, result.rmse["roll"][1], delta=1e-9)
        self.assertEqual(0, result.unmatched)

    def test_time_wrap_and_clock_offset_do_not_matter(self):
        run, served = made_run(start_us=2 ** 32 - 1_500_000)
        result = self.result(run[:150] + run[154:], served)  # the rows around the wrap were lost
        self.assertEqual(0, result.unmatched)
        self.assertAlmostEqual(3.99, result.t_s[-1], delta=1e-6)
        self.assertAlmostEqual(1.0, result.rmse["roll"][1], delta=1e-9)

    def test_truth_is_found_when_only_every_fourth_sample_has_a_row_and_one_was_lost(self):
        run, served = made_run()
        result = self.result(run[:2] + run[2::4], served)
        self.assertEqual((100, 0), (result.rows, result.unmatched))
        result = self.result(run[:150] + run[151:], served)
        self.assertEqual((399, 0), (result.rows, result.unmatched))
        self.assertAlmostEqual(1.0, result.rmse["pitch"][1], delta=1e-9)

    def test_a_row_with_a_reading_that_was_not_served_then_is_counted(self):
        run, served = made_run()
        fields = run[100].split(",")
        run[100] = ",".join([fields[0], "1", "2", "3", *fields[4:]])
        later = run[300].split(",")
        run[200] = ",".join([run[200].split(",")[0], *later[1:]])
        self.assertEqual(2, self.result(run, served).unmatched)

    def test_rows_after_a_reset_of_the_board_find_their_truth(self):
        run, served = made_run()
        rows = [line.split(",") for line in run[2:]]
        late = [",".join([str(int(f[0]) - 2_300_000), *f[1:]]) for f in rows[240:]]
        result = self.result(run[:202] + ["# tilt-uno", HEADER] + late, served)
        self.assertEqual((360, 0), (result.rows, result.unmatched))
        self.assertAlmostEqual(1.0, result.rmse["roll"][1], delta=1e-9)

    def test_identical_readings_match_in_order(self):
        rows = [f"{START_US + 10_000 * i},0,0,256,0,0,0,50,50,0" for i in range(50)]
        served = [f"{i},{START_US + 10_000 * i},{i},{i},0,0,256,0,0" for i in range(50)]
        result = self.result([HEADER, *rows], [SERVED_HEADER, *served])
        self.assertEqual(0, result.unmatched)
        self.assertAlmostEqual(0.5, result.rmse["roll"][1], delta=1e-9)


class Command(Case):
    def test_prints_the_numbers_and_writes_a_picture_of_1200_by_700(self):
        run, served = made_run(flags=lambda i: 128 if i < 5 else (1 if i % 4 == 0 else (2 if i == 9 else 0)))
        stats = self.write("stats.json", [json.dumps({"samples_served": 401, "lost": 1, "cpu_load": 0.084})])
        status, out, _ = self.plot("--run", self.write("run.csv", run), "--served", self.write("served.csv", served),
                                   "--stats", stats, "--title", "a title")
        self.assertEqual(0, status)
        # rows 8, 12 .. 396 are gated: 98 of 400
        self.assertIn("rows 400, samples served 401, lost 1, gated 24.5 %, CPU load 8.4 %", out)
        self.assertIn("raw 2.00 degrees, filtered 1.00 degrees (0.50 of raw)", out)
        self.assertIn("not scored: 6 rows", out)
        png = (self.folder / "run.png").read_bytes()
        self.assertEqual(b"\x89PNG\r\n\x1a\n", png[:8])
        self.assertEqual((1200, 700), struct.unpack(">II", png[16:24]))

    def test_without_truth_it_says_so_and_draws(self):
        run, _ = made_run()
        status, out, _ = self.plot("--run", self.write("run.csv", run))
        self.assertEqual(0, status)
        self.assertIn("no truth columns", out)

    def test_the_stream_serves_when_there_is_no_served_file(self):
        run, served = made_run()
        stream = ["# a stream", "t_us,x,y,z,roll_true_cdeg,pitch_true_cdeg"]
        for line in served[1:]:
            fields = line.split(",")
            stream.append(",".join([str(int(fields[1]) - START_US), *fields[4:]]))
        status, out, _ = self.plot("--run", self.write("run.csv", run), "--stream", self.write("stream.csv", stream))
        self.assertEqual(0, status)
        self.assertIn("raw 2.00 degrees, filtered 1.00 degrees", out)

    def test_all_rows_coasted_or_one_row_only(self):
        run, served = made_run(count=20, flags=lambda i: 18)
        options = "--served", self.write("served.csv", served)
        self.assertEqual(0, self.plot("--run", self.write("run.csv", run), *options)[0])
        run, served = made_run(count=1)
        options = "--served", self.write("served.csv", served)
        self.assertEqual(0, self.plot("--run", self.write("run.csv", run), *options)[0])

    def test_rows_cut_by_a_reset_or_the_end_are_counted(self):
        run, served = made_run()
        lines = run[:100] + ["123456,1,2# tilt-uno", "# reset", HEADER] + run[100:] + ["99,1"]
        status, out, _ = self.plot("--run", self.write("run.csv", lines), "--served", self.write("served.csv", served))
        self.assertEqual(0, status)
        self.assertIn("2 rows cut short", out)


    def test_a_sensor_faster_than_its_stream_is_explained(self):
        stream = self.write("stream.csv", ["t_us,x,y,z", *(f"{10_000 * i},1,2,{250 + i}" for i in range(9))])
        run = self.write("run.csv", made_run()[0])
        for sensor_hz, words in ((800, "the stream has 100 rows/s, the sensor took 800/s: it repeats each reading"), (100, ""), (50, "")):
            out = self.plot("--run", run, "--stream", stream, "--stats", self.write("stats.json", [json.dumps({"sensor_hz": sensor_hz})]))[1]
            self.assertEqual(bool(words), "it repeats each reading" in out)
            self.assertIn(words, out)


class BadInput(Case):
    def refused(self, lines, *words):
        status, out, err = self.plot("--run", self.write("run.csv", lines))
        self.assertEqual((2, ""), (status, out))
        self.assertEqual(1, err.count("\n"))
        for word in words:
            self.assertIn(word, err)

    def test_each_is_refused_with_file_line_and_reason(self):
        run, _ = made_run(count=9)
        self.refused(run[:3] + ["1,2,3"] + run[3:], "run.csv:4:", "3 fields, the header has 10")
        self.refused(run[:3] + ["x" + run[3]] + run[4:], "run.csv:4:", "is not a whole number")
        self.refused(run[:3] + [run[3].replace(",0,0,0,", ",0,0.5,0,")] + run[4:], "run.csv:4:", "'0.5'")
        self.refused(run[2:], "run.csv:1:", "t_us is missing")
        self.refused([HEADER.replace(",flags", "")], "run.csv:1:", "flags is missing")
        self.refused(run[:2], "run.csv: no rows")
        self.refused(["# banner only"], "run.csv: empty")
        self.refused(["roll_raw:1.0,roll:1.0"], "run.csv:1:", "csv header was expected")

    def test_missing_files_and_broken_statistics(self):
        run = self.write("run.csv", made_run(count=9)[0])
        for option in ("--served", "--stream", "--stats"):
            status, _, err = self.plot("--run", run, option, str(self.folder / "absent"))
            self.assertEqual(2, status)
            self.assertIn("absent: No such file", err)
        status, _, err = self.plot("--run", run, "--stats", self.write("bad.json", ["{", "  x"]))
        self.assertEqual(2, status)
        self.assertIn("bad.json:2:", err)


if __name__ == "__main__":
    from unity_line import main
    main()
