#!/usr/bin/env python3
"""What common sketches print, made here from known integers: every kind of row, of stamp, of line end and of encoding gives these integers
and times. Run from the repository root with build/venv/bin/python."""
import itertools
import pathlib
import sys
from datetime import datetime, timedelta

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import G, LSB, ROWS, Case, every

RULER = "------------------------------------"
ADAFRUIT = ["Accelerometer Test", "", RULER, "Sensor:       ADXL345", "Driver Ver:   1", "Unique ID:    12345", "Max Value:    -156.91 m/s^2",
            "Min Value:    156.91 m/s^2", "Resolution:   0.04 m/s^2", RULER, "", "Data Rate:    100  Hz", "Range:         +/- 16  g", ""]
SPARKFUN = ["SparkFun ADXL345 Accelerometer Hook Up Guide Example", ""]
I2CDEV = ["Initializing I2C devices...", "Testing device connections...", "ADXL345 connection successful"]


def printed(scale, form):
    return [tuple(form.format(value * scale) for value in row) for row in LSB]


def lines(form, rows):
    return [form.format(*row) for row in rows]


def commas(form, rows):
    return [line.replace(".", ",") for line in lines(form, rows)]


RAW, MS2, MG = printed(1, "{}"), printed(0.004 * G, "{:.2f}"), printed(3.9, "{:.1f}")
G2, G4 = printed(1 / 256, "{:.2f}"), printed(1 / 256, "{:.4f}")
EXACT = {
    "Adafruit sensortest": ADAFRUIT + lines("X: {} Y: {} Z: {} m/s^2 ", MS2),
    "Adafruit sensortest, wide": ADAFRUIT + lines("X: {}  Y: {}  Z: {}  m/s^2 ", MS2),
    "SparkFun": SPARKFUN + lines("{}, {}, {}", RAW),
    "SparkFun with taps": SPARKFUN + [line for row in lines("{}, {}, {}", RAW) for line in (row, "*** TAP ***")],
    "ADXL345_WE": [line for raw, g in zip(RAW, G2) for line in ("Raw-x = {}.00  |  Raw-y = {}.00  |  Raw-z = {}.00".format(*raw),
                                                              "g-x   = {}  |  g-y   = {}  |  g-z   = {}".format(*g), "")],
    "Wire, X=": lines("X={}  Y={}  Z={}", RAW),
    "Wire, a sentence": lines("The acceleration info of x, y, z are:{} {} {}", RAW),
    "Wire, counts above g": [line for raw, g in zip(RAW, G2) for line in ("values of X , Y , Z: {} , {} , {}".format(*raw), f"X={g[0]} g",
                                                                        f"Y={g[1]} g", f"Z={g[2]} g", "**********************")],
    "Wire, counts above m/s2": [line for raw, ms2 in zip(RAW, MS2) for line in ("Xraw = {} Yraw: {} Zraw: {}".format(*raw),
                                                                              "Xnorm = {} Ynorm: {} Znorm: {}".format(*ms2))],
    "i2cdevlib": I2CDEV + lines("accel:\t{}\t{}\t{}", RAW),
    "plotter, commas": lines("x:{},y:{},z:{}", RAW),
    "plotter, tabs": lines("x:{}\ty:{}\tz:{}", RAW),
    "plotter, blanks": lines("x:{} y:{} z:{}", RAW),
    "plotter with limits": lines("Min:-300,Max:300,x:{},y:{},z:{}", RAW),
    "plotter, AccX": lines("AccX:{},AccY:{},AccZ:{}", RAW),
    "plotter, x_mg": lines("x_mg:{},y_mg:{},z_mg:{}", MG),
    "tabs": lines("{}\t{}\t{}", RAW), "blanks": lines("{} {} {}", RAW), "padded": lines("{:>6} {:>6} {:>6}", RAW), "bars": lines("{} | {} | {}", RAW),
    "a tuple": lines("({}, {}, {})", printed(0.004 * G, "{:.6f}")), "a list": lines("[{}, {}, {}]", RAW),
    "g after each": lines("x: {} g, y: {} g, z: {} g", G4), "g without blank": lines("X: {}g Y: {}g Z: {}g", G4),
    "mg at the end": lines("X: {} mg  Y: {} mg  Z: {} mg", MG), "mg after all": lines("{},{},{} mg", printed(1000 / 256, "{:.0f}")),
    "m/s2 after each": lines("X={} m/s^2, Y={} m/s^2, Z={} m/s^2", MS2), "m/s2 with a superscript": lines("X: {} Y: {} Z: {} m/s²", MS2),
    "header, tabs": ["x\ty\tz", *lines("{}\t{}\t{}", RAW)], "header, blanks": ["X Y Z", *lines("{} {} {}", RAW)],
    "header, semicolons": ["ax;ay;az", *lines("{};{};{}", RAW)], "header in g": ["ax [g],ay [g],az [g]", *lines("{},{},{}", G4)],
    "header in mg": ["X (mg),Y (mg),Z (mg)", *lines("{},{},{}", MG)], "header in LSB": ["X (LSB),Y (LSB),Z (LSB)", *lines("{},{},{}", RAW)],
    "header in m/s2": ["Acceleration X (m/s^2),Acceleration Y (m/s^2),Acceleration Z (m/s^2)", *lines("{},{},{}", MS2)],
    "comma decimals, semicolons": commas("{};{};{}", G4), "comma decimals, tabs": commas("{}\t{}\t{}", G4),
    "comma decimals, blanks": commas("{} {} {}", G4), "comma decimals, labels": commas("X: {} Y: {} Z: {}", G4),
    "comma decimals, header": ["x;y;z", *commas("{};{};{}", G4)],
}
COARSE = {"Wire, Xa=": lines("Xa= {}   Ya= {}   Za= {}", G2), "ADXL345_WE, g alone": lines("g-x   = {}  |  g-y   = {}  |  g-z   = {}", G2)}
START = datetime(2026, 11, 22, 23, 59, 59, 800000)  # midnight comes in row 20
SEMICOLONS, TABS, BLANKS, COMMAS = (lines(separator.join(["{}"] * 3), RAW) for separator in (";", "\t", " ", ","))
LABELS = lines("X: {} Y: {} Z: {}", RAW)


