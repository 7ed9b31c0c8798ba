"""Resets of the UNO and its supply, with the sensor left alone or losing its supply too: the firmware streams again, says why it began
anew, and no row is wrong. Each once with the firmware alone in the flash and once started by the UNO's boot loader, which hands no
MCUSR on and, after an external reset, flashes its LED for 0.4 s and waits 1 s for avrdude."""
import pathlib
import re
import sys

sys.path[:0] = pathlib.Path("mk/pythonpath").read_text(encoding="ascii").split()
from system_support import STREAMS, Skip, run_all, simrun, test
from laws import DEFAULT  # noqa: E402

STREAM = STREAMS / "rest-2lsb.csv"
BOOT = pathlib.Path("build/uno/optiboot.hex")
HANG = "build/uno/hang/firmware.elf"
HANG_NOW = "poke:hang_stages=0x80"
# a power-on, an external reset and what comes out of a watchdog reset have these to get to the first row without a flag, in ms
POWER_LIMIT, WATCHDOG_LIMIT, WATCHDOG_PERIOD, LOADER_WAITS = 150, 600, 250, 1400
CAUSES = {"mcupower": "power on", "reset": "reset button or serial port opened", "brownout": "supply dropped",
          HANG_NOW: "watchdog, stage mask 7"}
# RAM outlives a short dip of the supply, and the boot loader clears MCUSR: only the button is left to be told
CAUSES_LOADER = {**CAUSES, "brownout": CAUSES["reset"]}


def reset_run(name, loader, *faults, resets, ms=4500, options=(), fw=HANG):
    """(causes as told, rows, notes, stats) of a run in which these faults come."""
    if loader and not BOOT.exists():
        raise Skip(f"no {BOOT}: Debian's arduino-core-avr has its source (make flashtest)")
    arguments = [word for fault in faults for word in ("--fault", fault)]
    boot = ["--bootloader", BOOT] if loader else []
    rows, notes, _, stats = simrun(name, STREAM, "--loop", "--max-ms", ms, "--expect-resets", resets, *arguments, *boot, *options, fw=fw)
    causes = [note.removeprefix("# reset: ") for note in notes if note.startswith("# reset: ")]
    return causes, rows, notes, stats


def assert_streaming(rows, notes, stats, period_us=10000):
    """To the end, each sample with its row and no fault that lasts."""
    assert not rows[-1][9] & (1 | 2 | 16 | 32 | 64), (rows[-1], notes)
    tail = rows[-20:]
    assert all(abs(b[0] - a[0] - period_us) < period_us / 10 for a, b in zip(tail, tail[1:])), [row[0] for row in tail]
    assert stats["rows_wrong"] == 0 and stats["rows_stale"] == 0, stats


def both_ways(function):
    """The test with the firmware alone and behind the boot loader."""
    for loader in (False, True):
        def check(loader=loader):
            function(loader)
        check.__name__ = f"{function.__name__}_{'by_the_boot_loader' if loader else 'alone'}"
        test(check)
    return function


@both_ways
def each_cause_is_told_and_rows_go_on(loader):
    told = CAUSES_LOADER if loader else CAUSES
    for kind, words in told.items():
        name = f"reset-{kind.split(':')[0]}-{'loader' if loader else 'alone'}"
        causes, rows, notes, stats = reset_run(name, loader, f"2000.3ms:{kind}", resets=1)
        assert causes == ["power on", words], f"{kind}: told {causes}"
        assert_streaming(rows, notes, stats)
        waits = LOADER_WAITS if loader and kind == "reset" else 0
        limit = WATCHDOG_PERIOD + WATCHDOG_LIMIT if kind == HANG_NOW else POWER_LIMIT + waits
        took = stats["fault_1_worst_recovery_ms"]
        assert stats["fault_1_recovered"] == 1 and took <= limit, f"{kind}: first row after {took} ms (limit {limit})"


@both_ways
def a_second_reset_at_any_moment_of_the_start_is_survived(loader):
    """After the first: before the sensor is asked, amid its registers, amid the banner, when rows have just begun."""
    base = 2000 + (LOADER_WAITS if loader else 0)
    for kind in ("reset", "mcupower", "brownout"):
        for after in (3.1, 21.7) if loader else (0.5, 3.1, 21.7, 60.3):
            faults = ("2000ms:reset", f"{base + after}ms:{kind}")
            causes, rows, notes, stats = reset_run(f"twice-{kind}-{loader}", loader, *faults, resets=2, ms=base + 2200)
            expected = (CAUSES_LOADER if loader else CAUSES)[kind]
            assert causes[-1] == expected, f"{kind} {after} ms later: told {causes}"
            assert_streaming(rows, notes, stats)


@both_ways
def watchdog_resets_twice_and_says_so_each_time(loader):
    causes, rows, notes, stats = reset_run(f"dog-twice-{loader}", loader, f"2000ms:{HANG_NOW}", f"2600ms:{HANG_NOW}", resets=2)
    assert causes[1:] == [CAUSES[HANG_NOW]] * 2, causes
    assert_streaming(rows, notes, stats)
    assert f"# filter {DEFAULT}, rate 100 Hz, range 16 g, every 1, baud 115200" == [n for n in notes if n.startswith("# filter")][-1], notes


@both_ways
def a_reset_meets_int1_high_already(loader):
    """The sample whose edge came before the reset is not read, so INT1 stays high and no edge will come."""
    for byte in (1, 4):
        causes, rows, notes, stats = reset_run(f"int1-{loader}", loader, f"xfer:60.{byte}:reset", resets=1, fw="build/uno/firmware.elf")
        assert len(causes) == 2 and not any(n.startswith("# fault") for n in notes), notes
        assert_streaming(rows, notes, stats)


@both_ways
def sensor_and_uno_lose_their_supply_in_any_order(loader):
    """The sensor's power 5 ms away before, during and after each kind of reset; it comes back in standby, with empty registers."""
    for kind in ("reset", "mcupower", "brownout", HANG_NOW):
        for sensor_ms in (1998, 2001, 2300) if loader else (1950, 1998, 2001, 2040, 2300):
            faults = (f"2000ms:{kind}", f"{sensor_ms}ms:power:5")
            causes, rows, notes, stats = reset_run(f"both-{loader}", loader, *faults, resets=1, ms=4000)
            assert causes[1:] == [(CAUSES_LOADER if loader else CAUSES)[kind]], f"{faults}: told {causes}"
            assert_streaming(rows, notes, stats)
            began = sum(": " in n and n.startswith("# fault") and " over" not in n for n in notes)
            over = sum(n.startswith("# fault") and " over" in n for n in notes)
            assert began <= 2 and over <= began, f"{faults}: {notes}"


@both_ways
def a_loop_of_watchdog_resets_ends_in_safe_settings(loader):
    """What hangs three times in a row gets the lowest rate and is told; a run of ten seconds makes the next one the first again."""
    hangs = [f"{ms}ms:{HANG_NOW}" for ms in (1800, 2400, 3000)]
    causes, rows, notes, stats = reset_run(f"loop-{loader}", loader, *hangs, f"15000ms:{HANG_NOW}", resets=4, ms=17500)
    dog = CAUSES[HANG_NOW]
    assert causes[1:] == [dog, dog, dog + ", repeatedly: safe settings", dog], causes
    rates = [re.search(r"rate (\S+) Hz", n)[1] for n in notes if n.startswith("# filter")]
    assert rates == ["100", "100", "100", "12.5", "100"], rates
    assert_streaming(rows, notes, stats)


if __name__ == "__main__":
    raise SystemExit(run_all())
