#!/usr/bin/env python3
"""The judges of `tilt board` for which the owner pulls a wire, presses reset or cuts the supply, with lines by the script and a clock of their
own: what passes, what fails and why, what never comes."""
import pathlib
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from board_support import BACK, BEGINS, GONE, OVER, Desk, JudgeCase, Model, banner, rows  # noqa: E402
from tilt.realboard.bench import Failed  # noqa: E402


class Wires(JudgeCase):
    def broken(self, number=8, back_s=7.0, flags=18, over=OVER, bounces=()):
        """Rows, a fault from 5 s to back_s, rows."""
        good = [each for each in rows(0, 40) if each[0] < 5 or each[0] > back_s]
        return (good + rows(5.05, back_s, flags=flags) + [(5.04, BEGINS.format(number)), (back_s, over.format(number))]
                + [(at, (BEGINS if n % 2 == 0 else over).format(number)) for n, at in enumerate(bounces)])

    def test_each_bus_fault_that_a_check_expects_passes_and_no_other_does(self):
        expected = {"sda_pulled": {1, 3, 7, 8, 11}, "scl_pulled": {1, 3, 7, 8, 11}, "sda_short": {3, 8}, "scl_short": {3, 7},
                    "sensor_power": {1, 3, 4, 6, 7, 8, 11}}
        for key, numbers in expected.items():
            for number in range(1, 13):
                desk = Desk(self.broken(number))
                if number in numbers:
                    self.assertEqual(self.passes(key, desk)["fault"], number)
                else:
                    self.fails(key, f"fault {number} was reported, expected", desk)

    def test_what_is_measured(self):
        numbers = self.passes("sda_short", Desk(self.broken()))
        self.assertEqual({name: numbers[name] for name in ("times", "samples_lost", "fault_lasted_ms", "sensor", "rate_hz")},
                         {"times": 1, "samples_lost": 150, "fault_lasted_ms": 1500, "sensor": "0x53", "rate_hz": 100.0})
        self.assertAlmostEqual(numbers["fault_after_s"], 0.05, delta=0.011)
        self.assertAlmostEqual(numbers["rows_back_s"], 0.01, delta=0.011)

    def test_a_wire_that_bounces(self):
        numbers = self.passes("sda_pulled", Desk(self.broken(bounces=(7.5, 8.0, 9.0, 9.5))))
        self.assertEqual((numbers["times"], numbers["samples_lost"]), (3, 450))
        self.assertEqual(self.passes("sda_pulled", Desk(self.broken(bounces=(7.5, 12.5))))["times"], 2)

    def test_a_bus_check_fails(self):
        self.fails("sda_short", "no fault was reported within 20 s", Desk(rows(0, 60)))
        self.fails("sda_short", "the fault was not over within 20 s", Desk(self.broken(back_s=39)))
        self.fails("sda_short", r"no row has flag 16 \(no sample\)", Desk(self.broken(flags=0)))
        self.fails("sda_short", "the board was reset", Desk(self.broken() + [(5.5, banner())]))
        self.fails("sda_short", "the fault was not over within 20 s", Desk(self.broken(bounces=[7.5 + n for n in range(20)])))
        self.fails("sda_short", "rows in 2 s", Desk([each for each in self.broken() if each[0] < 10.1]))

    def int1(self, number=5, step=1, back_s=16.0):
        script = [each for n, each in enumerate(rows(0, 60)) if each[0] < 5 or each[0] > back_s or n % step == 0]
        return script + [(5.0, BEGINS.format(number)), (back_s, OVER.format(number))]

    def test_int1_wire(self):
        for number in (5, 9):
            numbers = self.passes("int1_wire", Desk(self.int1(number), answers=["y", "y"]))
            self.assertEqual((numbers["fault"], numbers["rate_hz"]), (number, 100.0))
        self.fails("int1_wire", "fault 3 was reported, expected 5 or 9 or 13", Desk(self.int1(3)))
        self.fails("int1_wire", "only 250 rows with a sample in 5 s without INT1", Desk(self.int1(step=2)))
        self.fails("int1_wire", "does not flash three times", Desk(self.int1(), answers=["n"]))
        self.fails("int1_wire", "LED is not dark", Desk(self.int1(), answers=["perhaps", "yes", "no"]))
        self.fails("int1_wire", "no fault was reported within", Desk(rows(0, 60)))
        self.fails("int1_wire", "the fault was not over within", Desk(self.int1(back_s=59), answers=["y", "y"]))

    def test_int1_finger(self):
        self.assertEqual(self.passes("int1_finger", Desk(self.int1(9)))["rows_without_int1"], 1000)
        hum = self.int1(9) + [(at, (OVER if n % 2 == 0 else BEGINS).format(9)) for n, at in enumerate((6.0, 6.2, 8.0, 8.2))]
        self.assertEqual(self.passes("int1_finger", Desk(hum))["times"], 1)
        early = [each for each in self.int1(9) if "over" not in each[1]] + [(9.0, OVER.format(9))]
        self.passes("int1_finger", Desk(early))  # over before the wire was to be put back: hum is taken for INT1
        self.fails("int1_finger", "the board was reset", Desk(self.int1(9) + [(9.0, banner("watchdog, stage mask 1"))]))
        self.fails("int1_finger", r"rows with a sample in 10 s .*\(0.0 s by the board's clock\)", Desk(rows(0, 5) + [(5.0, BEGINS.format(9))]))
        self.fails("int1_finger", "was not over", Desk(self.int1(9, back_s=59)))


