"""make flash against the UNO's boot loader in the simulator: avrdude writes and verifies through it, then the firmware streams."""
import contextlib
import csv
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import FW, OUT, SIMRUN, STREAMS, Skip, read_output, run, run_all, test, triplets

BOOT = pathlib.Path("build/uno/optiboot.hex")
HEX = pathlib.Path("build/uno/firmware.hex")
LOG = pathlib.Path("build/flash.log")
STREAM = STREAMS / "rest-2lsb.csv"
BOOT_START, FLASH_END = 0x7E00, 0x8000
TRIES, PATIENCE_OF_AVRDUDE_S = 4, 0.25
TOO_LATE = ("not in sync", "not responding", "protocol expects")
PATIENCE_S = 300  # only reached when something is broken, however busy the machine


def need_tools():
    if not BOOT.exists():
        raise Skip(f"no {BOOT}: Debian's arduino-core-avr has its source (make flashtest)")
    if shutil.which("avrdude") is None:
        raise Skip("no avrdude on PATH (tools/deps.sh flashtest)")


@contextlib.contextmanager
def board(name, *options):
    """A simulated UNO with the boot loader and an empty flash; gives its serial port and the files of the run."""
    base = OUT / name
    command = [SIMRUN, "--fw", FW, "--blank", "--bootloader", BOOT, "--in", STREAM, "--loop", "--out", f"{base}.csv", "--served",
               f"{base}.served.csv", "--pty", *options]
    with open(f"{base}.log", "w", encoding="utf-8") as log:
        process = subprocess.Popen([str(c) for c in command], stderr=log)
    try:
        yield wait_for_port(f"{base}.log", process), base, process
    except AssertionError as problem:
        raise AssertionError(f"{problem}\nsimrun: {pathlib.Path(f'{base}.log').read_text(encoding='utf-8')}") from problem
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
        process.wait(timeout=PATIENCE_S)


def wait_for(what, found, process):
    """What found() gives, once that is something."""
    deadline = time.monotonic() + PATIENCE_S
    while time.monotonic() < deadline and process.poll() is None:
        value = found()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"{what} did not come")


def wait_for_port(log, process):
    def port():
        return re.search(r"UART on (\S+)", pathlib.Path(log).read_text(encoding="utf-8"))
    return wait_for("the name of the port", port, process)[1]


def output(base):
    path = pathlib.Path(f"{base}.csv")
    return path.read_bytes() if path.exists() else b""


def wait_for_rows(count, base, process, behind=0):
    """Until the firmware, since its last start, has sent so many; that start is further than `behind` in its output."""
    def there():
        _, banner, rows = output(base)[behind:].rpartition(b"# tilt-uno")
        return banner and len(re.findall(rb"^\d+,.*\n", rows, re.M)) >= count
    wait_for(f"{count} rows", there, process)


def avrdude(port, operation, image):
    return run("avrdude", "-p", "atmega328p", "-c", "arduino", "-P", port, "-b", "115200", "-D", "-U", f"flash:{operation}:{image}:i",
               expect=None)


def waited_s(process):
    """How long a process has waited for a processor so far."""
    try:
        return int(pathlib.Path(f"/proc/{process.pid}/schedstat").read_text(encoding="ascii").split()[1]) / 1e9
    except (OSError, IndexError):
        return 0.0


def talk(attempt, process):
    """What a program gave that talks to the boot loader. Where the simulated board answered too late it is tried again, in the end skipped:
    avrdude's patience is 250 ms of real time, and a busy machine may keep the simulator from running for longer."""
    for _ in range(TRIES):
        before = waited_s(process)
        done = attempt()
        words = done.stdout + done.stderr
        late = any(each in words for each in TOO_LATE)
        if done.returncode == 0 or not late:
            return done
        print(f"    no answer in time: simrun waited {waited_s(process) - before:.1f} s for a processor")
    if waited_s(process) - before > PATIENCE_OF_AVRDUDE_S:
        raise Skip(f"the machine is too busy: avrdude gave up {TRIES} times, and simrun waited {waited_s(process) - before:.1f} s for a processor")
    return done


def said(done):
    """Why a program was not what the test wants, in its own words: avrdude's first, where make flash has put them into a file."""
    log = LOG.read_text(encoding="utf-8") if str(LOG) in done.stderr and LOG.exists() else ""
    return f"{done.stderr.strip() or done.stdout.strip()}\n{log}\n{done.args[0]} gave status {done.returncode}"


def records(path):
    """(address, type, bytes) of each record."""
    for line in path.read_text(encoding="ascii").split():
        data = bytes.fromhex(line[1:])
        yield int.from_bytes(data[1:3], "big"), data[3], data[4:-1]


def record(address, kind, data):
    body = bytes([len(data)]) + address.to_bytes(2, "big") + bytes([kind]) + data
    return ":" + (body + bytes([-sum(body) & 0xFF])).hex().upper()


def with_a_bit_turned(image, to):
    """A copy whose byte at 0x1234 differs in one bit."""
    lines = []
    for address, kind, data in records(image):
        if kind == 0 and address <= 0x1234 < address + len(data):
            at = 0x1234 - address
            data = data[:at] + bytes([data[at] ^ 1]) + data[at + 1:]
        lines.append(record(address, kind, data))
    to.write_text("\n".join(lines) + "\n", encoding="ascii")
    assert lines != image.read_text(encoding="ascii").split()
    return to


