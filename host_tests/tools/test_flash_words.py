"""What make flash, tilt flash and make monitor print: with a pretended avrdude, made-up ports, and a pseudo terminal for the board."""
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import termios
import threading
import tty
from unittest import mock

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import OUT, images, needs, refused, run, run_all, test

needs("flash", "serial")
from tilt import flashing  # noqa: E402

LOG = OUT / "flash.log"  # its own: test_flash may run at the same time
PATIENCE_S = 300  # only reached when something is broken, however busy the machine
FLASH = ("tools/flash.py", "write", "flash")
TILT = (sys.executable, "-m", "tilt", "flash")
OURS = b"stop\0go\0save\0load\0defaults\0"
BANNER = b"# tilt-uno 9.9.9: roll and pitch\n"
AT = "/dev/ttyUSB7"
# what avrdude 7.1 and 6.3 say, BOARD, what it means
FAILURES = (
    (f"avrdude OS error: cannot open port {AT}: No such file or directory\navrdude error: unable to open programmer arduino on port {AT}", "uno",
     f"flash: no port {AT}: plug the board in"),
    (f'avrdude: ser_open(): can\'t open device "{AT}": Permission denied', "uno",
     f"flash: no permission for {AT}: sudo usermod -aG dialout $USER, then log"),
    (f"avrdude OS error: cannot open port {AT}: Device or resource busy", "uno", f"flash: {AT} is in use: close the serial monitor"),
    ("avrdude warning: attempt 1 of 10: not in sync: resp=0x00\n" * 10, "uno",
     f"flash: no boot loader answers at {AT} with 115200 baud (not in sync): wrong PORT or BOARD; try make flash BOARD=nano-old PORT={AT}; "),
    ("avrdude: stk500_recv(): programmer is not responding", "nano-old",
     f"57600 baud (not in sync): wrong PORT or BOARD; try make flash BOARD=nano PORT={AT}; "),
    ("avrdude error: protocol expects OK byte 0x10 but got 0x14", "promini",
     "57600 baud (not in sync): wrong PORT or BOARD; press reset as writing begins; "),
    ("avrdude warning: attempt 1 of 10: not in sync: resp=0x00\navrdude: verification error, first mismatch at byte 0x1234\n"
     "         0x12 != 0x13\navrdude: verification error; content mismatch", "uno",
     "flash: verification failed: try"),
    ("avrdude warning: verification mismatch", "uno", "flash: verification failed"),
    ("avrdude error: Yikes!  Invalid device signature.", "uno", f"flash: the chip at {AT} is not an ATmega328P"),
    ("avrdude: something that nobody has seen", "uno", "flash: avrdude ended with status 1; "),
)


def folder(name, *files):
    """An empty one, with links to these: {path in it: what it leads to}."""
    path = OUT.resolve() / name
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    for each, leads_to in files:
        (path / each).parent.mkdir(parents=True, exist_ok=True)
        (path / each).symlink_to(leads_to)
    return path


def program(*command, words="", status=1, dev=None):
    """A run with an avrdude that says these words, ends so and leaves its own command line in a file."""
    bin_ = folder("bin")
    (bin_ / "said").write_text(words + "\n", encoding="ascii")
    (bin_ / "avrdude").write_text(f'#!/bin/sh\necho "$@" > {bin_}/typed\ncat {bin_}/said >&2\nexit {status}\n', encoding="ascii")
    (bin_ / "avrdude").chmod(0o755)
    environment = {**os.environ, "PATH": f"{bin_}:{os.environ['PATH']}", "FLASH_DEV": str(dev or folder("no-dev")), "FLASH_LOG": str(LOG),
                   "MAKEFLAGS": "", "PYTHONPATH": "tools"}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=PATIENCE_S, env=environment)
    typed = bin_ / "typed"
    return done, typed.read_text(encoding="ascii") if typed.exists() else ""


