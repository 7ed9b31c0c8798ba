#!/usr/bin/env python3
"""Tests of the demo as a page in a headless Chromium: what it holds, bad input, a phone's motion sensor, two sizes of window, the keyboard;
and of what builds it.
Run from the repository root with build/venv/bin/python."""
import contextlib
import functools
import html
import http.server
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from demo_support import PAGE, WHY_NOT, DemoCase  # noqa: E402

MOST_BYTES = 250_000
# what would load or send something
OUTWARD = r"""(?:src|href)\s*=\s*["'](?!data:|#)[^"']+|\bimport\(|\bfetch\(|XMLHttpRequest|WebSocket|sendBeacon"""
LICENCES = ("LICENSE", "build/second/node_modules/avr8js/LICENSE", "mk/avr-libc.txt")
STREAM = "t_us,x,y,z\n" + "".join(f"{10000 * n},{n % 3},{n % 5},{256 + n % 2}\n" for n in range(200))
# name -> what is wrong with the text, as the page says it
NO_RECORDINGS = {
    "empty.csv": ("", "empty.csv: the file is empty"),
    "letter.txt": ("Dear all,\nhello\n", "letter.txt: line 1: missing column t_us (a header with t_us,x,y,z comes first): tilt import FILE "
                   "converts other recordings"),
    "axes.csv": ("t_us,x,y\n0,1,2\n", "axes.csv: line 1: missing column z"),
    "word.csv": (STREAM + "2000000,1,two,3\n", "word.csv: line 202: y is not a whole number: 'two'"),
    "units.csv": (STREAM + "2000000,1,0.5,3\n", "units.csv: line 202: y is not a whole number: '0.5': tilt import FILE converts other units"),
    "range.csv": (STREAM + "2000000,1,4096,3\n", "range.csv: line 202: y is outside -4096..4095: 4096"),
    "back.csv": (STREAM + "10,1,2,3\n", "back.csv: line 202: time goes backwards: 10 after 1990000"),
    "fields.csv": (STREAM + "2000000,1,2\n", "fields.csv: line 202: 3 fields where the header has 4"),
    "header.csv": ("t_us,x,y,z\n", "header.csv: fewer than two rows after the header"),
    "image.png": ("\x89PNG\r\n\x1a\n\0\0\0", "image.png: line 1: missing column t_us"),
    "nul.csv": (STREAM + "\0\n", "nul.csv: line 202: a NUL byte: no text, or UTF-16, which tilt import FILE converts"),
}
FORBIDDEN = "Object.defineProperty(window, 'localStorage', { get() { throw new DOMException('denied', 'SecurityError'); } });"
FULL = "Storage.prototype.setItem = () => { throw new DOMException('full', 'QuotaExceededError'); };"
# a phone that answers the question of iOS with `said`, and then moves or does not
PHONE = "DeviceMotionEvent.requestPermission = async () => {{ window.asked = true; return '{said}'; }};"
# whose browsers report the opposite of the standard's sign
APPLE = "Object.defineProperty(navigator, 'vendor', { value: 'Apple Computer, Inc.' });"
MOVES = """setInterval(() => dispatchEvent(new DeviceMotionEvent('devicemotion',
  { accelerationIncludingGravity: { x: 0, y: SIGN * 6.9343, z: SIGN * 6.9343 } })), 20);"""


@contextlib.contextmanager
def served():
    """The address of the page on a server of this machine: a secure context, as https is."""
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):  # pylint: disable=arguments-differ
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(PAGE.parent))) as server:
        threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True).start()
        try:
            yield f"http://localhost:{server.server_port}/{PAGE.name}"
        finally:
            server.shutdown()


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestFile(unittest.TestCase):
    def test_one_file_that_loads_nothing_with_all_licences(self):
        text = PAGE.read_text(encoding="utf-8")
        self.assertLessEqual(len(text.encode("utf-8")), MOST_BYTES)
        self.assertIn("default-src 'none'", text)
        self.assertEqual(re.findall(OUTWARD, text), [])
        for licence in LICENCES:
            self.assertIn(html.escape(pathlib.Path(licence).read_text(encoding="utf-8")), text)