def clock(t):
    return f"{t:%H:%M:%S}.{t.microsecond // 1000:03d}"


TIMED = {  # (header, the stamp of a time and its ms, rows)
    "IDE": ("", lambda t, ms: f"{clock(t)} -> ", LABELS),
    "PlatformIO": ("", lambda t, ms: f"{clock(t)} > ", COMMAS),
    "in brackets": ("", lambda t, ms: f"[{clock(t)}] ", COMMAS),
    "in brackets with its day": ("", lambda t, ms: f"[{t:%Y-%m-%d} {clock(t)}] ", COMMAS),
    "with an arrow and its day": ("", lambda t, ms: f"{t:%Y-%m-%d} {clock(t)} -> ", LABELS),
    "CoolTerm": ("", lambda t, ms: f"{t:%Y-%m-%d} {clock(t)} ", LABELS),
    "CoolTerm, tabs": ("", lambda t, ms: f"{t:%Y-%m-%d} {clock(t)}\t", TABS),
    "ISO": ("time,x,y,z\n", lambda t, ms: f"{t:%Y-%m-%d}T{clock(t)}Z,", COMMAS),
    "ISO without header": ("", lambda t, ms: f"{t:%Y-%m-%d}T{clock(t)}+01:00,", COMMAS),
    "clock and blanks": ("", lambda t, ms: f"{clock(t)} ", BLANKS),
    "clock and commas": ("", lambda t, ms: f"{clock(t)},", COMMAS),
    "European": ("time;x;y;z\n", lambda t, ms: f"{t:%d.%m.%Y} {clock(t)};", SEMICOLONS),
    "American": ("time,x,y,z\n", lambda t, ms: f"{t:%m/%d/%Y} {clock(t)},", COMMAS),
    "British": ("time,x,y,z\n", lambda t, ms: f"{t:%d/%m/%Y} {clock(t)},", COMMAS),
    "European day and clock": ("Date;Time;X;Y;Z\n", lambda t, ms: f"{t:%d.%m.%Y};{clock(t)};", SEMICOLONS),
    "day and clock": ("Date,Time,X,Y,Z\n", lambda t, ms: f"{t:%Y-%m-%d},{clock(t)},", COMMAS),
    "millis": ("", lambda t, ms: f"{1234 + ms},", COMMAS),
    "millis, label": ("", lambda t, ms: f"t: {ms} ms ", LABELS),
    "micros that wrap": ("", lambda t, ms: f"{(4294900000 + 1000 * ms) % 2 ** 32},", COMMAS),
    "micros, tabs": ("", lambda t, ms: f"{1000 * ms}\t", TABS),
    "seconds": ("", lambda t, ms: f"{1790000000.5 + ms / 1000:.6f} ", BLANKS),
    "seconds with commas": ("", lambda t, ms: f"{ms // 1000},{ms // 10 % 100:02d}\t", commas("{}\t{}\t{}", G4)),
}
DATED = ("in brackets with its day", "with an arrow and its day", "CoolTerm", "CoolTerm, tabs", "ISO", "ISO without header", "European", "American",
         "British", "day and clock", "European day and clock")
