#!/usr/bin/env python3
"""Tests of the reader and writer of streams: docs/protocol.md, "Streams". What is refused is refused in the words of sim/model/stream.c, which
host_tests/sim/test_stream.c holds to the same texts."""
import pathlib
import sys
from unittest import mock

import numpy as np

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from tilt_case import InFolder  # noqa: E402
from tilt import errors, stream  # noqa: E402


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "s.csv"

    def read(self, text, columns=()):
        self.path.write_bytes(text.encode() if isinstance(text, str) else text)
        return stream.read(self.path, columns)

    def refused(self, text, line, reason, columns=()):
        with self.assertRaises(errors.TiltError) as caught:
            self.read(text, columns)
        self.assertEqual(str(caught.exception), f"{self.path}:{line}: {reason}")


class Reads(Case):
    def test_plain_rows(self):
        s = self.read("t_us,x,y,z\n5000,1,-2,256\n15000,-4096,4095,0\n25000,3,4,5\n")
        self.assertEqual(s.t_us.tolist(), [0, 10000, 20000])
        self.assertEqual(s.lsb.tolist(), [[1, -2, 256], [-4096, 4095, 0], [3, 4, 5]])
        self.assertEqual((s.start_us, s.step_us, s.rate_hz, s.line.tolist()), (5000, 10000, 100.0, [2, 3, 4]))
        self.assertEqual((s.t_us.dtype, s.lsb.dtype, s.flags.dtype), (np.int64, np.int16, np.uint16))
        self.assertFalse(s.has_truth or s.flags.any() or s.missing.any())
        self.assertAlmostEqual(s.seconds, 0.03, delta=1e-12)

    def test_columns_go_by_name_and_the_first_of_two_counts(self):
        s = self.read("note,z_lsb,y_lsb,x_lsb,t_us,x,temperature\nhello,3,2,1,100,9,2.5\n,6,5,4,300,9,\n")
        self.assertEqual(s.lsb.tolist(), [[1, 2, 3], [4, 5, 6]])
        self.assertEqual(s.t_us.tolist(), [0, 200])

    def test_further_columns(self):
        s = self.read("t_us,x,y,z,roll_cdeg\n0,0,0,256,-17999\n1,0,0,256,18000\n", ["roll_cdeg"])
        self.assertEqual(s.columns["roll_cdeg"].tolist(), [-17999, 18000])
        self.refused("t_us,x,y,z\n0,0,0,0\n", 1, "missing column roll_cdeg", ["roll_cdeg"])
        self.refused("t_us,x,y,z,mg\n0,0,0,0,1.5\n", 2, "mg is not a whole number: '1.5': tilt import FILE converts other units", ["mg"])

    def test_truth_and_flags(self):
        s = self.read("t_us,x,y,z,pitch_true_cdeg,flags,roll_true_cdeg\n0,0,0,256,9000,2,-18000\n1,0,0,0,-9000,16,18000\n2,0,0,0,0,65517,1\n")
        self.assertEqual((s.roll_true_cdeg.tolist(), s.pitch_true_cdeg.tolist()), ([-18000, 18000, 1], [9000, -9000, 0]))
        self.assertEqual((s.flags.tolist(), s.missing.tolist()), ([2, 16, 65517], [True, True, False]))  # 65517 = 65535 - 2 - 16

    def test_mark_crlf_comments_blank_lines_and_padding(self):
        s = self.read("\ufeff# a comment\r\n\r\n t_us , x,y,z\r\n# another, with, commas\r\n 0, 1,\t2 , +3\r\n  \r\n10,4,5,6")
        self.assertEqual((s.lsb.tolist(), s.line.tolist()), ([[1, 2, 3], [4, 5, 6]], [5, 7]))

    def test_wraps_of_the_32_bit_clock(self):
        s = self.read("t_us,x,y,z\n4294960000,1,0,0\n2704,2,0,0\n4294960000,3,0,0\n2704,4,0,0\n")
        self.assertEqual(s.t_us.tolist(), [0, 10000, 2 ** 32, 2 ** 32 + 10000])  # 2^32 - 4294960000 + 2704 = 10000

    def test_a_step_back_of_2_31_is_a_fault_and_one_more_a_wrap(self):
        self.refused(f"t_us,x,y,z\n{2 ** 31},0,0,0\n0,0,0,0\n", 3, f"time goes backwards: 0 after {2 ** 31}")
        self.assertEqual(self.read(f"t_us,x,y,z\n{2 ** 31 + 1},0,0,0\n0,0,0,0\n").t_us.tolist(), [0, 2 ** 31 - 1])

    def test_segments_go_on_a_median_step_later(self):
        s = self.read("t_us,x,y,z\n0,1,0,0\n20000,2,0,0\n40000,3,0,0\nt_us,z,y,x\n7,0,0,4\n10007,0,0,5\nt_us,x,y,z\nt_us,x,y,z\n9,6,0,0\n")
        self.assertEqual(s.step_us, 20000)                     # of 20000, 20000, 10000
        self.assertEqual(s.t_us.tolist(), [0, 20000, 40000, 60000, 70000, 90000])
        self.assertEqual(s.segments, [slice(0, 3), slice(3, 5), slice(5, 6)])
        self.assertEqual(s.lsb[:, 0].tolist(), [1, 2, 3, 4, 5, 6])

    def test_both_ways_give_the_same_for_every_shipped_stream(self):
        for path in sorted(pathlib.Path("sim/streams").glob("*.csv")):
            with mock.patch.object(stream, "_careful", side_effect=AssertionError("not plain")):
                plain = stream.read(path)
            with mock.patch.object(stream, "_plain", side_effect=stream._NotPlain):
                careful = stream.read(path)
            for name in ("t_us", "lsb", "flags", "roll_true_cdeg", "pitch_true_cdeg", "line"):
                np.testing.assert_array_equal(getattr(plain, name), getattr(careful, name), f"{path} {name}")
            self.assertEqual((plain.segments, plain.step_us), (careful.segments, careful.step_us))

    def test_progress_goes_to_the_end(self):
        self.path.write_text("t_us,x,y,z\n0,0,0,1\n1,0,0,1\n", encoding="ascii")
        told = []
        with mock.patch.object(stream, "ROWS_AT_A_TIME", 1):
            stream.read(self.path, progress=lambda done, whole: told.append((done, whole)))
        self.assertEqual(told, [(18, 27), (26, 27)])           # ends of the two rows' lines, of 27 bytes


