#!/usr/bin/env python3
"""Tests of `tilt record`: what is written and what is counted, on made lines and on a board on a pseudo terminal."""
import contextlib
import io
import os
import pathlib
import signal
import sys
import termios
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import ROBUST  # noqa: E402
from fake_board import BANNER, HEADER, FakeBoard, row, rows, until  # noqa: E402
from tilt_case import InFolder  # noqa: E402
from tilt import cli, protocol, stream  # noqa: E402
from tilt.commands import record  # noqa: E402
from tilt.gaps import Gaps  # noqa: E402
from tilt.port import Port  # noqa: E402
from tilt.recorder import Recorder  # noqa: E402


def recorded(*parts):
    """(counts, text of the file) after these bytes, of which None is an outage."""
    out = io.BytesIO()
    recorder = Recorder(out.write)
    for part in parts:
        recorder.outage() if part is None else recorder.feed(part)
    recorder.finish()
    return recorder.counts, out.getvalue().decode("ascii")


def lines_that(text, word):
    return [number for number, line in enumerate(text.splitlines(), 1) if word in line]


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "out.csv"

    def stream_of(self, text):
        self.file.write_text(text)
        return stream.read(self.file)

    def run_tilt(self, script, *words, speed=None, **constants):
        """(status, stdout, stderr, board)"""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.ExitStack() as stack:
            for name, value in ({"RETRY_S": 0.01, "STRANGE_S": 0.1, "LISTEN_S": 0.3} | constants).items():
                stack.enter_context(mock.patch.object(record, name, value))
            board = stack.enter_context(FakeBoard(self.folder, script, speed))
            stack.enter_context(contextlib.redirect_stdout(out))
            stack.enter_context(contextlib.redirect_stderr(err))
            status = cli.main(["record", board.name, *(words or ("-o", str(self.file)))])
        return status, out.getvalue(), err.getvalue(), board

    def for_seconds(self, seconds):
        return "-o", str(self.file), "--seconds", str(seconds)

    def written(self, text):
        until(lambda: self.file.exists() and text in self.file.read_bytes())


