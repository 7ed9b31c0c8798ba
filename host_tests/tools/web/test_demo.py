#!/usr/bin/env python3
"""Tests of the demo in a headless Chromium: its rows and their times are simrun's for the same samples, of the virtual sensor and of a recording;
faults by button and what comes after them; what `save` writes stays. Run from the repository root with build/venv/bin/python."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import ROBUST  # noqa: E402
from demo_support import FIRMWARE, PAGE, SIMRUN, WHY_NOT, DemoCase, rows_of, simrun  # noqa: E402

SEED = 7
ROWS = 2000
STAMP_SPREAD_US = 20
COASTED_OR_FAULT = 2 | 16
STREAMS = pathlib.Path("sim/streams")
# order: the reports of the worker's pace and of the EEPROM's content, with `saved` among them
SAVES = """
window.order = [];
tiltPage.worker.addEventListener('message', ({ data }) => {
  if (data.text?.includes('# saved')) order.push('saved');
  order.push(...['status', 'eeprom'].filter((name) => name in data));
});
tiltPage.send('save');
"""
FAULTS = {"sda": 8, "unplug": 1, "int1": 5}


def apart(rows, others):
    """The first row of which a column other than t_us is different, and its counterpart."""
    return next(((one, other) for one, other in zip(rows, others) if one[1:] != other[1:]), None)


def stamp_spread(rows, others):
    """Microseconds by which t_us wanders about a constant difference between rows and their counterparts."""
    apart_us = [one[0] - other[0] for one, other in zip(rows, others)]
    return max(apart_us) - min(apart_us)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestRows(DemoCase):
    def hold(self, rows, others):
        """The rows are their counterparts'; the time from row to row is, within STAMP_SPREAD_US."""
        self.assertIsNone(apart(rows, others))
        self.assertLess(stamp_spread(rows, others), STAMP_SPREAD_US)

    def of_the_page(self, page, least):
        self.speed(page, 0)
        page.until(f"tiltPage.figures().rows >= {least}")
        self.speed(page, 1)
        return page.value("heard.text"), page.value("heard.samples.filter((each) => each[2]).map((each) => each[2])")

    @unittest.skipUnless(SIMRUN.exists() and FIRMWARE.exists(), "no simrun or firmware built: make build/sim/simrun build/uno/firmware.elf")
    def test_rows_and_banner_are_those_of_simrun(self):
        text, samples = self.of_the_page(self.demo(address=self.address(SEED)), ROWS)
        rows, words = rows_of(text)
        sim_rows, sim_words = simrun([(10000 * n, *lsb) for n, lsb in enumerate(samples)])
        print(f"seed {SEED}: {min(len(rows), len(sim_rows))} rows against simrun's")
        self.assertGreaterEqual(min(len(rows), len(sim_rows)), ROWS - 5)
        self.hold(rows, sim_rows)
        self.assertIsNotNone(apart(rows, sim_rows[1:]))  # the twin: a row late
        self.assertGreater(sum(row[9] & 1 for row in rows), ROWS // 10)  # 15 % outliers an axis: many rows are gated
        banner = words.index("t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags")
        self.assertEqual(words[:banner + 1], sim_words[:banner + 1])

    def test_a_seed_determines_the_samples(self):
        first, again, other = (self.of_the_page(self.demo(address=self.address(seed)), 300)[1][:250] for seed in (SEED, SEED, SEED + 1))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def address(self, seed):
        return f"{PAGE.resolve().as_uri()}#seed={seed}"

    def replayed(self, name):
        """The page's rows of a stream from its first row and a cold start on, and simrun's."""
        page, text = self.demo(), (STREAMS / name).read_text(encoding="ascii")
        self.press(page, "power")
        page.until("tiltPage.figures().words === 'switched off'")
        self.drop(page, name, text)
        page.until(f"document.getElementById('recording-name').textContent === 'replays {name}'")
        page.value("heard.text = ''")
        self.press(page, "power")
        before = page.figures()["rows"]
        rows = rows_of(self.of_the_page(page, before + 1000)[0])[0]
        lines = [line.split(",") for line in text.splitlines() if line[0].isdigit()]
        return page, rows, simrun([line[:4] for line in lines])[0]

    def test_recording_is_replayed_with_its_truth(self):
        page, rows, sim_rows = self.replayed("outliers-15pct.csv")
        self.assertGreater(min(len(rows), len(sim_rows)), 900)
        self.hold(rows, sim_rows)
        off = page.value("""(() => { const { history } = tiltPage, mask = history.size - 1; let raw = 0, filtered = 0, count = 0;
          for (let k = history.count - 900; k < history.count; k++) {
            const truth = history.trueRoll[k & mask];
            raw += (history.rawRoll[k & mask] - truth) ** 2; filtered += (history.roll[k & mask] - truth) ** 2; count++; }
          return [Math.sqrt(raw / count), Math.sqrt(filtered / count)]; })()""")
        print(f"roll off by {off[0]:.2f} degrees raw, {off[1]:.2f} filtered (rms)")
        self.assertLess(off[1], 1)
        self.assertGreater(off[0], 3)

    def test_recording_at_another_rate(self):
        _, rows, sim_rows = self.replayed("tilt-400hz.csv")
        self.assertGreater(min(len(rows), len(sim_rows)), 990)  # it lasts 10 s; then the page begins it again, and simrun ends
        self.hold(rows[:990], sim_rows)

    def test_recording_with_gaps(self):
        _, rows, sim_rows = self.replayed("gaps-jitter.csv")
        end = next(n for n, row in enumerate(sim_rows) if row[9] & COASTED_OR_FAULT)  # what comes first after a gap depends on microseconds
        self.assertGreater(end, 50)
        self.hold(rows[:end], sim_rows[:end])
        self.assertTrue(rows[end][9] & COASTED_OR_FAULT)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestHands(DemoCase):
    def test_faults_by_button_and_recovery(self):
        page = self.demo()
        self.speed(page, 4)
        for button, number in FAULTS.items():
            self.press(page, button)
            fault = page.until("tiltPage.figures().fault")
            self.assertTrue(fault.startswith(f"fault {number}:"), fault)
            self.assertEqual(page.value(f"document.querySelector('[data-hold={button}]').getAttribute('aria-pressed')"), "true")
            self.press(page, button)
            page.until("!tiltPage.figures().fault")
            rows = page.figures()["rows"]
            page.until(f"tiltPage.figures().rows > {rows + 50}")
        page.until("!tiltPage.figures().lamps.silence.lit")

    def test_the_truth_is_known_after_a_reset(self):
        page = self.demo(rows=100)
        self.press(page, "reset")
        page.until("tiltPage.figures().restarts || heard.text.includes('# reset: reset')")
        rows = page.figures()["rows"]
        page.until(f"tiltPage.figures().rows > {rows + 30} && Math.abs(tiltPage.newest.trueRoll - tiltPage.newest.roll) < 3")

    def test_a_fault_outlasts_reset_and_power(self):
        page = self.demo()
        self.press(page, "unplug")
        page.until("tiltPage.figures().fault")
        page.value("heard.text = ''")
        self.press(page, "reset")
        page.until("heard.text.includes('# reset: ') && tiltPage.figures().fault")
        self.press(page, "power")
        page.until("tiltPage.figures().words === 'switched off'")
        page.value("heard.text = '', tiltPage.send('status')")
        page.until("document.getElementById('log').innerText.includes('status: not sent: the board is switched off')")
        self.press(page, "power")
        page.until("heard.text.includes('# reset: power on') && tiltPage.figures().fault")
        self.press(page, "unplug")
        page.until("!tiltPage.figures().fault")

    def test_saved_settings_stay_when_the_page_is_opened_again(self):
        page = self.demo()
        self.addCleanup(page.value, "localStorage.clear()")
        page.until("tiltPage.figures().filters.length")
        self.assertEqual(page.figures()["filters"], FIRMWARE.with_name("filters.txt").read_text(encoding="ascii").split())
        page.value(f"document.querySelector('input[value={ROBUST}]').click()")
        page.until(f"tiltPage.figures().filter === '{ROBUST}'")
        page.value(SAVES)
        page.until("order.includes('saved') && order.slice(order.indexOf('saved')).filter((each) => each === 'status').length === 2")
        order = page.value("order")
        self.assertIn("eeprom", order[:order.index("status", order.index("status", order.index("saved")) + 1)])  # before the second report
        again = self.demo()
        again.until(f"heard.text.includes('# settings: as saved') && tiltPage.figures().filter === '{ROBUST}'")

    def test_sideways_and_a_knock(self):
        page = self.demo()
        self.slide(page, "outliers", 0)
        gated = page.figures()["lamps"]["gated"]["count"]
        self.press(page, "knock")
        page.until(f"tiltPage.figures().lamps.gated.count > {gated}")
        page.value("pad.dispatchEvent(new KeyboardEvent('keydown', { key: 'Home' }))")
        page.until("Math.abs(tiltPage.newest.trueRoll) < 0.1 && Math.abs(tiltPage.newest.roll) < 1")
        self.press(page, "push")  # the filtered roll follows 0.5 g, the truth does not: atan(0.5) is 26.6 degrees
        page.until("tiltPage.newest.roll > 24 && Math.abs(tiltPage.newest.trueRoll) < 0.1")
        page.until("Math.abs(tiltPage.newest.roll) < 1")

    def test_pointer_and_keys_move_the_sensor(self):
        page = self.demo()
        box = page.value("(({ x, y, width, height }) => [x + width / 2, y + height / 2])(pad.getBoundingClientRect())")
        for kind, by in (("mousePressed", 0), ("mouseMoved", 25), ("mouseMoved", 50), ("mouseReleased", 50)):
            held = 0 if kind == "mouseReleased" else 1
            page.call("Input.dispatchMouseEvent", type=kind, x=box[0] + by, y=box[1], button="left", buttons=held, clickCount=1)
        self.assertEqual(page.figures()["sensor"], "hand")
        page.value("pad.focus()")
        page.press("Home")
        for _ in range(4):
            page.press("ArrowRight")
        page.until("Math.abs(tiltPage.newest.truePitch - 20) < 0.1 && Math.abs(tiltPage.newest.pitch - 20) < 2")
        page.until("Math.abs(tiltPage.newest.trueRoll) < 0.1")

    def test_the_board_follows_a_recording_without_truth(self):
        page = self.demo()
        self.drop(page, "tilted.csv", "t_us,x,y,z\n" + "".join(f"{10000 * n},{n % 3},{187 + n % 2},181\n" for n in range(500)))
        page.until("Math.abs(tiltPage.newest.roll - 45) < 2")
        page.until("Math.abs(tiltPage.shown[0] - tiltPage.newest.roll) < 0.1 && Math.abs(tiltPage.shown[1]) < 2")

    def test_what_does_nothing_to_a_recording_is_disabled(self):
        page = self.demo()
        disabled = "[...document.querySelectorAll('.world :disabled')].map((each) => each.id || each.dataset.press)"
        self.assertEqual(page.value(disabled), [])
        self.drop(page, "level.csv", "t_us,x,y,z\n0,0,1,256\n10000,1,0,256\n")
        page.until("tiltPage.figures().sensor === 'recording'")
        self.assertEqual(page.value(disabled), ["outliers", "noise", "knock", "push"])
        page.value("document.querySelector('[value=self]').click()")
        self.assertEqual(page.value(disabled), [])


if __name__ == "__main__":
    from unity_line import main
    main()
