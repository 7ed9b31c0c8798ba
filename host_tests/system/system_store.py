"""The EEPROM on the chip: written, kept in simrun's file, and the store in it (store_probe.c) when the supply goes in a save."""
import json
import pathlib
import re

from system_support import OUT, SIMRUN, STREAMS, run, test

# the image, sequence number, two checks, and the mark twice, or the version and it once
IMAGE_SIZE = int(re.search(r"STORE_IMAGE_SIZE (\d+)u", pathlib.Path("firmware/settings/store.h").read_text(encoding="ascii")).group(1))
WRITES = IMAGE_SIZE + 5
STATUS = "damaged empty other_version good other_copy".split()
PROBE = "build/uno/store_probe.elf"
LEFT = ("ff", "old", "new", "random")


@test
def eeprom_is_written_on_the_chip_and_kept_in_the_file():
    image = OUT / "eeprom.bin"
    image.write_bytes(bytes([0xFF] * 1023 + [0x5A]))
    done = run(SIMRUN, "--fw", "build/uno/hal_probe.elf", "--in", STREAMS / "tilt-fast.csv", "--out", OUT / "eeprom.txt", "--eeprom", image,
               "--fault", "pc:hal_i2c_clear#1:sda:2", "--fault", "pc:hal_i2c_clear#2:scl:2", "--max-ms", "1000", expect=None)
    assert done.returncode == 8, done.stderr
    lines = [line.split() for line in (OUT / "eeprom.txt").read_text().splitlines()]
    said = dict(lines)
    assert said["before"] == "01011010" and said["after"] == "10100101" and said["ready"] == "00000000", said
    assert said["ticks"] == "00000001", "3.4 ms are less than one tick of 8 ms"
    assert image.read_bytes() == bytes([0xFF] * 1023 + [0xA5])
    late_us = [int(value, 2) for name, value in lines if name == "late"]
    assert len(late_us) == 7 and max(late_us) <= 20, f"main wakes {late_us} us after its alarm"
    assert said["room"] == "00000001", "the ring takes a line that fills it and none that is longer"
    slept_us = [int(value, 2) for name, value in lines if name == "slept"]
    # SDA low: 16 clocks of three steps of 5 us, each with its instructions; SCL low: a look without a clock; a free bus: one clock
    clears = [(line, 2 * int(us, 2)) for (_, us), (_, line) in zip(lines[-6::2], lines[-5::2])]
    look_us = clears[1][1]
    assert [line for line, _ in clears] == ["00000010", "00000001", "00000000"] and look_us <= 12, clears
    for (_, took_us), clocks in zip(clears, (16, 0, 1)):
        assert 15 * clocks - 2 <= took_us - look_us <= 16.5 * clocks + 2, (clears, clocks)
    assert len(slept_us) == 3 and max(slept_us) <= 40, f"main sleeps {slept_us} us although its alarm has passed"


def probe(image, *faults, seed=1):
    """What the probe says, one dictionary a start, and the statistics; the EEPROM is that of the file, before and after."""
    out, stats = OUT / "store.txt", OUT / "store.json"
    options = [word for fault in faults for word in ("--fault", fault)]
    done = run(SIMRUN, "--fw", PROBE, "--in", STREAMS / "tilt-fast.csv", "--out", out, "--eeprom", image, "--stats", stats,
               "--max-ms", "3000", "--seed", seed, "--expect-resets", len(faults), *options, expect=None)
    assert done.returncode == 8, done.stderr
    starts = []
    for name, *value in (line.split() for line in out.read_text(encoding="ascii").splitlines()):
        if name == "status":
            starts.append({})
        starts[-1][name] = STATUS[int(value[0])] if name == "status" else "".join(value)
    return starts, json.loads(stats.read_text(encoding="ascii"))


def four_saves(image):
    """What each of four starts finds on a board that was empty before the first."""
    image.unlink(missing_ok=True)
    return [probe(image) for _ in range(4)]


@test
def store_keeps_a_set_over_power_cycles_on_the_chip():
    told = four_saves(OUT / "store.bin")
    starts = [starts for starts, _ in told]
    assert starts == [[{"status": "empty", "set": "-", "save": "+", "end": ""}]] + [
        [{"status": "good", "set": str(n), "save": "+", "end": ""}] for n in (1, 2, 3)], starts
    assert [stats["eeprom_writes"] for _, stats in told] == [WRITES] * 4, told


def cut(kept, fault, seed=1):
    """A save cut by this fault on a board that keeps set 4: what the next start finds, and that it saves again."""
    image = OUT / "store_cut.bin"
    image.write_bytes(kept)
    (first, second), _ = probe(image, fault, seed=seed)
    assert first == {"status": "good", "set": "4"}, (fault, first)
    assert second["set"] in ("4", "5") and second["status"] in ("good", "other_copy") and second["save"] == "+", (fault, second)
    return second


@test
def store_survives_power_cuts_on_the_chip():
    """In every write with one kind of what is left in turn; in the outer ones all kinds, before and after too."""
    image = OUT / "store_kept.bin"
    four_saves(image)
    kept = image.read_bytes()
    outer = (1, 2, 25, WRITES - 1, WRITES)
    for n in range(1, WRITES + 1):
        for left in LEFT if n in outer else LEFT[n % 4:n % 4 + 1]:
            found = cut(kept, f"eeprom:{n}:mcupower:{left}", seed=n)
            assert found["set"] == "4" or n == WRITES and left in ("new", "random"), (n, left, found)
            assert found["status"] == "other_copy" or n in (1, WRITES), "a save that was cut is told"
    for n in outer:
        assert cut(kept, f"eeprom:{n}.before:mcupower:new")["set"] == "4"
        assert cut(kept, f"eeprom:{n}.after:mcupower:old")["set"] == ("5" if n == WRITES else "4")
        (third,), _ = probe(OUT / "store_cut.bin")
        assert third["status"] == "good" and third["set"] == ("6" if n == WRITES else "5"), (n, third)


@test
def store_fault_words_are_refused():
    for words, reason in (("eeprom:3.during:mcupower", "eeprom: wants N, N.before or N.after"), ("eeprom:0.after:mcupower", "counted from 1"),
                          ("eeprom:3.:mcupower", "eeprom: wants N, N.before or N.after"), ("eeprom:x.before:mcupower", "a whole number"),
                          ("eeprom:3:mcupower:half", "ff, old, new or random"), ("eeprom:3:mcupower:ff:2", "too many parts")):
        done = run(SIMRUN, "--fw", PROBE, "--in", STREAMS / "tilt-fast.csv", "--out", OUT / "x.csv", "--fault", words, expect=2)
        assert reason in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
