"""Simulates a flight and writes its sensors' readings for `tilt nav`.

The flight of paper 003 (section 3.4): a circle of 300 s at 6 m/s, banked by up to 17 degrees; IMU 100 Hz, magnetometer 10 Hz, GPS and altimeter 1 Hz,
each with the paper's noise. docs/navigation.md lists the columns.

Status: 0 written, 2 an option or the file cannot be used.
"""
import re

from tilt.errors import TiltError
from tilt.numbers import real_option, whole_option

NAME = "flight"
SUMMARY = "simulate a flight for `tilt nav`"


def arguments(parser):
    parser.add_argument("output", metavar="OUT.csv", help="file to write")
    parser.add_argument("--seconds", type=real_option, default=500.0, metavar="N", help="length, 2 to 4000 (default 500)")
    parser.add_argument("--seed", type=whole_option, default=7, metavar="N", help="seed of the noise (default 7)")
    parser.add_argument("--without-gps", default="160:400", metavar="A:B[,A:B...]", help="intervals without GPS (default 160:400; - for none)")
    parser.add_argument("--no-drift", action="store_true", help="gyros without drift (default: 7.5, -8.5, 5 e-4 rad/s)")
    parser.add_argument("--gps-late", type=real_option, default=0.0, metavar="MS", help="delay of each GPS epoch, 0 to 1000 (default 0)")


def intervals_of(text):
    if text == "-":
        return ()
    number = r"[0-9]+(\.[0-9]*)?"
    if not re.fullmatch(rf"{number}:{number}(,{number}:{number})*", text):
        raise TiltError(f"--without-gps {text}: give A:B[,A:B...] in seconds, or -")
    found = tuple(tuple(float(edge) for edge in piece.split(":")) for piece in text.split(","))
    for begin, end in found:
        if end <= begin:
            raise TiltError(f"--without-gps {begin:g}:{end:g}: ends before it begins")
    return found


def wish_of(args):
    from tilt.navigation.flight import Wish

    if not 2.0 <= args.seconds <= 4000.0:
        raise TiltError(f"--seconds {args.seconds:g}: give 2 to 4000")
    if not 0.0 <= args.gps_late <= 1000.0:
        raise TiltError(f"--gps-late {args.gps_late:g}: give 0 to 1000 ms")
    if args.seed < 0:
        raise TiltError(f"--seed {args.seed}: give 0 or more")
    return Wish(args.seconds, args.seed, not args.no_drift, intervals_of(args.without_gps), int(args.gps_late * 1000))


def run(args):
    from tilt.navigation import flight

    wish = wish_of(args)
    made = flight.simulated(wish)
    flight.write(args.output, made, f"tilt flight: {wish.seconds:g} s, seed {wish.seed}, drift {wish.drift}, without GPS {args.without_gps}")
    print(f"{args.output}: {made.seconds:.1f} s, {len(made.rows)} rows")
