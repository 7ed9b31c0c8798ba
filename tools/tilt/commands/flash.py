"""Writes the firmware to a board, with avrdude and the board's boot loader, and waits for its banner. Needs no compiler.

Without PORT it lists the serial ports of boards. --board: uno, nano (new boot loader), nano-old, promini (16 MHz), promini-8mhz. --image: a .hex of a
release; by default the fullest set of filters that fits the board (in a checkout: what make firmware built). avrdude's own output goes to a file.

Status: 0 written, verified and answered; 1 failed, with the reason; 2 the image, board or an option cannot be used.
"""
import os
import pathlib
import shlex
import sys
import tempfile

NAME = "flash"
SUMMARY = "write the firmware to a board"


def arguments(parser):
    parser.add_argument("port", metavar="PORT", nargs="?", help="serial port (/dev/ttyACM0, COM3); without it the ports are listed")
    parser.add_argument("--board", default="uno", metavar="NAME", help="uno, nano, nano-old, promini or promini-8mhz (default uno)")
    parser.add_argument("--image", metavar="FILE.hex", help="image to write (default: the fullest that fits)")


def run(args):
    from tilt import flashing

    def typed(port=None, board=None):
        words = {"--board": board or (args.board if args.board != "uno" else None), "--image": args.image}
        options = [word for name, value in words.items() if value for word in (name, value)]
        return shlex.join(["tilt", "flash", *([port or args.port] if port or args.port else []), *options])

    if not args.port:
        return listed(flashing, typed)
    log = pathlib.Path(os.environ.get("FLASH_LOG", pathlib.Path(tempfile.gettempdir(), "tilt-flash.log")))
    try:
        flashing.flash(args.board, args.image, lambda: args.port, typed, log, lambda sentence: print(sentence, flush=True))
    except flashing.Failed as why:
        print(f"tilt flash: {why}", file=sys.stderr)
        return 1
    return 0


def listed(flashing, typed):
    there = flashing.ports()
    if not there:
        raise flashing.TiltError(flashing.none_found(typed))
    print(f"serial ports; type the line of your board's:{flashing.listed(there, typed)}")
    return 0
