"""Words of the console from every image: each fault line whole, with the sensor at either address, and the filters of the other images; part of
system_tests.py."""
import pathlib
import re

from images import filters_of
from laws import PLAIN, names
from system_support import OUT, SET_IMAGES, STREAMS, simrun, test

REST = STREAMS / "rest-2lsb.csv"
LINE_MAX = int(re.search(r"#define TEXT_LINE_MAX (\d+)u", pathlib.Path("firmware/base/text.h").read_text(encoding="utf-8"))[1])
ADDRESSES = (("0x53", ()), ("0x1D", ("--alt-address",)))

# docs/faults.md; what raises it, one after the other
FAULTS = (
    (4, "a register lost its value: check supply, bus", ["xfer:18.4:flip:1"]),
    (8, "SDA held low: check SDA, SCL, pull-ups, GND", ["500ms:sda:60"]),
    (7, "SCL held low: check SDA, SCL, pull-ups, GND", ["700ms:scl:60"]),
    (1, "no sensor at 0x53 or 0x1D: check power, SDA to A4, SCL to A5, CS to 3.3 V", ["900ms:unplug:60"]),
    (6, "the sensor stopped: check supply", ["1100ms:power:1"]),
    (5, "INT1 stays low: check INT1 to D2", ["1300ms:noint:100"]),
    (9, "INT1 stays high: check INT1 to D2", ["1500.3ms:inthigh:100"]),
    (10, "values do not change: check supply, bus", ["2300ms:frozen:250"]),
    (2, "no ADXL345 at {address}: DEVID 0xE6, not 0xE5", ["2800ms:devid:230:300", "2800ms:power:1"]),
    (12, "values double: two sensors at {address}", [f"{3300 + 40 * i}ms:double:z" for i in range(20)]),
    (13, "INT1 flickers: check INT1 to D2", ["7500ms:storm:200000:50"]),
)
END_MS = 8500
# those that each sample raises again
ALWAYS = (
    (3, "I2C bus disturbed: check SDA, SCL, pull-ups, GND", ["p:1:buserr"]),
    (11, "torn readings: check SDA, SCL, pull-ups, GND", ["p:1:torn"]),
)
ALWAYS_MS = 400
# the sensor reads 0.2 g at rest
OTHER_PART = "# fault 14: not an ADXL345, or offsets beyond its data sheet: cal6"
OTHER_PART_MS, OTHER_PART_OPTIONS = 13000, ("--loop", "--part", "offset=0,0,-200")


def reported_by(faults, address, options, image, max_ms):
    """All lines about faults, in their order."""
    injected = [word for _, _, whens in faults for when in whens for word in ("--fault", when)]
    _, notes, _, _ = simrun("words", REST, *options, *injected, "--max-ms", max_ms, fw=image, judge=False)
    if not (OUT / "words.csv").read_bytes().endswith(b"\n"):
        notes = notes[:-1]  # cut by the end
    return [note for note in notes if note.startswith("# fault")]


def is_over(line, code, address):
    return re.fullmatch(rf"# fault {code} over: after \d+ ms, \d+ lost, sensor at {address}", line) is not None


def check_words(image, address, options):
    begun = {code: f"# fault {code}: {words.format(address=address)}" for code, words, _ in FAULTS + ALWAYS}
    lines = reported_by(FAULTS, address, options, image, END_MS)
    for code, _, _ in FAULTS:
        assert lines.pop(0) == begun[code], (image, code, lines)
        over = lines.pop(0)
        # the first is over before the header
        assert is_over(over, code, address) or (code == FAULTS[0][0] and over.startswith(f"# fault {code} over: ")), (image, over)
    assert not lines, (image, lines)
    for fault in ALWAYS:
        code = fault[0]
        lines = reported_by([fault], address, options, image, ALWAYS_MS)
        assert len(lines) >= 2 and all(line == begun[code] for line in lines[0::2]), (image, lines)
        assert all(is_over(line, code, address) for line in lines[1::2]), (image, lines)
    lines = reported_by([], address, (*options, *OTHER_PART_OPTIONS), image, OTHER_PART_MS)
    assert lines == [OTHER_PART], (image, lines)