class TestSources(unittest.TestCase):
    def test_who_imports_whom(self):
        """The worker uses second's UNO and sensor, which know nothing of it, of sim, of lib or of the firmware."""
        for folder, allowed in (("web/worker", r"\./\w+\.mjs|\.\./\.\./second/\w+\.mjs"), ("second", r"\./\w+\.mjs|node:[\w/]+")):
            for path in pathlib.Path(folder).glob("*.mjs"):
                for name in re.findall(r"""\bfrom ['"]([^'"]+)""", path.read_text(encoding="utf-8")):
                    self.assertRegex(name, f"^({allowed})$", path)

    def test_a_wheel_holds_the_page_of_tilt_live_and_its_parts(self):
        parts = re.findall(r'(?:stylesheet" href|script src)="([^"]+)"', pathlib.Path("web/live.html").read_text(encoding="utf-8"))
        packed = re.search(r'"tilt.web" = \[([^]]*)\]', pathlib.Path("tools/pyproject.toml").read_text(encoding="ascii"))[1]
        self.assertEqual(sorted(re.findall(r'"([^"]+)"', packed)), sorted(["live.html", *parts]))


# the row in force at 400 samples a second of a recording that lasts 2 s, before and after 100 s without a sample
AWAY = """
import { Recording, read } from './web/worker/recording.mjs';
const recording = new Recording(read(TEXT)), rows = [];
for (const us of [0, 2500, 9999, 10001, 100_000_000, 100_505_000, 102_015_000]) { recording.next(us, 2500); rows.push(recording.at); }
console.log(rows.join());
"""


