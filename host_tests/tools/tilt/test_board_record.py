#!/usr/bin/env python3
"""`tilt board` around its checks: the record, whole, cut short or something else; the owner's keys."""
import json
import pathlib
import sys
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from board_support import ALL, FIRMWARE_SAYS, CommandCase, Desk, Model, check, raises, row, rows  # noqa: E402
from tilt.errors import TiltError  # noqa: E402
from tilt.realboard import owner as owner_module  # noqa: E402
from tilt.realboard.bench import Failed, Quit, Repeat, Skip  # noqa: E402
from tilt.realboard.record import Record, begin_line, shown  # noqa: E402
from tilt.realboard.session import Session  # noqa: E402


class Sessions(CommandCase):
    def run_session(self, checks, answers=(), record=None):
        """(result of run() or what it raised, what was said)"""
        desk = Desk(rows(0, 120), Model(), answers)
        bench = desk.bench()
        session = Session(bench, record or self.record(), checks)
        try:
            return session.run(), desk.said
        except Quit as end:
            return end, desk.said

    def verdicts(self):
        return [(line["key"], line["verdict"], line["reason"], line["try"]) for line in self.lines() if line["kind"] == "check"]

    def test_pass_fail_and_skip_are_written_as_they_fall(self):
        checks = [(1, check(alone=True)), (2, check("rate", raises(Failed("3 rows are missing")), alone=True)), (3, check("selftest"))]
        ok, said = self.run_session(checks, answers=["", "s no time"] + ["", ""])
        self.assertEqual(self.verdicts(), [("identity", "pass", "", 1), ("rate", "fail", "3 rows are missing", 1),
                                           ("selftest", "skipped", "no time", 1)])
        self.assertFalse(ok)
        self.assertIn("What it means: Rows lost", "\n".join(said))
        line = self.lines()[1]
        self.assertEqual((line["number"], line["numbers"], self.lines()[-1]["kind"]), (1, {"seconds": 1.5}, "end"))
        self.assertTrue(line["lines"])

    def test_each_verdict_is_on_the_disk_before_the_next_check(self):
        def judge(_):
            self.assertEqual(self.verdicts(), [("identity", "pass", "", 1)])
        self.run_session([(1, check(alone=True)), (2, check("rate", judge, alone=True))])
        self.assertEqual(len(self.verdicts()), 2)

    def test_skip_without_a_reason_asks_for_it(self):
        self.run_session([(3, check("selftest"))], answers=["s", "  ", "no sensor", ""])
        self.assertEqual(self.verdicts(), [("selftest", "skipped", "no sensor", 1)])

    def test_repeat(self):
        """By the owner within a check: no line; after its verdict: another line, of which the last counts."""
        judge = raises(Repeat(), Failed("late"), None)
        ok, _ = self.run_session([(3, check("selftest", judge))], answers=["", "", "a note", "r", "", ""])
        self.assertEqual(self.verdicts(), [("selftest", "fail", "late", 2), ("selftest", "pass", "", 3)])
        self.assertTrue(ok)
        self.assertEqual([line["text"] for line in self.lines() if line["kind"] == "note"], ["a note"])

    def test_quit_leaves_what_was_done(self):
        for answers in (["q"], ["", "q"]):
            self.path.unlink(missing_ok=True)
            end, _ = self.run_session([(1, check(alone=True)), (3, check("selftest")), (4, check("fast_bus"))], answers=answers)
            self.assertIsInstance(end, Quit)
            self.assertEqual(len(self.verdicts()), len(answers))

    def test_keys_count_while_a_judge_waits(self):
        for key, kind in (("s because", Skip), ("r", Repeat), ("q", Quit)):
            desk = Desk(rows(0, 5))
            desk.keys.append(key)
            with self.assertRaises(kind):
                desk.bench().next(3.0)
        desk = Desk(rows(0, 5))
        desk.keys.append("nothing of these")
        self.assertIsNotNone(desk.bench().next(3.0))

    def test_rows_push_no_words_out_of_the_record(self):
        desk = Desk(rows(0, 120) + [(1.0, "# fault 8: SDA held low"), (1.5, "not a line\x07")], Model())
        bench = desk.bench()
        self.assertEqual(len(list(bench.events(9.0))), 903)
        self.assertEqual((bench.lines[:2], len(bench.lines)), (["# fault 8: SDA held low", "not a line?"], 22))
        bench.begin(10.0)
        self.assertEqual(bench.lines, [])

    def test_a_check_begins_with_a_board_that_sends_rows(self):
        desk = Desk([], Model())
        Session(desk.bench(), self.record(), [(1, check(alone=True))]).once(1, check(alone=True), 1)
        self.assertEqual(self.verdicts(), [("identity", "fail", "no row with a sample within 15 s", 1)])

    def test_what_the_owner_does_before_enter_is_seen(self):
        desk = Desk(rows(0, 60), Model())

        def late(text):
            if "Enter starts" in text:
                desk.script.appendleft((desk.time_s, ["# fault 8: SDA held low", row(desk.time_s, flags=2)]))
            desk.keys.extend([None] * 10 + [""])  # seen before Enter is pressed
        desk.prompt = late
        found = []
        judge = lambda bench: found.extend(seen for seen in bench.events(0.5))  # noqa: E731
        Session(desk.bench(), self.record(), []).once(3, check("selftest", judge), 1)
        self.assertEqual((found[0].text, found[1].row.flags), ("# fault 8: SDA held low", 2))
        self.assertGreater(found[2].at_s, found[1].at_s + 0.05)  # good rows are not kept

    def test_resume(self):
        checks = [(1, check(alone=True)), (2, check("rate", raises(Failed("late")), alone=True)), (3, check("selftest"))]
        self.run_session(checks, answers=["", "q"])
        with open(self.path, "ab") as file:
            file.write(b'{"kind": "check", "number": 3, "key": "self')  # cut by a power failure
        record = self.record(resumed=True)
        self.assertEqual(record.spoilt, [4])
        ran = []
        again = [(number, each._replace(judge=lambda bench, number=number: ran.append(number))) for number, each in checks]
        ok, _ = self.run_session(again, answers=["", ""], record=record)
        self.assertTrue(ok)
        self.assertEqual(ran, [2, 3])
        texts = self.path.read_text().splitlines()
        self.assertEqual(texts[3], '{"kind": "check", "number": 3, "key": "self')  # nothing is taken out
        self.assertEqual([line["verdict"] for line in Record(self.path, resumed=True).last().values()], ["pass", "pass", "pass"])
        self.assertEqual(json.loads(texts[4])["try"], 2)


