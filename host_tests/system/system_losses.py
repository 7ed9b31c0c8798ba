"""No sample and no row is lost: rates, baud rates, filters and their time; part of system_tests.py."""
import re

from system_support import FW, OUT, STREAMS, TESTS, assert_nothing_lost, image_with, simrun, test, within
import images  # noqa: E402
from laws import DEFAULT, ROBUST, SLOWEST  # noqa: E402


def worst_width_stream():
    """Readings whose columns are as wide as they get: -4096 and -4095 by turns."""
    path = OUT / "worst-width.csv"
    with open(path, "w", encoding="ascii") as file:
        file.write("t_us,x_lsb,y_lsb,z_lsb\n")
        for i in range(2000):
            v = -4096 + i % 2
            file.write(f"{i * 10000},{v},{v},{v}\n")
    return path


SUPERVISION_CYCLES = 600  # what checking and supervising a sample may cost beside reading, filtering and writing it


def lose_nothing(name, stream, ppm, rate, baud, every, load_limit, fw=FW, shift_us=0, filter_name=None):
    options = ["--ppm", ppm, "--loop", "--max-ms", "61500"]
    if filter_name is not None:
        options += ["--filter", filter_name]
    if baud != 115200:
        options += ["--baud", baud]
    if rate != 100:
        options += ["--rate", rate]
    if every != 1:
        options += ["--every", every]
    rows, notes, served, stats = simrun(name, stream, *options, fw=fw)
    for row in rows:
        row[0] -= shift_us
    assert_nothing_lost(rows, served, every, from_us=1000000, end_us=61000000)
    late = [r for r in rows if r[0] >= 1000000]
    assert not any(r[9] & 256 for r in rows), "a row was dropped"
    assert 60000000 / 1e6 * rate / every * 0.995 < len(late), f"{len(late)} rows in 60 s"
    within(f"CPU load at {rate} Hz", stats["cpu_load"], load_limit)
    # 120 bit times a sample: START, address, register, repeated START, address, ten bytes, STOP
    bit_hz = 400e3 if rate == 800 else 16e6 / 44
    assert abs(stats["i2c_load"] - rate * 120 / bit_hz) < 0.02 * stats["i2c_load"] + 0.0005, stats["i2c_load"]
    mean_us = (int(served[-1]["t_us"]) - int(served[200]["t_us"])) / (len(served) - 201)
    true_us = 1e6 / rate / (1 + ppm * 1e-6)
    assert abs(mean_us / true_us - 1) < 2e-5, f"the sensor's clock: {mean_us} us, {true_us} us asked for"
    return rows


@test
def supervision_costs_at_most_600_cycles_a_sample():
    """Against an image that takes readings as they come, and the four bytes that a plain read does without (INT_SOURCE to FIFO_STATUS)."""
    def cycles(name, fw, rate):
        options = ("--rate", rate, "--baud", 1000000, "--loop", "--max-ms", 20500)
        _, _, _, stats = simrun(f"supervision-{name}", STREAMS / "tilt-slow.csv", *options, fw=fw)
        return stats["cpu_load"] * 16e6 / rate, stats["isr_twi_mean"]

    for rate in (100, 400, 800):
        plain, _ = cycles("plain", "build/uno/plain/firmware.elf", rate)
        judged, a_byte = cycles("judged", FW, rate)
        verdict = judged - plain
        assert verdict > 50, f"the verdict takes {verdict} cycles: it is not in the image"
        what = f"supervision at {rate} Hz ({verdict:.0f} cycles the verdict, 4 x {a_byte:.0f} the bytes)"
        within(what, round(verdict + 4 * a_byte), SUPERVISION_CYCLES)


@test
def no_axis_is_left_out_before_there_is_a_sample():
    _, notes, _, _ = simrun("auto-start", STREAMS / "rest-2lsb.csv", "--fault", "0ms:unplug", "--cmd", "20:status", "--max-ms", 300,
                            fw=image_with("auto"), judge=False)
    (state,) = (note for note in notes if note.startswith("# state"))
    assert ", chosen x " in state and "without" not in state, state


@test
def a_rate_above_the_streams_raises_no_fault():
    """A row that several samples take is not the reading of a sensor that hangs."""
    for rate in (400, 800):
        options = ("--rate", rate, "--every", 4, "--baud", 500000, "--loop", "--max-ms", 30000)
        rows, notes, _, _ = simrun(f"above-the-stream-{rate}", STREAMS / "rest-0.7lsb.csv", *options)
        faults = [note for note in notes if note.startswith("# fault")]
        assert not faults and not any(row[9] & 32 for row in rows[20:]), f"at {rate} Hz: {faults[:3]}"
        assert len(rows) > 28 * rate / 4, f"at {rate} Hz: {len(rows)} rows"


@test
def a_slower_rate_costs_less_load():
    """Below 50 Hz a sample lies further ahead than the alarm reaches: main must sleep all the same, not look again and again."""
    loads = [simrun(f"slow-{rate}", STREAMS / "outliers-15pct.csv", "--rate", rate, "--loop", "--max-ms", 8000)[3]["cpu_load"]
             for rate in ("12.5", "25", "50", "100")]
    print(f"    load at 12.5, 25, 50 and 100 Hz, %: {', '.join(f'{100 * load:.2f}' for load in loads)}")
    assert all(slower < faster for slower, faster in zip(loads, loads[1:])), loads


