"""Converts recordings of other programs (docs/import.md) to a stream: t_us and x, y, z in LSB.

Finds the unit by the whole numbers that an ADXL345 gives, and prints it; rejects a file that is not a recording, with the reason.
"""
import argparse
import math
import pathlib
import re
import sys

from tilt.errors import TiltError
from tilt.numbers import real

NAME = "import"
SUMMARY = "convert a recording of another program to a stream"
SUFFIX = ".stream.csv"


def rate(text):
    try:
        value = real(text)
    except ValueError:
        value = math.nan
    if not 0.01 <= value <= 10000.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a rate from 0.01 to 10000 Hz")
    return value


def sensor(text):
    if not (text.isascii() and text.isdigit()) or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a sensor number: they start at 1")
    return int(text)


def arguments(parser):
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("-o", "--out", metavar="OUT", help="stream to write (default: FILE with .stream.csv in place of its suffix)")
    parser.add_argument("--join", action="store_true", help="join the files into one recording, in the order of the numbers in their names")
    parser.add_argument("--unit", metavar="UNIT", help="raw, g, mg, m/s2, mm/s2, k/265, or the value of one LSB: N, or N,N,N for x, y, z")
    parser.add_argument("--rate", type=rate, metavar="HZ", help="sample rate, if the file has no times or wrong ones")
    parser.add_argument("--columns", metavar="T,X,Y,Z", help="columns by name or number (from 1): x,y,z or time,x,y,z")
    parser.add_argument("--sensor", type=sensor, default=1, metavar="N", help="which sensor of a file with several (default 1)")


def by_numbers(path):
    """Sort key that puts 2 before 10."""
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in re.split(r"(\d+)", path) if part]


def jobs_of(args):
    """[(files, out)]. TiltError if an output would replace an input or another output."""
    files = [str(file) for file in args.files]
    if args.out is not None and len(files) > 1 and not args.join:
        raise TiltError("-o: give one FILE, or --join")
    if args.join:
        files.sort(key=by_numbers)
        jobs = [(files, args.out or out_of(files[0]))]
    else:
        jobs = [([file], args.out or out_of(file)) for file in files]
    inputs = {pathlib.Path(file).resolve() for file in files}
    outs = set()
    for named, out in jobs:
        place = pathlib.Path(out).resolve()
        if place in inputs:
            raise TiltError(f"{named[0]}: the stream would replace {out}, an input: give another name with -o")
        if place in outs:
            raise TiltError(f"{named[0]}: two files would be written to {out}: import them one by one with -o")
        outs.add(place)
    return jobs


def out_of(file):
    path = pathlib.Path(file)
    return str(path.with_name(path.stem + SUFFIX))


def run(args):
    from tilt.importing.convert import converted
    failed = 0
    jobs = jobs_of(args)
    for files, out in jobs:
        try:
            for line in converted(files, args, out):
                print(line, file=sys.stderr)
        except TiltError as why:
            if len(jobs) == 1:
                raise
            print(f"tilt import: {why}", file=sys.stderr)
            failed += 1
    if failed:
        raise TiltError(f"{failed} of {len(jobs)} files not imported: see the reasons above")