class Refuses(Case):
    def test_files(self):
        self.refused("", 1, "the file is empty")
        self.refused("# x\n\n", 2, "no header")
        self.refused("# x\nt_us,x,y,z\n", 2, "no rows after the header")
        self.refused("t_us,x,y,z\n0,0,\0,0\n", 2, "a NUL byte: no text, or UTF-16, which tilt import FILE converts")
        with self.assertRaisesRegex(errors.TiltError, r"absent.csv: cannot be read: No such file"):
            stream.read(self.path.parent / "absent.csv")
        with self.assertRaisesRegex(errors.TiltError, "cannot be read: Is a directory"):
            stream.read(self.path.parent)

    def test_headers(self):
        hint = " (a header with t_us and x,y,z or x_lsb,y_lsb,z_lsb comes first): tilt import FILE converts other recordings"
        self.refused("0,0,0,0\n", 1, "missing column t_us" + hint)
        self.refused("t_us,x,y\n0,0,0\n", 1, "missing column z" + hint)
        self.refused("t_us,x,y,z\n0,0,0,0\nt_us,x,y\n", 3, "missing column z")
        self.refused("t_us,x,y,z," + "a," * 61 + "\n", 1, "more than 64 columns")
        self.refused("t_us,x,y,z\n0,0,0,0\nt_us,x,y,z,roll_true_cdeg,pitch_true_cdeg\n", 3, "the truth columns come or go in the middle of the file")

    def test_rows(self):
        for row, reason in (("0,0,0", "3 fields where the header has 4"), ("0,0,0,0,", "5 fields where the header has 4"),
                            ("0" + ",0" * 64, "65 or more fields where the header has 4"),
                            ("0,,0,0", "x is not a whole number: ''"),
                            ("0,0,1.0,0", "y is not a whole number: '1.0': tilt import FILE converts other units"),
                            ("0,0,0,0x1", "z is not a whole number: '0x1'"), ("0,1 2,0,0", "x is not a whole number: '1 2'"),
                            ("0,--1,0,0", "x is not a whole number: '--1'"), ("0,-,0,0", "x is not a whole number: '-'"),
                            ("99999999999999999999,0,0,0", "t_us is not a whole number: '99999999999999999999'"),
                            ("1000000000000001,0,0,0", "t_us is outside 0..1000000000000000: 1000000000000001"),
                            ("-1,0,0,0", "t_us is outside 0..1000000000000000: -1"),
                            ("0,4096,0,0", "x is outside -4096..4095: 4096"), ("0,0,0,-4097", "z is outside -4096..4095: -4097"),
                            ("1#", "1 fields where the header has 4")):
            self.refused(f"# one\nt_us,x,y,z\n0,0,0,0\n{row}\n0,0,0,0,0,0\n", 4, reason)
        for row, fields in (("0,0,0,0", 4), ("0,0,0,0,note,", 6)):  # the last column is not read
            self.refused(f"t_us,x,y,z,note\n{row}\n", 2, f"{fields} fields where the header has 5")
        self.refused("t_us,x,y,z,flags\n0,0,0,0,65536\n", 2, "flags is outside 0..65535: 65536")
        self.refused("t_us,x,y,z,roll_true_cdeg,pitch_true_cdeg\n0,0,0,0,18001,0\n", 2, "roll_true_cdeg is outside -18000..18000: 18001")

    def test_the_first_fault_is_told(self):
        self.refused("t_us,x,y,z\n20,0,0,0\n10,0,0,0\n0,0,0\nt_us,x,y\n", 3, "time goes backwards: 10 after 20")

    def test_a_long_text_is_cut(self):
        self.refused(f"t_us,x,y,z\n0,{'a' * 50},0,0\n", 2, f"x is not a whole number: '{'a' * 40}'")


