"""The simulator's own faults and its judge, seen at the bus and in the firmware's rows; part of system_tests.py."""
import csv
import json
import statistics

from system_support import FW, OUT, SIMRUN, STREAMS, image_with, run, simrun, test, triplets
from laws import LIGHT  # noqa: E402

REST = STREAMS / "rest-2lsb.csv"
LENGTH_MS = 12000
IN_Y = "xfer:120.8:flip:2"  # in the low byte of y: what arrives is a reading like any other


def injected(name, *faults, judge=False, max_ms=LENGTH_MS, options=()):
    """A run with faults and the filter that gates nothing, so that no flag 1 hides a row from the judge."""
    arguments = [word for fault in faults for word in ("--fault", fault)]
    arguments += ["--altered", OUT / f"inject-{name}.altered.csv"]
    return simrun(f"inject-{name}", REST, "--filter", LIGHT, "--max-ms", max_ms, *arguments, *options, judge=judge)


def altered_at(name):
    """Of each sample that --altered tells of: when its read ended, as it arrived, as the sensor sent it."""
    lines = [[int(v) for v in line.values()] for line in csv.DictReader(open(OUT / f"inject-{name}.altered.csv", encoding="ascii"))]
    return [(line[1], line[2:5], line[5:8]) for line in lines]


def altered(name):
    return [(arrived, sent) for _, arrived, sent in altered_at(name)]


def changes(rows, served):
    """Of each row, what it shows less what the sensor latched for it: no sample is lost here."""
    wanted = triplets(served)
    assert len(wanted) - 2 <= len(rows) <= len(wanted), f"{len(rows)} rows, {len(wanted)} samples"
    return [[shown - true for shown, true in zip(row[1:4], lsb)] for row, lsb in zip(rows, wanted)]


def bits_flipped(row, lsb):
    return sum(bin((shown ^ true) & 0xFFFF).count("1") for shown, true in zip(row[1:4], lsb))


def served_without_faults():
    return triplets(injected("nothing", judge=True)[2])


def whole(reading):
    """The sign bits of full resolution at 16 g agree: 13 bits and their extension."""
    return all(-4096 <= value < 4096 for value in reading)


def check_flips(bits):
    """A flip among the sign bits, or in the frame around the data, is refused: its row is coasted and flagged; any other arrives in its row."""
    name = f"flip-{bits}"
    # so rare that no three in a row are refused: they would be a fault, and the sensor would be configured anew
    rows, _, served, stats = injected(name, f"p:0.09:flip:{bits}")
    assert triplets(served) == served_without_faults(), "--served does not stay what the sensor latched"
    told = {t_us: (arrived, sent) for t_us, arrived, sent in altered_at(name)}
    assert len(told) == stats["samples_altered"], stats
    refused, changed, shown = 0, [], iter(rows)
    for sample, lsb in zip(served, triplets(served)):
        arrived, sent = next((told[t] for t in told if 0 < t - int(sample["t_us"]) < 5000), (lsb, lsb))
        assert sent == lsb, (sample, sent)
        row = next(shown, None)
        if row is None:
            break
        if row[9] & 2:
            assert row[9] & 64, (row, sample)
            refused += 1
        else:
            assert row[1:4] == arrived and whole(arrived) and not row[9] & 64, (row, arrived)
            changed += [(row, lsb)] if arrived != lsb else []
    assert next(shown, None) is None, "a row of no sample"
    assert all(bits_flipped(row, lsb) == bits for row, lsb in changed), changed
    assert len(changed) >= 25 and refused >= 25, (len(changed), refused)
    assert len(changed) + refused <= stats["fault_1_injected"] + 2, stats
    assert len({axis for row, lsb in changed for axis in range(3) if row[1 + axis] != lsb[axis]}) == 3
    # each without a flag is found by the judge: a flipped reading that is by chance that of the sample before or after is stale
    bare = sum(not row[9] & 64 for row, _ in changed)
    assert bare - 3 <= stats["rows_wrong"] + stats["rows_stale"] <= bare, (bare, stats)
    assert stats["fault_1_detectable"] is False


