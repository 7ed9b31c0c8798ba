#!/usr/bin/env python3
"""`tilt import` of CWA files made here, field by field from the maker's description of the format: readings, clock, refusals."""
import pathlib
import struct
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import LSB, Case

RATE_100, RATE_50 = 0x4A, 0x49  # 3200 / 2^(15 - 10) and half of it; the top bits say +-8 g
PACKED, WORDS = 0x30, 0x32
START = (26 << 26) | (11 << 22) | (22 << 17) | (23 << 12) | (59 << 6) | 50  # 2026-11-22 23:59:50


def header(hardware=0):
    return b"MD" + struct.pack("<HB", 1020, hardware) + bytes(1019)


def packed(row):
    """Three axes of 10 bits below an exponent: value << exponent is the reading."""
    exponent = next(e for e in range(4) if all(value % (1 << e) == 0 and -512 <= value >> e <= 511 for value in row))
    x, y, z = (value >> exponent & 0x3FF for value in row)
    return struct.pack("<I", exponent << 30 | z << 20 | y << 10 | x)


def block(sequence, stamp, rows, offset=0, axes=PACKED, rate=RATE_100, fraction=0, light=0):
    body = b"".join(packed(row) for row in rows) if axes == PACKED else b"".join(struct.pack("<3h", *row) for row in rows)
    whole = struct.pack("<2sHHIIIHHBBBBhH", b"AX", 508, fraction, 7, sequence, stamp, light, 0, 0, 0, rate, axes, offset, len(rows)) \
        + body.ljust(480, b"\0")
    return whole + struct.pack("<H", -sum(struct.unpack("<255H", whole)) & 0xFFFF)


def many(count, size=120):
    """Rows of known readings, some beyond 10 bits (multiples of the exponent's step)."""
    return [[(*LSB[(b * 7 + i) % 60][:2], LSB[i % 60][2]) if i % 11 else (8 * (i - 60), 4095 // 8 * 8, -4096) for i in range(size)]
            for b in range(count)]


class Readings(Case):
    def test_packed_and_in_words(self):
        for axes, size in ((PACKED, 120), (WORDS, 80)):
            rows = many(3, size)
            stamps = [START, START + 1, START + 2]
            content = header() + b"".join(block(i, stamps[i], rows[i], offset=100 * i - size * i, axes=axes) for i in range(3))
            # the stamps hold at samples 0, 100 and 200: exactly 100 Hz
            self.gives(content, [row for part in rows for row in part], [10000 * i for i in range(3 * size)])

    def test_one_block_goes_by_the_nominal_rate(self):
        for rate, period in ((RATE_100, 10000), (RATE_50, 20000)):
            rows = many(1)[0]
            self.gives(header() + block(0, START, rows, offset=50, rate=rate), rows, [period * i for i in range(120)])

    def test_midnight_and_the_true_rate(self):
        """Stamps at samples 0, 98, 196, ...: 98 Hz, from 23:59:50 on."""
        rows = many(20)
        seconds, content = 0, header()
        for number in range(20):
            seconds = -(-120 * number // 98)  # the first whole second within the block
            clock = (23 * 3600 + 59 * 60 + 50 + seconds)
            day, hour, minute, second = 22 + clock // 86400, clock // 3600 % 24, clock // 60 % 60, clock % 60
            stamp = (26 << 26) | (11 << 22) | (day << 17) | (hour << 12) | (minute << 6) | second
            content += block(number, stamp, rows[number], offset=98 * seconds - 120 * number)
        said = self.gives(content, [row for part in rows for row in part], [round(i * 1e6 / 98) for i in range(2400)])
        self.assertIn("98 Hz", said)

    def test_long_files_go_by_the_average_of_many_stamps(self):
        """1,000 blocks at 100 Hz whose stamps hold a sample late in every second block: an average of 64 is half a sample late
        everywhere, so steps stay 10 ms and the whole is 1,199.99 s."""
        rows = [[(0, 4, 256)] * 120] * 1000
        content = header()
        for number in range(1000):
            seconds = -(-120 * number // 100)
            clock = seconds + 3600
            stamp = (26 << 26) | (11 << 22) | (22 << 17) | (clock // 3600 << 12) | (clock // 60 % 60 << 6) | clock % 60
            content += block(number, stamp, rows[number], offset=100 * seconds - 120 * number + number % 2)
        times = self.imported(content)[0]
        steps = [b - a for a, b in zip(times, times[1:])]
        self.assertLessEqual(abs(times[-1] - 1199990000), 10000)
        self.assertTrue(all(9990 <= step <= 10010 for step in steps), (min(steps), max(steps)))

    def test_a_fraction_of_a_second_stands_with_its_offset_moved(self):
        """Block 1 was stamped half a second later, at its sample 30; the recorder moved that back by the 50 samples of half a second to -20.
        Block 0 has no fraction: its sample 0 is at the second before."""
        rows = many(2)
        content = header() + block(0, START, rows[0], 0) + block(1, START + 1, rows[1], -20, fraction=0x8000 | 0x4000)
        self.gives(content, rows[0] + rows[1], [10000 * i for i in range(240)])

    def test_a_break_in_the_sequence(self):
        rows = many(2)
        content = header() + block(0, START, rows[0], 0) + block(9, START + 7, rows[1], 0)
        said = self.gives(content, rows[0] + rows[1], [10000 * i for i in range(120)] + [7000000 + 10000 * i for i in range(120)])
        self.assertIn("1 breaks in the sequence of blocks", said)


class Refused(Case):
    def setUp(self):
        super().setUp()
        rows = many(3)
        self.good = header() + b"".join(block(i, START + i, rows[i]) for i in range(3))

    def test_one_bit_turned_anywhere_in_a_block(self):
        """Each bit counts in the sum of words; the letters and the length are looked at first."""
        for place in range(1536, 2048, 13):
            spoilt = bytearray(self.good)
            spoilt[place] ^= 1 << (place % 8)
            reason = "not a data block (AX)" if place < 1540 else "wrong checksum"
            self.refused(bytes(spoilt), f"block 3 (byte 1536): {reason}")

    def test_cut_short(self):
        self.refused(self.good[:-1], "cut short: block 4 has 511 bytes of 512")
        self.refused(self.good[:1000], "cut short: the CWA header has 1000 bytes of 1024")
        self.refused(self.good[:1024], "only a header, no blocks")

    def test_other_sensors(self):
        self.refused(header(0x64) + self.good[1024:], "from an AX6, which has no ADXL345")
        rows = many(1, 40)[0]
        self.refused(header() + block(0, START, rows, axes=0x62), "block 2 (byte 1024): not three axes, packed or in words")
        self.refused(header() + block(0, START, rows, axes=WORDS, light=3 << 13),
                     "block 2 (byte 1024): counts are not 1/256 g: not an ADXL345")

    def test_numbers_of_samples(self):
        for rows, axes in (([], PACKED), ([(0, 0, 256)] * 80, WORDS)):
            content = bytearray(header() + block(0, START, rows, axes=axes))
            if rows:
                content[1024 + 28] += 1  # 81 of 80
                content[-2] -= 1
            self.refused(bytes(content), "block 2 (byte 1024): impossible number of samples")

    def test_a_header_with_text_after_it(self):
        self.refused(header() + b"1,2,3\n" * 256, "block 2 (byte 1024): not a data block (AX)")


if __name__ == "__main__":
    from unity_line import main
    main()
