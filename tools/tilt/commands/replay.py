"""Runs a recording through the firmware's own filters on the PC.

The rows are those that the board would send, to the last digit (docs/tools.md lists the limits). With one filter the output has the firmware's
columns; with several, each has its own, such as roll_cdeg_kf, and `flags` holds the flags common to all. Truth columns are passed on. Rows have
the times of the recording; a row for a missing sample has flag 2.
"""
import os
import sys
import time

from tilt.errors import TiltError
from tilt.numbers import real_option, whole_option

NAME = "replay"
SUMMARY = "run a recording through the shipped filters, many at once"


def stream_arguments(parser):
    """Arguments common to replay, compare and tune."""
    parser.add_argument("stream", metavar="STREAM", help="recording (docs/protocol.md, Streams)")
    parser.add_argument("--filter", metavar="A,B,C", help="filters (default: all)")
    parser.add_argument("--rate", metavar="HZ", type=real_option,
                        help="output data rate of the sensor (default: the firmware's rate nearest to the recording's)")


def arguments(parser):
    stream_arguments(parser)
    parser.add_argument("--range", metavar="G", type=whole_option, choices=(2, 4, 8, 16), default=16,
                        help="range of the sensor: 2 4 8 16 (default 16)")
    parser.add_argument("-o", "--output", metavar="OUT.csv", help="file of rows to write, - for standard output")


def write(path, stream, tables, report):
    from tilt import replaying, stream as streams

    rows = next(iter(tables.values()))
    streams.write("/dev/stdout" if path == "-" else path, rows["t_us"] + stream.start_us, rows["lsb"], columns=replaying.columns_of(tables),
                  **replaying.truth_of(stream, rows), progress=report)


def replayed(stream, names, rate_dhz, range_g=16):
    """replaying.runs with a progress bar."""
    from tilt import replaying
    from tilt.progress import bar

    with bar("filters", "filter") as report:
        return replaying.runs(stream, names, rate_dhz, range_g, report)


def share(flags, bit):
    return 100.0 * float(((flags & bit) != 0).mean())


def summary(stream, tables, rate_dhz):
    from tilt import native

    how = "one row per tick" if native.row_per_tick(stream, rate_dhz) else "at each tick the latest row"
    lines = [f"{stream.path}: {len(stream)} rows at {stream.rate_hz:.1f} Hz, {stream.seconds:.1f} s; sensor at {rate_dhz / 10:g} Hz: {how}",
             f"{'filter':<11}{'rows':>8}{'gated %':>9}{'re-acquired':>13}{'predicted %':>13}{'clipped %':>11}{'not 1 g %':>11}"]
    for name, rows in tables.items():
        flags = rows["flags"]
        lines.append(f"{name:<11}{len(rows):>8}{share(flags, 1):>9.2f}{int(((flags & 4) != 0).sum()):>13}{share(flags, 2):>13.2f}"
                     f"{share(flags, 8):>11.2f}{share(flags, 512):>11.2f}")
    return lines


def checked_output(args):
    """TiltError if the rows would replace the recording itself."""
    if args.output and args.output != "-" and os.path.exists(args.output) and os.path.samefile(args.stream, args.output):
        raise TiltError(f"{args.output}: the rows would replace the recording: give another name with -o")


def run(args):
    from tilt import Stream, native
    from tilt.progress import bar

    names = native.chosen(args.filter)
    began = time.perf_counter()
    with bar("reading", "B") as report:
        stream = Stream.read(args.stream, progress=report)
    rate_dhz = native.rate_of(stream, args.rate)
    checked_output(args)
    tables = replayed(stream, names, rate_dhz, args.range)
    took = time.perf_counter() - began
    if args.output:
        with bar("writing", "row") as report:
            write(args.output, stream, tables, report)
    out = sys.stderr if args.output == "-" else sys.stdout
    print("\n".join(summary(stream, tables, rate_dhz)), file=out)
    what = f"{len(names)} filters" if len(names) > 1 else "1 filter"
    print(f"{what} in {took:.2f} s, reading included: {stream.seconds / took:,.0f} times real time", file=out)
    if args.output and args.output != "-":
        print(f"{args.output}: {len(next(iter(tables.values())))} rows written", file=out)
