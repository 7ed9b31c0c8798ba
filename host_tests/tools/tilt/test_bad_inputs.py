#!/usr/bin/env python3
"""A corpus of bad inputs to every command, to design, the simulator and make: each ends with its status and one line that names a remedy, never
with a traceback, and leaves no file.
Run from the repository root with build/venv/bin/python."""
import gzip
import os
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from laws import DEFAULT, PLAIN, ROBUST  # noqa: E402
from tilt_case import InFolder, printed, run_tilt  # noqa: E402
import plot_run  # noqa: E402
from design import command as design_command  # noqa: E402

ROWS = "".join(f"{10000 * i},{i % 3},{-i % 5},{256 + i % 2}\n" for i in range(40))
STREAM, HEADER = "t_us,x,y,z\n" + ROWS, "t_us,x,y,z\n"
IN_G = "t_us,x,y,z\n" + "".join(f"{10000 * i},0.0{i % 3},-0.01,0.98\n" for i in range(40))
READERS = ("replay FILE", "compare FILE", "tune FILE", "plot FILE")
SEE, IMPORT, MEND = "see tilt ", "tilt import FILE", "correct or delete"

# (what the file holds, what every reader of streams says)
STREAMS = (
    ("", "is empty"), ("# x\n", "no header"), (HEADER, "no rows"), (IN_G, IMPORT), (STREAM.encode("utf-16"), IMPORT),
    ("time,x,y,z\n0,1,2,3\n", IMPORT),
    ("12,3,250\n", IMPORT), ("X: 1 Y: 2 Z: 3\n", IMPORT), (HEADER + "0,1,2\n", "the header has 4"), (HEADER + "20,0,0,0\n10,0,0,0\n", "backwards"),
    (HEADER + "0,5000,0,0\n", "outside -4096..4095"))
# (what the file holds, options, remedy)
IMPORTS = (
    ("", "", "record again"), ("Dear reader\n", "", "needs x, y and z"), ("x: 1\ny: 2\nz: 3\n" * 9, "", "print them on one line"),
    (gzip.compress(b"1,2,3\n"), "", "unpack"), (b"\x89PNG\r\n\x1a\n....", "", "export"), (bytes(range(256)), "", "export"),
    (STREAM.encode("utf-16")[:-1], "", "save it as UTF-8"), (HEADER, "", "record again"), ("1,2\n" * 9, "", "needs x, y and z"),
    ("1,2,250\n" * 9, "", "give the rate with --rate"), ("count,x,y,z\n1,1,2,250\n2,1,2,250\n", "", "give the rate with --rate"),
    ("time,x,y,z\n" + "5,1,2,250\n" * 9, "", "give the rate with --rate"), ("t_ms,x,y,z\n0,1,2,250\n10,1,2x,250\n", "", MEND),
    ("t_ms,x,y,z\n0,1,2,250\n10,1,2,250\n15,1,2\n20,1,2,250\n", "", MEND), ("t_ms,x,y,z\n20,1,2,250\n10,1,2,250\n", "", "split the file"),
    ("t_ms,x,y,z\n0,1,2,250\n10,1,2,9999\n", "", MEND), ("t_ms,temp,hum,p\n0,1,2,250\n10,1,2,9\n", "", "--columns"),
    ("freq,psd_x,psd_y,psd_z\n1,2,3,4\n", "", "import the raw data"), ("a,b,c\n1,2,250\n", "--columns 1,2", "give three"),
    ("a,b,c\n1,2,250\n", "--columns a,b,q", "choose from"), ("a,b,c\n1,2,250\n", "--columns 1,2,9", "count from 1"),
    ("t_ms,x,y,z\n" + "".join(f"{10 * i},{0.123 + i / 7},{i / 3},250.4\n" for i in range(40)), "", "--unit N"),
    ("x,y,z\n1,2,250\n", "--unit furlong", "give one of"), ("x,y,z\n1,2,250\n", "--rate fast", SEE), ("x,y,z\n1,2,250\n", "--sensor 0", SEE),
    ("x,y,z\n1,2,250\n", "--rate 10 --sensor 2", "count from 1"), ('{"a": 1, "b": 2}\n', "", "--columns"), ('{"x": 1, "y": 2}\n', "", "--columns"),
    ('{"x": 1, "y": 2, "z": "3"}\n', "", "write a number"), ('{"x": 1,\n', "", MEND), (b"MD\xfc\x03" + bytes(100), "", "export"),
    ("t_ms,x,y,z,w\n0,1,2,250\n", "", "name every column"), ("t_ms,x,y,z\n0,,,\n", "", "record again"))
