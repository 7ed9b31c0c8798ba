#!/usr/bin/env python3
"""Each format that people's recordings have: a sample made from known integers gives these integers."""
import json
import math
import pathlib
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import G, LSB, ROWS, Case, every

KLIPPER_AGES = {"0.004 g": (39.2266,) * 3, "0.0039 g": (38.245935,) * 3, "3.3 V": (37.0102971, 37.0102971, 38.3047749)}


def scaled(scale, form="{:.6f}"):
    """LSB as a file would print them: each axis times its scale."""
    return [tuple(form.format(value * part) for value, part in zip(row, scale)) for row in LSB]


class Klipper(Case):
    def test_three_ages(self):
        for age, scale in KLIPPER_AGES.items():
            with self.subTest(age):
                text = "#time,accel_x,accel_y,accel_z\n" + "".join(f"{2070.819483 + i * 0.0003115:.6f},{','.join(row)}\n"
                                                                   for i, row in enumerate(scaled(scale)))
                times, readings, said = self.imported(text)
                self.assertEqual(readings, LSB)
                self.assertEqual([times[0], times[2], times[20]], [0, 623, 6230])
                self.assertIn("first time 2070.819483 s", said)
                self.assertIn("unit mm/s2", said)

    def test_statistics_above_the_header_and_even_values(self):
        text = "##max 1.0, 2.0, 3.0, 4.0\n#time,accel_x,accel_y,accel_z\n" + "".join(
            f"{i * 0.0003125:.7f},{2 * x * 37.0102971:.6f},{2 * y * 37.0102971:.6f},{2 * z * 38.3047749:.6f}\n" for i, (x, y, z) in enumerate(LSB))
        said = self.gives(text, [tuple(2 * v for v in row) for row in LSB], [round(i * 312.5) for i in range(ROWS)])
        self.assertIn("every value is even: recorded at 1600 or 3200 Hz", said)