@test
def one_flipped_bit_is_seen_in_its_row_and_by_the_judge():
    check_flips(1)


@test
def two_flipped_bits_are_seen_in_their_row_and_by_the_judge():
    check_flips(2)


@test
def doubled_axis_reads_twice_its_value():
    for axis, letter in ((0, "x"), (2, "z")):
        rows, _, served, stats = injected("double", f"p:0.1:double:{letter}")
        found = 0
        for row, lsb, change in zip(rows, triplets(served), changes(rows, served)):
            assert change in ([0, 0, 0], [lsb[i] if i == axis else 0 for i in range(3)]), (row, lsb)
            found += change[axis] != 0
        # noise of 2 LSB about 36 or 248: no reading is zero
        assert found >= 80 and stats["fault_1_injected"] - 1 <= found <= stats["fault_1_injected"], (found, stats)
        assert len(altered("double")) - found in (0, 1) and stats["samples_altered"] == len(altered("double"))
        assert stats["rows_wrong"] == found and triplets(served) == served_without_faults(), stats


@test
def doubled_axis_stops_at_the_rails():
    path = OUT / "rails.csv"
    lines = [f"{i * 10000},{-240 - i % 60},0,{240 + i % 60}\n" for i in range(200)]
    path.write_text("t_us,x,y,z\n" + "".join(lines), encoding="ascii")
    rows, _, served, _ = simrun("inject-rails", path, "--filter", LIGHT, "--range", "2", "--fault", "p:1:double:x", "--fault", "p:1:double:z",
                                judge=False)
    late = [(row, lsb) for row, lsb in zip(rows, triplets(served)) if row[0] > 200000]
    assert len(late) > 100 and all(row[1:4:2] == [max(2 * x, -512), min(2 * z, 511)] for row, (x, _, z) in late), late[:5]
    assert {row[3] for row, _ in late} > {484, 510, 511} and {row[1] for row, _ in late} > {-484, -510, -512}


@test
def noise_has_the_sigma_that_was_asked_for():
    rows, _, served, stats = injected("noise", "p:1:noise:20")
    per_axis = list(zip(*changes(rows, served)))
    for values in per_axis:
        # 1190 samples: the mean is known to 0.6, the rms to 0.41; five times that
        assert abs(statistics.fmean(values)) < 3 and abs(statistics.pstdev(values) - 20) < 2.1, statistics.pstdev(values)
        assert max(map(abs, values)) <= 121
    assert abs(statistics.fmean(a * b for a, b in zip(per_axis[0], per_axis[1]))) < 5 * 400 / len(rows) ** 0.5
    assert stats["rows_wrong"] > 0.99 * len(rows) - 10 and triplets(served) == served_without_faults(), stats


@test
def frozen_sensor_latches_one_reading_again_and_again():
    rows, _, served, stats = injected("frozen", "2000ms:frozen:1000", judge=True, max_ms=5000)
    inside = [lsb for s, lsb in zip(served, triplets(served)) if 2000000 < int(s["t_us"]) <= 3000000]
    after = [lsb for s, lsb in zip(served, triplets(served)) if int(s["t_us"]) > 3000000]
    assert len(inside) == 100 and all(lsb == inside[0] for lsb in inside) and len(set(map(tuple, after))) > 50
    assert inside[0] in triplets(served)[195:202] and sum(row[1:4] == inside[0] for row in rows) >= 100
    assert stats["rows_wrong"] == 0 and stats["rows"] >= len(served) - 2
    assert stats["samples_altered"] == 0 and not altered("frozen"), "the sensor sends what it latched"