class Writes(Case):
    def test_what_is_written_is_read(self):
        t_us, lsb = np.array([0, 2 ** 31, 2 ** 32, 2 ** 32 + 1]), np.array([[1, -2, 3], [-4096, 4095, 0], [0, 0, 0], [7, 8, 9]])
        stream.write(self.path, t_us, lsb, flags=[0, 2, 16, 65535], roll_true_cdeg=[1, 2, 3, 4], pitch_true_cdeg=[5, 6, 7, 8],
                     columns={"index": [4, 3, 2, 1]}, comments=["made"])
        s = stream.read(self.path, ["index"])
        self.assertEqual((s.t_us.tolist(), s.lsb.tolist()), (t_us.tolist(), lsb.tolist()))
        self.assertEqual((s.flags.tolist(), s.roll_true_cdeg.tolist(), s.pitch_true_cdeg.tolist()), ([0, 2, 16, 65535], [1, 2, 3, 4], [5, 6, 7, 8]))
        self.assertEqual((s.columns["index"].tolist(), s.line[0]), ([4, 3, 2, 1], 3))

    def test_segments(self):
        stream.write(self.path, [0, 10, 20, 0, 10], np.zeros((5, 3)), segments=[slice(0, 3), slice(3, 5)])
        s = stream.read(self.path)
        self.assertEqual((s.segments, s.t_us.tolist()), ([slice(0, 3), slice(3, 5)], [0, 10, 20, 30, 40]))

    def test_what_may_not_be_is_refused_and_what_was_there_stays(self):
        self.path.write_text("precious", encoding="ascii")
        zeros = np.zeros((2, 3))
        for t_us, lsb, more in (([0, 1], zeros + 4096, {}), ([1, 0], zeros, {}), ([], zeros[:0], {}), ([0, 1, 2], zeros, {}),
                                ([0, 1], zeros, {"flags": [0, 65536]}), ([0, 1], zeros, {"flags": [0]})):
            with self.assertRaises(ValueError):
                stream.write(self.path, t_us, lsb, **more)
        with self.assertRaisesRegex(errors.TiltError, "cannot write it: No such file"):
            stream.write(self.path.parent / "absent" / "s.csv", [0], zeros[:1])
        with self.assertRaises(ZeroDivisionError):             # in the middle of the file
            stream.write(self.path, [0, 1], zeros, comments=(1 // n for n in (1, 0)))
        self.assertEqual([(p.name, p.read_text(encoding="ascii")) for p in self.path.parent.iterdir()], [("s.csv", "precious")])

    def test_a_pipe_is_written_as_it_is(self):
        stream.write("/dev/null", [0], np.zeros((1, 3)))
        self.assertFalse(pathlib.Path("/dev/null.part").exists())


if __name__ == "__main__":
    from unity_line import main
    main()