class Lines(Case):
    def test_what_a_board_sends_is_kept_as_it_came_however_it_is_cut(self):
        whole = BANNER + HEADER + rows(0, 50) + f"# filter {ROBUST}\n".encode() + rows(50, 90)
        for size in (1, 7, len(whole)):
            counts, text = recorded(*(whole[i:i + size] for i in range(0, len(whole), size)))
            self.assertEqual(text, whole.decode().lstrip("\n"))
            self.assertEqual((counts.rows, counts.complete()), (90, True))
            self.assertEqual(counts.span_us, 89 * 10_000)

    def test_half_a_row_at_the_end_is_not_written(self):
        counts, text = recorded(BANNER + HEADER + rows(0, 3) + row(3)[:-2])
        self.assertEqual(len(self.stream_of(text)), 3)
        self.assertTrue(text.endswith("\n") and counts.complete())

    def test_a_running_stream_gets_a_header_and_loses_the_row_it_was_in(self):
        counts, text = recorded(row(3)[9:] + rows(4, 30))
        self.assertEqual(text.splitlines()[1:3], [HEADER.decode().strip(), row(4).decode().strip()])
        self.assertEqual((len(self.stream_of(text)), counts.complete()), (26, True))

    def test_a_line_that_is_no_row_is_kept_as_a_comment_with_its_number_and_its_reason(self):
        bad = [b"1,2,3\n", row(20).replace(b",256,", b",25x,"), row(20).replace(b",256,", b",9256,"), b"\xff\x00,1\n"]
        for line, reason in zip(bad, ("3 fields, the header has 10", "z_lsb is not a whole number", "z_lsb is outside",
                                      "bytes that never occur in a row")):
            counts, text = recorded(HEADER + rows(0, 20) + line + rows(21, 60))
            self.assertEqual((counts.malformed, counts.malformed_at, counts.rows, counts.gaps.on_the_way), (1, [22], 59, 1))
            self.assertIn(reason, text.splitlines()[21])
            self.assertEqual(len(self.stream_of(text)), 59)

    def test_a_reset_within_a_row(self):
        counts, text = recorded(HEADER + rows(0, 30) + row(30)[:9] + BANNER.lstrip() + HEADER + rows(0, 20))
        self.assertEqual((counts.cut, counts.resets, counts.rows, counts.malformed, counts.gaps.lost), (1, 1, 50, 0, 0))
        self.assertFalse(counts.complete())
        self.assertEqual(len(self.stream_of(text).segments), 2)
        self.assertEqual(lines_that(text, "a row cut short: 315000,30"), [32])

    def test_a_reset_whose_header_was_lost(self):
        counts, text = recorded(HEADER + rows(100, 130) + b"# reset: watch" + rows(0, 20))
        self.assertEqual(self.stream_of(text).segments, [slice(0, 30), slice(30, 49)])  # the row behind `watch` went with that line
        self.assertEqual(counts.resets, 1)

    def test_the_port_gone_and_back(self):
        counts, text = recorded(HEADER + rows(0, 30) + row(30)[:12], None, row(99)[5:] + rows(100, 120), None, BANNER + HEADER + rows(0, 5))
        self.assertEqual((counts.outages, counts.resets, counts.rows, counts.malformed, counts.cut), (2, 0, 55, 0, 0))
        self.assertEqual([part.stop - part.start for part in self.stream_of(text).segments], [30, 20, 5])
        self.assertEqual(text.count("the port was gone here"), 2)

    def test_a_digit_lost_from_a_time_is_no_reset(self):
        late = 4_000_000_000
        for start in (15_000, late):
            bad = row(40, start_us=start)[1:]
            counts, text = recorded(HEADER + rows(0, 40, start_us=start) + bad + rows(41, 80, start_us=start))
            self.assertEqual((counts.malformed, counts.resets, counts.rows, counts.gaps.on_the_way), (1, 0, 79, 1))
            self.assertEqual(len(self.stream_of(text).segments), 1)

    def test_the_counter_wraps(self):
        counts, text = recorded(HEADER + rows(0, 60, start_us=(1 << 32) - 300_000))
        self.assertEqual((counts.complete(), counts.span_us), (True, 590_000))
        self.assertEqual(int(self.stream_of(text).t_us[-1]), 590_000)

    def test_plotter_rows_are_kept_as_comments(self):
        plotter = b"# mode plot\nroll_raw:1.23,roll:1.20,pitch_raw:-0.42,pitch:-0.40,gated:0\n# mode csv\n"
        counts, text = recorded(HEADER + rows(0, 9) + plotter + HEADER + rows(200, 209))
        self.assertEqual((counts.plotter, counts.malformed, counts.complete(), len(self.stream_of(text))), (1, 0, True, 18))

    def test_what_is_never_ours_is_never_written(self):
        for text in (b"X: 0.12 Y: -0.33\n" * 20, b"# somebody else's\n1.5,2.5\n" * 20, bytes(range(128, 256)) * 20):
            self.assertEqual(recorded(text)[1], "")


