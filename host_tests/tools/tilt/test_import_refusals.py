#!/usr/bin/env python3
"""What `tilt import` refuses, each with its reason and place and without writing anything."""
import bz2
import gzip
import io
import json
import lzma
import pathlib
import sys
import zipfile

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import LSB, ROWS, Case, every

TABLE = "t_ms,x,y,z\n" + "".join(f"{10 * i},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB))


def changed(line, text):
    """TABLE with another line."""
    lines = TABLE.split("\n")
    lines[line - 1] = text
    return "\n".join(lines)


class Files(Case):
    def test_empty_and_header_only(self):
        self.refused("", "the file is empty")
        for text in ("#time,accel_x,accel_y,accel_z\n", "t_us,x,y,z\n", "time;x;y;z\r\n\r\n# 1,2,3\r\n"):
            self.refused(text, "only a header, no rows of numbers")

    def test_no_numbers(self):
        self.refused("\n\n", "not a recording: no row of three numbers in its first 3 lines")
        self.refused("Dear reader,\nthere is nothing here.\n", "not a recording: no row of three numbers in its first 3 lines")

    def test_packed(self):
        whole = TABLE.encode()
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w") as file:
            file.writestr("a.csv", TABLE)
        for name, content in (("gzip", gzip.compress(whole)), ("bzip2", bz2.compress(whole)), ("xz", lzma.compress(whole)),
                              ("zip (or a spreadsheet)", archive.getvalue())):
            self.refused(content, f"packed with {name}: unpack it first")

    def test_binary(self):
        words = "binary data in an unknown format (known: text, JSON, the AX3's CWA)"
        self.refused(bytes(range(256)) * 4, words)
        self.refused(b"1,2,3\n\x00\x00", words)
        self.refused(bytes((i * 7) % 31 + 1 for i in range(300)), words)
        self.refused(b"\x89PNG\r\n\x1a\n....", "this is a picture, not a recording")
        self.refused("1,2,3\n".encode("utf-16")[:-1], "begins as UTF-16, but is not valid at byte 12")

    def test_not_there(self):
        missing = self.folder / "missing.csv"
        self.assertEqual(self.run_tilt(missing), (2, f"tilt import: {missing}: No such file or directory: give a recording's path\n"))
        self.assertEqual(self.run_tilt(self.folder), (2, f"tilt import: {self.folder}: Is a directory: give a recording's path\n"))

    def test_spectra(self):
        for head, words in (("freq,psd_x,psd_y,psd_z,psd_xyz,mzv\n", "freq, psd_x, psd_y, psd_z"), ("freq,x,y,z\n", "freq, x, y, z")):
            self.refused(head + "5.0,1.5,2.5,3.5,4.5,1.0\n" * 5, f"a spectrum ({words}), not accelerations over time")

    def test_other_sensors(self):
        self.refused("time,gx,gy,gz\n0,1,2,3\n10,1,2,3\n",
                     "no columns x, y, z among time, gx, gy, gz: if these are accelerations, name the columns with --columns")
        self.refused("time,temp,hum,pres\n0,1,2,3\n10,1,2,3\n",
                     "no columns x, y, z among time, temp, hum, pres: if these are accelerations, name the columns with --columns")

    def test_names_that_mean_nothing_here(self):
        self.refused("temp,hum,pres\n" + "201,402,10003\n" * 9,
                     "no columns x, y, z among temp, hum, pres: if these are accelerations, name the columns with --columns")
        self.gives("east,north,up\n" + "".join(f"{x},{y},{z}\n" for x, y, z in LSB), LSB, every(10000), "--rate", "100", "--columns", "1,2,3")

    def test_lines_of_pairs_that_lack_one(self):
        text = "".join(f"x = {x}, y = {y}, z = {z}\n" for x, y, z in LSB)
        self.refused(text + "x = 1, y = 2\n", "2 fields where the header has 3", line=ROWS + 1)

    def test_plotter_lines(self):
        self.refused("roll_raw:1.23,roll:1.20,pitch_raw:-0.42,pitch:-0.40,gated:0\n" * 9,
                     "no columns x, y, z among roll_raw, roll, pitch_raw, pitch, gated: if these are accelerations, name the columns with --columns")

    def test_two_columns(self):
        self.refused("1,2\n3,4\n5,6\n", "not a recording: no row of three numbers in its first 4 lines")


class Rows(Case):
    def test_another_number_of_fields(self):
        for text, count in (("100,1,2", 3), ("100,1,2,3,4", 5), ("100", 1)):
            self.refused(changed(12, text), f"{count} fields where the header has 4", line=12)
        headless = TABLE.split("\n", 1)[1]
        self.refused(headless.replace("100,", "100,7,", 1), "5 fields where the other rows have 4", line=11)

    def test_a_header_that_does_not_fit(self):
        self.refused("t_ms,x,y,z,temp\n" + TABLE.split("\n", 1)[1], "4 fields where the header has 5", line=2)

    def test_jas_soh_rows_are_whole_sensors_and_alike(self):
        head = "time," + ",".join(f"accel{n}_{axis}" for n in (1, 2, 3, 4) for axis in "xyz") + "\n"
        rows = [",".join(map(str, [10 * i, *LSB[i], *LSB[i]])) for i in range(ROWS)]
        self.refused(head + "\n".join(row + ",5" for row in rows) + "\n", "8 fields where the header has 13", line=2)
        rows[20] += ",1,2,3"
        self.refused(head + "\n".join(rows) + "\n", "10 fields where the other rows have 7", line=22)

    def test_what_is_no_number(self):
        self.refused(changed(30, "280,1,2x,3"), "not a number: '2x'", line=30)
        self.refused(changed(30, "280,1,inf,3"), "not a number: 'inf'", line=30)
        self.refused(changed(30, "280,1,2_0,3"), "not a number: '2_0'", line=30)
        self.refused(changed(30, "28o,1,2,3"), "not a number: '28o'", line=30)
        self.refused(changed(30, ",1,2,3"), "not a number: ''", line=30)
        self.refused(changed(30, "280,1,2,0x1F"), "not a number: '0x1F'", line=30)

    def test_torn_text_of_a_serial_line(self):
        lines = [f"20:05:{i // 10:02d}.{i % 10}00 -> {x},{y},{z}" for i, (x, y, z) in enumerate(LSB)]
        lines[7] = "1,2,3"
        self.refused("\n".join(lines) + "\n", "not in the form of the other rows: '1,2,3'", line=8)

    def test_time_goes_backwards(self):
        self.refused(changed(30, "269,1,2,3"), "time goes backwards: 269 after 270", line=30)
        self.refused("count,x,y,z\n1,1,2,3\n2,1,2,3\n2,1,2,3\n", "the counter goes from 2 to 2", "--rate", "10", line=4)

    def test_every_reading_missing(self):
        self.refused("t_ms,x,y,z\n" + "".join(f"{10 * i},,,\n" for i in range(9)), "only a header, no rows of numbers")
        self.refused("t_ms,x,y,z\n" + "".join(f"{10 * i},nan,nan,nan\n" for i in range(9)), "only a header, no rows of numbers")

    def test_beyond_the_registers(self):
        reason = "1, 2, {} LSB by raw of 1 per LSB: outside an ADXL345's -4096..4095"
        for value in (4096, -4097, 10484, 65540):
            self.refused(changed(30, f"280,1,2,{value}"), reason.format(value), line=30)
        for value in (4095, -4096):
            self.assertEqual(self.imported(changed(30, f"280,1,2,{value}"))[1][28], (1, 2, value))

    def test_times_that_no_sensor_has(self):
        self.refused("time,x,y,z\n" + "".join(f"{5e9 * i:.0f},{x},{y},{z}\n" for i, (x, y, z) in enumerate(LSB)),
                     "time steps of 5e+09 fit no sensor in s, ms, us or ns: give the rate with --rate HZ")
        self.refused("time,x,y,z\n" + "5,1,2,250\n" * 9, "the times are constant: give the rate with --rate HZ")

    def test_no_times(self):
        self.refused("".join(f"{x},{y},{z}\n" for x, y, z in LSB), "no column of times: give the rate with --rate HZ")


class Json(Case):
    def test_lines(self):
        good = [json.dumps({"X": x / 256, "Y": y / 256, "Z": z / 256}) for x, y, z in LSB]
        cases = (("{\"X\": 1", "not JSON: Expecting ',' delimiter"), ("[1, 2, 3]", "not an object with x, y, z"), ("{\"X\": 1, \"Y\": 2}", "no Z"),
                 ("{\"X\": 1, \"Y\": \"2\", \"Z\": 3}", "Y is not a number: '2'"), ("{\"X\": true, \"Y\": 2, \"Z\": 3}", "X is not a number: True"))
        for bad, reason in cases:
            self.refused("\n".join(good[:10] + [bad] + good[10:]), reason, "--rate", "10", line=11)
        self.refused("{\"a\": 1, \"b\": 2}\n", "no x, y, z among a, b: if these are accelerations, name the keys with --columns", line=1)
        self.refused("[1, 2,", "not JSON: Expecting value", line=1)

    def test_edge_impulse(self):
        def payload(**changes):
            whole = {"interval_ms": 10, "sensors": [{"name": f"acc{a}", "units": "m/s2"} for a in "XYZ"], "values": [[0.0, 0.0, 9.8]] * 9}
            return json.dumps({"payload": whole | changes})
        self.refused(payload(values=[[0, 0, 9.8], [0, 9.8]]), "payload.values[1]: 2 values for 3 sensors")
        self.refused(payload(interval_ms=0), "payload.interval_ms is 0")
        self.refused(payload(values=[]), "no rows")
        self.refused(payload(sensors=[{"name": "audio"}]),
                     "payload.sensors: no x, y, z among audio: if these are accelerations, name the keys with --columns")
        self.refused(json.dumps({"payload": {"values": []}}), "not an Edge Impulse file: the payload has no 'sensors'")


class Options(Case):
    def test_options_that_cannot_be(self):
        self.refused(TABLE, "--columns: no column 'u': choose from t_ms, x, y, z", "--columns", "t_ms,u,y,z")
        self.refused("1,2,250\n" * 9, "--columns: no column 'u': give numbers, there is no header", "--columns", "u,y,z")
        self.refused(TABLE, "column 9 requested, but rows have 4", "--columns", "1,2,3,9")
        for words, reason in ((("--columns", "1,2"), "--columns 1,2: give three (x,y,z) or four (time,x,y,z) names or numbers"),
                              (("--unit", "furlong"), "--unit furlong: give one of raw, g, mg, m/s2, mm/s2, k/265, or the value of one LSB: "
                               "a number, or three for x, y, z"),
                              (("--unit", "0"), "--unit 0: give one of raw, g, mg, m/s2, mm/s2, k/265, or the value of one LSB: a number, or three "
                               "for x, y, z")):
            self.assertEqual(self.run_tilt(self.file(TABLE), *words), (2, f"tilt import: {reason}\n"))
        for words in (("--rate", "0"), ("--rate", "fast"), ("--rate", "nan"), ("--sensor", "0"), ()):
            self.assertEqual(self.run_tilt(*words, *([self.file(TABLE)] if words else []))[0], 2)

    def test_no_input_is_replaced(self):
        path = self.file(TABLE, "a.stream.csv")
        for words in ([path, "-o", path], [path, "-o", self.folder / "." / "a.stream.csv"], [self.file(TABLE, "a.csv"), path]):
            status, said = self.run_tilt(*words)
            self.assertEqual(status, 2)
            self.assertIn("the stream would replace", said)
            self.assertEqual(path.read_text(encoding="ascii"), TABLE)

    def test_no_output_is_replaced_by_another(self):
        status, said = self.run_tilt(self.file(TABLE, "a.csv"), self.file(TABLE, "a.txt"))
        self.assertEqual(status, 2)
        self.assertIn("two files would be written to", said)
        self.assertEqual(self.run_tilt(self.file(TABLE), self.file(TABLE, "b.txt"), "-o", self.out),
                         (2, "tilt import: -o: give one FILE, or --join\n"))

    def test_a_refused_file_leaves_what_is_there(self):
        self.out.write_text("before", encoding="ascii")
        status, _ = self.run_tilt(self.file(changed(30, "1,2")), "-o", self.out)
        self.assertEqual((status, self.out.read_text(encoding="ascii")), (2, "before"))

    def test_of_several_files_the_good_ones_are_imported(self):
        good, bad = self.file(TABLE, "good.csv"), self.file("x", "bad.csv")
        status, said = self.run_tilt(bad, good)
        self.assertEqual(status, 2)
        self.assertIn("1 of 2 files not imported", said)
        self.assertEqual(len(self.rows(self.folder / "good.stream.csv")[1]), ROWS)

    def test_an_output_that_cannot_be_written(self):
        out = self.folder / "nowhere" / "a.csv"
        self.assertEqual(self.run_tilt(self.file(TABLE), "-o", out), (2, f"tilt import: {out}: cannot write it: No such file or directory\n"))

    def test_files_of_different_forms_are_not_joined(self):
        first, second = self.file(TABLE, "a1.csv"), self.file("x,y,z\n1,2,3\n", "a2.csv")
        self.assertEqual(self.run_tilt(first, second, "--join", "-o", self.out),
                         (2, f"tilt import: {second}: not in the form of {first}: times, units or columns differ: import it alone\n"))

    def test_a_fault_in_a_joined_file_names_that_file(self):
        first, second = self.file(TABLE, "a1.csv"), self.file("t_ms,x,y,z\n600,1,2,3\n610,1,2,9999\n", "a2.csv")
        status, said = self.run_tilt(first, second, "--join", "-o", self.out)
        self.assertEqual(status, 2)
        self.assertIn(f"{second}:3: 1, 2, 9999 LSB", said)


if __name__ == "__main__":
    from unity_line import main
    main()