@unittest.skipUnless(shutil.which("node"), "no Node")
class TestRecording(unittest.TestCase):
    def test_time_passes_while_the_recording_is_away(self):
        code = AWAY.replace("TEXT", json.dumps(STREAM))
        said = subprocess.run(["node", "--input-type=module", "-e", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.strip(), "0,0,0,1,0,50,1")


# npm that installs what is asked of it, esbuild's program with status $ESBUILD
NPM = """#!/bin/sh
mkdir -p node_modules/.bin node_modules/avr8js node_modules/esbuild
printf '#!/bin/sh\\nexit %s\\n' "$ESBUILD" > node_modules/.bin/esbuild
chmod +x node_modules/.bin/esbuild
"""


class TestBuild(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def program(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="ascii")
        path.chmod(0o755)

    def deps(self, group, node="20.19.0", esbuild=0):
        """(status, words) of tools/deps.sh in a folder of its own, with a Node and an npm that are none."""
        for name in ("tools/deps.sh", *(f"{folder}/{file}" for folder in ("web", "second") for file in ("package.json", "package-lock.json"))):
            (self.folder / name).parent.mkdir(exist_ok=True)
            shutil.copy(name, self.folder / name)
        self.program("node", f"#!/bin/sh\necho v{node}\n")
        self.program("npm", NPM)
        env = {**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", "ESBUILD": str(esbuild)}
        done = subprocess.run(["sh", "tools/deps.sh", group], cwd=self.folder, env=env, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_node_of_age(self):
        for group, node, status in (("demo", "18.0.0", 0), ("demo", "16.20.2", 3), ("second", "20.19.0", 0), ("second", "20.18.3", 3)):
            said = self.deps(group, node)
            self.assertEqual(said[0], status, said)
            self.assertEqual("is too old" in said[1], bool(status), said)

    def test_esbuild_without_its_program_is_fetched_again(self):
        for broken, status in ((1, 3), (0, 0)):
            said = self.deps("demo", esbuild=broken)
            self.assertEqual(said[0], status, said)
            self.assertIn("installing with npm into build/web", said[1])
            self.assertEqual((self.folder / "build/web/node_modules").exists(), not broken)
            self.assertEqual("left out esbuild's program" in said[1], bool(broken), said)
        self.assertEqual(self.deps("demo"), (0, ""))

    def test_page_that_cannot_be_built_goes(self):
        page, worker = self.folder / "demo/tilt-demo.html", self.folder / "web/worker.js"
        (self.folder / "web/node_modules/esbuild").mkdir(parents=True)
        (self.folder / "second/node_modules/avr8js").mkdir(parents=True)
        for target in ("demo_built", "clean_demo"):
            for path in (page, worker):
                path.parent.mkdir(exist_ok=True)
                path.write_text("old", encoding="ascii")
            subprocess.run(["make", "-s", f"B={self.folder}", target], check=True, capture_output=True)
            self.assertEqual((page.exists(), worker.exists()), (False, False), target)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestBadInput(DemoCase):
    def test_dropped_files_that_are_no_recordings(self):
        page = self.demo()
        for name, (text, why) in NO_RECORDINGS.items():
            self.drop(page, name, text)
            self.notice(page, why)
            self.assertEqual(page.figures()["sensor"], "self")
        page.value("dispatchEvent(new DragEvent('drop', { dataTransfer: new DataTransfer(), cancelable: true }))")
        self.notice(page, "What was dropped is no file")
        page.value("tiltPage.open({ name: 'long.csv', size: 65e6 })")
        self.notice(page, "long.csv: more than 64 MB")
        self.drop(page, "good.csv", STREAM)
        page.until("tiltPage.figures().sensor === 'recording'")

    def test_storage_forbidden(self):
        page = self.demo(FORBIDDEN)
        self.notice(page, "does not let the page store anything")

    def test_storage_full(self):
        page = self.demo(FULL)
        page.value("tiltPage.send('save')")
        self.notice(page, "storage is full")

    def test_stored_nonsense_is_an_empty_eeprom(self):
        page = self.demo("try { localStorage.setItem('tilt-uno EEPROM', '\u00e9 no base64'); } catch {}")
        self.addCleanup(page.value, "localStorage.clear()")
        self.notice(page, "The EEPROM that this browser has kept cannot be read")
        page.until("heard.text.includes('# settings: defaults')")

    def test_worker_that_falls_behind(self):
        page = self.demo()
        page.value("tiltPage.tell({ speed: 1000 })")
        self.notice(page, "This browser falls behind: ")
        page.value("tiltPage.tell({ speed: 1 })")
        page.until("tiltPage.figures().pace < 1.2")
        self.assertEqual(page.figures()["lost"], 0)

    def test_worker_that_stops(self):
        page = self.demo()
        page.value("tiltPage.worker.onmessage({ data: { broken: 'timer with TCNT at 0x84' } })")
        self.notice(page, "The simulation has stopped: timer with TCNT at 0x84. Reload the page")

    def test_notice_can_be_closed(self):
        page = self.demo()
        self.assertEqual(page.value("tiltPage.refused('x'), document.getElementById('notice-words').textContent"), "x. The page goes on without it.")
        page.value("document.getElementById('notice-close').click()")
        self.assertTrue(page.value("notice.hidden"))


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestPhone(DemoCase):
    PHONE_RADIO = "document.querySelector('[value=phone]')"

    def test_hidden_with_one_line_where_the_page_is_a_file(self):
        page = self.demo()
        self.assertTrue(page.value("document.getElementById('phone-choice').hidden"))
        self.assertEqual(page.value("document.getElementById('phone-hint').textContent"), "A phone's motion sensor needs this page over https.")

    def chosen(self, address, before):
        page = self.demo(before, address=address)
        page.value(f"{self.PHONE_RADIO}.click()")
        return page

    def test_the_sensor_is_the_phone(self):
        for sign, vendor in (("1", ""), ("-1", APPLE)):
            with served() as address:
                page = self.chosen(address, PHONE.format(said="granted") + vendor + MOVES.replace("SIGN", sign))
                page.until("Math.abs(tiltPage.newest.roll - 45) < 2 && tiltPage.figures().sensor === 'phone'")
                self.assertTrue(page.value("Number.isNaN(tiltPage.history.trueRoll[(tiltPage.history.count - 1) & (tiltPage.history.size - 1)])"))

    def test_refused(self):
        with served() as address:
            page = self.chosen(address, PHONE.format(said="denied"))
            self.notice(page, "the motion sensor was refused")
            self.assertEqual(page.value("asked"), True)
            self.assertEqual(page.figures()["sensor"], "self")

    def test_a_device_without_one(self):
        with served() as address:
            page = self.chosen(address, "")
            self.notice(page, "the motion sensor does not report")
            self.assertEqual(page.value("document.querySelector('[name=mode]:checked').value"), "self")


@unittest.skipIf(WHY_NOT, WHY_NOT)
class TestLooks(DemoCase):
    # visible elements that reach beyond the window's edges or out of their card
    OUTSIDE = """[...document.querySelectorAll('body *')].filter((each) => {
      const box = each.getBoundingClientRect(), card = each.closest('.card')?.getBoundingClientRect();
      return each.checkVisibility() && box.width && !each.closest('svg, #pad, .choices, #log') &&
        (box.right > innerWidth + 0.5 || box.left < -0.5 || (card && (box.right > card.right + 0.5 || box.bottom > card.bottom + 0.5)));
    }).map((each) => each.id || each.outerHTML.slice(0, 80))"""
    # pairs of cards that lie on each other
    OVERLAPS = """(() => {
      const cards = [...document.querySelectorAll('.card')].filter((each) => each.checkVisibility()), place = (each) => each.getBoundingClientRect();
      const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5;
      const pairs = cards.flatMap((one, n) => cards.slice(n + 1).map((other) => [one, other]));
      return pairs.filter(([one, other]) => meet(place(one), place(other))).map((pair) => pair.map((each) => each.className));
    })()"""

    def test_two_sizes_of_window(self):
        for width, height in ((360, 640), (1280, 900)):
            page = self.demo(size=(width, height))
            page.until("tiltPage.figures().filters.length")
            for _ in range(2):
                self.assertLessEqual(page.value("document.documentElement.scrollWidth"), width)
                self.assertEqual(page.value(self.OUTSIDE), [], f"{width} x {height}")
                self.assertEqual(page.value(self.OVERLAPS), [], f"{width} x {height}")
                page.value("tiltPage.note('fault 8: SDA held low: check SDA, SCL, pull-ups, GND'), tiltPage.notice('A line.')")
                page.value("tiltPage.lamps.forEach((each) => Object.assign(each, { count: 123456, litMs: Infinity }))")  # all flags on
                page.until("fault.classList.contains('lit') && tiltPage.lamps.every(({ item }) => item.innerText.includes('123,'))")
            if width == 1280:
                continue
            for part in ("roll", "horizon", "pad"):  # without scrolling
                self.assertLessEqual(page.value(f"document.getElementById('{part}').getBoundingClientRect().top"), height - 120)

    def test_everything_is_reached_by_the_keyboard(self):
        page = self.demo()
        page.until("tiltPage.figures().filters.length")
        wanted = {"pad", "outliers", "noise", "speed", "file", "line", "SUMMARY", "mode", "filter", "knock", "push", "sda", "unplug", "int1", "power",
                  "reset"}
        focused = """(({ id, name, dataset, tagName }) => [id, name ?? '', dataset.press ?? dataset.hold ?? '', tagName])(document.activeElement)"""
        seen = set()
        for _ in range(45):
            page.press("Tab")
            seen |= set(page.value(focused))
        self.assertEqual(wanted - seen, set())


if __name__ == "__main__":
    from unity_line import main
    main()