class Starts(JudgeCase):
    def restarts(self, at_s=5.0, cause="reset button or serial port opened", kept="as saved", gone_s=None):
        """Rows, a start at that time, rows; with the port gone for so long before."""
        script = rows(0, at_s - 2 * (gone_s or 0) - 0.5) + [(at_s, banner(cause, kept))] + rows(at_s + 0.1, 60)
        return script if gone_s is None else script + [(at_s - gone_s - 0.4, GONE), (at_s - 0.4, BACK)]

    def test_reset_button(self):
        numbers = self.passes("reset_button", Desk(self.restarts(), Model()))
        self.assertEqual((numbers["settings"], numbers["rate_hz"]), ("as saved", 100.0))
        self.assertAlmostEqual(numbers["silent_s"], 0.51, delta=0.02)
        self.assertAlmostEqual(numbers["rows_back_s"], 0.1, delta=0.02)
        self.fails("reset_button", "names the cause 'supply dropped'", Desk(self.restarts(cause="supply dropped"), Model()))
        self.fails("reset_button", "did not restart within 20 s", Desk(rows(0, 60), Model()))
        self.fails("reset_button", "did not restart within 20 s", Desk(rows(0, 5) + [(5.0, banner())], Model()))
        self.fails("reset_button", "no reply to 'mode csv'", Desk(self.restarts()))

    def test_reset_typing(self):
        desk = Desk(self.restarts(), Model(every="3"))
        self.assertEqual(self.passes("reset_typing", desk)["every"], "3")
        self.assertEqual(desk.sent[:2], ["every 4", "4"])
        joined = Model()
        joined.get = lambda text, default=(): (lambda *_: ["# every 44"]) if text in ("4", "every") else Model.get(joined, text, default)
        self.fails("reset_typing", "was joined to text typed after it: every 44", Desk(self.restarts(), joined))
        desk = Desk(rows(0, 60), Model())
        self.fails("reset_typing", "did not restart", desk)
        self.assertEqual(desk.sent[-1], "\n")

    def test_power_second(self):
        numbers = self.passes("power_second", Desk(self.restarts(gone_s=1.2), Model()))
        self.assertAlmostEqual(numbers["port_gone_s"], 1.2, delta=0.01)
        self.passes("power_second", Desk(self.restarts(cause="power on"), Model()))  # a port that stays: another supply
        self.fails("power_second", "settings are 'defaults, saved ones damaged'",
                   Desk(self.restarts(gone_s=1.2, kept="defaults, saved ones damaged"), Model()))
        self.fails("power_second", r"did not restart within 20 s$", Desk(self.restarts(), Model()))  # the button alone
        self.fails("power_second", r"did not restart within 20 s \(the port is gone\)", Desk(rows(0, 5) + [(5.0, GONE)], Model()))

    def test_a_board_that_no_opening_resets(self):
        script = rows(0, 4) + [(4.0, GONE), (5.0, BACK)] + rows(5.1, 60)
        numbers = self.passes("power_second", Desk(script, Model()))
        self.assertEqual((numbers["cause"], numbers["port_gone_s"]), (None, 1.0))

    def test_a_plug_put_back_at_the_last_moment(self):
        script = rows(0, 5) + [(5.0, GONE), (19.0, BACK), (22.0, banner())] + rows(22.1, 60)
        self.assertEqual(self.passes("power_second", Desk(script, Model()))["port_gone_s"], 14.0)

    def test_the_last_of_two_starts_counts(self):
        script = rows(0, 3) + [(3.0, GONE), (4.0, BACK), (4.1, banner("power on")[:2]), (4.3, banner())] + rows(4.4, 60)
        self.assertEqual(self.passes("power_second", Desk(script, Model()))["cause"], "reset button or serial port opened")

    def test_strap(self):
        unread = "defaults, saved ones not read"
        twice = rows(0, 4) + [(4.0, banner(kept=unread))] + rows(4.1, 8) + [(8.0, banner())] + rows(8.1, 60)
        self.assertEqual(self.passes("strap", Desk(twice, Model()))["with_d4"], unread)
        self.fails("strap", "with D4 at GND the settings are 'as saved'", Desk(self.restarts(), Model()))
        again = rows(0, 4) + [(4.0, banner(kept=unread))] + rows(4.1, 8) + [(8.0, banner(kept=unread))] + rows(8.1, 60)
        self.fails("strap", "without the wire the settings are", Desk(again, Model()))
        self.fails("strap", "did not restart", Desk(self.restarts(kept=unread), Model()))
        self.fails("strap", "did not restart", Desk(rows(0, 60), Model()))