@test
def frozen_sensor_is_flagged_from_the_tenth_reading_and_told_once():
    rows, notes, served, _ = injected("stuck", "2000ms:frozen:1000", judge=True, max_ms=5000)
    held = next(lsb for s, lsb in zip(served, triplets(served)) if 2500000 < int(s["t_us"]))
    inside = [i for i, row in enumerate(rows) if row[1:4] == held and 1900000 < row[0] < 3005000]
    assert inside == list(range(inside[0], inside[-1] + 1)) and 100 <= len(inside) <= 102, inside
    assert [i for i, row in enumerate(rows) if row[9] & 32] == inside[9:], "flag 32"
    assert [n.split(":")[0] for n in notes if n.startswith("# fault")] == ["# fault 10", "# fault 10 over"], notes


@test
def doubled_axis_is_told_as_two_sensors_and_one_doubled_reading_is_not():
    rows, notes, _, stats = injected("two", *[f"{2000 + 100 * i}ms:double:z" for i in range(20)], judge=False, max_ms=8000)
    assert [n.split(":")[0] for n in notes if n.startswith("# fault")] == ["# fault 12", "# fault 12 over"], notes
    assert stats["samples_altered"] == 20 and not any(row[9] & (16 | 32 | 64) for row in rows)
    _, notes, _, stats = injected("one", *[f"{2000 + 500 * i}ms:double:z" for i in range(10)], judge=False, max_ms=8000)
    assert stats["samples_altered"] == 10 and not any(n.startswith("# fault") for n in notes), notes


@test
def storm_on_int1_comes_at_its_rate():
    edges = injected("calm", judge=True, max_ms=3000)[3]["isr_int0_n"]
    rows, _, served, stats = injected("storm", "1000ms:storm:500:1000", max_ms=3000)
    # a pulse against a high level gives its edge when the level comes back
    assert 480 <= stats["isr_int0_n"] - edges <= 520, (edges, stats["isr_int0_n"])
    assert stats["rows_wrong"] == 0 and len(rows) >= len(served) - 2, stats


@test
def storm_on_int1_keeps_its_rate_up_to_the_fastest():
    """At the pin, because no handler runs so often: 100 ms, with the edges of up to eleven samples and of a pulse that is cut by the end."""
    for hz in (20000, 125000, 500000):
        path = OUT / "inject-fast-storm.vcd"
        injected("fast-storm", f"100ms:storm:{hz}:100", max_ms=250, options=("--vcd", path))
        lines = path.read_text(encoding="ascii").splitlines()
        wire = next(line.split()[3] for line in lines if line.startswith("$var") and "INT1_D2" in line)
        at_us, edges = 0.0, 0
        for line in lines:
            if line.startswith("#"):
                at_us = int(line[1:]) / 10000  # 100 ps
            elif line == f"1{wire}" and 100000 <= at_us < 200000:
                edges += 1
        assert abs(edges - hz / 10) <= 12, f"{edges} edges in 100 ms of {hz} Hz"


@test
def output_data_rate_changes_for_as_long_as_asked():
    for ppm in (50000, -50000):
        _, _, served, stats = injected("odr", f"2000ms:odr:{ppm}:4000", judge=True, max_ms=9000)
        at = [int(s["t_us"]) for s in served]
        steps = [b - a for a, b in zip(at, at[1:])]
        inside = [step for t, step in zip(at, steps) if 2010000 < t < 5980000]
        outside = [step for t, step in zip(at, steps) if t < 1980000 or t > 6020000]
        assert all(abs(step - 1e4 / (1 + ppm * 1e-6)) <= 1.5 for step in inside) and len(inside) > 350, inside[:5]
        assert all(abs(step - 10000) <= 1.5 for step in outside) and len(outside) > 400
        assert stats["rows"] >= len(served) - 2


@test
def flood_of_received_bytes_fills_the_line_and_costs_no_row():
    calm = injected("calm", judge=True, max_ms=3000)[3]
    rows, _, served, stats = injected("rxflood", "1000ms:rxflood:1000", judge=True, max_ms=3000)
    # 115200 baud is 117647 on this chip, ten bits a byte
    assert 11500 <= stats["isr_usart_rx_n"] - calm["isr_usart_rx_n"] <= 11800, stats["isr_usart_rx_n"]
    assert [row[1:4] for row in rows] == triplets(served)[:len(rows)] and len(rows) >= len(served) - 2


