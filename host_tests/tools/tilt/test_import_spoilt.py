#!/usr/bin/env python3
"""Recordings of every form, spoilt at random: `tilt import` gives a stream that reads as one, or one line with the reason; nothing else."""
import json
import pathlib
import random
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from import_support import LSB, Case
from tilt import stream  # found by import_support

SEED, TRIES = 20261122, 500
LETTERS = b"0123456789,.;:-\n\r \t{}[]\"'eEnaxyz#=>_\xff\x00"
WORDS = ([], ["--rate", "100"], ["--columns", "1,2,3", "--rate", "50"], ["--columns", "time,x,y,z"], ["--sensor", "2"], ["--unit", "g"],
         ["--unit", "0.5", "--rate", "3"])


def lines(form):
    return "".join(form.format(i=i, t=i / 100, x=x, y=y, z=z, a=x / 256, b=y / 256, c=z / 256) for i, (x, y, z) in enumerate(LSB)).encode()


def payload():
    return json.dumps({"payload": {"interval_ms": 10, "sensors": [{"name": f"acc{axis}", "units": "g"} for axis in "XYZ"],
                                   "values": [[value / 256 for value in row] for row in LSB]}}).encode()


FORMS = (b"time,x,y,z\n" + lines("{t:.2f},{a:.5f},{b:.5f},{c:.5f}\n"), lines("20:05:{i:02d}.252 -> , {a:.4f}, {b:.4f}, {c:.4f}, g\n"),
         lines("b'{a:.4f} {b:.4f} {c:.4f}\\r\\n'\n"), lines("time = {t:.2f}, x = {a:.4f}, y = {b:.4f}, z = {c:.4f}\n"),
         b"t_us,x,y,z,flags\n" + lines("{i}0000,{x},{y},{z},0\n"), lines("{x};{y};{z}\n"), lines(" {x},{y}, {z},1,2,3,4,5,6;\n"),
         lines("\tClient acc: acc,{a:.4f},{b:.4f},{c:.4f},16000000{i:02d}\n"), lines('{{"X": {a}, "Y": {b}, "Z": {c}}}\n'), payload())


def spoilt(chance):
    data = bytearray(chance.choice(FORMS))
    for _ in range(chance.randint(0, 6)):
        place = chance.randrange(len(data)) if data else 0
        kind = chance.randint(0, 3)
        if kind == 0 and data:
            data[place] = chance.choice(LETTERS)
        elif kind == 1:
            del data[place:place + chance.randint(1, 20)]
        elif kind == 2:
            data[place:place] = bytes(chance.choice(LETTERS) for _ in range(chance.randint(1, 8)))
        elif chance.random() < 0.2:
            del data[place:]
    return bytes(data)


class Spoilt(Case):
    def test_a_stream_or_a_reason(self):
        print(f"seed {SEED}")
        chance = random.Random(SEED)
        imported = 0
        for number in range(TRIES):
            content = spoilt(chance)
            words = chance.choice(WORDS)
            self.out.unlink(missing_ok=True)
            with self.subTest(number=number, words=words):
                path = self.file(content)
                status, said = self.run_tilt(path, "-o", self.out, *words)
                if status == 0:
                    imported += 1
                    self.assertGreater(len(stream.read(self.out)), 0)
                else:
                    self.assertEqual((status, said.count("\n"), self.out.exists()), (2, 1, False), said)
                    self.assertRegex(said, "^tilt import: .+")
        self.assertGreater(imported, TRIES // 10)
        self.assertLess(imported, TRIES * 9 // 10)


if __name__ == "__main__":
    from unity_line import main
    main()