class Kept(JudgeCase):
    """The EEPROM: the model answers until the supply goes, and as its EEPROM says after it."""

    OWN = {"every": "1", "offset": "7 8 9", "level": "0 0 1"}

    def cut(self, after, kept="as saved", left=None):
        """The supply goes as the save with this number is typed; `left` is what the EEPROM has then, None: what it had."""
        model, count = Model(**self.OWN), [0]
        desk = Desk(rows(0, 120), model)

        def save(*_):
            count[0] += 1
            if count[0] != after:
                return model.save()
            model.values = dict(model.saved) if left is None else model.values | left
            desk.script.clear()
            at = desk.time_s
            desk.script.extend([(at + 0.2, GONE), (at + 1.5, BACK), (at + 3, banner(kept=kept))] + rows(at + 3.1, at + 60))
            return []
        real = model.get
        model.get = lambda text, default=(): save if text == "save" else real(text, default)
        return desk

    def test_eeprom_cut(self):
        old = self.passes("eeprom_cut", self.cut(4), **self.OWN)
        self.assertEqual((old["saves"], old["read_back"]), (4, "every 5; offset -4 -5 -6"))
        new = self.passes("eeprom_cut", self.cut(4, left={}), **self.OWN)
        self.assertEqual(new["read_back"], "every 3; offset 1 2 3")
        first = self.passes("eeprom_cut", self.cut(1), **self.OWN)
        self.assertEqual(first["read_back"], "every 1; offset 7 8 9")
        self.fails("eeprom_cut", "has 'every 3; offset -4 -5 -6', neither", self.cut(4, left={"every": "3", "offset": "-4 -5 -6"}), **self.OWN)
        self.fails("eeprom_cut", "settings are 'defaults, saved ones damaged'", self.cut(4, kept="defaults, saved ones damaged"), **self.OWN)
        self.fails("eeprom_cut", r"the supply was not cut within 20 s or \d+ saves", Desk(rows(0, 120), self.slow()), **self.OWN)
        self.fails("eeprom_cut", "refused 10: busy", Desk(rows(0, 120), {"every 5": ["# refused 10: busy measuring"]}), **self.OWN)

    def slow(self):
        model = Model()
        real, desk_get = model.save, model.get

        def save(_, desk):
            desk.time_s += 1.0
            return real()
        model.get = lambda text, default=(): save if text == "save" else desk_get(text, default)
        return model

    def test_settings_are_put_back_and_saved_whatever_happens(self):
        for left in ({}, {"every": "3", "offset": "-4 -5 -6"}):
            desk = self.cut(4, left=left)
            try:
                self.passes("eeprom_cut", desk, **self.OWN)
            except Failed:
                pass
            self.assertEqual({name: desk.replies.saved[name] for name in self.OWN}, self.OWN)
        desk = Desk(rows(0, 5) + [(5.0, GONE)], self.slow())
        self.fails("eeprom_cut", "did not restart", desk, **self.OWN)
        self.assertIn("could not be restored", desk.said[-1])
        self.assertIn("'offset 7 8 9', 'level 0 0 1', 'every 1', 'save'", desk.said[-1])

    def kept_desk(self, gone_s=10.0, tilt=(5, -5), level="0.1 0.2 0.97", forgets=()):
        model = Model(**self.OWN)
        desk = Desk(rows(0, 120), model)
        real = model.get

        def tare(*_):
            model.values["level"] = level
            return ["# tare: hold still", f"# level {level}: -1.1499 to 1.1499", "# in force now; type save to keep it"]

        def save(*_):
            model.save()
            if desk.gone or any("pull the USB plug" in text for text in desk.said):
                return ["# saved"]
            at = desk.time_s
            model.values |= dict(forgets)
            desk.script.clear()
            desk.script.extend(rows(at, at + 2) + [(at + 2, GONE), (at + 2 + gone_s, BACK), (at + 4 + gone_s, banner())]
                               + rows(at + 4.1 + gone_s, at + 90, tilt=tilt))
            return ["# saved"]
        model.get = lambda text, default=(): {"tare": tare, "save": save}.get(text) or real(text, default)
        return desk

    def test_kept(self):
        numbers = self.passes("kept", self.kept_desk(), **self.OWN)
        self.assertEqual((numbers["off_s"], numbers["every"], numbers["level"]), (10.0, "7", "0.1 0.2 0.97"))
        self.assertEqual((numbers["roll_deg"], numbers["pitch_deg"]), (0.05, -0.05))
        self.fails("kept", "has level 0.1 0.2 0.97 and every 1, but saved", self.kept_desk(forgets={"every": "1"}), **self.OWN)
        self.fails("kept", "has level 0 0 1 and every 7, but saved", self.kept_desk(forgets={"level": "0 0 1"}), **self.OWN)
        self.fails("kept", "roll 2.5 and pitch -0.1 degrees", self.kept_desk(tilt=(250, -10)), **self.OWN)
        self.fails("kept", "the plug was out for only 2.0 s", self.kept_desk(gone_s=2.0), **self.OWN)
        self.fails("kept", "no reply to 'tare'", Desk(rows(0, 120)), **self.OWN)
        moving = {"tare": ["# tare: hold still", "# refused 8: moving"]}
        self.fails("kept", "the board replied 'refused 8: moving'", Desk(rows(0, 120), moving), **self.OWN)


if __name__ == "__main__":
    from unity_line import main
    main()