# (command line, remedy); FILE is a good stream, OUT a file that is not there
LINES = (
    ("", SEE), ("foo", "choose from"), ("replay", SEE), ("replay missing.csv", "No such file"), ("replay FILE --rate 90", "choose from"),
    ("replay FILE --rate x", SEE), ("replay FILE --range 3", "choose from"), ("replay FILE --filter foo", "choose from"),
    (f"replay FILE --filter {PLAIN},{PLAIN}", "give it once"),
    ("replay FILE -o FILE", "another name"), ("replay FILE -o no/where.csv", "No such file"),
    ("compare FILE --filter foo", "choose from"), ("compare FILE --rate 1_0", SEE), ("compare DIR", "Is a directory"),
    ("tune FILE --filter foo", "choose from"), (f"tune FILE --filter {PLAIN},{ROBUST}", "give one filter"), ("tune FILE --nope", SEE),
    ("plot FILE -o OUT.gif", ".png .svg .html"), ("plot FILE --columns q", "choose from"), ("plot FILE --columns ,", "name at least one"),
    ("plot FILE --from x", SEE), ("plot FILE -o no/where.png", "No such file"), ("plot", SEE), ("import FILE -o FILE", "another name"),
    ("import missing.csv", "give a recording's path"), ("import DIR", "give a recording's path"), ("import FILE FILE -o OUT.csv", "give one FILE"),
    ("record FILE", "give one, such as"), ("record missing", "port"), ("record FILE --baud 12345", "choose from"),
    ("record FILE --seconds 0", "give a time"),
    ("record FILE --seconds 1_0", SEE), ("record FILE -o FILE", "--force"), ("record FILE -o no/where.csv", "no folder"),
    ("live FILE", "give one, such as"), ("nav missing", "No such file"), ("nav --states 7", "choose from 9, 12"),
    ("start", SEE), ("start FILE -o FILE", "--force"), ("start FILE --baud 1", "choose from"),
    ("flight", SEE), ("flight OUT --seed x", SEE), ("board", "tilt board PORT"), ("board FILE --only foo", "--list prints them"),
    ("board --show missing", "No such file"), ("board --show FILE", "begins with"))
RATES = "choose from 12.5 25 50 100 200 400 800"
NAMES = f"choose from {DEFAULT} {PLAIN} {ROBUST}"
SIMRUN = "simrun --fw build/uno/firmware.elf --in FILE --out /dev/null"
DESIGN = "design --rate 100 --sigma 2"
# (command line, status, what it says, the remedy included): programs besides tilt
PROGRAMS = (
    ("make sim RATE=abc", 2, f"sim: RATE=abc: {RATES}"), ("make sim RATE=90", 2, RATES), ("make sim RATE=100Hz", 2, RATES),
    ("make sim RATE=", 2, RATES), ("make sim RATE=0", 2, RATES), ("make sim RATE=1e9", 2, RATES),
    ("make sim STREAM=missing", 2, "give STREAM=file.csv"), ("make sim STREAM=", 2, "give STREAM=file.csv"),
    ("make sim STREAM=DIR", 2, "give STREAM=file.csv"), ("make sim OUT=DIR", 2, "is a folder: give a file in it"),
    ("make sim OUT=no/run.csv", 2, "mkdir -p "), ("make sim FILTER=foo", 2, f"filters: {DEFAULT}"),
    ("make sim STREM=x.csv", 2, "did you mean STREAM?"),
    ("make sim RTAE=50", 2, "did you mean RATE?"), ("make sim FILTRE=x", 2, "did you mean FILTER"), ("make help XYZZY=1", 2, "`make help` lists"),
    ("make firmware FILTERS=foo", 2, NAMES), ("make firmware FILTERS=", 2, NAMES), ("make flash FILTERS=foo", 2, NAMES),
    ("make firmware FILTERS=a,b", 2, NAMES), ("make firmware BOARD=mega", 2, "choose from uno nano"), ("make flash BOARD=", 2, "choose from uno"),
    ("make size BOARD=x", 2, "choose from uno"), ("make t T=xyzzy", 2, "make t T=list"), ("make t", 2, "make t T=filters"),
    ("simrun", 2, "simrun --help"), (f"{SIMRUN} --loop", 2, "give --max-ms"), (f"{SIMRUN} --max-ms abc", 2, "wants a number"),
    (f"{SIMRUN} --fault foo", 2, "WHEN is 12.3ms"), (f"{SIMRUN} --fault 12ms:foo", 2, "simrun --help"), (f"{SIMRUN} --cmd foo", 2, "wants MS:TEXT"),
    (f"{SIMRUN} --sensor bmp", 2, "is none of adxl345"), (SIMRUN.replace("FILE", "STRANGE"), 2, "tilt import FILE"),
    ("plot_run --png OUT", 2, "see plot_run --help"), ("plot_run --run FILE", 2, "see plot_run --help"),
    ("plot_run --run missing --png OUT", 2, "No such file"), ("plot_run --run FILE --png OUT", 2, "column x_mg is missing"),
    ("design", 1, "nearest: --rate 100"), (DESIGN, 1, "nearest: --noise-gain"), ("design --rate x", 2, "see design --help"),
    ("design --nope", 2, "see design --help"), ("design --rate 0 --sigma 2", 1, "nearest: 0.001"), (f"{DESIGN} --region foo", 2, "choose from"),
    (f"{DESIGN} --noise-gain 0.4", 1, "nearest: --noise-gain"), (f"{DESIGN} --noise-gain 0.6 --a=x", 2, "see design --help"),
    (f"{DESIGN} --error 2", 1, "nearest: --at 100"), (f"{DESIGN} --sigma-of FILE", 1, "either --sigma"),
    (f"{DESIGN} --band b0", 2, "such as b0=0.5..1"),
    ("design schedule", 2, "such as --p0-over-r 8.33"), ("design schedule --foo", 2, "see design schedule --help"),
    ("design schedule --steps 0 --p0-over-r 1", 2, "must be 1..1000"))