@test
def bus_fault_per_sample_comes_at_any_byte():
    """Lost in the middle of its data a sample is gone; before it, it is read again. Five of the nine bytes are the former."""
    for kind in ("arb", "buserr"):
        rows, _, served, stats = injected(f"byte-{kind}", f"p:0.1:{kind}", judge=True)
        gone = sum(row[9] & 2 != 0 for row in rows)
        assert abs(len(served) - len(rows)) <= 2, (len(served), len(rows))
        assert 80 <= stats["fault_1_injected"] <= 160 and stats["fault_1_detectable"] is True, stats
        assert 0.3 <= gone / stats["fault_1_injected"] <= 0.8, f"{gone} of {stats['fault_1_injected']} lost"


@test
def state_per_sample_begins_anew_only_when_it_is_over():
    _, _, _, stats = injected("again", "p:1:odr:1000:500", judge=True, max_ms=5100)
    assert stats["fault_1_injected"] == 10, stats["fault_1_injected"]


@test
def judge_ends_the_run_with_its_status_and_names_the_first_row():
    rows, _, served, stats = injected("judged", IN_Y, max_ms=1500)
    wrong = [(i, row) for i, (row, lsb) in enumerate(zip(rows, triplets(served)), 1) if row[1:4] != lsb]
    assert len(wrong) == 1 and stats["rows_wrong"] == 1 and abs(stats["rows_judged"] - len(rows)) <= 1, (wrong, stats)  # one may be cut
    number, row = wrong[0]
    words = f"1 wrong, 0 stale, 0 twice; 0 steps back in time; first row {number}: t_us {row[0]}, readings {row[1]},{row[2]},{row[3]}, "
    assert words in stats["stderr"]
    command = [SIMRUN, "--fw", image_with(LIGHT), "--in", REST, "--out", OUT / "judged.csv", "--filter", LIGHT, "--max-ms", "1500", "--judge"]
    assert f"status 10: {stats['rows_judged']} rows judged: {words}" in run(*command, "--fault", IN_Y, expect=10).stderr
    run(*command)
    # a clock that is said to begin elsewhere makes every stamp one second early
    run(*command, "--clock-start", "1000000", expect=10)


@test
def faults_that_no_firmware_can_see_are_marked():
    kinds = ("unplug plug power sda scl hang arb buserr nack nackdata devid noint inthigh reset mcupower flip noise double frozen storm odr "
             "rxflood torn starve overrun brownout mixed glitch clip txstall").split()
    stats = injected("marks", *[f"5000ms:{kind}" for kind in kinds], judge=True, max_ms=100)[3]
    assert [kind for i, kind in enumerate(kinds, 1) if not stats[f"fault_{i}_detectable"]] == ["flip", "noise", "double", "mixed"], stats


@test
def wrong_parameters_of_a_fault_are_refused():
    for what, words in (("flip:9", "flip wants a whole number from 1 to 8"), ("clip:4", "clip wants an axis: x, y or z"),
                        ("flip:x", "flip wants a whole number"),
                        ("double:w", "double wants an axis: x, y or z"), ("noise:0", "noise wants a whole number from 1 to 4096"),
                        ("storm:0", "storm wants a whole number from 1 to 500000"), ("frozen:1:2", "too many parts"),
                        ("odr:-200001", "odr wants a whole number from -200000 to 200000"), ("flip:1:5", "too many parts"),
                        ("devid:256", "devid wants a whole number from 0 to 255"), ("hang:17", "hang wants a whole number from 1 to 16")):
        done = run(SIMRUN, "--fw", FW, "--in", REST, "--out", OUT / "x.csv", "--fault", f"1ms:{what}", expect=2)
        assert words in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr


