"""Leads the owner of a real board through twenty checks that no simulator can do: pull a wire, short SDA, reset, cut the power, change baud rates.

The program says what to do, watches the serial line, and writes each verdict to a record at once, so that nothing is lost if it ends early;
--resume continues. At any time you can skip a check (s REASON), repeat it (r), or quit (q). docs/board.md lists what you need and what to take
care of.

Status: 0 no check failed, 1 a check failed or is not done, 2 the port or a file cannot be used.
"""
import datetime
import pathlib
import signal

from tilt import protocol
from tilt.errors import TiltError
from tilt.numbers import whole_option

NAME = "board"
SUMMARY = "check a real board by hand and record the results"


def arguments(parser):
    parser.add_argument("port", metavar="PORT", nargs="?", help="/dev/ttyACM0, /dev/serial/by-id/..., COM3, or simrun's pseudo terminal")
    parser.add_argument("-o", "--output", metavar="FILE", help="record to write (default: tilt-board-DATE-TIME.jsonl here)")
    parser.add_argument("--resume", metavar="FILE", help="continue this record: checks that passed are not repeated")
    parser.add_argument("--only", metavar="CHECK,...", help="only these checks, such as 'sda_short,scl_short'")
    parser.add_argument("--baud", type=whole_option, default=protocol.BAUD_AT_START, metavar="N",
                        help=f"baud rate when the port is opened (default {protocol.BAUD_AT_START})")
    parser.add_argument("--show", metavar="FILE", help="print a record as a table; needs no PORT")
    parser.add_argument("--list", action="store_true", help="print the twenty checks; needs no PORT")


def run(args):
    from tilt.realboard.checks import CHECKS, chosen, page_lines
    from tilt.realboard.record import Record, shown
    if args.list:
        print("\n".join(page_lines()))
        return 0
    if args.show:
        print("\n".join(shown(Record(args.show, resumed=True), list(enumerate(CHECKS, 1)))))
        return 0
    try:
        checks = chosen(args.only)
    except ValueError as why:
        raise TiltError(f"--only: no check '{why}': tilt board --list prints them") from why
    return on_board(checked(args), checks)


def checked(args):
    if args.port is None:
        from serial.tools import list_ports
        names = ", ".join(port.device for port in list_ports.comports())
        raise TiltError(f"no port given: tilt board PORT (ports: {names})" if names else "no port given and no serial port found: plug the board in")
    protocol.check_baud(args.baud)
    if args.resume and args.output:
        raise TiltError("-o and --resume both name the record: leave one of them out")
    return args


def default_path():
    return pathlib.Path(f"tilt-board-{datetime.datetime.now():%Y%m%d-%H%M%S}.jsonl")


def on_board(args, checks):
    from tilt.board import Board
    from tilt.feed import Feed
    from tilt.port import Port
    from tilt.realboard.bench import Bench, Quit, Wire
    from tilt.realboard.owner import Owner
    from tilt.realboard.record import Record

    owner = Owner()
    record = Record(args.resume or args.output or default_path(), resumed=bool(args.resume))
    board = Board(Port(args.port, args.baud), Feed())
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)  # restores settings, as after Ctrl-C
    try:
        board.start()
        return checks_of(Bench(Wire(board), owner), record, checks, args.port)
    except Quit:
        return 1
    finally:
        signal.signal(signal.SIGTERM, before)
        board.end()
        record.close()
        print_record(record)


def checks_of(bench, record, checks, name):
    """The exit status, 0 or 1."""
    from tilt.board import identity
    from tilt.realboard.record import begin_line
    from tilt.realboard.session import Session, meet

    firmware, bench.settings = meet(bench, name)
    if record.read and record.read[0]["firmware"] != firmware:
        raise TiltError(f"{record.path}: of firmware '{record.read[0]['firmware']}', but the board has '{firmware}': start a new record")
    usb = identity(name)
    record.add(begin_line(name, list(usb[:2]) if usb else None, firmware, bench.settings))
    bench.say(f"{firmware}\nRecord: {record.path}. Never connect 5 V or 3.3 V to GND.")
    return 0 if Session(bench, record, checks).run() else 1


def print_record(record):
    from tilt.realboard.checks import CHECKS
    from tilt.realboard.record import SENT_IN, tally
    if record.file is not None:
        print(f"\n{record.path.resolve()}: {tally(record.last(), list(enumerate(CHECKS, 1)))}\nShow it: tilt board --show {record.path}. "
              f"Continue: --resume {record.path}. Send it in: {SENT_IN}.")