@contextlib.contextmanager
def answering(text=BANNER):
    """The port of a board that prints this again and again, as if it were reset whenever the port is opened."""
    ours, its = os.openpty()
    tty.setraw(its)
    os.set_blocking(ours, False)
    done = threading.Event()

    def talk():
        while not done.wait(0.02):
            with contextlib.suppress(BlockingIOError):
                os.write(ours, text)

    talker = threading.Thread(target=talk)
    talker.start()
    try:
        yield os.ttyname(its)
    finally:
        done.set()
        talker.join()
        os.close(its)
        os.close(ours)


def image_of(size, content=OURS):
    """An Intel HEX file that fills so many bytes of the flash."""
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / "image.bin").write_bytes(content + bytes(size - len(content)))
    path = OUT / f"{size}.hex"
    run("avr-objcopy", "-I", "binary", "-O", "ihex", OUT / "image.bin", path)
    return path


@test
def failures_of_avrdude_are_one_line_that_says_what_to_do():
    image = image_of(4096)
    for words, board_, meaning in FAILURES:
        done, _ = program(*FLASH, board_, image, AT, words=words)
        assert done.returncode == 1 and meaning in done.stderr and done.stderr.count("\n") == 1, (words, done.stderr)
        assert done.stderr.endswith(f"; avrdude's output: {LOG}\n") and words in LOG.read_text(encoding="utf-8"), done.stderr


@test
def each_board_is_written_at_the_rate_of_its_boot_loader_with_what_fits():
    image = image_of(4096)
    with answering() as port:
        for name, baud in (("uno", 115200), ("nano", 115200), ("nano-old", 57600), ("promini", 57600), ("promini-8mhz", 57600)):
            done, typed = program(*FLASH, name, image, port, status=0)
            words = "4,096 bytes written and verified; the board answers: tilt-uno 9.9.9: roll and pitch\n"
            assert done.returncode == 0 and done.stdout.endswith(words), done
            assert typed == f"-p atmega328p -c arduino -P {port} -b {baud} -D -U flash:w:{image}:i\n", typed
            assert program(*TILT, port, "--board", name, "--image", image, status=0)[1] == typed
        done, typed = program("make", "flash", "BOARD=nano-old", f"PORT={port}", status=0)
        assert done.returncode == 0 and f" -P {port} -b 57600 -D -U flash:w:build/promini/firmware.hex:i" in typed, done
    small = " ".join(images.HOLDS["small"])
    notice = f"BOARD=nano-old has 30720 bytes of flash: the image holds the set small ({small}); choose others with FILTERS=\n"
    assert notice in done.stdout, done.stdout
    done, typed = program("make", "flash", "BOARD=mega", f"PORT={AT}")
    refused = "BOARD: no board 'mega': choose from uno nano nano-old promini promini-8mhz"
    assert done.returncode != 0 and refused in done.stderr and not typed, done


@test
def image_that_does_not_fit_the_board_is_refused_before_avrdude_runs():
    for board_, room in (("uno", 32256), ("nano", 32256), ("nano-old", 30720), ("promini", 30720), ("promini-8mhz", 30720)):
        done, typed = program(*FLASH, board_, image_of(room + 16), AT, status=0)
        assert done.returncode == 2 and not typed and f"{room + 16}.hex is 16 bytes too large for an Arduino " in done.stderr, done.stderr
        assert f"({room + 16:,} where {room:,} fit): make flash BOARD={board_} writes a set of filters that fits" in done.stderr, done.stderr
        assert program(*FLASH, board_, image_of(room), AT, status=1)[1], "not written"
    (OUT / "torn.hex").write_text(":0100000000FF\nhello\n", encoding="ascii")
    done, typed = program(*FLASH, "uno", OUT / "torn.hex", AT, status=0)
    assert done.returncode == 2 and "torn.hex:2: not an Intel HEX record" in done.stderr and not typed, done.stderr
    whole = image_of(4096).read_text(encoding="ascii")
    not_a_record = "torn.hex:1: not an Intel HEX record"
    for wrong, words in ((whole.replace(":10", ":20", 1), not_a_record), (whole.replace("73746F70", "73746F71", 1), not_a_record),  # "stop"
                         (whole[:20], not_a_record), (whole[:whole.rindex(":")], "has no last record, it is cut off"), ("", "has no last record"),
                         (f":02000004FFFFFC\n{whole}", "torn.hex:2: address 0xFFFF0000 is beyond the flash of an ATmega328P")):
        (OUT / "torn.hex").write_text(wrong, encoding="ascii")
        refused(flashing.TiltError, lambda: flashing.chosen("uno", OUT / "torn.hex"), words)


