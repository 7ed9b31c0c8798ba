#!/usr/bin/env python3
"""How `tilt import` finds the unit: each scale of the public drivers from each printing, what cannot be told, what is no ADXL345's."""
import pathlib
import random
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import G, LSB, ROWS, Case, every

PER_LSB_G = {"1/256 g": (1 / 256,) * 3, "4 mg": (0.004,) * 3, "3.9 mg": (0.0039,) * 3, "1/265, 1/265, 1/256 g": (1 / 265, 1 / 265, 1 / 256),
             "0.003774, 0.003774, 0.003906 g": (0.003774, 0.003774, 0.003906)}
PRINTED = {"g": (1.0, (3, 4, 6, 12)), "mg": (1000.0, (1, 2, 3)), "m/s2": (G, (2, 3, 6)), "mm/s2": (1000.0 * G, (0, 1, 6))}


def table(rows):
    return "t_ms,x,y,z\n" + "".join(f"{10 * i},{','.join(row)}\n" for i, row in enumerate(rows))


def printed(scale, digits, lsb=None):
    return table([[f"{value * part:.{digits}f}" for value, part in zip(row, scale)] for row in lsb or LSB])


class Found(Case):
    def test_every_scale_in_every_printing(self):
        """Half a digit is at most 0.13 LSB, and the scales lie 0.16 % apart, 0.4 LSB at 1 g: whole numbers tell them. Two are closer than a
        digit (0.003906 g and 1/256 g: 0.016 LSB), but only in z, and x, y are 1/265 or 1/256."""
        for unit, (factor, precisions) in PRINTED.items():
            for words, per_lsb in PER_LSB_G.items():
                for digits in precisions:
                    with self.subTest(unit=unit, scale=words, digits=digits):
                        said = self.gives(printed([part * factor for part in per_lsb], digits), LSB, every(10000))
                        self.assertIn(f"unit {unit}, ", said)

    def test_the_scale_is_named_where_the_digits_tell_it(self):
        for unit, (factor, precisions) in PRINTED.items():
            for words, per_lsb in PER_LSB_G.items():
                said = self.imported(printed([part * factor for part in per_lsb], precisions[-1] + 3))[2]
                self.assertIn(f"unit {unit}, {words} (found by whole numbers, residual 0.000", said)

    def test_whole_numbers_of_mg_are_no_counts(self):
        said = self.gives(printed((1000 / 256,) * 3, 0), LSB, every(10000))
        self.assertIn("unit mg, 1/256 g", said)

    def test_counts_in_motion_are_counts(self):
        """1,000 LSB of magnitude are 4 g, not 1,000 mg."""
        fast = [(4 * x + i % 3, 4 * y + 1, 4 * z + i % 2) for i, (x, y, z) in enumerate(LSB)]
        self.assertIn("unit raw", self.gives(table([map(str, row) for row in fast]), fast, every(10000)))

    def test_counts_without_gravity(self):
        """Recordings from which the start pose was subtracted, on the board or later."""
        small = [(x, y, z - 256) for x, y, z in LSB]
        self.assertIn("unit raw", self.gives(table([map(str, row) for row in small]), small, every(10000)))
        self.assertIn("unit g, 4 mg", self.gives(printed((0.004,) * 3, 3, small), small, every(10000)))

    def test_coarse_values_that_are_nothing_in_another_unit(self):
        """All below 0.02 LSB of mm/s2, which would be whole numbers: 0."""
        low = [(90 + i % 7, 90 - i % 5, 100 + i % 3) for i in range(ROWS)]
        expected = [tuple(round(float(f"{value / 256:.2f}") * 256) for value in row) for row in low]
        self.assertIn("unit g, 1/256 g", self.gives(printed((1 / 256,) * 3, 2, low), expected, every(10000)))

    def test_other_gravities(self):
        for g in (9.81, 9.8):
            self.assertIn(f"unit m/s2, 1/256 g of {g} m/s2", self.gives(printed((g / 256,) * 3, 6), LSB, every(10000)))

    def test_a_unit_in_the_header(self):
        text = printed((1 / 256,) * 3, 5).replace("t_ms,x,y,z", "t_ms,x (g),y (g),z (g)")
        self.assertIn("(stated by the file", self.gives(text, LSB, every(10000)))
        text = printed((1000 / 256,) * 3, 0).replace("t_ms,x,y,z", "t_ms,x_mg,y_mg,z_mg")
        self.assertIn("unit mg, 1/256 g (stated by the file", self.gives(text, LSB, every(10000)))