class Records(CommandCase):
    def test_what_is_in_its_first_line(self):
        self.record()
        line = self.lines()[0]
        self.assertEqual((line["kind"], line["firmware"], line["usb"], line["settings"]), ("begin", FIRMWARE_SAYS, [9025, 67], {"every": "1"}))
        for name in ("at", "tool", "os", "python", "port"):
            self.assertTrue(line[name], name)

    def test_shown(self):
        desk = Desk(rows(0, 120), Model(), ["", "a short cable", ""])
        Session(desk.bench(), self.record(), [(1, check(alone=True)), (3, check("selftest", raises(Failed("no axis"))))]).run()
        status, out, err = self.tilt("--show", self.path)
        self.assertEqual((status, err), (0, ""))
        self.assertIn(FIRMWARE_SAYS, out)
        self.assertRegex(out, r"(?m)^ 1 identity +pass +seconds 1.5$")
        self.assertRegex(out, r"(?m)^ 3 selftest +fail +no axis; tries 1$")
        self.assertRegex(out, r"(?m)^ +note: a short cable$")
        self.assertRegex(out, r"(?m)^20 strap +not done$")
        self.assertIn("1 passed, 1 failed, 0 skipped, 18 not done", out)

    def test_cut_anywhere_the_rest_is_shown(self):
        desk = Desk(rows(0, 120), Model())
        Session(desk.bench(), self.record(), [(1, check(alone=True)), (2, check("rate", alone=True))]).run()
        whole = self.path.read_bytes()
        ends = [at for at, byte in enumerate(whole) if byte == 10]
        for size in range(ends[0], len(whole), 7):
            self.path.write_bytes(whole[:size])
            record = Record(self.path, resumed=True)
            self.assertEqual(len(record.last()), sum(size >= end for end in ends[1:3]), size)
            text = "\n".join(shown(record, ALL))
            self.assertEqual("unreadable (cut short?)" in text, size not in ends and size - 1 not in ends, size)

    def test_what_is_no_record_is_refused_with_its_place(self):
        for text, reason in (("", ":1: not a record"), ("t_us,x,y,z\n1,2,3,4\n", ":1: not a record"), ('{"kind": "check"}\n', ":1: not a record"),
                             ('[1]\n', ":1: not a record"), ('{"kind": "begin", "form": 1}\n', ":1: not a record"),
                             ("\x00\xff\n", ":1: not a record"),
                             (json.dumps(begin_line("p", None, FIRMWARE_SAYS, {}) | {"form": 2}), ":1: record of form 2, but this program reads")):
            self.path.write_text(text, encoding="latin-1")
            for words in (("--show", self.path), ("nowhere", "--resume", self.path)):
                with mock.patch.object(owner_module, "Owner", lambda: Desk()):
                    status, _, err = self.tilt(*words)
                self.assertEqual(status, 2, text)
                self.assertIn(f"tilt board: {self.path}{reason}", err)
        self.assertEqual(self.path.read_text()[:8], '{"kind":')  # as it was
        status, _, err = self.tilt("--show", self.folder / "none")
        self.assertEqual((status, "none: No such file" in err), (2, True))

    def test_a_file_that_is_there_is_never_overwritten(self):
        self.path.write_text("precious")
        with self.assertRaisesRegex(TiltError, "exists already"):
            Record(self.path)
        with self.assertRaisesRegex(TiltError, "no folder"):
            Record(self.folder / "none" / "x")
        self.assertEqual(self.path.read_text(), "precious")

    def test_a_disk_that_is_full_leaves_whole_lines(self):
        record = self.record()
        size = self.path.stat().st_size

        class Full:
            def __getattr__(self, name):
                return getattr(record_file, name)

            def write(self, data):
                record_file.write(data[:10])
                raise OSError(28, "No space left on device")
        record_file, record.file = record.file, Full()
        with self.assertRaisesRegex(TiltError, "No space left on device; the file holds what came before"):
            record.add({"kind": "end"})
        self.assertEqual(self.path.stat().st_size, size)

    def test_no_serial_number_of_the_port_is_in_it(self):
        self.assertEqual(begin_line("p", [1, 2], FIRMWARE_SAYS, {})["usb"], [1, 2])
        self.assertNotIn("serial", json.dumps(begin_line("p", [1, 2], FIRMWARE_SAYS, {})))


if __name__ == "__main__":
    from unity_line import main
    main()
