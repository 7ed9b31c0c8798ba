#!/usr/bin/env python3
"""A board on a serial port: write an image to it, or show what it sends. make flash, make navflash and make monitor run it.

    flash.py port TARGET [PORT]              checks that there is a port to use, PORT or the only one of a board; prints nothing else then
    flash.py write TARGET BOARD HEX [PORT]   avrdude writes and verifies; its output goes to build/flash.log, a failure is one line
    flash.py monitor BAUD [PORT]             prints what the board sends, sends the lines typed; Ctrl-C ends

TARGET: make's target, flash or navflash, for the commands that are proposed. BOARD: from mk/boards.txt. Without PORT (or with an empty one) the
only port of /dev/ttyACM*, /dev/ttyUSB* and /dev/serial/by-id is used and named; with none or several it prints what to type. Status 1: failed;
2: rejected. For the tests: FLASH_DEV is a folder that replaces /dev, FLASH_LOG another log file.
"""
import os
import pathlib
import re
import select
import shlex
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "mk/scripts"))
import boards

LOG = pathlib.Path(os.environ.get("FLASH_LOG", "build/flash.log"))
PATTERNS = ("ttyACM*", "ttyUSB*", "serial/by-id/*")
DATA, EXTENDED_SEGMENT, EXTENDED_LINEAR = 0, 2, 4  # records of Intel HEX
# avrdude's messages and their meaning, searched in this order, because it also prints "not in sync" for an attempt that succeeds when repeated.
FAILURES = (
    (r"No such file or directory", "no port {port}: plug the board in, or leave PORT out to find it"),
    (r"[Pp]ermission denied", "no permission for {port}: sudo usermod -aG dialout $USER, then log out and in again"),
    (r"busy|temporarily unavailable", "{port} is in use: close the serial monitor or plotter"),
    (r"verification (error|mismatch)|content mismatch",
     "verification failed: try another cable or USB port, without other supplies"),
    (r"[Ii]nvalid device signature|signature does not match|differs in signature",
     "the chip at {port} is not an ATmega328P: this firmware needs one"),
    (r"not in sync|not responding|out of sync|protocol expects|initialization failed",
     "no boot loader answers at {port} with {baud} baud (not in sync): wrong PORT or BOARD; {instead}"),
)


class Refused(Exception):
    """What failed, with cause and remedy; and the exit status."""

    def __init__(self, words, status=1):
        super().__init__(words)
        self.status = status


def ports(dev):
    """{path: its name in serial/by-id, or nothing}, each port once."""
    found, names = {}, {}
    for path in (path for pattern in PATTERNS for path in sorted(dev.glob(pattern)) if path.exists()):
        if path.parent.name == "by-id":
            names[path.resolve()] = path.name
        found.setdefault(path.resolve(), path)
    return {str(path): names.get(real, "") for real, path in found.items()}


def typed(target, **words):
    """The make command that was typed, with these variables added or replaced."""
    given = dict(word.split("=", 1) for word in shlex.split(os.environ.get("MAKEFLAGS", "").partition("-- ")[2]) if "=" in word)
    kept = {name: given[name] for name in ("BOARD", "FILTERS", "STATES", "BAUD") if name in given and name not in words}
    kept = {name: shlex.quote(value) for name, value in kept.items()}
    return " ".join(["make", target, *(f"{name}={value}" for name, value in {**kept, **words}.items())])


def port_to_take(given, target, say=True):
    """PORT, or the only port found."""
    if given:
        return given
    dev = pathlib.Path(os.environ.get("FLASH_DEV", "/dev"))
    there = ports(dev)
    if len(there) == 1:
        if say:
            print(f"{target}: using {next(iter(there))}, the only port of a board", flush=True)
        return next(iter(there))
    if there:
        lines = (f"\n  {typed(target, PORT=port)}" + (f"   ({name})" if name else "") for port, name in there.items())
        raise Refused(f"{len(there)} serial ports found; type the line of your board's:{''.join(lines)}")
    looked_at = ", ".join(str(dev / pattern) for pattern in PATTERNS)
    raise Refused(f"no board found ({looked_at}): plug it in, with a cable that carries data, or type\n  {typed(target, PORT='/dev/...')}")