def ran(words):
    """(status, stdout, stderr) of a command line; of make without the lines in which make itself reports that its rule failed."""
    inside = {"design": design_command.main, "plot_run": plot_run.main}
    if words[:1] and words[0] in inside:
        return printed(inside[words[0]], words[1:])
    if words[:1] not in (["make"], ["simrun"]):
        return run_tilt(*words)
    typed = {word.partition("=")[0] for word in os.environ.get("MAKEFLAGS", "").split() if "=" in word}  # to the make that runs the tests
    plain = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS")) and name not in typed}
    command = ["make", *words[1:]] if words[0] == "make" else ["build/sim/simrun", *words[1:]]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=plain)
    return done.returncode, done.stdout, re.sub(r"^make: \*\*\* \[.*\n", "", done.stderr, flags=re.M)


class Case(InFolder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "given.csv"

    def refused(self, line, content, remedy, status=2):
        self.file.write_bytes(content if isinstance(content, bytes) else content.encode())
        names = {"FILE": str(self.file), "DIR": str(self.folder), "no": str(self.folder / "no"), "OUT": str(self.folder / "out"),
                 "missing": str(self.folder / "missing")}
        words = []
        for word in line.split():
            variable, _, value = word.rpartition("=")
            first = next((name for name in names if value == name or value.startswith((f"{name}.", f"{name}/"))), None)
            words.append(word if first is None else (f"{variable}=" if variable else "") + names[first] + value.removeprefix(first))
        result, out, err = ran(words)
        with self.subTest(line, content=content[:40]):
            self.assertEqual((result, out), (status, ""), err)
            self.assertRegex(err, r"\A[^\n]*: [^\n]+\n\Z")
            self.assertIn(remedy, err)
            self.assertEqual([path.name for path in self.folder.iterdir()], [self.file.name])


class Corpus(Case):
    def test_there_are_66_and_more(self):
        self.assertGreaterEqual(len(IMPORTS) + len(LINES) + len(PROGRAMS), 66)

    def test_files_that_are_no_streams(self):
        for content, remedy in STREAMS:
            for line in READERS:
                self.refused(line, content, remedy)

    def test_files_that_cannot_be_imported(self):
        for content, options, remedy in IMPORTS:
            self.refused(f"import FILE -o OUT.csv {options}", content, remedy)

    def test_other_programs(self):
        for line, status, remedy in PROGRAMS:
            self.refused(line.replace("STRANGE", "FILE"), IN_G if "STRANGE" in line else STREAM, remedy, status)

    def test_command_lines(self):
        for line, remedy in LINES:
            self.refused(line, STREAM, remedy)


if __name__ == "__main__":
    from unity_line import main
    main()
