"""The image of a board with half the clock (make firmware BOARD=promini-8mhz): the same rows, and what it has no time for is refused."""
import pathlib
import re

from system_support import FW, OUT, SIMRUN, STREAMS, assert_nothing_lost, run, simrun, start_offset_us, test, within

SLOW = "build/promini-8mhz/firmware.elf"
SLOW_HZ = 8_000_000
STREAM = STREAMS / "outliers-15pct.csv"
SETTLED_US = 300_000  # the change of the baud rate is over, and the rows of the start
# within 2.2 % of a divider's rate, and a byte lasts 160 cycles
BAUDS = (9600, 19200, 38400, 57600, 250000, 500000)


def rows_by_sample(rows, served):
    """{number of the sample that the sensor served: its row}"""
    late_us = start_offset_us(served, rows)
    numbers = {int(sample["t_us"]) - late_us: number for number, sample in enumerate(served)}
    found = {}
    for row in rows:
        near = [number for t_us, number in numbers.items() if abs(t_us - row[0]) <= 50]
        assert len(near) == 1, (row, near)
        found[near[0]] = row
    return found


@test
def at_8_mhz_no_sample_is_lost_and_each_row_is_that_of_16_mhz():
    columns, loads = [], []
    for name, options in (("clock-16", {}), ("clock-8", {"fw": SLOW})):
        rows, _, served, stats = simrun(name, STREAM, "--baud", 250000, **options)
        assert_nothing_lost(rows, served, from_us=SETTLED_US)
        readings = [row for row in rows if row[0] >= SETTLED_US and not row[9] & (2 | 16)]  # the stream's end looks like a sensor that stopped
        columns.append({number: row[1:] for number, row in rows_by_sample(readings, served).items()})
        loads.append(stats["cpu_load"])
    both = columns[0].keys() & columns[1].keys()
    assert len(both) >= 5900, len(both)
    differ = [(number, *(each[number] for each in columns)) for number in sorted(both) if columns[0][number] != columns[1][number]]
    assert not differ, f"{len(differ)} rows differ, the first: {differ[0]}"
    within("load at 8 MHz beside that at 16 MHz", round(loads[1] / loads[0], 3), 2.05)  # the same work in as many cycles


@test
def at_8_mhz_and_400_hz_no_sample_is_lost():
    rows, notes, served, stats = simrun("clock-8-400", STREAMS / "tilt-400hz.csv", "--cmd", "200:baud 500000", "--cmd", "300:rate 400", "--cmd",
                                        "500:every 4", "--loop", "--max-ms", "6000", fw=SLOW)
    assert "# rate 400 Hz, I2C at 363.6 kHz" in notes and "# every 4" in notes, notes
    assert_nothing_lost(rows, served, every=4, from_us=700_000)
    assert not any(row[9] & (2 | 16 | 256) for row in rows if row[0] >= 700_000)
    within("load at 8 MHz and 400 Hz, %", round(100 * stats["cpu_load"], 1), 75)


@test
def at_8_mhz_what_does_not_fit_is_refused_with_its_reason():
    _, notes, _, _ = simrun("clock-8-refused", STREAM, "--cmd", "500:rate 800", "--cmd", "600:baud 1000000", "--cmd", "700:baud 115200", "--cmd",
                            "800:baud", "--cmd", "900:rate", "--max-ms", "3000", fw=SLOW)
    rest = int(re.search(r"SETTINGS_REST_CYCLES (\d+)u", next(pathlib.Path("firmware").rglob("settings.h")).read_text(encoding="utf-8"))[1])
    assert any(re.fullmatch(rf"# refused 5: takes \d+ of {SLOW_HZ // 800 - rest} cycles a sample", note) for note in notes), notes
    assert notes.count(f"# refused 4: baud is one of {' '.join(map(str, BAUDS))}") == 2, notes
    assert "# baud 57600" in notes and any(note.startswith("# rate 100 Hz") for note in notes), notes


@test
def at_8_mhz_each_baud_rate_has_its_nearest_divider():
    for baud in BAUDS:
        _, _, _, stats = simrun("clock-8-divider", STREAM, "--baud", baud, "--max-ms", "600", fw=SLOW)
        nearest = min((SLOW_HZ / 8 / divider for divider in range(1, 4097)), key=lambda rate: abs(rate - baud))
        assert abs(stats["uart_baud"] - nearest) <= 1 and abs(nearest / baud - 1) <= 0.022, (baud, stats["uart_baud"], nearest)


@test
def clock_that_simrun_cannot_believe_is_refused():
    for hz in (20_000_000, 32_768):
        wrong = OUT / "clock-wrong.elf"
        run("avr-objcopy", "--add-symbol", f"cpu_hz={hz}", FW, wrong)
        done = run(SIMRUN, "--fw", wrong, "--in", STREAM, "--out", OUT / "clock-wrong.csv", expect=2)
        assert "its symbol cpu_hz, the processor's clock, is not between 1 and 16 MHz" in done.stderr, done.stderr