class Asked(Case):
    def test_units_by_name(self):
        for unit, (factor, precisions) in PRINTED.items():
            self.assertIn("(--unit", self.gives(printed((0.0039 * factor,) * 3, precisions[-1]), LSB, every(10000), "--unit", unit))
        self.gives(table([map(str, row) for row in LSB]), LSB, every(10000), "--unit", "raw")
        self.gives(printed(PER_LSB_G["1/265, 1/265, 1/256 g"], 5), LSB, every(10000), "--unit", "k/265")

    def test_what_one_lsb_counts(self):
        self.gives(printed((0.5,) * 3, 1), LSB, every(10000), "--unit", "0.5")
        self.gives(printed((0.5, 0.25, 2.0), 2), LSB, every(10000), "--unit", "0.5,0.25,2")
        self.assertIn("from whole numbers, rounded", self.imported(printed((0.5,) * 3, 1), "--unit", "0.7")[2])

    def test_ten_bits_of_sixteen_g(self):
        """Without full resolution a count at +-16 g is 8 LSB of 1/256 g."""
        counts = [(x // 8, y // 8, z // 8) for x, y, z in LSB]
        said = self.gives(table([map(str, row) for row in counts]), [tuple(8 * v for v in row) for row in counts], every(10000), "--unit", "0.125")
        self.assertIn("every value is a multiple of 8 LSB", said)

    def test_a_wrong_unit_is_refused(self):
        status, said = self.run_tilt(self.file(printed((1 / 256,) * 3, 5)), "-o", self.out, "--unit", "m/s2")
        self.assertEqual(status, 2)
        self.assertIn("no whole numbers of LSB in any known unit", said)
        self.assertFalse(self.out.exists())


class Refused(Case):
    def no_whole_numbers(self, text, *words):
        status, said = self.run_tilt(self.file(text), "-o", self.out, *words)
        self.assertEqual(status, 2, said)
        self.assertIn("no whole numbers of LSB in any known unit", said)
        return said

    def test_another_sensors_values(self):
        """An MPU-6050 at +-2 g has 16,384 steps to the g: printed to 0.01 m/s2 they are any multiple of that, 0.25 of an LSB."""
        chance = random.Random(7)
        rows = [[f"{chance.gauss(mean, 0.4):.2f}" for mean in (0.0, 0.0, G)] for _ in range(300)]
        self.assertIn("nearest: m/s2", self.no_whole_numbers(table(rows)))

    def test_averaged_readings(self):
        """Means of three counts lie a third off."""
        means = [[f"{(a + b + c) / 3:.4f}" for a, b, c in zip(*LSB[i:i + 3])] for i in range(ROWS - 2)]
        self.no_whole_numbers(table(means))

    def test_one_value_in_fifty_off_is_refused_and_one_in_two_hundred_is_not(self):
        """At least 99 % of the values must be whole."""
        for share, refused in ((50, True), (200, False)):
            rows = [[f"{value / 256 + (0.0015 if (3 * i + axis) % share == 0 else 0):.6f}" for axis, value in enumerate(LSB[i % ROWS])]
                    for i in range(400)]
            if refused:
                self.no_whole_numbers(table(rows))
            else:
                self.imported(table(rows))

    def test_another_sensor_of_the_file_is_named(self):
        rows = "".join(",".join([str(10 * i), *(f"{value / 256 + 0.0017:.5f}" for value in LSB[i]), *(f"{value / 256:.5f}" for value in LSB[i])])
                       + "\n" for i in range(ROWS))
        text = "t_ms,x1,y1,z1,x2,y2,z2\n" + rows
        self.assertIn("or choose another sensor of the file: --sensor N", self.no_whole_numbers(text))
        self.gives(text, LSB, every(10000), "--sensor", 2)


if __name__ == "__main__":
    from unity_line import main
    main()
