"""Samples missing from a stream, or samples without a row: the chip's rows in their places are those of the native build."""
from system_support import OUT, STREAMS, TESTS, image_with, read_output, run, simrun, test
from laws import DEFAULT, LIGHT, PLAIN  # noqa: E402


def thinned(stream):
    """A copy of a stream without one or two samples now and then: too few for the sensor to be asked what is wrong."""
    path = OUT / "thinned.csv"
    lines = stream.read_text(encoding="utf-8").splitlines()
    header = next(i for i, line in enumerate(lines) if line.startswith("t_us"))
    rows = lines[header + 1:]
    missing = {at + i for turn, at in enumerate(range(200, len(rows) - 20, 37)) for i in range(1 + turn % 2)}
    path.write_text("\n".join([lines[header]] + [row for i, row in enumerate(rows) if i not in missing]) + "\n", encoding="utf-8")
    return path, missing


def compare_thinned(filter_name):
    stream, missing = thinned(STREAMS / "tilt-slow.csv")
    name = f"thinned-{filter_name}"
    rows, _, _, _ = simrun(name, stream, "--filter", filter_name, fw=image_with(filter_name))
    run("build/host/native_replay", "--in", stream, "--out", OUT / f"{name}.native.csv", "--filter", filter_name)
    native, _ = read_output(OUT / f"{name}.native.csv")
    end = next((i for i, row in enumerate(rows) if row[9] & 16), len(rows)) - 3  # the stream is over
    rows, native = rows[:end], native[:end]
    for i, (chip, pc) in enumerate(zip(rows, native)):
        assert chip[1:] == pc[1:], f"row {i}: chip {chip}, PC {pc}"
    for a, b in zip(rows, rows[1:]):
        assert abs(b[0] - a[0] - 10000) <= 200, f"{a[0]} and {b[0]}"
    coasted = sum(row[9] & 2 != 0 for row in rows)
    assert len(missing) - 4 <= coasted <= len(missing), (coasted, len(missing))


def make_thinned_test(filter_name):
    def check():
        compare_thinned(filter_name)
    check.__name__ = f"missing_samples_have_rows_on_chip_as_on_pc_{filter_name}"
    return check


for filter_kind in (DEFAULT, PLAIN, LIGHT):
    TESTS.append(make_thinned_test(filter_kind))


def check_true_rate(ppm):
    """From the second second on the sensor's clock is off: measured, handed to the filters, and no row shows it."""
    name = f"true-rate{ppm:+d}"
    rows, _, _, _ = simrun(name, STREAMS / "rest-2lsb.csv", "--fault", f"1000ms:odr:{ppm}", "--max-ms", "14000")
    late = [row for row in rows if row[0] > 1500000]
    assert len(late) >= 1150 and not any(row[9] & (2 | 16 | 64 | 128) for row in late), [row for row in late if row[9] & 210][:3]
    assert max(abs(b[7] - a[7]) for a, b in zip(late, late[1:])) <= 100
    period_us = 10000 / (1 + ppm * 1e-6)
    assert all(abs(b[0] - a[0] - period_us) <= 30 for a, b in zip(late, late[1:])), period_us


def make_true_rate_test(ppm):
    def check():
        check_true_rate(ppm)
    check.__name__ = f"rate_off_by_{ppm:+d}_ppm_is_taken_over_unseen".replace("+", "plus_").replace("-", "minus_")
    return check


for clock_ppm in (-50000, 50000):
    TESTS.append(make_true_rate_test(clock_ppm))


def after_the_gap(times_us):
    """Where the samples begin anew after `stop` and `go`."""
    return next(i for i in range(1, len(times_us)) if times_us[i] - times_us[i - 1] > 150000)


@test
def pipeline_of_chip_equals_pc_at_800_hz():
    """No filter leaves time for every row there: the PC takes the samples as the sensor served them, and every second one has a row. The
    first five rows are flagged whatever samples they hold."""
    rows, notes, served, _ = simrun("pipeline-800", STREAMS / "tilt-400hz.csv", "--cmd", "200:stop", "--cmd", "300:baud 1000000", "--cmd",
                                    "400:rate 800", "--cmd", "500:go", "--max-ms", "6000", "--loop", "--filter", LIGHT)
    assert "# rate 800 Hz, I2C at 400 kHz" in notes and "# every 2: the least for this filter" in notes, notes
    rows = rows[after_the_gap([row[0] for row in rows]):]
    skip = after_the_gap([int(one["t_us"]) for one in served])
    whole = OUT / "pipeline-800-served.csv"
    lines = [",".join(one[name] for name in ("t_us", "x_lsb", "y_lsb", "z_lsb")) for one in served]
    whole.write_text("\n".join(["t_us,x_lsb,y_lsb,z_lsb", *lines, ""]), encoding="ascii")
    done = run("build/host/pipeline_replay", whole, LIGHT, 8000, 16, skip)
    again = [[int(f) for f in line.split(",")] for line in done.stdout.splitlines()]
    flagged = [[*pc[1:9], pc[9] | (again[i - 1][9] if i else 0)] for i, pc in enumerate(again)]
    begin = 0 if rows[2][1:] == flagged[4] else 1  # the first row is of the first or of the second sample
    assert len(rows) > 2000
    for i, (chip, pc) in enumerate(zip(rows, flagged[begin::2])):
        pc[8] |= 128 if i < 5 else 0
        assert chip[1:] == pc, f"row {i}: chip {chip}, PC {pc}"
