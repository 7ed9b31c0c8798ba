"""Tests of the page of `tilt live` opened as a file: a headless Chromium reads a port by WebSerial, which is mocked. Run from the repository
root with build/venv/bin/python."""
import json
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN  # noqa: E402
from browser import ABSENT  # noqa: E402
from fake_board import BANNER, HEADER, row, rows  # noqa: E402
from live_support import PAGE_FILE, Case  # noqa: E402

SPEAKS = """
  window.typed = []; window.opened = [];
  class MockPort extends EventTarget {
    async open(options) {
      if (this.busy) throw new DOMException("Failed to open serial port.", "NetworkError");
      opened.push(options.baudRate);
      this.readable = new ReadableStream({ start: (controller) => { this.controller = controller; } });
      this.writable = new WritableStream({ write: (bytes) => { typed.push(new TextDecoder().decode(bytes)); } });
    }
    async close() { this.readable = this.writable = null; }
    say(text) { this.controller.enqueue(new TextEncoder().encode(text)); }
    unplug() {
      const controller = this.controller;
      this.readable = null;
      controller.error(new DOMException("The device has been lost.", "NetworkError"));
    }
  }
  class MockSerial extends EventTarget { async requestPort() { return port; } async getPorts() { return [port]; } }
  window.port = new MockPort();
  Object.defineProperty(navigator, "serial", { value: new MockSerial() });
"""


@unittest.skipIf(ABSENT, ABSENT)
class TestDirect(Case):
    """The same file, opened as a file: the browser reads the port itself."""

    def connected(self):
        page = self.opened(PAGE_FILE, before=SPEAKS)
        self.assertFalse(page.value("document.getElementById('direct').hidden"))
        page.value("document.getElementById('baud').value = '250000'; document.getElementById('connect').click()")
        page.until("opened.length === 1 && tiltPage.figures().kind === 'up'")
        self.assertEqual(page.value("opened"), [250000])
        return page

    def say(self, page, data):
        page.value(f"port.say({json.dumps(data.decode('ascii'))})")

    def test_rows_and_commands(self):
        page = self.connected()
        self.say(page, b"5,0,0,256,0,0,1000,0,0,0\n" + BANNER + HEADER + rows(0, 30))
        page.until("tiltPage.figures().rows === 30 && tiltPage.figures().firstPictureMs")
        page.until("typed.length === 2")
        self.assertEqual(page.value("typed"), ["filter\n", "filter ?\n"])
        self.say(page, f"# filter: {DEFAULT} {PLAIN}\n# filter {PLAIN}\n".encode() + rows(30, 60))
        page.until(f"tiltPage.figures().filter === '{PLAIN}'")
        page.value(f"document.querySelector('input[value={DEFAULT}]').click()")
        page.until("typed.length === 3")
        self.assertEqual(page.value("typed[2]"), f"filter {DEFAULT}\n")
        self.assertEqual(page.figures()["lost"], 0)

    def test_baud_is_not_changed_under_the_browser(self):
        page = self.connected()
        page.value("tiltPage.send('baud 9600')")
        page.until("document.getElementById('log').innerText.includes('baud 9600: not sent: ')")
        self.assertEqual(page.value("typed"), [])

    def test_unplugged_and_plugged_in_again(self):
        page = self.connected()
        self.say(page, HEADER + rows(0, 30))
        page.until("tiltPage.figures().rows === 29 || tiltPage.figures().rows === 30")
        page.value("port.unplug()")
        self.assertIn("plug it in again", page.until("tiltPage.figures().kind === 'wait' && tiltPage.figures().words"))
        page.value("port.open = MockOpen = Object.getPrototypeOf(port).open; "
                   "port.dispatchEvent(new Event('connect')); navigator.serial.dispatchEvent(Object.defineProperty(new Event('connect'), "
                   "'target', { value: port }))")
        page.until("opened.length === 2 && tiltPage.figures().kind === 'up'")
        self.say(page, b"\n" + BANNER + HEADER + row(0) + rows(1, 12))
        page.until("tiltPage.figures().rows >= 41")
        self.assertEqual(page.figures()["lost"], 0)

    def test_disconnect_gives_the_port_back(self):
        page = self.connected()
        page.value("document.getElementById('connect').click()")
        page.until("tiltPage.figures().words === 'not connected' && port.readable === null")

    def test_port_in_use_is_said(self):
        page = self.opened(PAGE_FILE, before=SPEAKS)
        page.value("port.busy = true; document.getElementById('connect').click()")
        self.assertIn("in use by another program", page.until("tiltPage.figures().kind === 'down' && tiltPage.figures().words"))

    def test_browser_without_webserial_is_told(self):
        page = self.opened(PAGE_FILE, before="delete Navigator.prototype.serial")
        self.assertIn("tilt live PORT", page.until("tiltPage.figures().words"))


if __name__ == "__main__":
    from unity_line import main
    main()
