#!/usr/bin/env python3
"""What becomes of the commands of `tilt record --send`: refused, unanswered, answered late, answered in other words; and that the flags are the
firmware's. Run from the repository root with build/venv/bin/python."""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
import test_record  # noqa: E402
from fake_board import BANNER, HEADER, rows  # noqa: E402
from tilt import protocol  # noqa: E402

REFUSAL = "refused 4: filter is one of one two; make flash FILTERS=NAME: three"


class Commands(test_record.Case):
    def sent(self, answers, *commands, begin=BANNER + HEADER, **constants):
        """(status, stdout) of a recording by a board that answers these commands with these lines."""
        def script(board):
            board.send(begin + rows(0, 20))
            number = 20
            for heard, answer in answers:
                board.heard(heard + b"\n")
                board.send(answer + rows(number, number + 10))
                number += 10
            board.send(rows(number, 250))
        words = [word for command in commands for word in ("--send", command)]
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.2), *words, **{"ANSWER_S": 120.0} | constants)
        self.assertNotIn("Traceback", err)
        return status, out

    def test_a_refusal_is_status_1_with_the_boards_words(self):
        status, out = self.sent([(b"filter foo", b"# " + REFUSAL.encode() + b"\n"), (b"every 1", b"# every 1\n")], "filter foo", "every 1")
        self.assertEqual((status, out.splitlines()[-2:]), (1, ["nothing is missing", f"the board refused 'filter foo': {REFUSAL}"]))

    def test_answers_are_status_0(self):
        answers = [(b"rate 100", b"# rate 100 Hz\n"), (b"LOAD", b"# settings: as saved\n"), (b"status", b"# state streaming\n# reset: power on\n"),
                   (b"version", BANNER.splitlines()[1] + b"\n"), (b"tare", b"# tare: hold still\n"), (b"?", b"# filter one\n")]
        self.assertEqual(self.sent(answers, *(heard.decode() for heard, _ in answers))[0], 0)

    def test_another_line_is_no_answer(self):
        status, out = self.sent([(b"rate 400", b"# fault 10: the values do not change\n")], "rate 400", "every 1", ANSWER_S=0.1)
        self.assertEqual(status, 1)
        self.assertIn("the board did not answer 'rate 400'", out)

    def test_an_answer_that_comes_late_counts(self):
        answers = [(b"rate 400\nevery 1", b"# rate 400 Hz\n# every 1\n")]
        self.assertEqual(self.sent(answers, "rate 400", "every 1", ANSWER_S=0.1)[0], 0)

    def test_a_refusal_that_comes_late_is_not_lost(self):
        answers = [(b"rate 90\nevery 1", b"# refused 4: rate is one of 12.5 25 50 100 200 400 800\n# every 1\n")]
        status, out = self.sent(answers, "rate 90", "every 1", ANSWER_S=0.1)
        self.assertEqual(status, 1)
        self.assertIn("the board refused 'rate 90': refused 4: rate is one of", out)

    def test_a_command_that_was_not_sent_in_time_is_named(self):
        self.assertIn("not sent: 'every 1'", self.sent([(b"rate 400", b"")], "rate 400", "every 1")[1])

    def test_after_a_reset_what_counts_is_the_commands_sent_again(self):
        answers = [(b"rate 200", BANNER + HEADER), (b"rate 200\nrate 200", b"# rate 200 Hz\n")]
        status, out = self.sent(answers, "rate 200")
        self.assertEqual((status, out.splitlines()[1:]), (1, ["1 resets of the board", "something is missing"]))


class Flags(unittest.TestCase):
    def test_the_firmwares_flags_have_names_here(self):
        enum = re.search(r"enum row_flag \{(.*?)\}", pathlib.Path("firmware/path/pipeline.h").read_text(encoding="utf-8"), re.S)[1]
        found = {int(bit): name.lower().replace("_", " ") for name, bit in re.findall(r"ROW_(\w+) = (\d+)", enum)}
        words = {protocol.REACQUIRED: "reacquired", protocol.SILENCE: "fault", protocol.LEFT_OUT: "left out"}  # where they differ
        self.assertEqual(found, protocol.FLAG_NAMES | words)

    def test_every_flag_in_words(self):
        self.assertEqual(protocol.flags_in_words(2048 | 4096 | 1), "gated, switched, axis left out")


if __name__ == "__main__":
    from unity_line import main
    main()
