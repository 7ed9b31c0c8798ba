"""Tests of how the page of `tilt live` reads lines, counts what is lost and draws, in a headless Chromium. Run from the repository root with
build/venv/bin/python."""
import json
import math
import pathlib
import random
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt import protocol  # noqa: E402
from browser import ABSENT  # noqa: E402
from fake_board import BANNER, HEADER, rows  # noqa: E402
from live_support import PAGE_FILE, Case  # noqa: E402

# feeds pieces [text, arrival in ms] to a parser of its own; what came out
PARSE = """((pieces, whole) => {
  const rows = [], notes = [], protocol = new Protocol({ row: (row) => rows.push(row), note: (text) => notes.push(text) });
  protocol.begin(whole);
  for (const [text, ms] of pieces) protocol.feed(text, ms);
  return { rows, notes, count: protocol.rows, broken: protocol.broken, lost: protocol.losses.lost, restarts: protocol.restarts,
    mode: protocol.mode };
})"""


@unittest.skipIf(ABSENT, ABSENT)
class TestParser(Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.page = cls.browser.open(PAGE_FILE)
        cls.page.until("true")

    def parse(self, *pieces, whole=True):
        pieces = [piece if isinstance(piece, tuple) else (piece, 0) for piece in pieces]
        return self.page.value(f"{PARSE}({json.dumps(pieces)}, {json.dumps(whole)})")

    def lost(self, times, flags=lambda number: 0):
        return self.parse("".join(f"{t % (1 << 32)},0,0,256,0,0,1000,0,0,{flags(n)}\n" for n, t in enumerate(times)))["lost"]

    def test_row(self):
        found = self.parse(HEADER.decode() + "14985,-5,1,259,-20,4,1012,22,-110,129\n")
        self.assertEqual((found["count"], found["broken"], found["lost"]), (1, 0, 0))
        one = found["rows"][0]
        self.assertEqual((one["lsb"], one["mg"], one["roll"], one["pitch"], one["flags"]), ([-5, 1, 259], [-20, 4, 1012], 0.22, -1.1, 129))
        self.assertAlmostEqual(one["rawRoll"], math.degrees(math.atan2(1 / 265, 259 / 256)), 9)
        self.assertAlmostEqual(one["rawPitch"], math.degrees(math.atan2(5 / 265, math.hypot(1 / 265, 259 / 256))), 9)

    def test_pieces_and_line_ends_make_no_difference(self):
        text = (BANNER + HEADER + rows(0, 5)).decode()
        whole = self.parse(text)
        self.assertEqual((whole["count"], len(whole["notes"])), (5, 2))
        self.assertEqual(self.parse(*text), whole)
        self.assertEqual(self.parse(text.replace("\n", "\r\n")), whole)

    def test_lines_that_are_no_rows_are_counted(self):
        good = "1,2,3,4,5,6,7,8,9,0"
        for bad in ("1,2,3,4,5,6,7,8,9", good + ",1", "1,2,3,4,5,6,7,8,9,x", "1,,3,4,5,6,7,8,9,0", "-1,2,3,4,5,6,7,8,9,0", "1,4096,3,4,5,6,7,8,9,0",
                    "1,2,3,4,5,6,7,18001,9,0", "1,2,3,4,5,6,7,8,-9001,0", "1,2,3,4,5,6,7,8,9,65536", "4294967296,2,3,4,5,6,7,8,9,0", "\u00ff\u00fe",
                    "1e3,2,3,4,5,6,7,8,9,0", "t_us,x_lsb", "roll_raw:1.0,roll:x", "roll_raw:1.0,roll:1.0"):
            found = self.parse(bad + "\n" + good + "\n")
            self.assertEqual((found["broken"], found["count"]), (1, 1), bad)

    def test_first_piece_of_a_line_is_dropped_where_the_stream_was_joined(self):
        found = self.parse("5,2,3,4,5,6,7,8,9,0\n15,2,3,4,5,6,7,8,9,0\n", whole=False)  # the first may have been 14985,...
        self.assertEqual((found["count"], found["broken"]), (1, 0))
        self.assertEqual(self.parse("# tilt-uno\n", whole=False)["notes"], ["tilt-uno"])

    def test_header_names_the_columns(self):
        found = self.parse("flags,t_us,new,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg\n8,1000,77,1,2,3,4,5,6,700,800\n")
        self.assertEqual((found["rows"][0]["flags"], found["rows"][0]["lsb"], found["rows"][0]["roll"]), (8, [1, 2, 3], 7))

    def test_clock_wraps_and_begins_anew(self):
        found = self.parse("".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in (4294967290, 4704, 14704)))
        self.assertAlmostEqual(found["rows"][1]["s"] - found["rows"][0]["s"], 0.00471, 9)  # 6 us to the wrap and 4704 after it
        self.assertEqual(found["restarts"], 0)
        found = self.parse("".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in (90000, 100000, 15000, 25000)))
        self.assertEqual((found["restarts"], found["lost"]), (1, 0))
        self.assertTrue(found["rows"][2]["apart"] and not found["rows"][3]["apart"])
        self.assertGreater(found["rows"][2]["s"], found["rows"][1]["s"])

    def test_digit_lost_in_a_time_costs_its_row_alone(self):
        good = [f"{15000 + 10000 * n}" for n in range(100)]
        for wrong in (good[60][:-1], good[60][1:], "9" + good[60], "4000000000"):
            times = [*good[:60], wrong, *good[61:]]
            found = self.parse("".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in times))
            self.assertEqual([found[name] for name in ("count", "broken", "lost", "restarts")], [99, 1, 1, 0], wrong)

    def test_held_row_goes_where_the_interval_changes(self):
        text = "".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in [*range(0, 300000, 10000), 77])
        for line in ("# going", "# tilt-uno 0.1.0: roll and pitch from an ADXL345"):
            found = self.parse(text + line + "\n" + "".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in range(9000000, 9100000, 10000)))
            self.assertEqual([found[name] for name in ("count", "broken", "lost", "restarts")], [40, 1, 0, 0], line)

    def test_long_gap_counts(self):
        self.assertEqual(self.lost([10000 * n for n in range(2000) if not 100 <= n < 1500]), 1400)  # 14 s

    def test_rows_minutes_apart_are_rows(self):
        found = self.parse("".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in range(0, 3200000001, 800000000)))  # every 10000 at 12.5 Hz
        self.assertEqual((found["count"], found["broken"], found["lost"]), (5, 0, 0))

    def test_plotter_rows_are_spread_over_their_arrival(self):
        line = "roll_raw:1.23,roll:1.20,pitch_raw:-0.42,pitch:-0.40,gated:1\n"
        found = self.parse((line, 1000), (line * 4, 1100))
        times = [each["s"] for each in found["rows"]]
        for before, after in zip(times, times[1:]):
            self.assertAlmostEqual(after - before, 0.025, 9)
        self.assertEqual((found["mode"], found["count"], found["rows"][0]["flags"]), ("plot", 5, protocol.GATED))
        self.assertEqual([found["rows"][0][name] for name in ("rawRoll", "roll", "rawPitch", "pitch")], [1.23, 1.2, -0.42, -0.4])

    def test_lost_rows_are_counted_exactly(self):
        chance = random.Random(7)
        for period, share in ((10000, 0.0), (10000, 0.02), (2500, 0.1), (1251, 0.25), (80000, 0.05)):
            kept = [n for n in range(3000) if n in (0, 2999) or chance.random() >= share]
            times = [n * period * 1.021 + chance.uniform(-0.05, 0.05) * period + 4290000000 for n in kept]  # over the wrap, 2.1 % off, jitter
            self.assertEqual(self.lost([round(t) for t in times]), 3000 - len(kept), (period, share))

    def test_gap_among_the_first_rows_counts(self):
        self.assertEqual(self.lost([10000 * n for n in range(30) if n not in (2, 3, 5)]), 3)

    def test_interval_follows_the_sensor(self):
        """9300 us at first, 10000 then: a gap of 9 intervals reckoned with the first would be 9.7, one row too many."""
        times = [9300 * n for n in range(12)] + [102300 + 10000 * n for n in range(1, 300) if not 200 <= n < 208]
        self.assertEqual(self.lost(times), 8)

    def test_flag_dropped_is_one_row_at_least_and_the_gap_tells_how_many(self):
        times = [10000 * n for n in range(60) if n not in (30, 31, 40)]
        flagged = {28, 29, 45}  # row 29 is late by nothing; 32 (index 30) has no flag: lost on the line; index 45 was late by nothing
        self.assertEqual(self.lost(times, lambda n: protocol.DROPPED if n in flagged else 0), 1 + 1 + 2 + 1 + 1)

    def test_first_row_tells_nothing_of_what_was_before(self):
        self.assertEqual(self.lost([10000 * n for n in range(20)], lambda n: protocol.DROPPED if n == 0 else 0), 0)

    def test_silence_has_rows_of_its_own(self):
        times = [10000 * n for n in range(50)] + [490000 + 100000 * n for n in range(1, 20)] + [2395000 + 10000 * n for n in range(20)]
        self.assertEqual(self.lost(times, lambda n: protocol.NO_SAMPLE if 50 <= n < 69 else 0), 0)
        self.assertEqual(self.lost(times), 18 * 9 + 9 + 0)  # the same times of rows with samples: 19 gaps of 9, the last of 4.5 less

    def test_announced_change_of_the_interval_is_no_loss(self):
        def text(times):
            return "".join(f"{t},0,0,256,0,0,1000,0,0,0\n" for t in times)
        before, late = range(0, 500000, 10000), range(590000, 1000000, 100000)  # row 490000, then every tenth, told four rows later
        after = [t for t in range(1090000, 4000000, 100000) if t != 3090000]
        self.assertEqual(self.parse(text(before) + text(late) + "# every 10\n" + text(after))["lost"], 1)
        self.assertGreater(self.parse(text(before) + text(late) + text(after))["lost"], 9 * 30)  # not told: they are gaps

    def test_shorter_interval_is_learned(self):
        times = list(range(0, 1000000, 100000)) + [t for t in range(1000000, 2000000, 10000) if t not in (1500000, 1510000)]
        self.assertEqual(self.lost(times), 2)

    def test_flags_have_the_names_of_the_protocol(self):
        self.assertEqual({bit: name for bit, name, _ in self.page.value("FLAGS")}, protocol.FLAG_NAMES)

    def test_a_pixel_shows_its_extremes(self):
        chance = random.Random(3)
        values = [round(chance.gauss(0, 1), 3) for _ in range(4000)]
        values[1234] = 99.5  # one outlier among 40 rows of a pixel
        found = self.page.value("""((values) => {
          const history = new RowHistory(8192), points = [];
          values.forEach((value, n) => history.push({ s: n * 0.01, apart: n === 0, rawRoll: value, roll: 0, rawPitch: 0, pitch: 0, flags: 0 }));
          eachPixel(history, "rawRoll", 0, values.length, (s) => Math.floor(s / 0.4 + 1e-9), (x, y) => points.push([x, y]));
          return points; })(""" + json.dumps(values) + ")")
        for x in range(100):
            shown, meant = [y for at, y in found if at == x], values[40 * x:40 * x + 40]
            self.assertAlmostEqual(max(shown), max(meant), 4)
            self.assertAlmostEqual(min(shown), min(meant), 4)
            self.assertLessEqual(len(shown), 4)

    def test_line_breaks_where_roll_goes_round_and_where_rows_are_apart(self):
        begins = self.page.value("""(() => {
          const history = new RowHistory(16), begins = [];
          [[179, 1], [180, 0], [-179, 0], [-178, 0], [-177, 1]].forEach(([roll, apart], n) =>
            history.push({ s: n, apart, rawRoll: 0, roll, rawPitch: 0, pitch: 0, flags: 0 }));
          eachPixel(history, "roll", 0, 5, (s) => s, (x, y, anew) => { if (anew) begins.push(y); });
          return begins; })()""")
        self.assertEqual(begins, [179, -179, -177])

    def test_horizon_turns_against_roll_and_rises_with_pitch(self):
        # x lowered: the gravity reaction has a part along -x, so atan2(-x, ..) is positive and the eye looks down: the horizon goes up (-y)
        self.assertEqual(self.page.value("horizonTransform(12.345, 7)"), "rotate(-12.35) translate(0 -14.00)")
        self.assertEqual(self.page.value("horizonTransform(-90, -45.5)"), "rotate(90.00) translate(0 91.00)")

    def test_history_keeps_the_last_rows(self):
        self.assertEqual(self.page.value("""(() => {
          const history = new RowHistory(8);
          for (let n = 0; n < 20; n++) history.push({ s: n * 0.5, apart: false, rawRoll: n, roll: n, rawPitch: 0, pitch: 0, flags: 0 });
          return [history.first, history.last, history.find(0), history.find(7), history.find(7.1), history.find(99), history.rate()]; })()"""),
                         [12, 9.5, 12, 14, 15, 20, 2])


if __name__ == "__main__":
    from unity_line import main
    main()