def streamed(base):
    """Rows of the run's output behind its last banner, and the notes there."""
    raw = pathlib.Path(f"{base}.csv").read_bytes()
    starts = [found.start() for found in re.finditer(rb"# tilt-uno", raw)]
    assert starts, "no banner"
    after = OUT / "flash-after.csv"
    after.write_bytes(raw[starts[-1]:raw.rindex(b"\n") + 1])
    return read_output(after)


def assert_rows_follow_the_sensor(rows, base):
    """The readings of the rows are samples of the sensor, each once and in its order."""
    with open(f"{base}.served.csv", encoding="ascii") as file:
        served = triplets(csv.DictReader(file))
    readings = [row[1:4] for row in rows]
    first = next((i for i in range(len(served)) if served[i:i + len(readings)] == readings), None)
    assert first is not None, f"{len(readings)} rows that are not {len(readings)} samples on end"


@test
def boot_loader_fits_its_section():
    need_tools()
    data = [(address, address + len(bytes_)) for address, kind, bytes_ in records(BOOT) if kind == 0]
    assert min(a for a, _ in data) == BOOT_START and max(e for _, e in data) == FLASH_END, data
    ordered = sorted(data)
    assert all(end <= start for (_, end), (start, _) in zip(ordered, ordered[1:])), "the records overlap"


@test
def nothing_runs_until_the_port_of_an_empty_board_is_opened():
    """However long make takes before avrdude opens it: the boot loader would leave for the empty flash."""
    need_tools()
    with board("unopened") as (_, base, process):
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=PATIENCE_S) == 0
        assert "simrun: 0.0 ms, " in pathlib.Path(f"{base}.log").read_text(encoding="utf-8")


@test
def make_flash_writes_verifies_and_the_firmware_streams():
    need_tools()
    with board("flash", "--max-ms", "1000000") as (port, base, process):
        done = talk(lambda: run("make", "flash", f"PORT={port}", expect=None), process)  # tools/flash.py, the code of tilt flash
        size = sum(len(data) for _, kind, data in records(HEX) if kind == 0)
        assert done.returncode == 0 and f"flash: {size:,} bytes written and verified" in done.stdout, said(done)
        assert f"{size} bytes of flash verified" in LOG.read_text(encoding="utf-8")
        assert "; the board answers: tilt-uno " in done.stdout, done.stdout
        wait_for_rows(1, base, process)  # the firmware runs, so that the next opening of the port has something to interrupt
        turned = with_a_bit_turned(HEX, OUT / "turned.hex")
        wrong = talk(lambda: avrdude(port, "v", turned), process)
        assert wrong.returncode != 0 and "0x1234" in wrong.stderr, said(wrong)
        right = talk(lambda: avrdude(port, "v", HEX), process)
        assert right.returncode == 0, said(right)
        wait_for_rows(101, base, process, len(output(base)))  # of an earlier start no more than 93 rows are in simrun's buffer of 4 KB
        process.send_signal(signal.SIGINT)
        status = process.wait(timeout=PATIENCE_S)
    assert status == 0, pathlib.Path(f"{base}.log").read_text(encoding="utf-8")
    rows, notes = streamed(base)
    assert len(rows) > 100, f"{len(rows)} rows"
    assert not any(row[9] & 16 for row in rows), "a fault in the rows"
    assert any("serial port opened" in note for note in notes), notes
    assert_rows_follow_the_sensor(rows, base)


@test
def an_empty_flash_does_not_stream():
    need_tools()
    done = run(SIMRUN, "--fw", FW, "--blank", "--bootloader", BOOT, "--in", STREAM, "--out", OUT / "blank.csv", "--max-ms", "3000", expect=3)
    assert "erased flash" in done.stderr, done.stderr
    assert (OUT / "blank.csv").read_bytes() == b""


BAD_IMAGES = {
    "checksum": (":107E0000112484B714BE81FFFDD085E080938100EB", ":1: ", "checksum"),
    "cut-short": (":107E0000112484B7", ":1: ", "cut short"),
    "no-record": ("ELF", ":1: ", "not a record"),
    "behind-the-flash": (record(0x7FF8, 0, bytes(16)), ":1: ", "not within the boot section"),
    "in-the-application": (record(0x100, 0, bytes(16)), ":1: ", "not within the boot section"),
    "unknown-type": (record(0, 9, bytes(2)), ":1: ", "record type 09"),
    "no-end": (record(0x7E00, 0, bytes(16)), "", "without an end record"),
    "no-data": (record(0, 1, b""), "", "without data"),
}


def make_bad_image_test(name, text, where, what):
    def check():
        path = OUT / f"boot-{name}.hex"
        path.write_text(text + "\n", encoding="ascii")
        done = run(SIMRUN, "--fw", FW, "--in", STREAM, "--out", OUT / "x.csv", "--bootloader", path, expect=2)
        assert f"{path.name}{where}" in done.stderr and what in done.stderr, done.stderr
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    check.__name__ = "bad_boot_image_" + name.replace("-", "_")
    return test(check)


for bad_name, bad in BAD_IMAGES.items():
    make_bad_image_test(bad_name, *bad)

if __name__ == "__main__":
    raise SystemExit(run_all())