WRITTEN = {"LF": lambda text: text.encode(), "CRLF, mark": lambda text: ("\ufeff" + text.replace("\n", "\r\n")).encode(),
           "UTF-16": lambda text: text.replace("\n", "\r\n").encode("utf-16")}


def stamped(found):
    """As the serial monitor shows the lines."""
    return "".join(f"20:05:00.{number:04d} -> {line}\n" for number, line in enumerate(found))


class Sketches(Case):
    def test_each_gives_its_integers_in_every_encoding(self):
        for name, found in EXACT.items():
            for how, written in WRITTEN.items():
                with self.subTest(name, how=how):
                    self.gives(written("\n".join(found) + "\n"), LSB, every(10000), "--rate", 100)

    def test_each_with_stamps(self):
        for name, found in EXACT.items():
            with self.subTest(name):
                times, readings, _ = self.imported(stamped(found))
                self.assertEqual(readings, LSB)
                self.assertEqual(len({b - a for a, b in zip(times, times[1:])}), 1)

    def test_two_decimals_of_g_are_near_and_said_to_be_coarse(self):
        for name, found in COARSE.items():
            with self.subTest(name):
                readings, said = self.imported("\n".join(found) + "\n", "--rate", 100)[1:]
                self.assertEqual(readings, [tuple(round(float(f"{value / 256:.2f}") * 256) for value in row) for row in LSB])
                self.assertIn("too coarse", said)

    def test_each_kind_of_time(self):
        for name, (header, stamp, rows) in TIMED.items():
            for how, written in WRITTEN.items():
                with self.subTest(name, how=how):
                    text = "".join(stamp(START + timedelta(milliseconds=10 * i), 10 * i) + row + "\n" for i, row in enumerate(rows))
                    self.gives(written(header + text), LSB, every(10000))

    def test_a_pause_of_days_is_a_gap(self):
        """3 days and 13 h, with and without a new month, however the day is written; only a clock without a day cannot know."""
        for name, begins in itertools.product(DATED, (datetime(2026, 11, 22, 10), datetime(2026, 9, 30, 10), datetime(2026, 11, 30, 23))):
            header, stamp, rows = TIMED[name]
            with self.subTest(name, begins=begins):
                times = [begins + timedelta(milliseconds=10 * i) + (i >= 30) * timedelta(days=3, hours=13) for i in range(ROWS)]
                found, readings, said = self.imported(header + "".join(stamp(t, 0) + row + "\n" for t, row in zip(times, rows)))
                self.assertEqual((readings, found), (LSB, [round((t - begins) / timedelta(microseconds=1)) for t in times]))
                self.assertIn("1 gaps", said)

    def test_a_day_in_no_known_form_is_reported(self):
        text = "".join(f"Sunday;10:00:00.{10 * i:03d};{row}\n" for i, row in enumerate(SEMICOLONS))
        self.assertIn("the day 'Sunday' is in no known form: ignored", self.gives("Date;Time;X;Y;Z\n" + text, LSB, every(10000)))

    def test_a_board_that_restarts_prints_its_banner_again(self):
        rows = lines("X: {} Y: {} Z: {} m/s^2 ", MS2)
        readings, said = self.imported(stamped(ADAFRUIT + rows[:30] + ADAFRUIT + rows[30:]))[1:]
        self.assertEqual(readings, LSB)
        self.assertIn(f"{2 * sum(map(bool, ADAFRUIT))} lines of text skipped", said)
        self.assertIn("1 gaps", said)

    def test_a_torn_row_is_no_ruler(self):
        rows = ["20:05:02.001 -> " + row for row in COMMAS]
        rows[7] = "20:05:02.001 -> ---- 1 2 3"
        self.refused("\n".join(rows) + "\n", "not in the form of the other rows: '20:05:02.001 -> ---- 1 2 3'", line=8)


if __name__ == "__main__":
    from unity_line import main
    main()
