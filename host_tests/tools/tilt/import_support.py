"""What the tests of `tilt import` share: integers that are known beforehand, and a run of the command on a file made from them."""
import re
import sys

sys.dont_write_bytecode = True
from tilt_case import InFolder, run_tilt  # noqa: E402

ROWS = 60
G = 9.80665
# x, y within +-20 and +-30, z about 1 g: each row differs from its neighbours, values even and odd
LSB = [((i * 37) % 41 - 20, (i * 53) % 61 - 30, 240 + (i * 29) % 37) for i in range(ROWS)]
HEADER = "t_us,x,y,z"
REMEDY = (r"(if these are accelerations, )?"
          r"(correct|delete|give|split|record|export|save|unpack|choose|name|write|print|count from|import|each \w+ needs) ")


def every(period_us, rows=ROWS):
    return [i * period_us for i in range(rows)]


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out.csv"

    def file(self, content, name="in.txt"):
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def run_tilt(self, *words):
        """(status, stderr) of `tilt import WORDS`."""
        status, _, said = run_tilt("import", *words)
        return status, said

    def rows(self, path=None):
        """(header, [numbers]) of the stream written."""
        lines = (path or self.out).read_text(encoding="ascii").split("\n")
        self.assertEqual(lines.pop(), "", "the last line has an end")
        return lines[0], [tuple(int(cell) for cell in line.split(",")) for line in lines[1:]]

    def imported(self, content, *words, name="in.txt"):
        """([t_us], [(x, y, z)], stderr) of an import that must succeed."""
        status, said = self.run_tilt(self.file(content, name), "-o", self.out, *words)
        self.assertEqual(status, 0, said)
        header, rows = self.rows()
        self.assertEqual(header, HEADER)
        return [row[0] for row in rows], [row[1:] for row in rows], said

    def gives(self, content, lsb, t_us, *words, name="in.txt"):
        """The import gives these integers at these times; returns what was said."""
        times, readings, said = self.imported(content, *words, name=name)
        self.assertEqual(readings, lsb)
        self.assertEqual(times, t_us)
        return said

    def refused(self, content, reason, *words, name="in.txt", line=None):
        """The import ends with status 2, exactly this reason, and a colon and a remedy: after the reason, or spelled out at its end. Nothing is
        written."""
        path = self.file(content, name)
        self.out.unlink(missing_ok=True)
        status, said = self.run_tilt(path, "-o", self.out, *words)
        where = f"{path}:{line}: " if line else f"{path}: "
        self.assertEqual(status, 2, said)
        begins = f"tilt import: {where}{reason}"
        self.assertTrue(said.startswith(begins), said)
        remedy = said.removeprefix(begins)
        self.assertRegex(remedy if remedy != "\n" else re.search(r": [^:]*\Z", reason + remedy)[0], rf"\A: {REMEDY}[^:\n]*\n\Z")
        self.assertEqual(sorted(found.name for found in self.folder.iterdir()), [name])