@test
def image_of_something_else_is_refused():
    done, typed = program(*TILT, AT, "--image", image_of(4096, b"Blink"), status=0)
    assert done.returncode == 2 and "4096.hex is not an image of this firmware" in done.stderr and done.stderr.count("\n") == 1 and not typed, done
    for words, why in (("--image", "/nowhere.hex"), "no /nowhere.hex: build it"), (("--board", "mega"), "no board 'mega': choose from uno nano "):
        done, typed = program(*TILT, AT, *words, status=0)
        assert done.returncode == 2 and why in done.stderr and done.stderr.count("\n") == 1 and not typed, done


@test
def the_navigation_image_is_known_by_what_was_built():
    image, folder_ = image_of(4096, b"no text of its own"), OUT / "build/promini/nav9"
    folder_.mkdir(parents=True, exist_ok=True)
    with mock.patch.object(flashing, "ROOT", OUT):
        for built, ours in ((image_of(2048), False), (image, True)):
            shutil.copyfile(built, folder_ / "firmware.hex")
            assert flashing.navigation(flashing.content(image)) == ours
        assert flashing.chosen("nano-old", image)[2:] == (4096, False)


@test
def a_board_that_does_not_answer_is_a_failure():
    uno, slow = (flashing.boards.TABLE[name] for name in ("uno", "promini-8mhz"))
    with mock.patch.multiple(flashing, SILENT_S=0.5, GARBLED_S=0.05):
        for text, board_, words in ((b"\xf3\x81" * 200, uno, "not readable at any rate: is the image for a clock of 16 MHz?"),
                                    (b"", uno, "is silent for 0 s at 115200 baud"), (b"", slow, "at 57600 baud")):
            with answering(text) as port:
                refused(flashing.Failed, lambda port=port, board_=board_: flashing.banner(board_, port), words, "written and verified, but")


@test
def what_goes_wrong_after_writing_says_that_it_is_written():
    done, typed = program(*FLASH, "uno", image_of(4096), AT, status=0)
    words = f"written and verified, but its banner cannot be read: {AT}: No such file or directory"
    assert done.returncode == 1 and typed and words in done.stderr and done.stderr.count("\n") == 1, done.stderr


@test
def a_log_that_cannot_be_written_stops_nothing():
    with mock.patch.dict(os.environ, PATH=f"{folder('bin')}:{os.environ['PATH']}"):
        avrdude = OUT.resolve() / "bin/avrdude"
        for script, words in (("echo one\necho two\nexit 1\n", "avrdude ended with status 1; avrdude's last line: two"),
                              ("exit 1\n", "avrdude's last line: none")):
            avrdude.write_text(f"#!/bin/sh\n{script}", encoding="ascii")
            avrdude.chmod(0o755)
            uno = flashing.boards.TABLE["uno"]
            refused(flashing.Failed, lambda: flashing.written(uno, "x.hex", AT, None, pathlib.Path("/dev/null/log")), words)
        avrdude.write_text("#!/bin/sh\n", encoding="ascii")
        flashing.written(uno, "x.hex", AT, None, pathlib.Path("/dev/null/log"))


@test
def tilt_flash_lists_the_ports():
    several = folder("dev", ("ttyACM0", "/dev/null"), ("ttyUSB0", "/dev/zero"), ("serial/by-id/usb-Arduino-if00", "../../ttyACM0"))
    done, typed = program(*TILT, "--board", "nano", dev=several)
    assert done.returncode == 0 and not typed, done
    assert f"  tilt flash {several}/ttyACM0 --board nano   (usb-Arduino-if00)\n  tilt flash {several}/ttyUSB0 --board nano\n" in done.stdout, done
    done, _ = program(*TILT)
    assert done.returncode == 2 and "tilt flash: no board found (" in done.stderr and done.stderr.endswith("\n  tilt flash PORT\n"), done


