#!/usr/bin/env python3
"""Tests of `tilt plot`: what thinning keeps, the spectrum of known signals, pictures and page of made recordings."""
import base64
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from unittest import mock

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import LONG, PLAIN  # noqa: E402
from tilt_case import InFolder, run_tilt  # noqa: E402
from tilt import picture, pictured, plot_page, spectrum, stream, thin  # noqa: E402

SEED = 20261122
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
USUAL = ["roll", "pitch", "flags", "spectrum"]


def noise(rows, columns=1):
    return np.random.default_rng(SEED).normal(0.0, 1.0, (rows, columns))


class Case(InFolder):
    def recording(self, rows=2000, gated=(), name="run.csv", filtered=True, truth=False, step_us=10_000, flags=None):
        """A run at 20 degrees of roll with white noise of 2 LSB; the gated rows read 90 degrees."""
        lsb = np.round(np.array([0.0, 87.6, 240.6]) + 2.0 * noise(rows, 3)).astype(int)
        lsb[list(gated)] = (0, 256, 0)
        flags = np.zeros(rows, int) if flags is None else flags
        flags[list(gated)] |= 1
        columns = {"x_mg": np.zeros(rows, int), "y_mg": np.full(rows, 342), "z_mg": np.full(rows, 940), "roll_cdeg": np.full(rows, 2000),
                   "pitch_cdeg": np.zeros(rows, int)} if filtered else None
        more = {"roll_true_cdeg": np.full(rows, 2000), "pitch_true_cdeg": np.zeros(rows, int)} if truth else {}
        path = self.folder / name
        stream.write(path, 15_000 + step_us * np.arange(rows), lsb, flags=flags, columns=columns, **more)
        return path

    def tilt(self, *words):
        return run_tilt("plot", *words)


class Thinned(Case):
    def test_each_column_keeps_its_extremes_and_its_ends(self):
        t_s, values = np.arange(10_000) * 0.01, np.cumsum(noise(10_000)[:, 0])
        other = np.cumsum(noise(10_000)[::-1, 0])
        kept = thin.extremes(t_s, [values, other], 100)
        self.assertLessEqual(len(kept), 6 * 100)
        self.assertEqual((kept[0], kept[-1]), (0, 9999))
        column = np.minimum((t_s * (100 / t_s[-1])).astype(int), 99)
        for number in range(100):
            here, left = column == number, kept[column[kept] == number]
            for series in (values, other):
                self.assertEqual((series[here].min(), series[here].max()), (series[left].min(), series[left].max()))

    def test_a_single_spike_in_an_hour_and_holes(self):
        values = np.zeros(360_000)
        values[[100_000, 200_001]] = 5.0, -7.0
        values[300_000:310_000] = np.nan
        kept = thin.extremes(np.arange(360_000) * 0.01, [values], 1000)
        self.assertTrue({100_000, 200_001} <= set(kept.tolist()))
        self.assertLess(len(kept), 4001)

    def test_short_ones_stay_whole(self):
        for rows in (1, 2, 399):
            self.assertEqual(len(thin.extremes(np.zeros(rows), [np.zeros(rows)], 100)), rows)

    def test_no_flag_is_lost(self):
        flags = np.zeros(10_000, np.uint16)
        flags[[3, 4321, 9999]] = 1, 8, 1024
        kept = thin.extremes(np.arange(10_000.0), [np.zeros(10_000)], 50)
        joined = thin.joined_flags(flags, kept)
        self.assertEqual(len(joined), len(kept))
        for row, flag in ((3, 1), (4321, 8), (9999, 1024)):
            self.assertEqual(joined[np.searchsorted(kept, row)], flag)  # the first kept row not before it
        self.assertEqual(int(joined.sum()), 1 + 8 + 1024)

    def test_every_cell_of_the_picture_that_has_a_point_keeps_one(self):
        t_s, values = np.arange(50_000) * 0.01, noise(50_000)[:, 0]
        values[123], values[44_000] = 99.0, -99.0  # alone at the edges
        values[500] = np.nan
        kept = thin.spots(t_s, values, 40, 30, (-6.0, 6.0))

        def cells(rows):
            rows = rows[~np.isnan(values[rows])]
            across = np.minimum((t_s[rows] * (40 / t_s[-1])).astype(int), 39)
            return list(zip(across, np.clip((values[rows] + 6.0) * (30 / 12.0), 0, 29).astype(int)))
        self.assertEqual(sorted(cells(kept)), sorted(set(cells(np.arange(50_000)))))

    def test_shares(self):
        t_s = np.array([0.0, 0.1, 1.5, 3.2, 3.3, 3.4, 3.9])
        share = thin.shares(t_s, np.array([True, False, True, False, False, False, True]), 6, (0.0, 6.0))
        self.assertEqual(share.tolist(), [0.5, 1.0, 1.0, 0.25, 0.0, 0.0])  # 2..3 s is between rows, from 4 s on there are none

    def test_runs(self):
        self.assertEqual(thin.runs(np.array([1, 1, 0, 1, 0, 0, 1], bool)), [(0, 1), (3, 3), (6, 6)])
        self.assertEqual(thin.runs(np.zeros(3, bool)), [])