@test
def words_of_each_fault_are_whole_in_each_image_with_the_sensor_at_either_address():
    for image in SET_IMAGES:
        for address, options in ADDRESSES:
            check_words(image, address, options)


@test
def a_fault_around_the_end_of_the_banner_has_both_its_lines():
    """At 9600 baud the banner takes a quarter of a second, from the line with the fault to the rows 40 ms."""
    eeprom = OUT / "slow.bin"
    eeprom.unlink(missing_ok=True)
    simrun("banner", REST, "--eeprom", eeprom, "--cmd", "200:baud 9600", "--cmd", "300:save", "--max-ms", 900)
    reported = 0
    for fault in [f"0ms:unplug:{ms}" for ms in range(100, 400, 6)] + [f"{ms}ms:unplug:60" for ms in range(100, 400, 6)]:
        _, notes, _, _ = simrun("banner", REST, "--loop", "--eeprom", eeprom, "--fault", fault, "--max-ms", 1500)
        lines = [note.split(":")[0] for note in notes if note.startswith("# fault")]
        begun, over = ([line for line in lines if line.endswith(" over") == ends] for ends in (False, True))
        assert over == [f"{line} over" for line in begun], (fault, lines)
        reported += len(begun)
    assert reported > 90, reported


# Of a device that is none, at the start: the MCU is reset again and again, and a `status` typed so many ms later.
PHASES, STEP_MS, EVERY_MS = 50, 1.2, 90


def check_phases(image, address, options):
    arguments = ["--fault", "0ms:devid:230"]
    for phase in range(PHASES):
        at_ms = EVERY_MS * (phase + 1)
        arguments += ["--fault", f"{at_ms}ms:reset", "--cmd", f"{at_ms + STEP_MS * phase:.1f}:status"]
    path = OUT / "steady.csv"
    path.write_text("t_us,x,y,z\n0,0,0,256\n10000,0,0,256\n", encoding="ascii")
    _, notes, _, stats = simrun("named", path, "--loop", *options, *arguments, "--expect-resets", PHASES, "--max-ms", EVERY_MS * (PHASES + 1),
                                fw=image, judge=False)
    reported = [note for note in notes if note.startswith("# fault")]
    wanted = f"# fault 2: no ADXL345 at {address}: DEVID 0xE6, not 0xE5"
    wrong = [note for note in reported if note != wanted]
    assert not wrong, f"{image}: {wrong[0]} ({len(wrong)} of {len(reported)})"
    assert len(reported) >= PHASES, f"{image}: {len(reported)} lines after {PHASES} resets"


@test
def fault_2_names_the_device_that_was_found_whenever_its_line_comes():
    for image in SET_IMAGES:
        for address, options in ADDRESSES:
            check_phases(image, address, options)


@test
def an_image_names_the_filters_of_the_others():
    for image in SET_IMAGES:
        own = filters_of(image)
        _, notes, _, _ = simrun("elsewhere", REST, "--cmd", "300:filter median", "--max-ms", 500, fw=image)
        said = next(note for note in notes if note.startswith("# refused"))
        found = re.fullmatch(r"# refused 4: filter is one of ([a-z0-9_ ]+); make flash FILTERS=NAME: ([a-z0-9_ ]+)", said)
        assert found and found[1].split() == own and sorted(own + found[2].split()) == sorted(names()), (image, said)
        assert len(said) < LINE_MAX, (image, len(said))


@test
def a_limited_q_is_reported_once_and_a_saved_one_too():
    """q 10^9 at 100 Hz is 1000 LSB^2 per sample, beyond 14 R; at 800 Hz it is 2 LSB^2."""
    for image in (image for image in SET_IMAGES if PLAIN in filters_of(image)):
        eeprom = OUT / "limited.bin"
        eeprom.unlink(missing_ok=True)
        for commands, reported in ((("baud 500000", f"filter {PLAIN}", "q 1000000000", "save"), 1), ((), 1), (("rate 800", "save"), 0), ((), 0)):
            typed = [word for i, line in enumerate(commands) for word in ("--cmd", f"{300 + 100 * i}:{line}")]
            _, notes, _, _ = simrun("limited", REST, "--loop", "--eeprom", eeprom, *typed, "--max-ms", 4000, fw=image)
            assert notes.count("# limited: q by r") == reported, (image, commands, notes)
