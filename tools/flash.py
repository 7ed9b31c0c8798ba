#!/usr/bin/env python3
"""A board on a serial port: write an image to it, or show what it sends. make flash, make navflash and make monitor run it.

    flash.py port TARGET [PORT]              there is one port to take, PORT or the only one of a board; says nothing then
    flash.py write TARGET BOARD HEX [PORT]   avrdude writes and verifies; what it says goes into build/flash.log, a failure into one line
    flash.py monitor BAUD [PORT]             prints what the board sends, sends the lines that are typed; Ctrl-C ends

TARGET: of make, flash or navflash, for the commands that are proposed. BOARD: mk/boards.txt. Without PORT (or with an empty one) the only port of
/dev/ttyACM*, /dev/ttyUSB* and /dev/serial/by-id is taken and named; where there are none or several it says what to type. Status 1: it could not be
done; 2: it is not to be done as asked. For the tests: FLASH_DEV is a folder instead of /dev, FLASH_LOG another file.
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
# What avrdude says, and what it means; looked for in this order, because it also says "not in sync" of an attempt that the next one makes good.
FAILURES = (
    (r"No such file or directory", "there is no port {port}: plug the board in, or leave PORT out and the port is looked for"),
    (r"[Pp]ermission denied", "no permission for {port}: sudo usermod -aG dialout $USER, then log out and in again"),
    (r"busy|temporarily unavailable", "another program uses {port}: close the serial monitor or plotter"),
    (r"verification (error|mismatch)|content mismatch",
     "verification failed, the board does not hold what was written: try another cable or USB port, without other supplies"),
    (r"[Ii]nvalid device signature|signature does not match|differs in signature",
     "the chip at {port} is no ATmega328P: this firmware runs on no other"),
    (r"not in sync|not responding|out of sync|protocol expects|initialization failed",
     "no boot loader answers at {port} with {baud} baud (not in sync): wrong PORT or BOARD; {instead}"),
)


class Refused(Exception):
    """What could not be done, with cause and remedy; and the exit status."""

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
    """The command of make that was typed, with these variables in place of its own."""
    given = dict(word.split("=", 1) for word in shlex.split(os.environ.get("MAKEFLAGS", "").partition("-- ")[2]) if "=" in word)
    kept = {name: given[name] for name in ("BOARD", "FILTERS", "STATES", "BAUD") if name in given and name not in words}
    kept = {name: shlex.quote(value) for name, value in kept.items()}
    return " ".join(["make", target, *(f"{name}={value}" for name, value in {**kept, **words}.items())])


def port_to_take(given, target, say=True):
    """PORT, or the only one there is."""
    if given:
        return given
    dev = pathlib.Path(os.environ.get("FLASH_DEV", "/dev"))
    there = ports(dev)
    if len(there) == 1:
        if say:
            print(f"{target}: {next(iter(there))} is the only port of a board and is taken", flush=True)
        return next(iter(there))
    if there:
        lines = (f"\n  {typed(target, PORT=port)}" + (f"   ({name})" if name else "") for port, name in there.items())
        raise Refused(f"{len(there)} serial ports are there; type the line of the board's:{''.join(lines)}")
    looked_at = ", ".join(str(dev / pattern) for pattern in PATTERNS)
    raise Refused(f"no board is plugged in ({looked_at}): plug it in, with a cable that carries data, or type\n  {typed(target, PORT='/dev/...')}")


def flash_bytes(image):
    """The end of what an Intel HEX file fills of the flash."""
    base = end = 0
    for number, line in enumerate(image.read_text(encoding="ascii", errors="replace").split(), 1):
        try:
            data = bytes.fromhex(line.removeprefix(":"))
            count, kind = data[0], data[3]
        except (ValueError, IndexError) as problem:
            raise Refused(f"{image}:{number}: not a record of Intel HEX; build it again: make clean firmware", 2) from problem
        if kind == DATA:
            end = max(end, base + int.from_bytes(data[1:3], "big") + count)
        elif kind in (EXTENDED_SEGMENT, EXTENDED_LINEAR):
            base = int.from_bytes(data[4:6], "big") << (4 if kind == EXTENDED_SEGMENT else 16)
    return end


def instead(target, board, port):
    """What may help where no boot loader answers."""
    if board.name.startswith("promini"):
        return "press its reset as writing begins"
    return f"try {typed(target, BOARD='nano' if board.name == 'nano-old' else 'nano-old', PORT=port)}"


def meaning(said, target, board, port):
    """avrdude's failure in one line of ours; nothing where it is of no known kind."""
    for pattern, words in FAILURES:
        if re.search(pattern, said):
            return words.format(port=port, baud=board.baud, instead=instead(target, board, port))
    return ""


def write(target, name, image, given):
    if name not in boards.TABLE:
        raise Refused(f"there is no board '{name}'; boards: {' '.join(boards.TABLE)}", 2)
    board = boards.TABLE[name]
    image = pathlib.Path(image)
    if not image.is_file():
        raise Refused(f"there is no {image}: make firmware builds one", 2)
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
        raise Refused("avrdude is not installed: sh tools/deps.sh flash") from problem
    LOG.write_text(f"{shlex.join(command)}\n{done.stdout}", encoding="utf-8")
    if done.returncode != 0:
        said = meaning(done.stdout, target, board, port) or f"avrdude gave status {done.returncode}"
        raise Refused(f"{said}; avrdude's own words: {LOG}")
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
        raise Refused(f"{port} cannot be set to {baud} baud ({done.stderr.strip().removeprefix('stty: ')}): BAUD= one that the board has")
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