def make_loss_test(filter_name, rate, baud, every, load_limit, ppm):
    def check():
        lose_nothing(f"loss-{filter_name}-{rate}-{ppm}", STREAMS / "tilt-slow.csv", ppm, rate, baud, every, load_limit, filter_name=filter_name)
    check.__name__ = f"nothing_lost_{rate}_hz_{'plus' if ppm > 0 else 'minus'}_777_ppm_{filter_name}"
    return check


TESTS.append(make_loss_test(DEFAULT, 100, 115200, 1, 0.108, 777))
TESTS.append(make_loss_test(DEFAULT, 400, 500000, 1, 0.39, -777))
TESTS.append(make_loss_test(DEFAULT, 800, 500000, 4, 0.47, 777))
# above adaptive: three times 1,320 cycles of the filters (docs/results/benchmarks.md) and those of the supervisor
TESTS.append(make_loss_test("auto", 100, 115200, 1, 0.14, 777))
TESTS.append(make_loss_test("auto", 400, 500000, 1, 0.535, -777))
TESTS.append(make_loss_test("auto", 800, 500000, 4, 0.80, 777))
TESTS.append(make_loss_test(ROBUST, 100, 115200, 1, 0.11, -777))
TESTS.append(make_loss_test(ROBUST, 400, 500000, 1, 0.42, 777))
TESTS.append(make_loss_test(ROBUST, 800, 500000, 4, 0.54, -777))


def make_width_test(rate, baud, every):
    def check():
        # this image's clock starts at 4.2e9 us: ten digits in every stamp
        rows = lose_nothing(f"wide-{rate}", worst_width_stream(), 777, rate, baud, every, 1.0, fw="build/uno/late/firmware.elf",
                            shift_us=4200000000)
        assert min(r[0] for r in rows) + 4200000000 > 1000000000
        text = (OUT / f"wide-{rate}.csv").read_text().splitlines()
        assert max(len(line) for line in text) >= 62
    check.__name__ = f"nothing_lost_{rate}_hz_with_the_widest_rows"
    return check


TESTS.append(make_width_test(100, 115200, 1))
TESTS.append(make_width_test(400, 500000, 1))
TESTS.append(make_width_test(800, 500000, 15))  # of the filters there none leaves time for more


def forced_every(filter_name, rate):
    """The `every` that the firmware sets when it is asked for every row at 1,000,000 baud."""
    _, notes, _, stats = simrun("forced", STREAMS / "rest-2lsb.csv", "--filter", filter_name, "--rate", rate, "--baud", 1000000, "--every", 1,
                                "--max-ms", 1500, fw=image_with(filter_name))
    forced = [re.fullmatch(r"# every (\d+)(: the least for this filter)?", note) for note in notes]
    every = int([f for f in forced if f][-1].group(1))
    assert f"# filter {filter_name}" in notes and f"# rate {rate} Hz, I2C at {400 if rate == 800 else 363.6} kHz" in notes, notes
    return every


def make_time_test(filter_name, rate):
    def check():
        # rows are as many and as wide as they get: all that the firmware allows must go out
        every = forced_every(filter_name, rate)
        for stream, shift_us, fw in ((worst_width_stream(), 4200000000, "build/uno/late/firmware.elf"),
                                     (STREAMS / "outliers-15pct.csv", 0, image_with(filter_name))):
            lose_nothing(f"time-{filter_name}-{rate}", stream, 777, rate, 1000000, every, 1.0, fw=fw, shift_us=shift_us, filter_name=filter_name)
    check.__name__ = f"nothing_lost_{rate}_hz_1000000_baud_{filter_name}"
    return check


# the slowest of them takes more than a sample at 800 Hz leaves for every row
SLOW = images.HOLDS["research"]
for slow_filter in SLOW:
    TESTS.append(make_time_test(slow_filter, 400 if slow_filter == SLOWEST else 800))


@test
def a_filter_too_slow_for_the_rate_is_refused_and_samples_go_on():
    # this image is told of 15.5 MHz: the slowest takes more than a sample at 800 Hz leaves, the next does not
    fits = SLOW[-2]
    tight = "build/uno/tight/firmware.elf"
    reply = "# refused 5: takes 13050 of 12075 cycles a sample"
    rows, notes, served, _ = simrun("tight-filter", STREAMS / "rest-2lsb.csv", "--filter", fits, "--rate", 800, "--baud", 1000000, "--cmd",
                                    f"1500:filter {SLOWEST}", "--cmd", "1600:filter", "--loop", "--max-ms", 3000, fw=tight)
    assert notes.count(reply) == 1 and notes[notes.index(reply) + 1] == f"# filter {fits}", notes
    # 19,375 - 7,300 - 10,950 cycles a sample are left for rows of 11,700
    assert "# every 11: the least for this filter" in notes, notes
    assert_nothing_lost(rows, served, 11, from_us=1000000, end_us=2900000)
    assert not any(r[9] & (128 | 256) for r in rows if r[0] > 1400000)
    rows, notes, served, _ = simrun("tight-rate", STREAMS / "rest-2lsb.csv", "--filter", SLOWEST, "--cmd", "1500:rate 800", "--cmd", "1600:rate",
                                    "--loop", "--max-ms", 3000, fw=tight)
    assert notes.count(reply) == 1 and notes[notes.index(reply) + 1] == "# rate 100 Hz, I2C at 363.6 kHz", notes
    assert_nothing_lost(rows, served, from_us=1000000, end_us=2900000)
    assert not any(r[9] & (128 | 256) for r in rows if r[0] > 1400000)