class Spectrum(unittest.TestCase):
    RATE_HZ, ROWS, SIGMA = 100.0, 60_000, 2.0

    def white(self):
        return spectrum.density(self.SIGMA * noise(self.ROWS), [slice(0, self.ROWS)], self.RATE_HZ)

    def test_white_noise_within_its_confidence_interval(self):
        """Power 2 sigma^2 / rate in each bin. Of K half overlapping Hann pieces, whose neighbours correlate by 1/6, a bin has 36/19 K degrees of
        freedom; neighbouring bins correlate by (2/3)^2, the next by (1/6)^2."""
        from scipy import stats
        found = self.white()
        pieces = 2 * self.ROWS // 1024 - 1
        self.assertEqual((found.pieces, len(found.hz)), (pieces, 511))
        freedom, bins = 36.0 / 19.0 * pieces, len(found.hz)
        power = found.lsb_rthz[:, 0] ** 2 / (2.0 * self.SIGMA ** 2 / self.RATE_HZ)
        together = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0)
        self.assertLess(abs(power.mean() - 1.0), 4.0 * np.sqrt(2.0 / freedom / bins * together))
        low, high = stats.chi2.ppf([0.025, 0.975], freedom) / freedom
        outside = np.mean((power < low) | (power > high))
        self.assertLess(abs(outside - 0.05), 4.0 * np.sqrt(0.05 * 0.95 / bins * together))

    def test_it_is_welchs_method_as_scipy_has_it(self):
        from scipy import signal
        values = noise(5000, 3) + 100.0
        found = spectrum.density(values, [slice(0, 5000)], 50.0)
        hz, power = signal.welch(values, 50.0, window="hann", nperseg=1024, noverlap=512, detrend="constant", axis=0)
        np.testing.assert_allclose(found.hz, hz[1:-1])
        np.testing.assert_allclose(found.lsb_rthz ** 2, power[1:-1], rtol=1e-9)

    def test_a_sine_has_half_its_amplitude_squared(self):
        hz = 100.0 * 128 / 1024
        wave = 30.0 * np.sin(2.0 * np.pi * hz * np.arange(8192) / 100.0)
        found = spectrum.density(wave[:, None], [slice(0, 8192)], 100.0)
        power = np.sum(found.lsb_rthz ** 2) * (100.0 / 1024)
        self.assertAlmostEqual(power, 30.0 ** 2 / 2.0, delta=1e-6 * 450.0)
        self.assertEqual(found.hz[np.argmax(found.lsb_rthz)], hz)

    def test_gaps_missing_samples_and_segments_end_a_stretch(self):
        t_us = 10_000 * np.arange(100)
        t_us[40:] += 10_000
        missing = np.zeros(100, bool)
        missing[60:62] = True
        self.assertEqual(spectrum.even_stretches(t_us, missing, [slice(0, 80), slice(80, 100)], 10_000),
                         [slice(0, 40), slice(40, 60), slice(62, 80), slice(80, 100)])

    def test_several_stretches_are_averaged_by_their_pieces(self):
        values = np.concatenate((3.0 * noise(32 * 50), noise(32 * 150)))
        parts = [slice(0, 32 * 50), slice(32 * 50, 32 * 200)]
        found = spectrum.density(values, parts, 100.0)
        length = 2 * (len(found.hz) + 1)
        (one, n), (two, m) = (spectrum.power_sum(values[part], length) for part in parts)
        self.assertEqual((n, m), (2 * 1600 // length - 1, 2 * 4800 // length - 1))
        both = (one + two)[1:-1, 0] * 2.0 / ((n + m) * 100.0 * 0.375 * length)  # 3/8: the mean square of a Hann window
        np.testing.assert_allclose(found.lsb_rthz[:, 0] ** 2, both, rtol=1e-9)

    def test_too_short_is_none(self):
        self.assertIsNone(spectrum.density(noise(31), [slice(0, 31)], 100.0))
        self.assertIsNone(spectrum.density(noise(31), [], 100.0))
        self.assertEqual(spectrum.density(noise(32), [slice(0, 32)], 100.0).pieces, 1)

    def test_the_data_sheets_noise(self):
        """0.75 LSB rms to 100 Hz over 50 Hz; 1.5 LSB at 400 Hz over 200 Hz; 0.75 LSB at 25 Hz over 12.5 Hz; z 1.1."""
        for rate_hz, rms_x, rms_z, width_hz in ((100.0, 0.75, 1.1, 50.0), (400.0, 1.5, 2.2, 200.0), (25.0, 0.75, 1.1, 12.5)):
            x, z = rms_x / width_hz ** 0.5, rms_z / width_hz ** 0.5
            np.testing.assert_allclose(spectrum.sheet_lsb_rthz(rate_hz), (x, x, z))


class Picture(Case):
    def marked(self, figure):
        """Times at which the first panel marks a gated row, and those of them at its edges."""
        lines = figure.axes[0].get_lines()
        marks = {mark: sorted(t for line in lines if line.get_marker() == mark for t in line.get_xdata()) for mark in "x^v"}
        return marks["x"] + marks["^"] + marks["v"], marks["^"]

    def test_no_gate_hit_of_an_hour_goes_unseen(self):
        gated = (1, 23_456, 60_000, 89_998)
        (one,) = pictured.load(self.recording(90_000, gated, step_us=40_000))
        figure = picture.draw([one], USUAL, True, "an hour")
        seen, at_edge = self.marked(figure)
        np.testing.assert_allclose(sorted(seen), [0.04 * row for row in gated])
        self.assertEqual(len(at_edge), 4)  # 90 degrees: 0.004 % of the points do not widen the picture
        drawn = sum(len(line.get_xdata()) for axes in figure.axes[:2] for line in axes.get_lines())
        self.assertLess(drawn, 2 * (2400 * 4 + 2400 * 600))

    def test_lanes_show_a_single_row_with_its_count(self):
        flags = np.zeros(50_000, int)
        flags[40_000] = 8
        figure = picture.draw(pictured.load(self.recording(50_000, (7,), flags=flags)), ["flags"], True, "")
        lanes = figure.axes[0]
        self.assertEqual([label.get_text() for label in lanes.get_yticklabels()], ["gated", "clipped"])
        self.assertEqual([text.get_text() for text in lanes.texts], ["1 rows, 0.002 %"] * 2)
        for image, row in zip(lanes.get_images(), (7, 40_000)):
            shaded = np.flatnonzero(image.get_array()[0, :, 3])
            self.assertEqual(shaded.tolist(), [int(row * picture.LANE_COLUMNS / 49_999)])

    def test_a_line_is_broken_at_the_seam_and_at_a_gap(self):
        from matplotlib.figure import Figure
        axes = Figure().subplots()
        begins = np.zeros(8, bool)
        begins[[0, 2]] = True
        picture.line(axes, np.arange(8.0), np.array([1.0, 2, 3, 170, 179, -179, -170, -160]), begins, True)
        gaps = np.flatnonzero(np.isnan(axes.get_lines()[0].get_ydata()))
        self.assertEqual(gaps.tolist(), [2, 6])  # before row 2, and before row 5

    def test_pictures_of_each_kind(self):
        runs = (self.recording(500, gated=(5, 50), truth=True), self.recording(500, name="plain.csv", filtered=False),
                self.recording(20, name="short.csv"))
        for suffix, *words in (("svg", runs[0]), ("png", runs[1]), ("png", *runs, "--columns", "roll,flags,spectrum"), ("html", *runs),
                               ("png", runs[0], runs[2], "--stack", "--columns", "x,y,flags,spectrum"), ("html", *runs, "--stack"),
                               ("html", runs[0], "--columns", "spectrum"), ("png", runs[2], "--columns", "z", "--from", 0.05, "--to", 0.1)):
            out = self.folder / f"out.{suffix}"
            status, said, err = self.tilt(*words, "-o", out)
            self.assertEqual((status, err), (0, ""), words)
            self.assertIn(str(out), said)
        self.assertTrue((self.folder / "out.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n"))
        self.assertTrue(xml.etree.ElementTree.parse(self.folder / "out.svg").getroot().tag.endswith("svg"))

    def test_several_filters_in_one_file_as_replay_writes_them(self):
        path = self.folder / "several.csv"
        columns = {f"{name}_{end}": np.full(40, value) for end, value in ((PLAIN, 100), (LONG, 200)) for name in ("roll_cdeg", "x_mg")}
        columns |= {f"flags_{PLAIN}": np.arange(40) == 3, f"flags_{LONG}": np.full(40, 200)}
        stream.write(path, 10_000 * np.arange(40), np.full((40, 3), 100), flags=np.zeros(40, int), columns=columns)
        found = pictured.load(path)
        self.assertEqual([one.name for one in found], [f"several.csv: {PLAIN}", f"several.csv: {LONG}"])
        self.assertEqual([(one.filtered["roll"][0], one.filtered["x"][0], int(one.flags[5])) for one in found], [(1.0, 100.0, 0), (2.0, 200.0, 200)])
        self.assertEqual([np.flatnonzero(one.gated).tolist() for one in found], [[3], []])
        self.assertTrue(pictured.same_readings(found))

    def test_a_part(self):
        status, out, _ = self.tilt(self.recording(), "-o", self.folder / "a.html", "--from", 5, "--to", 7)
        self.assertEqual(status, 0)
        self.assertIn("200 rows", out)


class Refused(Case):
    def refused(self, reason, *words):
        status, out, err = self.tilt(*words)
        self.assertEqual((status, out), (2, ""))
        self.assertIn(reason, err)
        self.assertEqual(list(self.folder.glob("*.png*")), [])

    def test_a_bad_file_with_its_line(self):
        path = self.recording(20)
        lines = path.read_text().splitlines()
        for number, bad, reason in ((5, "1,2,3", "3 fields where the header has 10"),
                                    (9, lines[8].replace("2000", "20.5"), "not a whole number: '20.5'")):
            path.write_text("\n".join(lines[:number - 1] + [bad] + lines[number:]))
            self.refused(f"run.csv:{number}: ", path, "-o", self.folder / "out.png")
            self.refused(reason, path, "-o", self.folder / "out.png")

    def test_what_cannot_be_meant(self):
        path, out = self.recording(20), self.folder / "out.png"
        self.refused("no column row: choose from roll", path, "-o", out, "--columns", "row")
        self.refused("--columns: empty: name at least one", path, "-o", out, "--columns", ",")
        self.refused("use one of .png .svg .html", path, "-o", self.folder / "out.pdf")
        self.refused("no rows from 9 s to", path, "-o", out, "--from", "9")
        self.refused("absent.csv: cannot be read", self.folder / "absent.csv", "-o", out)
        self.refused("cannot write it", path, "-o", self.folder / "no" / "out.png")


class Page(Case):
    def data(self, *words):
        out = self.folder / "out.html"
        self.assertEqual(self.tilt(*words, "-o", out)[0], 0)
        text = out.read_text()
        self.assertNotRegex(text, r"(?:src|href)\s*=|https?://|@import|url\(")  # it loads nothing
        return json.loads(re.search(r"const DATA = (.*);\n", text).group(1).replace("<\\/", "</"))

    def numbers(self, text, kind):
        return np.frombuffer(base64.b64decode(text), kind)

    def test_the_page_has_the_recordings_numbers(self):
        path = self.recording(300, (7, 100))
        found, known = self.data(path)["files"][0], stream.read(path, ["roll_cdeg"])
        np.testing.assert_array_equal(self.numbers(found["t"], "<u4"), known.t_us // 100)
        np.testing.assert_array_equal(self.numbers(found["flags"], "<u2"), known.flags)
        np.testing.assert_array_equal(self.numbers(found["series"]["filtered"]["roll"], "<i2"), known.columns["roll_cdeg"])
        raw = np.degrees(np.arctan2(known.lsb[:, 1] / 265.0, known.lsb[:, 2] / 256.0))
        np.testing.assert_allclose(self.numbers(found["series"]["raw"]["roll"], "<i2"), 100.0 * raw, atol=0.51)
        shown = pictured.load(path)[0]
        for axis, lsb_per_g in enumerate((265.0, 265.0, 256.0)):
            np.testing.assert_allclose(shown.raw["xyz"[axis]], 1000.0 / lsb_per_g * known.lsb[:, axis])
        self.assertEqual((found["gated"], found["rows"], found["kept"]), (2, 300, 300))

    def test_a_long_recording_is_thinned_to_its_extremes_and_no_gate_hit_is_lost(self):
        gated = (1, 5000, 15_000, 19_998)
        with mock.patch.object(plot_page, "ROWS_MAX", 4000):
            found = self.data(self.recording(20_000, gated))["files"][0]
        t = self.numbers(found["t"], "<u4")
        self.assertLess(len(t), 4000)
        self.assertEqual((found["rows"], found["kept"], found["gated"]), (20_000, len(t), 4))
        at = t[(self.numbers(found["flags"], "<u2") & 1) != 0]
        self.assertEqual(len(at), 4)
        self.assertTrue(np.all((at - 100 * np.array(gated) >= 0) & (at - 100 * np.array(gated) < 100 * 200)))  # of 20,000 rows in 100 columns
        self.assertEqual(self.numbers(found["series"]["raw"]["roll"], "<i2").max(), 9000)

    def test_a_name_cannot_break_the_page(self):
        path = self.recording(50, name="a<b>&'.csv")
        self.assertEqual(self.data(path, "--title", "</script><script>alert(1)")["title"], "</script><script>alert(1)")
        self.assertEqual((self.folder / "out.html").read_text().count("</script>"), 2)

    @unittest.skipUnless(BROWSER, "no chromium: the page is not looked at (apt-get install chromium)")
    def test_in_a_browser(self):
        self.data(self.recording(360, (100,)), "--columns", "roll,flags")
        page = self.folder / "out.html"
        script = """<script>
const key = name => document.dispatchEvent(new KeyboardEvent("keydown", { key: name }));
const span = () => Math.round(view.a) + " " + Math.round(view.b), told = [];
told.push(span()); key("+"); told.push(span()); key("ArrowLeft"); told.push(span());
key("ArrowRight"); key("ArrowRight"); key("ArrowRight"); told.push(span());
key("0"); told.push(span()); zoom(0.1, 10000); told.push(span()); show(0, 1e9);
tell(9960); document.body.dataset.readout = document.getElementById("readout").textContent;
document.body.dataset.spans = told.join("; ");
document.body.dataset.crosses = 0;
requestAnimationFrame(() => { new Plot(drawings[0][0], 0, 100).marks(DATA.files[0], DATA.files[0].series.raw.roll, 100, 0, 360,
  i => DATA.files[0].flags[i] & 1, 2, () => document.body.dataset.crosses++); });
</script></body>"""
        page.write_text(page.read_text().replace("</body>", script))
        command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=3000",
                   "--run-all-compositor-stages-before-draw", f"--user-data-dir={self.folder}/user"]
        done = subprocess.run([*command, "--dump-dom", f"file://{page}"], capture_output=True, text=True, timeout=600, check=False)
        body = re.search(r"<body([^>]*)>", done.stdout)
        self.assertIsNotNone(body, done.stderr)
        body = body.group(1)
        # 3.59 s in ticks of 0.1 ms; 0.6 of it about the middle; a quarter of that earlier; 3 later, as far as it goes; all; a tenth about 1 s
        self.assertIn('data-spans="0 35900; 7180 28720; 1795 23335; 14360 35900; 0 35900; 9000 12590"', body)
        self.assertRegex(body, r'data-readout="1\.000 s   roll raw 90\.00, filtered 20\.00   flags: gated"')
        self.assertIn('data-rows="360"', body)
        self.assertRegex(body, r'data-drawn-ms="\d+"')
        self.assertIn('data-crosses="1"', body)


if __name__ == "__main__":
    from unity_line import main
    main()
