"""Writes an image to a board with avrdude, through its boot loader, and waits for the firmware's banner. `tilt flash` and make flash use it."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

from tilt import protocol
from tilt.errors import TiltError
from tilt.place import IN_WHEEL, ROOT
from tilt.port import Gone, Port, Unreadable

sys.path.insert(0, str(ROOT / "mk/scripts"))
import boards  # noqa: E402

PATTERNS = ("cu.usb*", "cu.wchusb*") if sys.platform == "darwin" else ("ttyACM*", "ttyUSB*", "serial/by-id/*")
PACKED = pathlib.Path(__file__).with_name("images")  # in a wheel
DATA, END, EXTENDED_SEGMENT, EXTENDED_LINEAR = 0, 1, 2, 4  # records of Intel HEX
MOST_BYTES = 1 << 20  # of a file that is read at all: 32 KB fit an ATmega328P
OURS = b"stop\0go\0save\0load\0defaults\0"  # commands, in every image of the tilt firmware
SILENT_S, GARBLED_S = 10.0, 1.0  # an old boot loader takes 2 s
# avrdude's messages and their meaning, searched in this order, because it also prints "not in sync" for an attempt that succeeds when repeated.
FAILURES = (
    (r"No such file or directory|cannot find the file", "no port {port}: plug the board in, or leave PORT out to find it"),
    (r"[Pp]ermission denied", "no permission for {port}: sudo usermod -aG dialout $USER, then log out and in again"),
    (r"busy|temporarily unavailable|[Aa]ccess is denied", "{port} is in use: close the serial monitor or plotter"),
    (r"verification (error|mismatch)|content mismatch",
     "verification failed: try another cable or USB port, without other supplies"),
    (r"[Ii]nvalid device signature|signature does not match|differs in signature",
     "the chip at {port} is not an ATmega328P: this firmware needs one"),
    (r"not in sync|not responding|out of sync|protocol expects|initialization failed",
     "no boot loader answers at {port} with {baud} baud (not in sync): wrong PORT or BOARD; {instead}"),
)
FITTING = "leave --image out to write a set of filters that fits" if IN_WHEEL else "make flash BOARD={name} writes a set of filters that fits"
ABSENT = "download it, or leave --image out" if IN_WHEEL else "build it with make firmware BOARD={name}, or download an image"
INSTALL = ("avrdude is not installed: install it (Debian: apt install avrdude; macOS: brew install avrdude; Windows: the Arduino IDE has one; "
           "put it on PATH)")


class Failed(TiltError):
    """It was tried and did not work: status 1, where what cannot be used is 2."""


def ports():
    """{path: its name in serial/by-id, or description}, each port once."""
    if os.name == "nt":
        from serial.tools import list_ports
        return {port.device: port.description for port in sorted(list_ports.comports())}
    dev, found, names = folder_of_ports(), {}, {}
    for path in (path for pattern in PATTERNS for path in sorted(dev.glob(pattern)) if path.exists()):
        if path.parent.name == "by-id":
            names[path.resolve()] = path.name
        found.setdefault(path.resolve(), path)
    return {str(path): names.get(real, "") for real, path in found.items()}


def folder_of_ports():
    return pathlib.Path(os.environ.get("FLASH_DEV", "/dev"))  # the tests have another


def listed(there, typed):
    """A line for each port, with what to type."""
    return "".join(f"\n  {typed(port=port)}" + (f"   ({name})" if name else "") for port, name in there.items())


def none_found(typed):
    places = "COM*" if os.name == "nt" else ", ".join(str(folder_of_ports() / pattern) for pattern in PATTERNS)
    return f"no board found ({places}): plug it in, with a cable that carries data, or type\n  {typed(port='PORT')}"


def content(image):
    """The flash that an Intel HEX file fills, from 0 to its end."""
    base, flash, kind = 0, bytearray(), None
    try:
        lines = image.read_text(encoding="ascii", errors="replace").split()
    except OSError as error:
        raise TiltError(f"{image}: {error.strerror}") from error
    for number, line in enumerate(lines, 1):
        address, kind, body = record(line)
        if kind is None:
            raise TiltError(f"{image}:{number}: not an Intel HEX record: build it or download it again")
        if kind == DATA:
            at = base + address
            if at + len(body) > MOST_BYTES:
                raise TiltError(f"{image}:{number}: address 0x{at:X} is beyond the flash of an ATmega328P")
            flash.extend(b"\xff" * (at + len(body) - len(flash)))
            flash[at:at + len(body)] = body
        elif kind in (EXTENDED_SEGMENT, EXTENDED_LINEAR):
            base = int.from_bytes(body, "big") << (4 if kind == EXTENDED_SEGMENT else 16)
    if kind != END:
        raise TiltError(f"{image} has no last record, it is cut off: build it or download it again")
    return bytes(flash)


def record(line):
    """(address, kind, data) of a line of Intel HEX; its kind is None if it is not one."""
    try:
        data = bytes.fromhex(line.removeprefix(":"))
    except ValueError:
        data = b""
    if line[:1] != ":" or len(data) < 5 or len(data) != data[0] + 5 or sum(data) & 0xFF:
        return 0, None, b""
    return int.from_bytes(data[1:3], "big"), data[3], data[4:-1]


def navigation(flash):
    """Whether it is the navigation image, which has no text of its own to know it by."""
    known = PACKED.glob("nav*.hex") if IN_WHEEL else ROOT.glob("build/*/nav*/firmware.hex")
    return any(content(image) == flash for image in known)


def default_image(board):
    """The fullest set of filters that fits the board."""
    if not IN_WHEEL:
        return ROOT / f"build/{board.folder}/firmware.hex"
    *fuller, last = (PACKED / f"{name}-{board.clock_hz // 1_000_000}mhz.hex" for name in ("everyday", "small"))
    return next((image for image in fuller if image.is_file() and len(content(image)) <= board.flash), last)


def chosen(name, image):
    """(board, image, its size, whether it is the tilt firmware), all of which are as they should be."""
    if name not in boards.TABLE:
        raise TiltError(f"no board '{name}': choose from {' '.join(boards.TABLE)}")
    board = boards.TABLE[name]
    image = pathlib.Path(image) if image is not None else default_image(board)
    if not image.is_file():
        raise TiltError(f"no {image}: {ABSENT.format(name=name)}")
    flash = content(image)
    if len(flash) > board.flash:
        raise TiltError(f"{image} is {len(flash) - board.flash:,} bytes too large for {board.what} ({len(flash):,} where {board.flash:,} fit): "
                        f"{FITTING.format(name=name)}")
    if OURS not in flash and not navigation(flash):
        raise TiltError(f"{image} is not an image of this firmware: to write it, use avrdude itself")
    return board, image, len(flash), OURS in flash


def instead(board, port, typed):
    """What may help if no boot loader answers."""
    if board.name.startswith("promini"):
        return "press reset as writing begins"
    return f"try {typed(port=port, board='nano' if board.name == 'nano-old' else 'nano-old')}"


def written(board, image, port, typed, log):
    """avrdude writes and verifies; its output goes to the log."""
    command = ["avrdude", "-p", "atmega328p", "-c", "arduino", "-P", port, "-b", str(board.baud), "-D", "-U", f"flash:w:{image}:i"]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                              check=False)
    except FileNotFoundError as problem:
        raise Failed(INSTALL) from problem
    except OSError as problem:
        raise Failed(f"avrdude does not start: {problem.strerror}") from problem
    where = kept(log, command, done.stdout)
    if done.returncode != 0:
        said = next((words.format(port=port, baud=board.baud, instead=instead(board, port, typed))
                     for pattern, words in FAILURES if re.search(pattern, done.stdout)), f"avrdude ended with status {done.returncode}")
        raise Failed(f"{said}; avrdude's {where}")


def kept(log, command, output):
    """Where avrdude's output can be read. A log that cannot be written, such as another user's in /tmp, does not stop anything."""
    try:
        log.parent.mkdir(parents=True, exist_ok=True)
        log.write_text(f"{shlex.join(command)}\n{output}", encoding="utf-8")
    except OSError:
        return f"last line: {(output.strip().splitlines() or ['none'])[-1]}"
    return f"output: {log}"


def heard(name, baud):
    """The banner's first line; None: the board sends what cannot be read at this rate, "": it is silent."""
    port, data, unreadable, until = Port(name, baud), b"", Unreadable(), time.monotonic() + SILENT_S
    try:
        port.open()
        while time.monotonic() < until:
            fresh = port.read()
            data += fresh
            found = re.search(rb"# (tilt-uno [ -~]*)\r?\n", data)
            if found:
                return found[1].decode("ascii")
            if unreadable.lasts_s(len(fresh), re.search(rb"[\r\n][ -~]{8,}\r?\n", fresh)) > GARBLED_S:
                return None
        return None if data else ""
    except Gone as why:
        raise Failed(f"written and verified, then {name} was gone ({why}): plug the board in again") from why
    except TiltError as why:
        raise Failed(f"written and verified, but its banner cannot be read: {why}") from why
    finally:
        port.close()


def banner(board, name):
    """What the firmware says when it starts; it may have kept another baud rate in the EEPROM."""
    first = protocol.BAUD_AT_START if board.clock_hz == 16_000_000 else protocol.BAUD_AT_START // 2
    for baud in [first, *sorted(set(protocol.BAUDS) - {first}, reverse=True)]:
        found = heard(name, baud)
        if found:
            return found
        if found == "":
            raise Failed(f"written and verified, but the board is silent for {SILENT_S:.0f} s at {baud} baud: press its reset button, and look with "
                         "a serial monitor")
    raise Failed("written and verified, but the board's output is not readable at any rate: is the image for a clock of "
                 f"{board.clock_hz // 1_000_000} MHz?")


def flash(board_name, image, take_port, typed, log, say):
    """All of it. take_port() chooses one; typed(port=, board=): the command as it should be typed; say(sentence) prints."""
    board, image, size, talks = chosen(board_name, image)
    port = take_port()
    say(f"writing {image}, {size:,} bytes, to {board.what} at {port} ...")
    written(board, image, port, typed, log)
    if talks:
        say(f"{size:,} bytes written and verified; the board answers: {banner(board, port)}")
    else:
        say(f"{size:,} bytes written and verified: the navigation image, for tilt nav")