def flash_bytes(image):
    """The end of the flash used by an Intel HEX file."""
    base = end = 0
    for number, line in enumerate(image.read_text(encoding="ascii", errors="replace").split(), 1):
        try:
            data = bytes.fromhex(line.removeprefix(":"))
            count, kind = data[0], data[3]
        except (ValueError, IndexError) as problem:
            raise Refused(f"{image}:{number}: not an Intel HEX record: build it again: make clean firmware", 2) from problem
        if kind == DATA:
            end = max(end, base + int.from_bytes(data[1:3], "big") + count)
        elif kind in (EXTENDED_SEGMENT, EXTENDED_LINEAR):
            base = int.from_bytes(data[4:6], "big") << (4 if kind == EXTENDED_SEGMENT else 16)
    return end


def instead(target, board, port):
    """What may help if no boot loader answers."""
    if board.name.startswith("promini"):
        return "press reset as writing begins"
    return f"try {typed(target, BOARD='nano' if board.name == 'nano-old' else 'nano-old', PORT=port)}"


def meaning(said, target, board, port):
    """One line for avrdude's failure; nothing if it is unknown."""
    for pattern, words in FAILURES:
        if re.search(pattern, said):
            return words.format(port=port, baud=board.baud, instead=instead(target, board, port))
    return ""


def write(target, name, image, given):
    if name not in boards.TABLE:
        raise Refused(f"no board '{name}': choose from {' '.join(boards.TABLE)}", 2)
    board = boards.TABLE[name]
    image = pathlib.Path(image)
    if not image.is_file():
        raise Refused(f"no {image}: build it with make firmware", 2)
    size = flash_bytes(image)
    if size > board.flash:
        raise Refused(f"{image} is {size - board.flash:,} bytes too large for {board.what} ({size:,} where {board.flash:,} fit): "
                      f"make flash BOARD={name} writes a set of filters that fits", 2)
    port = port_to_take(given, target)
    command = ["avrdude", "-p", "atmega328p", "-c", "arduino", "-P", port, "-b", str(board.baud), "-D", "-U", f"flash:w:{image}:i"]
    print(f"{target}: writing {image}, {size:,} bytes, to {board.what} at {port} ...", flush=True)
    LOG.parent.mkdir(parents=True, exist_ok=True)
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    except FileNotFoundError as problem:
        raise Refused("avrdude is not installed: install it with sh tools/deps.sh flash") from problem
    LOG.write_text(f"{shlex.join(command)}\n{done.stdout}", encoding="utf-8")
    if done.returncode != 0:
        said = meaning(done.stdout, target, board, port) or f"avrdude ended with status {done.returncode}"
        raise Refused(f"{said}; avrdude's output: {LOG}")
    print(f"{target}: {size:,} bytes written and verified; make monitor shows what the board sends")


def opened(port, baud):
    """The port, set to this baud rate."""
    try:
        line = os.open(port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError as problem:
        known = next((words.format(port=port) for pattern, words in FAILURES[:3] if re.search(pattern, problem.strerror)), "")
        raise Refused(known or f"cannot open {port}: {problem.strerror}") from problem
    done = subprocess.run(["stty", baud, "raw", "-echo", "-hupcl", "clocal"], stdin=line, capture_output=True, text=True)
    if done.returncode != 0:
        raise Refused(f"{port} cannot be set to {baud} baud ({done.stderr.strip().removeprefix('stty: ')}): give a BAUD= that the board has")
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
                raise Refused(f"{port} is gone: plug the board in again, then make monitor")
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
    except Refused as refused:
        print(f"{'monitor' if sys.argv[1] == 'monitor' else sys.argv[2]}: {refused}", file=sys.stderr)
        sys.exit(refused.status)
    except KeyboardInterrupt:
        sys.exit(0 if sys.argv[1] == "monitor" else 130)
