"""The simulator's pseudo terminal and those who hold its other end; part of system_tests.py."""
import contextlib
import fcntl
import os
import re
import struct
import subprocess
import termios
import time

from system_support import FW, OUT, SIMRUN, STREAMS, run, test

STREAM = STREAMS / "rest-2lsb.csv"
FAST = ["--rate", "400", "--baud", "500000"]  # fills the terminal, 12 KB, in half a second
ENDS_S = 300  # only reached when something is broken, however busy the machine


@contextlib.contextmanager
def held(name, *options):
    """A run and the other end of its terminal, held open as a program that reads it does."""
    command = [SIMRUN, "--fw", FW, "--in", STREAM, "--loop", "--out", OUT / f"{name}.csv", "--pty", *FAST, *options]
    with subprocess.Popen([str(c) for c in command], stderr=subprocess.PIPE, text=True) as process:
        try:
            port = os.open(re.search(r"UART on (\S+)", process.stderr.readline())[1], os.O_RDWR | os.O_NOCTTY)
            yield process, port
            os.close(port)
        finally:
            process.kill()


def waiting(port):
    return struct.unpack("i", fcntl.ioctl(port, termios.FIONREAD, bytes(4)))[0]


@test
def who_holds_the_terminal_and_never_reads_ends_the_run():
    with held("never-read", "--patience", "0.2") as (process, _):
        said = process.communicate(timeout=ENDS_S)[1]
        assert process.returncode == 12, (process.returncode, said)
        assert "has read nothing for 0.2 s (see --patience), at " in said, said
    assert (OUT / "never-read.csv").stat().st_size > 4000  # more than nothing was there to be read


@test
def who_reads_late_is_waited_for():
    """The twin: what fills the terminal is no end; every byte comes, in order, and the run ends well."""
    with held("late-read", "--max-ms", "2500") as (process, port):
        while process.poll() is None and waiting(port) < 4000:
            time.sleep(0.01)
        came = bytearray()
        with contextlib.suppress(OSError):  # the run's end hangs up
            while block := os.read(port, 4096):
                came += block
        status, said = process.wait(timeout=ENDS_S), process.stderr.read()
    sent = (OUT / "late-read.csv").read_bytes()
    assert status == 0, (status, said)
    assert len(came) > 20000 and came in sent, (len(came), len(sent))


@test
def patience_is_for_a_terminal():
    done = run(SIMRUN, "--fw", FW, "--in", STREAM, "--out", OUT / "x.csv", "--patience", "5", expect=2)
    assert "--patience is for a terminal: give --pty" in done.stderr, done.stderr