class Missing(unittest.TestCase):
    def lost(self, *numbers, excused=(), dropped=(), period_us=10_000):
        gaps = Gaps()
        for before, number in zip(numbers, numbers[1:]):
            gaps.add((number - before) * period_us, number in dropped, number in excused)
        gaps.cut()
        return gaps

    def test_each_gap_counts_the_rows_that_would_fill_it(self):
        gone = {3, 4, 50, 60, 61, 62, 98}
        gaps = self.lost(*(n for n in range(100) if n not in gone))
        self.assertEqual((gaps.on_the_way, gaps.by_the_board), (7, 0))

    def test_a_rate_that_the_board_says_has_changed_is_not_lost_rows(self):
        """100 Hz, then 400, and back; 4 of the changes lie nearer to an end than half a window. A row lost beside each still counts."""
        for first in (1, 2, 3, 6, 20):
            for last in (1, 2, 3, 6, 20):
                gaps = Gaps()
                for us, many in ((10_000, first), (2_500, 30), (10_000, last)):
                    for number in range(many):
                        gaps.add(us, spoken=number == 0 and gaps.steps)
                gaps.cut()
                self.assertEqual(gaps.lost, 0, (first, last))
        gaps = Gaps()
        for number, us in enumerate((10_000, 20_000, 10_000, 10_000, 2_500, 2_500, 5_000, 2_500, 2_500)):
            gaps.add(us, spoken=number == 4)
        gaps.cut()
        self.assertEqual(gaps.lost, 2)

    def test_the_first_and_last_rows_too(self):
        self.assertEqual(self.lost(0, 1, 2, 5, 6).on_the_way, 2)
        self.assertEqual(self.lost(0, 1, 2, 3, 6).on_the_way, 2)
        self.assertEqual(self.lost(0, 1).on_the_way, 0)
        self.assertEqual(self.lost(0).on_the_way, 0)

    def test_what_the_board_dropped_is_told_apart(self):
        gaps = self.lost(*range(20), *range(24, 50), dropped=(24, 30))
        self.assertEqual((gaps.on_the_way, gaps.by_the_board), (0, 5))  # 20 to 23, and one whose gap is not to be seen

    def test_a_pause_is_no_loss(self):
        gaps = self.lost(*range(20), *range(120, 150), excused=(120,))
        self.assertEqual((gaps.lost, gaps.pauses, gaps.pauses_us), (0, 1, 1_010_000))

    def test_another_rate_is_no_loss_and_a_loss_at_it_is(self):
        steps = [*range(0, 40), *range(41, 80, 2), *range(85, 180, 2), *range(180, 230)]  # 81 and 83 are gone
        self.assertEqual(self.lost(*steps).on_the_way, 2)

    def test_rows_read_by_the_clock_come_early_and_late(self):
        gaps = Gaps()
        for us in [10_000] * 20 + [15_000, 5_000] * 10 + [17_400, 10_000] + [10_000] * 20:
            gaps.add(us)
        gaps.cut()
        self.assertEqual(gaps.lost, 0)


