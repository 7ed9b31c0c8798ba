"""Leads a person with a new board from wiring to a picture of the first recording: wiring, self-test, calibration, noise, rate, a recording of 30 s,
tune, plot. Each step says what to do and prints what the board answers.

At any time s skips the step, r repeats it, q quits. Nothing lasts over power-off unless the last step saves it. docs/start.md has it all.

Status: 0 every step is done or skipped, 1 you quit, 2 the port or the file cannot be used, 130 Ctrl-C.
"""
import datetime
import pathlib
from types import SimpleNamespace

from tilt import protocol
from tilt.commands import record
from tilt.numbers import whole_option

NAME = "start"
SUMMARY = "lead through the first hour with a board, step by step"


def arguments(parser):
    parser.add_argument("port", metavar="PORT", help="/dev/ttyACM0, /dev/serial/by-id/..., COM3, or simrun's pseudo terminal")
    parser.add_argument("-o", "--output", metavar="FILE", help="recording to write (default: tilt-start-DATE-TIME.csv here)")
    parser.add_argument("--force", action="store_true", help="overwrite FILE")
    parser.add_argument("--baud", type=whole_option, default=protocol.BAUD_AT_START, metavar="N",
                        help=f"baud rate when the port is opened (default {protocol.BAUD_AT_START})")


def run(args):
    from tilt.board import Board
    from tilt.feed import Feed
    from tilt.port import Port
    from tilt.realboard import owner
    from tilt.realboard.bench import Quit, Wire
    from tilt.realboard.session import meet
    from tilt.starting import Guided, guide

    protocol.check_baud(args.baud)
    path = pathlib.Path(args.output or f"tilt-start-{datetime.datetime.now():%Y%m%d-%H%M%S}.csv")
    record.Output(path, args.force)
    board, person = Board(Port(args.port, args.baud), Feed()), owner.Owner()
    board.start()
    try:
        bench = Guided(Wire(board), person)
        firmware, bench.settings = meet(bench, args.port)
        bench.say(f"{firmware[2:]}\nAt any time: s skips a step, r repeats it, q quits.")
        results = guide(bench, SimpleNamespace(path=path, force=args.force, recorded=False, rate_hz=None))
    except (KeyboardInterrupt, Quit) as why:
        person.say("\nquit: what was set stays until the power goes off; to start over: tilt start")
        if isinstance(why, KeyboardInterrupt):
            raise
        return 1
    finally:
        board.end()
    bench.say("\n" + "\n".join(f"{name}: {result}" for name, result in results.items()))
    bench.say(f"Next: tilt live {args.port}" + (f", tilt compare {path}" if results["recording"] == "done" else ""))
    return 0
