#!/usr/bin/env python3
"""What make flash, make navflash and make monitor run: tilt.flashing with make's words, and a plain serial monitor.

    flash.py port TARGET [PORT]              checks that there is a port to use, PORT or the only one of a board; prints nothing else then
    flash.py write TARGET BOARD HEX [PORT]   writes the image, verifies it and waits for its banner; a failure is one line
    flash.py monitor BAUD [PORT]             prints what the board sends, sends the lines typed; Ctrl-C ends

TARGET: make's target, flash or navflash, for the commands that are proposed. Without PORT (or with an empty one) the only port of a board is used
and named; with none or several it prints what to type. Status 1: failed; 2: rejected. For the tests: FLASH_DEV is a folder that replaces /dev,
FLASH_LOG another file for avrdude's output.
"""
import os
import pathlib
import re
import select
import shlex
import subprocess
import sys

VENV = pathlib.Path("build/venv/bin/python")
LOG = pathlib.Path(os.environ.get("FLASH_LOG", "build/flash.log"))
try:
    import serial  # noqa: F401
except ImportError:
    if not VENV.exists() or pathlib.Path(sys.prefix).resolve() == VENV.parents[1].resolve():
        sys.exit(f"{pathlib.Path(__file__).name}: pyserial is not installed: sh tools/deps.sh flash")
    os.execv(VENV, [str(VENV), *sys.argv])
from tilt import flashing  # noqa: E402
from tilt.errors import TiltError  # noqa: E402


def typed(target, **words):
    """The make command that was typed, with these variables added or replaced."""
    given = dict(word.split("=", 1) for word in shlex.split(os.environ.get("MAKEFLAGS", "").partition("-- ")[2]) if "=" in word)
    words = {name.upper(): value for name, value in words.items()}
    kept = {name: given[name] for name in ("BOARD", "FILTERS", "STATES", "BAUD") if name in given and name not in words}
    kept = {name: shlex.quote(value) for name, value in kept.items()}
    words = {name: {**kept, **words}[name] for name in ("BOARD", "FILTERS", "STATES", "BAUD", "PORT") if name in {**kept, **words}}
    return " ".join(["make", target, *(f"{name}={value}" for name, value in words.items())])


def port_to_take(given, target, say=True):
    """PORT, or the only port found."""
    if given:
        return given
    there = flashing.ports()
    if len(there) == 1:
        if say:
            print(f"{target}: using {next(iter(there))}, the only port of a board", flush=True)
        return next(iter(there))
    if there:
        lines = flashing.listed(there, lambda **words: typed(target, **words))
        raise flashing.Failed(f"{len(there)} serial ports found; type the line of your board's:{lines}")
    raise flashing.Failed(flashing.none_found(lambda **_: typed(target, port="/dev/...")))


def write(target, name, image, given):
    flashing.flash(name, image, lambda: port_to_take(given, target), lambda **words: typed(target, **words), LOG,
                   lambda sentence: print(f"{target}: {sentence}", flush=True))


def opened(port, baud):
    """The port, set to this baud rate."""
    try:
        line = os.open(port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError as problem:
        known = next((words.format(port=port) for pattern, words in flashing.FAILURES[:3] if re.search(pattern, problem.strerror)), "")
        raise flashing.Failed(known or f"cannot open {port}: {problem.strerror}") from problem
    done = subprocess.run(["stty", baud, "raw", "-echo", "-hupcl", "clocal"], stdin=line, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise flashing.Failed(f"{port} cannot be set to {baud} baud ({done.stderr.strip().removeprefix('stty: ')}): give a BAUD= that the board has")
    os.set_blocking(line, True)
    return line


def monitor(baud, given):
    port = port_to_take(given, "monitor")
    line = opened(port, baud)
    print(f"monitor: {port} at {baud} baud; type help and Enter, Ctrl-C ends", flush=True)
    while True:
        ready, _, _ = select.select([line, sys.stdin], [], [])
        if line in ready:
            try:
                data = os.read(line, 4096)
            except OSError:
                data = b""
            if not data:
                raise flashing.Failed(f"{port} is gone: plug the board in again, then make monitor")
            sys.stdout.buffer.write(data)
            sys.stdout.buffer.flush()
        if sys.stdin in ready:
            words = os.read(sys.stdin.fileno(), 4096)
            if not words:
                return
            os.write(line, words)


def main(command="", *words):
    if command == "port" and 1 <= len(words) <= 2:
        port_to_take("".join(words[1:]), words[0], say=False)
    elif command == "write" and 3 <= len(words) <= 4:
        write(*words[:3], "".join(words[3:]))
    elif command == "monitor" and 1 <= len(words) <= 2:
        monitor(words[0], "".join(words[1:]))
    else:
        print(__doc__, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except TiltError as refused:
        print(f"{'monitor' if sys.argv[1] == 'monitor' else sys.argv[2]}: {refused}", file=sys.stderr)
        sys.exit(1 if isinstance(refused, flashing.Failed) else 2)
    except KeyboardInterrupt:
        sys.exit(0 if sys.argv[1] == "monitor" else 130)
