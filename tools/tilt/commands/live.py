"""Shows a board in the browser: raw and filtered roll and pitch, an artificial horizon, the flags, and a choice of filters.

The page is served to this machine only, at the printed address. If the board is unplugged, the page waits for it. Ctrl-C ends.
PORT is a serial port (/dev/ttyACM0, COM3) or the pseudo terminal that build/sim/simrun --pty prints. The page also works without
this command: open live.html from the folder web/ in Chrome or Edge, which read the port by WebSerial.

Status: 0 ended by Ctrl-C or SIGTERM, 1 the recording ended early, 2 the port, the file or the address cannot be used.
"""
import contextlib
import pathlib
import signal
import sys
import threading
import webbrowser

from tilt import protocol
from tilt.numbers import whole_option

NAME = "live"
SUMMARY = "show a board in the browser"


def arguments(parser):
    parser.add_argument("port", metavar="PORT", help="/dev/ttyACM0, /dev/serial/by-id/..., COM3, or simrun's pseudo terminal")
    parser.add_argument("--baud", type=whole_option, default=protocol.BAUD_AT_START, metavar="N", help="baud rate when the port is opened (default "
                        f"{protocol.BAUD_AT_START}); follows `baud N` typed in the page")
    parser.add_argument("--no-reset", action="store_true", help="join a running board without resetting it")
    parser.add_argument("--port-http", type=whole_option, default=0, metavar="N", help="TCP port of the page (default: any free one)")
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    parser.add_argument("--record", metavar="FILE", help="also record to a new file, as `tilt record` does")


def say(text):
    print(f"tilt live: {text}", file=sys.stderr, flush=True)


@contextlib.contextmanager
def signals():
    """An event set by Ctrl-C and SIGTERM."""
    ending = threading.Event()
    before = {number: signal.signal(number, lambda *_: ending.set()) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield ending
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run(args):
    from tilt.board import Board
    from tilt.commands.record import Output
    from tilt.feed import Feed
    from tilt.port import Port
    from tilt.recorder import Recorder
    from tilt.serving import Server

    with contextlib.ExitStack() as stack:
        ending = stack.enter_context(signals())
        output = Output(pathlib.Path(args.record), False) if args.record else None
        recorder = Recorder(output.write) if output else None
        board = Board(Port(args.port, args.baud, reset=not args.no_reset), Feed(), recorder)
        server = Server(board.feed, board, args.port_http)
        stack.callback(board.end)
        stack.callback(server.close)
        board.start()
        show(server.address, args.no_browser)
        while not ending.wait(0.5):
            pass
    if output:
        output.close()
        print_summary(recorder.counts, output.path)
    return 1 if board.failed else 0


def show(address, only_print):
    print(address, flush=True)
    if not only_print and not webbrowser.open(address):
        say("no browser found: open the address above")


def print_summary(counts, path):
    from tilt.commands.record import summary
    print(summary(counts, path) if counts.rows else f"{path}: no row received", file=sys.stderr)