@test
def the_only_port_is_taken_and_named():
    image = image_of(4096)
    for files in ((("ttyACM0", "/dev/null"),), (("ttyUSB3", "/dev/null"), ("serial/by-id/usb-1a86_USB_Serial-if00-port0", "../../ttyUSB3")),
                  (("serial/by-id/usb-Arduino-if00", "/dev/null"),), (("ttyACM1", "/dev/null"), ("ttyUSB0", "/dev/gone"))):
        dev = folder("dev", *files)
        done, typed = program(*FLASH, "uno", image, dev=dev)
        path = f"{dev}/{files[0][0]}"
        assert f" -P {path} " in typed and f"flash: using {path}, the only port of a board\n" in done.stdout, done


@test
def where_no_port_or_several_are_there_it_says_what_to_type():
    several = folder("dev", ("ttyACM0", "/dev/null"), ("ttyUSB0", "/dev/zero"), ("serial/by-id/usb-Arduino-if00", "../../ttyACM0"))
    for target in ("flash", "monitor"):
        both = " ".join(images.HOLDS["small"])
        options = (f"FILTERS={both}", "BOARD=nano-old")
        done, typed = program("make", target, *options, dev=several)
        command = f"make {target} BOARD=nano-old FILTERS='{both}' PORT={several}"
        for line in (f"{target}: 2 serial ports found; type the line of your board's:", f"  {command}/ttyACM0   (usb-Arduino-if00)",
                     f"  {command}/ttyUSB0"):
            assert line in done.stderr.splitlines(), done.stderr
        assert done.returncode != 0 and not typed and "built" not in done.stdout, done
        done, typed = program("make", target)
        assert f"{target}: no board found (" in done.stderr and f"\n  make {target} PORT=/dev/...\n" in done.stderr, done.stderr
        assert done.returncode != 0 and not typed and "built" not in done.stdout, done


@contextlib.contextmanager
def monitored(*more):
    """make monitor's program on the other end of a pseudo terminal, which is the only port; gives the board's end."""
    ours, its = os.openpty()
    dev = folder("dev", ("ttyACM0", os.ttyname(its)))
    process = subprocess.Popen(["tools/flash.py", "monitor", "57600", *more], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               env={**os.environ, "FLASH_DEV": str(dev)})
    try:
        assert process.stdout.readline().endswith(b", the only port of a board\n")
        assert process.stdout.readline().endswith(b"at 57600 baud; type help and Enter, Ctrl-C ends\n")
        assert termios.tcgetattr(its)[4:6] == [termios.B57600] * 2
        os.close(its)
        yield ours, process
    finally:
        process.kill()
        process.wait()


@test
def monitor_shows_what_comes_and_sends_what_is_typed():
    with monitored() as (board_end, process):
        os.write(board_end, b"# tilt-uno\n")
        assert process.stdout.readline() == b"# tilt-uno\n"
        process.stdin.write(b"help\n")
        process.stdin.flush()
        assert os.read(board_end, 100) == b"help\n"
        process.stdin.close()
        assert process.wait(timeout=PATIENCE_S) == 0
        os.close(board_end)


@test
def monitor_says_that_the_board_was_unplugged():
    with monitored() as (board_end, process):
        os.close(board_end)
        assert process.wait(timeout=PATIENCE_S) == 1
        assert b"ttyACM0 is gone: plug the board in again, then make monitor\n" in process.stderr.read()


@test
def monitor_says_why_a_port_does_not_open():
    for port, words in (("/dev/ttyUSB77", "monitor: no port /dev/ttyUSB77: plug the board in"),
                        ("/dev/null", "monitor: /dev/null cannot be set to 57600 baud (")):
        done, _ = program("tools/flash.py", "monitor", "57600", port)
        assert done.returncode == 1 and words in done.stderr and done.stderr.count("\n") == 1, done.stderr


if __name__ == "__main__":
    raise SystemExit(run_all())
