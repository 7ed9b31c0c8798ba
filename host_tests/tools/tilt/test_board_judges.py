#!/usr/bin/env python3
"""The judges of `tilt board` for which nobody touches a wire, with lines by the script and a clock of their own: what passes, what fails and why,
what never comes."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT  # noqa: E402
from board_support import BEGINS, GONE, Desk, JudgeCase, Model, banner, row, rows  # noqa: E402
from tilt.realboard import judges_motion, judges_starts, judges_wires, watch  # noqa: E402
from tilt.realboard.checks import CHECKS  # noqa: E402


class Alone(JudgeCase):
    def test_identity(self):
        numbers = self.passes("identity", Desk(rows(0, 20), Model()))
        self.assertEqual((numbers["fault"], numbers["measured_hz"], numbers["filter"]), (0, 98.5, DEFAULT))
        self.fails("identity", "state 'fault' with fault 7", Desk(rows(0, 20), Model(fault=7)))
        self.fails("identity", "no reply to 'version' within 5 s", Desk(rows(0, 20)))
        versions = iter([[banner()[0]], []])
        self.fails("identity", "incomplete reply to 'settings'", Desk(rows(0, 20), {"version": lambda *_: next(versions)}))
        less = Model()
        del less.values["level"]
        self.fails("identity", "does not list level", Desk(rows(0, 20), less))

    def test_rate(self):
        numbers = self.passes("rate", Desk(rows(0, 40)))
        self.assertEqual((numbers["rate_hz"], numbers["clock_ppm"], numbers["rows_lost"]), (100.0, 0, 0))
        numbers = self.passes("rate", Desk(rows(0, 40, fast_ppm=4800)))
        self.assertAlmostEqual(numbers["clock_ppm"], 4800, delta=60)
        for ppm in (-6000, 6000):
            self.assertAlmostEqual(self.fails("rate", f"off by {str(ppm)[0]}", Desk(rows(0, 40, fast_ppm=ppm)))["clock_ppm"], ppm, delta=60)

    def test_rate_with_what_is_missing(self):
        whole = rows(0, 40)
        self.fails("rate", "3 rows missing, 0 bad lines", Desk(whole[:500] + whole[503:]))
        self.fails("rate", "1 rows missing, 1 bad lines", Desk(whole[:500] + [(5.0, "12,3")] + whole[501:]))
        self.fails("rate", r"1 of 300\d rows have no sample", Desk(whole[:500] + [(5.0, row(5.0, flags=2))] + whole[501:]))
        self.fails("rate", "94.34 rows/s, but 100 are set", Desk(rows(0, 40, period_s=0.0106)))
        self.fails("rate", "0 rows in 30 s, 0.0 s", Desk())
        self.fails("rate", "the port is gone", Desk(whole[:500] + [(6.0, GONE)]))
        self.fails("rate", "the board was reset", Desk(whole[:500] + [(6.0, banner())] + whole[700:]))
        self.fails("rate", "the board reported 'fault 3", Desk(whole[:500] + [(6.0, BEGINS.format(3))]))

    def test_selftest(self):
        def says(*verdicts):
            return {"selftest": ["# selftest: hold still"] + [f"# selftest {axis} 521.875 LSB, 88.5 to 955.8: {word}" for axis, word in
                                                              zip("xyz", verdicts)]}
        numbers = self.passes("selftest", Desk(rows(0, 20), says("pass", "high", "pass")))
        self.assertEqual((numbers["y_says"], numbers["x_lsb"]), ("high", 521.875))
        self.fails("selftest", "failed on y, z", Desk(rows(0, 20), says("pass", "FAIL", "FAIL")))
        self.fails("selftest", "the board replied 'refused 8: moving'", Desk(rows(0, 20), {"selftest": ["# refused 8: moving"]}))
        self.fails("selftest", "no result of 'selftest' within 15 s", Desk(rows(0, 20), says("pass")))

    def fast(self, khz=400, **grow):
        model = Model(grow={"samples": 16050, **grow})
        model.UNITS = model.UNITS | {"rate": f" Hz, I2C at {khz} kHz"}
        return Desk(rows(0, 60, period_s=1 / 160), model)

    def test_fast_bus(self):
        desk = self.fast()
        desk.replies.grow["bus errors"] = 16
        numbers = self.passes("fast_bus", desk)
        self.assertEqual((numbers["khz"], numbers["samples"], numbers["bus_errors"]), (400.0, 16050, 16))
        self.assertEqual(desk.sent[-1], "rate 100")
        self.fails("fast_bus", "17 bus errors in 16050 samples", self.fast(**{"not acknowledged": 10, "timeouts": 7}))
        self.fails("fast_bus", "2 samples lost", self.fast(lost=2))
        self.fails("fast_bus", "12000 samples in 20.0 s, expected 15995", self.fast(samples=12000))
        self.fails("fast_bus", "refused 5", Desk(rows(0, 60), {"rate 800": ["# refused 5: takes 9 of 8 cycles a sample"]}))
        self.fails("fast_bus", "no reply to 'rate 800'", Desk(rows(0, 60)))

    def bauds(self, spoilt_at=None, silent_at=None, deaf_at=None):
        desk = Desk(rows(0, 200), Model())
        real = desk.replies.get

        def get(text, default=()):
            if text.startswith("baud "):
                if text == f"baud {deaf_at}":
                    return ()
                desk.baud = int(text.split()[1])
                at = [(each, line) for each, line in rows(0, 200) if each > desk.time_s + 0.05]
                lines = at if desk.baud != silent_at else [each for each in at if each[0] > desk.time_s + 7]
                if desk.baud == spoilt_at:
                    lines = [(each, line if n % 50 else "12,") for n, (each, line) in enumerate(lines)]
                desk.script.clear()
                desk.script.extend(lines)
            return real(text, default)
        desk.replies.get = get
        return desk

    def test_baud_rates(self):
        desk = self.bauds()
        numbers = self.passes("baud_rates", desk)
        self.assertEqual([text for text in desk.sent if text.startswith("baud ")], ["baud 9600", "baud 1000000", "baud 115200"])
        self.assertGreater(numbers["rows_at_9600"], 250)
        self.fails("baud_rates", r"fails at 1000000 \(\d+ bad lines, \d+ rows\)$", self.bauds(spoilt_at=1000000))
        self.fails("baud_rates", r"fails at 9600 \(no row within 5 s\)$", self.bauds(silent_at=9600))
        self.fails("baud_rates", r"fails at 1000000 \(no reply to 'baud 1000000' within 5 s\)$", self.bauds(deaf_at=1000000))

    def test_a_baud_rate_that_never_comes_back_asks_for_a_reset(self):
        desk = self.bauds(silent_at=9600)
        real = desk.replies.get

        def get(text, default=()):
            found = real(text, default)
            if text == "baud 9600":
                desk.script.clear()
                desk.script.extend([(desk.time_s + 15, banner())] + rows(desk.time_s + 15.1, 200))
            return found
        desk.replies.get = get
        self.fails("baud_rates", "fails at 9600", desk)
        self.assertTrue(any("press its reset button" in text for text in desk.said))


class Motion(JudgeCase):
    G = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))

    def faces(self, which, g_mg=1000, sideways=0):
        script, at = [], 0.0
        for face in which:
            mg = [round(g_mg * each) for each in face]
            mg = [each or sideways for each in mg]
            script += rows(at, at + 2, mg=mg) + [(at + 2 + n * 0.01, row(at + 2 + n * 0.01, mg=(300 + 20 * n, 500, 400))) for n in range(50)]
            at += 2.5
        return script

    def test_six_faces(self):
        self.assertEqual(self.passes("six_faces", Desk(self.faces(self.G)))["-y_mg"], 1000)
        self.fails("six_faces", "not seen at rest within 20 s: -y, -z", Desk(self.faces(self.G[:3] + self.G[4:5])))
        self.fails("six_faces", r"not 800 to 1280 mg: \+x 1350, -x 1350", Desk(self.faces(self.G, g_mg=1350)))
        self.fails("six_faces", "not 800 to 1280 mg", Desk(self.faces(self.G, g_mg=790)))
        self.fails("six_faces", "not seen at rest within 20 s", Desk(self.faces(self.G, sideways=500)))  # on edge
        self.fails("six_faces", "not seen at rest within 20 s", Desk())

    def knocks(self, many=40, after=(0, 0, 1000)):
        script = rows(0, 4) + rows(9, 40, mg=after)
        shown = [(at, (90, 0, 256), (30, 0, 1000)) if n < many else (at, (0, 0, 256), after) for n, (at, _) in enumerate(rows(4, 9))]
        return script + [(at, row(at, flags=1, lsb=lsb, mg=mg)) for at, lsb, mg in shown]

    def test_shake(self):
        numbers = self.passes("shake", Desk(self.knocks()))
        self.assertEqual((numbers["readings_off"], numbers["moved_deg"], numbers["rows_gated"] > 100), (40, 0.0, True))
        self.assertAlmostEqual(numbers["worst_deg"], 1.72, delta=0.01)
        self.fails("shake", "the tilt changed by 2.29 degrees", Desk(self.knocks(after=(40, 0, 1000))))
        self.passes("shake", Desk(self.knocks(after=(17, 0, 1000))))
        self.fails("shake", "only 10 of 20 readings more than 60 LSB off within 20 s", Desk(self.knocks(10)))
        moving = [(n * 0.01, row(n * 0.01, mg=(n % 50 * 10, 0, 1000))) for n in range(3000)]
        self.fails("shake", "was not at rest within 20 s", Desk(moving))


class Words(unittest.TestCase):
    def test_every_check_has_its_tests(self):
        text = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path("host_tests/tools/tilt").glob("test_board_*.py"))
        for check in CHECKS:
            for call in ("passes", "fails"):
                self.assertTrue(f'self.{call}("{check.key}"' in text or check.key in ("sda_pulled", "scl_pulled", "scl_short", "sensor_power"),
                                (check.key, call))

    def test_values(self):
        for words, value in (("0 0 0 LSB", "0 0 0"), ("100 Hz, I2C at 363.6 kHz", "100"), ("xyz", "xyz"), ("-yxz", "-yxz"),
                             ("0.1212 0.207 0.9704", "0.1212 0.207 0.9704"), ("csv", "csv")):
            self.assertEqual(watch.value_of(words), value)

    def test_angle(self):
        self.assertAlmostEqual(watch.angle_deg((0, 0, 1000), (0, 1000, 0)), 90)
        self.assertEqual(watch.angle_deg((0, 0, 0), (0, 1000, 0)), 180.0)

    def test_faces(self):
        self.assertEqual(judges_motion.face_of((0, -990, 100))[0], "-y")
        self.assertIsNone(judges_motion.face_of((700, 700, 0))[0])
        self.assertIsNone(judges_motion.face_of((0, 0, 0))[0])

    def test_numbers_of_faults_are_those_of_the_page(self):
        with open("docs/faults.md", encoding="utf-8") as file:
            page = file.read()
        wires = judges_wires
        for number, words in ((wires.INT1_LOW, "INT1 stays low"), (wires.SDA_LOW, "SDA held low"), (wires.SCL_LOW, "SCL held low"),
                              (wires.NO_SENSOR, "no sensor at"), (wires.INT1_HIGH, "INT1 stays high"), (wires.TORN, "torn readings"),
                              (wires.BUS, "I2C bus disturbed"), (wires.READ_BACK, "a register lost"), (wires.NO_DATA, "the sensor stopped")):
            self.assertIn(f"| {number} | {words}", page)
        for words in (judges_starts.BUTTON, *watch.SUPPLY):
            self.assertIn(f"| {words} |", page)
        with open("docs/protocol.md", encoding="utf-8") as file:
            protocol = file.read()
        for words in judges_starts.BROKEN:
            self.assertIn(f"| {words} |", protocol)


if __name__ == "__main__":
    from unity_line import main
    main()