class Plain(Case):
    def test_adxl345spi(self):
        text = "time, x, y, z \n" + "".join(f"{i * 0.001:.5f}, {', '.join(row)} \n" for i, row in enumerate(scaled((1 / 256,) * 3, "{:.5f}")))
        said = self.gives(text, LSB, every(1000))
        self.assertIn("unit g, 1/256 g", said)

    def test_adxl345usb(self):
        text = "time,x,y,z\n" + "".join(f"{i * 0.01:.3f},{','.join(row)}\n" for i, row in enumerate(scaled((0.0039,) * 3, "{:.4f}")))
        said = self.gives(text, LSB, every(10000))
        self.assertIn("3.9 mg", said)

    def two_sensors(self):
        other = [tuple(-value for value in row) for row in LSB]
        return other, "time,x0,y0,z0,x1,y1,z1\n" + "".join(
            ",".join([f"{i * 0.01:.3f}"] + [f"{value / 256:.6f}" for value in LSB[i] + other[i]]) + "\n" for i in range(ROWS))

    def test_two_sensors_the_first_or_the_one_asked_for(self):
        other, text = self.two_sensors()
        self.assertIn("sensor 1 of 2 used (--sensor N for another)", self.gives(text, LSB, every(10000)))
        self.gives(text, other, every(10000), "--sensor", 2)

    def test_a_sensor_that_is_not_there(self):
        self.refused(self.two_sensors()[1], "--sensor 3: the file has 2", "--sensor", "3")

    def test_adxl345usb_console(self):
        text = "Press Q to stop\n" + "".join(f"time = {i * 0.1:.3f}, x = {row[0]}, y = {row[1]}, z = {row[2]}\n"
                                             for i, row in enumerate(scaled((1 / 256,) * 3, "{:.4f}")))
        self.gives(text, LSB, every(100000))

    def test_jas_soh(self):
        names = "time," + ",".join(f"accel{n}_{axis}" for n in (1, 2, 3, 4) for axis in "xyz") + "\n"
        for sensors in (2, 3):
            with self.subTest(sensors=sensors):
                rows = "".join(",".join(map(str, [1200 + 10 * i, *([-1, -1, -1] * (sensors - 1)), *LSB[i]])) + "\n" for i in range(ROWS))
                said = self.gives(names + rows, LSB, every(10000), "--sensor", sensors)
                self.assertIn(f"rows of {1 + 3 * sensors} fields under a header of 13: the last {4 - sensors} sensors are missing", said)
                self.assertIn("first time 1200 ms", said)
                readings, said = self.imported(names + rows)[1:]
                self.assertEqual(set(readings), {(-1, -1, -1)})
                self.assertIn(f"{ROWS} rows read -1,-1,-1: no sensor answered", said)

    def test_farezhalim_csv_with_a_mark_and_uneven_decimals(self):
        text = "\ufefft,x,y,z\n" + "".join(f"{i * 0.034:g},{','.join(row)}\n" for i, row in enumerate(scaled((0.004 * G,) * 3, "{:.2f}")))
        self.assertIn("unit m/s2, 4 mg", self.gives(text, LSB, every(34000)))

    def test_kefanzhg_counter(self):
        text = "".join(f"{i + (7 if i >= 30 else 0)},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
        self.refused("n,x,y,z\n" + text, "a sample counter, but no times: give the rate with --rate HZ")
        expected = [2500 * (i + (7 if i >= 30 else 0)) for i in range(ROWS)]
        self.assertIn("the counter skips 7 samples", self.gives("count,x,y,z\n" + text, LSB, expected, "--rate", 400))
        without_gaps = "".join(f"{i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
        self.gives(without_gaps, LSB, every(2500), "--rate", 400)

    def test_axelskrauba_chunks_joined_in_the_order_of_their_numbers(self):
        for number in (1, 2, 10):
            part = LSB[20 * (0, 1, 2)[(1, 2, 10).index(number)]:][:20]
            self.file("".join(f"{x}, {y}, {z}\n" for x, y, z in part), f"c{number}.csv")
        paths = [self.folder / f"c{number}.csv" for number in (10, 1, 2)]
        status, said = self.run_tilt(*paths, "--join", "--rate", 1600, "-o", self.out)
        self.assertEqual(status, 0, said)
        self.assertEqual(self.rows()[1], [(i * 625, *LSB[i]) for i in range(ROWS)])

    def test_sisfall(self):
        for end in (";", ""):
            text = "".join(f" {x:2d},{y:4d},{z:4d}, 1,-2, 3,  -7, 8,-999{end}\n" for x, y, z in LSB)
            self.assertIn("no header: columns 1, 2, 3 used, 4, 5, 6, 7, 8, 9 ignored", self.gives(text, LSB, every(5000), "--rate", 200))

    def test_uraich(self):
        text = "ax,ay,az\r\n\r\n" + "".join(f"{x:4d}, {y:4d}, {z:4d}\r\n\r\n" for x, y, z in LSB[:30]) + "gesture again\r\n\r\n" \
            + "".join(f"{x:4d}, {y:4d}, {z:4d}\r\n\r\n" for x, y, z in LSB[30:])
        said = self.gives(text, LSB, every(10000), "--rate", 100)
        self.assertIn("1 lines of text skipped, the first: line 63 'gesture again'", said)
        labelled = "ax,ay,az,label\r\n" + "".join(f"{x},{y},{z},7\r\n" for x, y, z in LSB)
        self.gives(labelled, LSB, every(10000), "--rate", 100)

    def test_freeimu_magnitude(self):
        text = "".join(f"{x} {y} {z} {math.sqrt(x * x + y * y + z * z):.2f}\n" for x, y, z in LSB)
        self.assertIn("column 4, the magnitude, ignored", self.gives(text, LSB, every(50000), "--rate", 20))

    def test_axivity_csv(self):
        grid = [tuple(4 * (value // 4) for value in row) for row in LSB]
        rows = "".join(f"{1599033600 + i * 0.0025:.4f},{x / 256:.6f},{y / 256:.6f},{z / 256:.6f}\n" for i, (x, y, z) in enumerate(grid))
        for text in (rows, "\ufefftimestamp,x,y,z\n" + rows):
            said = self.gives(text, grid, every(2500))
            self.assertIn("every value is a multiple of 4 LSB", said)

    def test_axivity_csv_with_dates(self):
        text = "Time,Accel-X (g),Accel-Y (g),Accel-Z (g)\n" + "".join(
            f"2026-11-22 23:59:59.{i * 10:03d},{x / 256:.6f},{y / 256:.6f},{z / 256:.6f}\n" for i, (x, y, z) in enumerate(LSB))
        self.gives(text, LSB, every(10000))

    def test_twyatt_scale_in_the_file(self):
        head = "Timestamp (ns), Multiplier, X*Multiplier, Y*Multiplier, Z*Multiplier\n"
        products = "".join(f"{7000000000 + i * 10000000}, 0.0039, {x * 0.0039:.4f}, {y * 0.0039:.4f}, {z * 0.0039:.4f}\n"
                           for i, (x, y, z) in enumerate(LSB))
        counts = "".join(f"{7000000000 + i * 10000000}, 0.0039, {x}, {y}, {z}\n" for i, (x, y, z) in enumerate(LSB))
        for rows in (products, counts):
            self.gives(head + rows, LSB, every(10000))

    def test_ramdelcastillo_too_coarse(self):
        text = "time,x,y,z\n" + "".join(f"{100 * i},{x / 256:.2f},{y / 256:.2f},{z / 256:.2f}\n" for i, (x, y, z) in enumerate(LSB))
        expected = [tuple(round(float(f"{v / 256:.2f}") * 256) for v in row) for row in LSB]
        said = self.gives(text, expected, every(100000))
        self.assertIn("steps of 2.6 LSB: too coarse", said)


class SerialMonitor(Case):
    def clocked(self, form, start_ms):
        lines = ["20:05:02.001 -> Accelerometer Test", "20:05:02.040 -> Range:         +/- 8 g", ""]
        for i, row in enumerate(scaled((0.004 * G,) * 3, "{:.2f}")):
            ms = (start_ms + 34 * i) % 86400000
            lines.append(f"{ms // 3600000:02d}:{ms // 60000 % 60:02d}:{ms // 1000 % 60:02d}.{ms % 1000:03d} -> " + form.format(*row))
        return "\n".join(lines) + "\n"

    def test_adafruit_across_midnight(self):
        for form in (", {},   {},   {},  m/s^2", "X: {} Y: {} Z: {} m/s^2", "X: {}  Y: {}  Z: {}  m/s^2 "):
            for start_ms in (72303252, 86399000):
                with self.subTest(form=form, start=start_ms):
                    said = self.gives(self.clocked(form, start_ms), LSB, every(34000))
                    self.assertIn("unit m/s2, 4 mg", said)

    def test_without_the_clock_a_rate_is_needed(self):
        text = "".join(f"X: {x} Y: {y} Z: {z} m/s^2\n" for x, y, z in scaled((0.004 * G,) * 3, "{:.2f}"))
        self.refused(text, "no column of times: give the rate with --rate HZ")
        self.gives(text, LSB, every(20000), "--rate", 50)


class Others(Case):
    def test_edison_keys_in_changing_order(self):
        scale = {"X": 265, "Y": 265, "Z": 256}
        lines = []
        for i, row in enumerate(LSB):
            items = [(key, value / scale[key]) for key, value in zip("XYZ", row)]
            lines.append(json.dumps(dict(items[i % 3:] + items[:i % 3])))
        self.assertIn("1/265, 1/265, 1/256 g", self.gives("\n".join(lines) + "\n", LSB, every(100000), "--rate", 10))

    def test_json_lines_with_times_and_an_array_of_objects(self):
        objects = [{"t_ms": 500 + 10 * i, "x": x, "y": y, "z": z} for i, (x, y, z) in enumerate(LSB)]
        self.gives("\n".join(map(json.dumps, objects)), LSB, every(10000))
        self.gives(json.dumps(objects), LSB, every(10000))

    def test_edge_impulse(self):
        payload = {"device_type": "X", "interval_ms": 12.5, "sensors": [{"name": f"acc{a}", "units": "m/s2"} for a in "XYZ"],
                   "values": [[value * 0.004 * G for value in row] for row in LSB]}
        text = json.dumps({"protected": {"ver": "v1"}, "signature": "0", "payload": payload})
        self.assertIn("(stated by the file", self.gives(text, LSB, every(12500)))

    def blocks(self):
        lines = []
        for i, (x, y, z) in enumerate(LSB):
            lines += ["Combined sample:", f"\tServer acc: acc,{-x / 256:.4f},{-y / 256:.4f},{-z / 256:.4f},{1668000000.5 + i * 0.01:.2f}",
                      f"\tClient acc: acc,{x / 256:.4f},{y / 256:.4f},{z / 256:.4f},{1668000000 + i * 0.01:.2f}", "\tClient emg: 1,2,3,4"]
        return lines

    def test_gingerninja_keyword_and_time_at_the_end(self):
        lines = self.blocks()
        only = "\n".join(line for line in lines if "Server" not in line) + "\n"
        self.gives(only, LSB, every(10000))
        self.assertIn("lines 'Server acc:' used, of Server acc, Client acc", self.imported("\n".join(lines))[2])
        self.gives("\n".join(lines), LSB, every(10000), "--sensor", 2)

    def test_msart_bytes_as_text(self):
        text = "".join(f"b'{x} {y} {z}\\r\\n'\n" for x, y, z in scaled((0.004 * G,) * 3, "{:.2f}"))
        self.gives(text, LSB, every(10000), "--rate", 100)


class Variants(Case):
    """What the suggested rules ask for beyond the formats."""

    def table(self, separator=",", end="\n", decimal="."):
        rows = [separator.join([f"{i * 0.01:.2f}", *(f"{value / 256:.5f}" for value in LSB[i])]).replace(".", decimal) for i in range(ROWS)]
        return separator.join(["time", "x", "y", "z"]) + end + end.join(rows) + end

    def test_separators_and_line_ends(self):
        for separator in (",", ";", "\t", " ", "  ", ", "):
            for end in ("\n", "\r\n", "\r", "\n\n"):
                with self.subTest(separator=separator, end=end):
                    self.gives(self.table(separator, end), LSB, every(10000))

    def test_mixed_line_ends_comments_and_a_mark(self):
        lines = self.table().split("\n")
        lines.insert(5, "# a remark, 1, 2, 3, 4, 5")
        lines.insert(9, "")
        text = "\ufeff" + "".join(line + ("\r\n" if i % 2 else "\n") for i, line in enumerate(lines))
        self.gives(text, LSB, every(10000))

    def test_decimal_comma_after_semicolons(self):
        self.gives(self.table(";", decimal=","), LSB, every(10000))

    def test_quoted_cells(self):
        rows = [[f"{i * 0.01:.2f}"] + [f"{value / 256:.5f}" for value in LSB[i]] for i in range(ROWS)]
        text = "".join(",".join(f'"{cell}"' for cell in row) + "\n" for row in [["Time (s)", "X", "Y", "Z"], *rows])
        self.gives(text, LSB, every(10000))

    def test_wide_text_of_powershell(self):
        self.gives(self.table().encode("utf-16"), LSB, every(10000))

    def test_names_of_times(self):
        for name, per_second in (("t_us", 10 ** 6), ("t_ms", 1000), ("millis", 1000), ("micros", 10 ** 6), ("Time (ms)", 1000), ("time_ns", 10 ** 9),
                                 ("t", 1000), ("timestamp", 10 ** 6), ("time", 10 ** 9)):
            with self.subTest(name):
                head = f"{name},ax,ay,az\n"
                text = head + "".join(f"{i * per_second // 50},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
                self.gives(text, LSB, every(20000))

    def test_a_counter_of_32_bits_wraps(self):
        for name, per_us in (("micros", 1), ("millis", 1000)):
            start = 2 ** 32 - 30 * 10000 // per_us
            text = f"{name},x,y,z\n" + "".join(f"{(start + i * 10000 // per_us) % 2 ** 32},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
            self.gives(text, LSB, every(10000))

    def test_columns_by_name_and_by_number(self):
        text = "when,east,north,up\n" + "".join(f"{10 * i},{y},{x},{z}\n" for i, (x, y, z) in enumerate(LSB))
        for words in ("when,north,east,up", "1,3,2,4", "WHEN,3,2,up"):
            self.gives(text, LSB, every(10000), "--columns", words)
        self.gives(text, LSB, every(10000), "--columns", "3,2,4", "--rate", 100)

    def test_missing_readings_are_flagged(self):
        text = "t_ms,x,y,z\n" + "".join(f"{10 * i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))
        lines = text.split("\n")
        lines[3], lines[8] = "20,,5,250", "70,nan,nan,nan"
        status, said = self.run_tilt(self.file("\n".join(lines)), "-o", self.out)
        self.assertEqual(status, 0, said)
        header, rows = self.rows()
        self.assertEqual(header, "t_us,x,y,z,flags")
        self.assertEqual(rows[:4], [(0, *LSB[0], 0), (10000, *LSB[1], 0), (20000, *LSB[1], 2), (30000, *LSB[3], 0)])
        self.assertEqual(rows[7], (70000, *LSB[6], 2))
        self.assertEqual(sum(row[-1] for row in rows), 4)
        self.assertIn("2 readings missing, flagged 2", said)

    def test_gaps_repeats_and_equal_times_are_told(self):
        times = [10 * i + (500 if i >= 30 else 0) for i in range(ROWS)]
        times[10] = times[9]
        rows = [LSB[i - i % 2] for i in range(ROWS)]
        said = self.gives("t_ms,x,y,z\n" + "".join(f"{t},{x},{y},{z}\n" for t, (x, y, z) in zip(times, rows)), rows, [1000 * t for t in times])
        self.assertIn("1 gaps, the longest 510.0 ms", said)
        self.assertIn("50.8 % of the rows repeat the row before", said)  # 30 of 59
        self.assertIn("1.7 % of the rows repeat the time of the previous row", said)  # 1 of 59

    def test_the_rate_seen_leaves_gaps_out(self):
        times = [10 * i + (500 if i >= 30 else 0) for i in range(ROWS)]
        said = self.imported("t_ms,x,y,z\n" + "".join(f"{t},{x},{y},{z}\n" for t, (x, y, z) in zip(times, LSB)))[2]
        self.assertIn(f"{ROWS} rows, {times[-1] / 1000:g} s, 100 Hz", said)

    def test_a_last_line_cut_off_is_left_out_and_told(self):
        text = self.table()
        whole = text + "0.60,0.1"
        self.assertIn(f"line {ROWS + 2}, the last, is cut off and skipped: '0.60,0.1'", self.gives(whole, LSB, every(10000)))
        self.refused(whole + "\n", "2 fields where the header has 4", line=ROWS + 2)


if __name__ == "__main__":
    from unity_line import main
    main()
