"""Shows a board in the browser: raw against filtered roll and pitch, an artificial horizon, the flags, the filter to choose.

The page is served to this machine alone, at the address that is printed. An unplugged board is waited for. Ctrl-C ends it.
PORT is a serial port (/dev/ttyACM0, COM3) or the pseudo terminal that build/sim/simrun --pty names. Without this
command the page works too: open tools/tilt/page/live.html itself in Chrome or Edge, which read the port by WebSerial.
"""
import signal
import sys
import threading
import webbrowser

NAME = "live"
SUMMARY = "show a board in the browser"


def arguments(parser):
    parser.add_argument("port", metavar="PORT", help="serial port of the board")
    parser.add_argument("--baud", type=int, default=115200, metavar="N", help="rate of the line when it is opened (115200); `baud N`, typed in "
                        "the page, is followed")
    parser.add_argument("--port-http", type=int, default=0, metavar="N", help="TCP port of the page (a free one)")
    parser.add_argument("--no-browser", action="store_true", help="only print the address")
    parser.add_argument("--record", metavar="FILE", help="write what comes to a new file, as it comes")


def say(text):
    print(f"tilt live: {text}", file=sys.stderr, flush=True)


def run(args):
    from tilt.board import Board, Recorder
    from tilt.feed import Feed
    from tilt.serving import Server

    ending = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ending.set())
    recorder = Recorder(args.record) if args.record else None
    feed = Feed()
    board = Board(args.port, args.baud, feed, recorder.take if recorder else None)
    server = Server(feed, board, args.port_http)
    board.start()
    try:
        print(server.address, flush=True)
        if not args.no_browser and not webbrowser.open(server.address):
            say("no browser found: open the address above")
        while not ending.wait(0.5):
            pass
    finally:
        server.close()
        board.end()
    return finish(recorder)


def finish(recorder):
    """Exit status: 1 where the recording had to end before."""
    if recorder is None:
        return 0
    recorder.close()
    aside = f", {recorder.kept_aside} lines that are no rows kept as comments" if recorder.kept_aside else ""
    say(recorder.failed or f"{recorder.path}: {recorder.rows} rows{aside}")
    return 1 if recorder.failed else 0
