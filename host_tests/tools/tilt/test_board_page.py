#!/usr/bin/env python3
"""docs/board.md holds the table of `tilt board` as the code has it, and its numbers."""
import contextlib
import io
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt import cli  # noqa: E402
from tilt.realboard import bench, judges_alone, judges_motion, judges_starts, judges_wires, watch  # noqa: E402
from tilt.realboard.checks import CHECKS, chosen, page_lines  # noqa: E402


class Page(unittest.TestCase):
    def test_the_table_is_that_of_the_code(self):
        page = pathlib.Path("docs/board.md").read_text(encoding="utf-8")
        lines = [line for line in page.splitlines() if line.startswith("|")]
        self.assertEqual(lines, page_lines())
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            self.assertEqual(cli.main(["board", "--list"]), 0)
        self.assertEqual(out.getvalue().splitlines(), lines)

    def test_twenty_with_keys_of_their_own(self):
        self.assertEqual(len(CHECKS), 20)
        self.assertEqual(len({each.key for each in CHECKS}), 20)
        self.assertEqual([number for number, _ in chosen(None)], list(range(1, 21)))
        self.assertEqual([each.key for _, each in chosen("strap, rate")], ["rate", "strap"])

    def test_where_it_is_listed(self):
        for path in ("README.md", "docs/tools.md"):
            self.assertIn("`tilt board PORT`", pathlib.Path(path).read_text(encoding="utf-8"), path)

    def test_times_and_shares_on_the_page_are_those_of_the_code(self):
        table = {each.key: each.watched + each.do for each in CHECKS}
        for key, words in (("rate", f"rows for {judges_alone.RATE_S:.0f} s"), ("rate", f"within {judges_alone.CLOCK_PPM / 1e4:.2f} %"),
                           ("rate", f"rate within {watch.RATE_SHARE:.0%}".replace("%", " %")), ("fast_bus", f"{judges_alone.FAST_S:.0f} s at 800 Hz"),
                           ("baud_rates", f"{judges_alone.BAUD_ROWS} rows or more in {judges_alone.BAUD_S:.0f} s"),
                           ("six_faces", f"0.8 to {judges_motion.ONE_G_MG[1] / 1000} g"), ("shake", f"{judges_motion.SHAKEN_ROWS} readings"),
                           ("int1_finger", f"for {judges_wires.FINGER_S:.0f} s"), ("reset_button", f"within {judges_starts.ROWS_AFTER_S:.0f} s"),
                           ("kept", f"after {judges_starts.KEPT_OFF_S:.0f} s or more")):
            self.assertIn(words, table[key])
        page = pathlib.Path("docs/board.md").read_text(encoding="utf-8")
        self.assertIn(f"up to {judges_starts.SAVES_MAX} times", page)
        self.assertIn(f"the last {bench.ROWS_KEPT} rows and the last {bench.LINES_KEPT} lines", page.replace("\n", " "))
        self.assertIn("none has begun for three seconds", page)
        self.assertEqual(watch.QUIET_S, 3.0)


if __name__ == "__main__":
    from unity_line import main
    main()
