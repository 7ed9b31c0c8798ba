"""What the tests of the demo share: the page in a browser, what its worker says, and what simrun makes of the same samples."""
import csv
import json
import pathlib
import subprocess
import tempfile

from browser import ABSENT
from live_support import Case

PAGE = pathlib.Path("build/demo/tilt-demo.html")
SIMRUN, FIRMWARE = pathlib.Path("build/sim/simrun"), pathlib.Path("build/uno/firmware.elf")
WHY_NOT = ABSENT or (None if PAGE.exists() else "no build/demo/tilt-demo.html: make demo (needs Node and npm)")

# window.heard: all that the worker says, from its first word on
LISTENS = """
  window.heard = { text: '', samples: [] };
  const Plain = Worker;
  window.Worker = class extends Plain {
    constructor(...words) {
      super(...words);
      this.addEventListener('message', ({ data }) => { heard.text += data.text ?? ''; heard.samples.push(...(data.samples ?? [])); });
    }
  };
"""


class DemoCase(Case):
    """The page, with nothing on the browser's console at the end."""

    def demo(self, before="", size=(1280, 900), address=None, rows=20):
        page = self.opened(address or PAGE.resolve().as_uri(), LISTENS + before, size)
        self.addCleanup(lambda: self.assertEqual(page.console(), ""))
        page.until(f"tiltPage.figures().rows >= {rows}")
        return page

    def slide(self, page, name, value):
        page.value(f"{name}.value = {value}, {name}.dispatchEvent(new Event('input'))")

    def press(self, page, name):
        page.value(f"document.querySelector('[data-hold={name}], [data-press={name}]').click()")

    def speed(self, page, value):
        page.value(f"speed.value = '{value}', speed.dispatchEvent(new Event('change'))")

    def drop(self, page, name, text):
        page.value("""((name, text) => {
          const dataTransfer = new DataTransfer();
          dataTransfer.items.add(new File([text], name));
          dispatchEvent(new DragEvent('drop', { dataTransfer, cancelable: true }));
        })""" + f"({json.dumps(name)}, {json.dumps(text)})")

    def notice(self, page, words):
        """Waits until the page has said these words (on a busy machine another notice may follow), and shows rows that come after them."""
        page.until(f"!notice.hidden && document.getElementById('log').innerText.includes({json.dumps(words)})")
        rows = page.figures()["rows"]
        page.until(f"tiltPage.figures().rows > {rows + 10}")


def rows_of(text):
    """The numbers of each whole row, and the lines that are none."""
    lines = [line.strip() for line in text.split("\n")[:-1]]
    rows = [[int(field) for field in line.split(",")] for line in lines if line[:1].isdigit()]
    return rows, [line for line in lines if line and not line[0].isdigit()]


def simrun(samples):
    """What simrun makes of samples [t_us, x, y, z]: its rows, and its other lines."""
    with tempfile.TemporaryDirectory() as folder:
        stream, out = pathlib.Path(folder, "in.csv"), pathlib.Path(folder, "out.csv")
        with stream.open("w", encoding="ascii", newline="") as file:
            csv.writer(file).writerows([["t_us", "x", "y", "z"], *samples])
        subprocess.run([SIMRUN, "--fw", FIRMWARE, "--in", stream, "--out", out], check=True, capture_output=True)
        return rows_of(out.read_text(encoding="latin-1"))


__all__ = ["DemoCase", "FIRMWARE", "PAGE", "SIMRUN", "WHY_NOT", "rows_of", "simrun"]