@test
def wrong_occasions_of_a_fault_are_refused():
    occasions, counted = "WHEN is 12.3ms, xfer:N.K, pc:SYMBOL#N, eeprom:N or p:CHANCE", "are counted from 1"
    for when, words in (("", occasions), ("soon", occasions), ("12", occasions), ("12 ms", occasions), ("-1ms", "before the beginning"),
                        ("nanms", "too late"), ("1e10ms", "too late"), ("xfer:3", "a whole number"),
                        ("xfer:0.1", counted), ("xfer:1.0", counted), ("pc:main#0", counted), ("eeprom:0", counted),
                        ("pc:", "no such function"), ("pc:#2", "no such function"), ("p:1.1", "a chance from 0 to 1")):
        done = run(SIMRUN, "--fw", FW, "--in", REST, "--out", OUT / "x.csv", "--fault", f"{when}:glitch", expect=2)
        assert words in done.stderr and len(done.stderr.splitlines()) == 1, (when, done.stderr)


def bus_probe(*options, twbr=14):
    """The words that a program without driver says, which moves the lines by hand, and the statistics of its run."""
    elf, stats = OUT / "lines_by_hand.elf", OUT / "lines_by_hand.json"
    run("avr-gcc", "-mmcu=atmega328p", "-DF_CPU=16000000UL", f"-DPROBE_TWBR={twbr}", "-Os", "host_tests/chip/lines_by_hand.c",
        "-o", elf)
    run(SIMRUN, "--fw", elf, "--in", REST, "--out", OUT / "lines.txt", "--stats", stats, "--max-ms", "200", *options, expect=8)
    return (OUT / "lines.txt").read_text(encoding="ascii").split(), json.loads(stats.read_text(encoding="ascii"))


@test
def line_held_low_is_told_by_its_name_and_never_driven_high():
    """Both lines at phases of a sample: its own code, rows again in time, at most 16 clocks by hand and none into an SCL that is low."""
    for phase in range(8):
        for line, code in (("scl", 7), ("sda", 8)):
            at_ms = 1000 + 1.3 * phase
            _, notes, _, told = simrun(f"line-{line}", REST, "--fault", f"{at_ms:.1f}ms:{line}:60", "--max-ms", "1400")
            begun = [note for note in notes if note.startswith("# fault") and "over" not in note]
            assert len(begun) == 1 and begun[0].startswith(f"# fault {code}: {line.upper()} held low"), (phase, notes)
            assert any(note.startswith(f"# fault {code} over: after ") for note in notes), (phase, notes)
            assert told["fault_1_recovered"] == 1 and told["i2c_driven_high"] is False, told
            # a slave that SCL stopped within a byte holds SDA until it has had the rest of its clocks
            clocks = told["i2c_hand_clocks_max"]
            assert clocks == 16 if line == "sda" else 1 <= clocks <= 9, (line, clocks)
            assert told["i2c_hand_stops"] >= 2, "one before first use, one when the line is free again"


@test
def lines_moved_by_hand_are_clocks_starts_and_stops():
    """DEVID is 11100101: left after two bits, the slave goes on with 100101 and the 1 of its acknowledge slot, until START or STOP."""
    said, told = bus_probe()
    assert said[:4] == ["1001011111", "1111111111", "1111111111", "1001011111"], said
    assert told["i2c_hand_clocks_max"] == 11 and told["i2c_hand_stops"] == 1 and told["i2c_driven_high"] is True, told


@test
def slave_hung_in_a_byte_goes_on_where_it_stopped():
    """Eight bits and the acknowledge, then the same byte later: what is left of 11100101, a one not pulled, which ends the read."""
    for clocks, bytes_read in ((None, "E50000"), (1, "72FFFF"), (3, "1C7FFF"), (8, "00CBFF"), (9, "00E500"), (12, "001C7F")):
        said, _ = bus_probe(*([] if clocks is None else ["--fault", f"xfer:5.4:hang:{clocks}"]))
        assert said[4] == bytes_read, f"{clocks} clocks: {said[4]}, not {bytes_read}"