class Command(Case):
    """With a board; the times to wait are shortened, none is asserted."""

    def test_so_many_seconds_by_the_boards_clock(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 400))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2))
        self.assertEqual(status, 0, out + err)
        self.assertIn("nothing is missing", out)
        self.assertIn("# tilt-uno 0.1.0", err)
        self.assertGreaterEqual(stream.read(self.file).t_us[-1], 2_000_000)

    def test_rows_lost_are_counted_and_are_the_status(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 100) + rows(103, 150) + b"garbage\n" + rows(151, 180) + row(184, flags=256) + rows(185, 260))
        status, out, _, _ = self.run_tilt(script, *self.for_seconds(2.5))
        self.assertEqual(status, 1)
        self.assertIn("4 rows missing by their times", out)
        self.assertIn("4 rows dropped by the board", out)
        place = int(out.split("kept as # lines: ")[1].split("\n")[0].rsplit(":", 1)[1])
        self.assertIn("garbage", self.file.read_text().splitlines()[place - 1])

    def end_by(self, number):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 30) + row(30)[:10])
            self.written(row(29))
            os.kill(os.getpid(), number)
        status, out, _, _ = self.run_tilt(script)
        self.assertEqual((status, self.file.read_bytes()), (0, BANNER.lstrip() + HEADER + rows(0, 30)), out)

    def test_ctrl_c_and_sigterm_lose_nothing(self):
        before = signal.getsignal(signal.SIGINT)
        self.end_by(signal.SIGINT)
        self.file.unlink()
        self.end_by(signal.SIGTERM)
        self.assertIs(signal.getsignal(signal.SIGINT), before)

    def test_unplugged_and_plugged_in_again(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 100) + row(100)[:7])
            self.written(row(99))
            board.unplug()
            board.plug()
            board.opened(2)
            board.send(BANNER + HEADER + rows(0, 150))
        status, out, err, _ = self.run_tilt(script, *self.for_seconds(2.3))
        self.assertEqual(status, 1)
        self.assertIn("1 times the port was gone", out)
        self.assertIn("is gone: waiting for it", err)
        self.assertIn("is back", err)
        parts = stream.read(self.file).segments
        self.assertEqual((len(parts), parts[0].stop), (2, 100))

    def test_no_reconnect(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 100))
            self.written(row(99))
            board.unplug()
        status, _, _, _ = self.run_tilt(script, "-o", str(self.file), "--no-reconnect")
        self.assertEqual((status, len(stream.read(self.file))), (1, 100))

    def test_commands_are_typed_when_the_board_is_there_and_after_a_reset(self):
        def script(board):
            board.send(BANNER + HEADER + rows(0, 50))
            board.heard(f"filter {ROBUST}\nevery 2\n".encode())
            board.send(f"# filter {ROBUST}\n".encode() + BANNER + HEADER)
            board.heard(f"filter {ROBUST}\nevery 2\nfilter {ROBUST}\nevery 2\n".encode())
            board.send(rows(0, 150))
        status, _, _, _ = self.run_tilt(script, *self.for_seconds(1.9), "--send", f"filter {ROBUST}", "--send", "every 2")
        self.assertEqual(status, 1)  # the reset

    def test_a_wrong_baud_rate_is_told_with_the_right_one(self):
        def script(board):
            while True:
                board.send(rows(0, 100))
        status, _, err, _ = self.run_tilt(script, speed=termios.B500000, LISTEN_S=2.0)
        self.assertEqual(status, 2)
        self.assertIn("no text at 115200 baud, but this firmware's at 500000 baud: give --baud 500000", err)
        self.assertFalse(self.file.exists())

    def test_what_is_no_board_of_ours_is_told(self):
        cases = ((b"X: 0.12 Y: -0.33\n" * 30, "not from this firmware: 'X: 0.12 Y: -0.33'"),
                 (b"roll_raw:1.23,roll:1.20,pitch_raw:-0.42,pitch:-0.40,gated:0\n" * 30, "--send 'mode csv'"),
                 (bytes(range(128, 256)) * 4, "no text at 115200 baud, nor at 9600"))
        for data, reason in cases:
            status, _, err, _ = self.run_tilt(lambda board, data=data: board.send(data), STRANGE_BYTES=100, LISTEN_S=0.01)
            self.assertEqual((status, self.file.exists()), (2, False))
            self.assertIn(reason, err)

    def test_silence_is_told(self):
        status, _, err, _ = self.run_tilt(lambda board: None, SILENT_S=0.1)
        self.assertEqual(status, 2)
        self.assertIn("nothing received", err)

    def test_no_port_a_busy_one_and_a_file_that_is_there(self):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            self.assertEqual(cli.main(["record", str(self.folder / "none"), "-o", str(self.file)]), 2)
            self.file.write_text("precious")
            self.assertEqual(cli.main(["record", str(self.folder / "none"), "-o", str(self.file)]), 2)
        self.assertIn("none: No such file or directory (", err.getvalue())
        self.assertIn("out.csv: exists already", err.getvalue())
        self.assertEqual(self.file.read_text(), "precious")
        self.file.unlink()
        with FakeBoard(self.folder, lambda board: None) as board, contextlib.redirect_stderr(err):
            first = Port(board.name, protocol.BAUD_AT_START)
            first.open()
            self.assertEqual(cli.main(["record", board.name, "-o", str(self.file)]), 2)
            first.close()
        self.assertIn("in use by another program", err.getvalue())

    def test_force_and_a_full_disk(self):
        self.file.write_text("old")
        script = lambda board: board.send(BANNER + HEADER + rows(0, 200))  # noqa: E731
        self.assertEqual(self.run_tilt(script, *self.for_seconds(1), "--force")[0], 0)
        self.assertNotIn("old", self.file.read_text())
        if os.path.exists("/dev/full"):
            status, _, err, _ = self.run_tilt(script, "-o", "/dev/full", "--force")
            self.assertEqual(status, 2)
            self.assertIn("/dev/full: No space left on device", err)

    def test_a_senseless_option(self):
        for words in (("--seconds", "0"), ("--seconds", "nan"), ("--baud", "-1")):
            with contextlib.redirect_stderr(io.StringIO()) as err:
                self.assertEqual(cli.main(["record", "nowhere", *words]), 2)
            self.assertIn(words[0], err.getvalue())


if __name__ == "__main__":
    from unity_line import main
    main()
