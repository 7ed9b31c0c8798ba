"""Tests of the page of `tilt live` in a headless Chromium: lamps, filter switch, commands, light and dark, a
narrow window. Run from the repository root with build/venv/bin/python."""
import json
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, LIGHT, PLAIN, ROBUST  # noqa: E402
from tilt import protocol  # noqa: E402
from browser import ABSENT  # noqa: E402
from fake_board import until  # noqa: E402
from live_support import FILTERS, Case, Talk, watched  # noqa: E402


@unittest.skipIf(ABSENT, ABSENT)
class TestServed(Case):
    def test_filter_switch_and_faults(self):
        talk = Talk()
        with watched(talk) as (server, _):
            page = self.opened(server.address)
            self.assertEqual(page.until("tiltPage.figures().filters.length && tiltPage.figures().filters"), list(FILTERS))
            self.assertEqual(talk.commands, ["filter", "filter ?"])
            page.value(f"document.querySelector('input[value={ROBUST}]').click()")
            page.until(f"tiltPage.figures().filter === '{ROBUST}'")
            self.assertEqual((talk.filter, talk.commands[2:]), (ROBUST, [f"filter {ROBUST}"]))
            self.assertTrue(page.value(f"document.querySelector('input[value={ROBUST}]').checked"))
            self.lights(page, talk)

    def lights(self, page, talk):
        fault = "document.getElementById('fault')"
        self.assertEqual(page.value(f"[{fault}.className, {fault}.textContent]"), ["card fault", "no fault reported"])
        talk.say("# fault 8: SDA held low: check SDA, SCL, pull-ups, GND")
        page.until(f"{fault}.classList.contains('lit')")
        self.assertEqual(page.value(f"{fault}.textContent"), "fault 8: SDA held low: check SDA, SCL, pull-ups, GND")
        talk.say("# fault 8 over: after 1234 ms, 123 lost, sensor at 0x53")
        page.until(f"!{fault}.classList.contains('lit')")
        for line in ("# fault 8: SDA held low", "fault 8 over"):
            self.assertIn(line, page.value("document.getElementById('log').innerText"))

    def test_lamps_light_for_their_flag_alone_and_go_out(self):
        talk = Talk()
        with watched(talk) as (server, _):
            page = self.opened(server.address)
            page.until("tiltPage.figures().rows > 5")
            for bit in (protocol.GATED, protocol.SILENCE, protocol.ROLL_UNDEFINED):
                name, sent = protocol.FLAG_NAMES[bit], []
                talk.flags = lambda number, bit=bit, sent=sent: sent.append(number) or bit
                page.until(f"tiltPage.figures().lamps[{name!r}].lit")
                self.assertEqual({each for each, lamp in page.figures()["lamps"].items() if lamp["lit"]}, {name})
                talk.flags = lambda number: 0
                page.until(f"!tiltPage.figures().lamps[{name!r}].lit && tiltPage.figures().lamps[{name!r}].count >= {len(sent)}")
                self.assertEqual(page.figures()["lamps"][name]["count"], len(sent))

    def test_by_the_keyboard_alone(self):
        talk = Talk()
        with watched(talk) as (server, _):
            page = self.opened(server.address)
            page.until("tiltPage.figures().filters.length")
            for _ in range(12):
                page.press("Tab")
                if page.value("document.activeElement.name") == "filter":
                    break
            page.press("ArrowRight")
            page.until(f"tiltPage.figures().filter === '{PLAIN}'")
            for _ in range(4):
                page.press("Tab")
                if page.value("document.activeElement.id") == "line":
                    break
            page.type("FILTER nix")
            page.press("Enter")
            until(lambda: "FILTER nix" in talk.commands)
            page.press("ArrowUp")
            self.assertEqual(page.value("document.getElementById('line').value"), "FILTER nix")

    def test_refused_filter_leaves_what_is_in_force_marked(self):
        talk = Talk()
        talk.reply_before = talk.reply
        talk.reply = lambda command: f"# refused 5: {PLAIN} takes 12600 of the 11950 cycles that a sample at 800 Hz leaves\n" \
            f"# filter {DEFAULT}\n".encode() \
            if command == f"filter {PLAIN}" else talk.reply_before(command)
        with watched(talk) as (server, _):
            page = self.opened(server.address)
            page.until("tiltPage.figures().filters.length")
            page.value(f"document.querySelector('input[value={PLAIN}]').click()")
            page.until(f"document.getElementById('log').innerText.includes('refused 5: {PLAIN}')")
            page.until(f"document.querySelector('input[value={DEFAULT}]').checked")

    def test_filter_is_asked_for_again_where_settings_were_loaded(self):
        talk = Talk()
        with watched(talk) as (server, _):
            page = self.opened(server.address)
            page.until("tiltPage.figures().filters.length")
            talk.filter = LIGHT
            talk.say("# settings: as saved")
            page.until(f"tiltPage.figures().filter === '{LIGHT}'")
            talk.say(f"# filter {PLAIN}: {PLAIN} {LIGHT} {ROBUST}")
            page.until(f"tiltPage.figures().filters.join() === '{PLAIN},{LIGHT},{ROBUST}' && tiltPage.figures().filter === '{PLAIN}'")
            talk.say(f"# filter {LIGHT}")
            talk.say(f"# refused 4: filter is one of {LIGHT} {PLAIN}")
            page.until(f"tiltPage.figures().filters.join() === '{LIGHT},{PLAIN}' && tiltPage.figures().filter === '{LIGHT}'")

    def test_picture_moves_and_stands_still_in_a_pause(self):
        with watched(Talk()) as (server, _):
            page = self.opened(server.address)
            page.until("tiltPage.figures().firstPictureMs")
            shown = "document.getElementById('pitch').toDataURL()"
            first = page.value(shown)
            page.until(f"{shown} !== {json.dumps(first)}")
            paused_ms = page.value("document.getElementById('pause').click(), performance.now()")
            page.until(f"tiltPage.drawnMs > {paused_ms}")
            still, rows_then = page.value(f"[{shown}, tiltPage.figures().rows]")
            page.until(f"tiltPage.figures().rows > {rows_then + 30}")
            self.assertEqual(page.value(shown), still)
            page.value("document.getElementById('pause').click()")
            page.until(f"{shown} !== {json.dumps(still)}")

    def test_filtered_line_is_where_its_angle_is(self):
        with watched(Talk()) as (server, _):  # roll is 0.45 degrees in each row, raw roll 0.448
            page = self.opened(server.address)
            page.value("document.getElementById('scale').value = '15'; document.getElementById('scale').dispatchEvent(new Event('change'))")
            page.until("tiltPage.figures().rows > 150")
            heights = page.value("""(() => {
              const canvas = document.getElementById('roll'), pen = canvas.getContext('2d'), found = [];
              const [r, g, b] = tiltPage.colours.filtered.match(/[0-9]+/g).map(Number);
              const pixels = pen.getImageData(canvas.width - 30, 0, 1, canvas.height).data;
              for (let y = 0; y < canvas.height; y++)
                if (Math.abs(pixels[4 * y] - r) + Math.abs(pixels[4 * y + 1] - g) + Math.abs(pixels[4 * y + 2] - b) < 20) found.push(y);
              return [found, canvas.height]; })()""")
            found, height = heights
            top, bottom = 22, height - 20  # what Chart leaves for the words
            meant = top + (15 - 0.45) * (bottom - top) / 30
            self.assertTrue(found)
            self.assertLess(abs(sum(found) / len(found) + 0.5 - meant), 1.5, heights)

    def test_unplugged_is_said_and_the_end_too(self):
        with watched(Talk()) as (server, fake):
            page = self.opened(server.address)
            page.until("tiltPage.figures().rows > 20")
            fake.unplug()
            self.assertIn("waiting for it", page.until("tiltPage.figures().kind === 'wait' && tiltPage.figures().words"))
            page.until("document.getElementById('rate').textContent === '0.0'")  # nothing comes: no rate is shown
            page.value("tiltPage.send('go')")
            page.until("document.getElementById('log').innerText.includes('go: not sent: ')")
        self.assertIn("tilt live has ended", page.until("tiltPage.figures().kind === 'down' && tiltPage.figures().words"))

    def test_wrong_token_and_broken_lines_are_said(self):
        with watched(Talk()) as (server, _):
            page = self.opened(server.address.partition("#")[0] + "#guessed")
            self.assertIn("refused", page.until("tiltPage.figures().kind === 'wait' && tiltPage.figures().words"))
            page = self.opened(server.address)
            page.until("tiltPage.figures().rows > 5")
            server.feed.put("lines", b"12,\xff\xfe\x80\n" * 3)
            page.until("tiltPage.figures().broken === 3")
            page.until("document.getElementById('broken').textContent === '3'")

    def test_nothing_sticks_out_of_a_narrow_window(self):
        with watched(Talk()) as (server, _):
            page = self.opened(server.address, size=(390, 800))
            page.until("tiltPage.figures().filters.length")
            self.assertLessEqual(page.value("document.documentElement.scrollWidth"), 390)

    def test_light_and_dark_are_legible(self):
        with watched(Talk()) as (server, _):
            page = self.opened(server.address)
            for theme in ("light", "dark"):
                page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
                page.until(f"tiltPage.isDark() === {json.dumps(theme == 'dark')}")
                ink, dim, card = page.value("""['ink', 'dim', 'card'].map((name) => {
                  const pen = document.createElement('canvas').getContext('2d'), probe = document.createElement('b');
                  document.body.append(probe);
                  probe.style.color = `var(--${name})`;
                  pen.fillStyle = getComputedStyle(probe).color;
                  pen.fillRect(0, 0, 1, 1);
                  probe.remove();
                  return [...pen.getImageData(0, 0, 1, 1).data].slice(0, 3); })""")
                self.assertGreaterEqual(contrast(ink, card), 7.0)  # WCAG 2: AAA for text, AA for what is beside it
                self.assertGreaterEqual(contrast(dim, card), 4.5)
            page.value("document.getElementById('theme').click()")
            self.assertFalse(page.value("tiltPage.isDark()"))


def contrast(one, other):
    """Of two sRGB colours, as WCAG 2 defines it."""
    def luminance(colour):
        parts = [part / 255 / 12.92 if part <= 10 else ((part / 255 + 0.055) / 1.055) ** 2.4 for part in colour]
        return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


if __name__ == "__main__":
    from unity_line import main
    main()
