"""What the firmware does with sensors that resemble an ADXL345, by the scales of their data sheets; part of system_tests.py."""
import math
import random
import re

from system_support import FW, OUT, SIMRUN, run, simrun, test

# of the same identity: g per LSB and noise in mg rms at 100 Hz, as the data sheets have them (sim/model/adxl345_variants.c)
OTHER_SCALES = {"adxl375": (0.049, 35), "adxl314": (0.04883, 35), "adxl312": (0.0029, 3)}
# the firmware's own: full resolution of an ADXL345
BELIEVED_G = 1 / 256
END_S, STREAM_HZ, SETTLED_US = 6, 400, 3000000
WITHIN = ("--max-ms", 5900)  # of the stream
FLAG_NO_GRAVITY = 512


def at_rest(name, noise_mg, tilt=(0.0, 0.0, 1.0), end_s=END_S):
    """A stream of end_s: this direction of gravity, with noise. It is at the rate of a self-test, so that no reading comes twice."""
    dice, path = random.Random(name), OUT / f"{name}-rest.csv"
    with open(path, "w", encoding="ascii") as file:
        file.write("t_us,x_lsb,y_lsb,z_lsb\n")
        for i in range(end_s * STREAM_HZ):
            lsb = [round(256 * (g + dice.gauss(0, noise_mg / 1000))) for g in tilt]
            file.write(f"{i * 1000000 // STREAM_HZ},{lsb[0]},{lsb[1]},{lsb[2]}\n")
    return path


def selftest_verdicts(notes):
    return [note.split()[-1] for note in notes if re.match(r"# selftest [xyz] ", note)]


@test
def adxl343_is_an_adxl345():
    stream = at_rest("adxl343", 5, (0.3, -0.2, 0.93))
    outcomes = []
    for sensor in ("adxl345", "adxl343"):
        name = f"sensors-same-{sensor}"
        simrun(name, stream, "--sensor", sensor, "--cmd", "2000:selftest")
        outcomes.append([(OUT / f"{name}{kind}").read_bytes() for kind in (".csv", ".served.csv")])
    assert outcomes[0] == outcomes[1] and outcomes[0][0].count(b"pass") == 3


@test
def sensor_of_another_identity_is_refused_by_its_name():
    stream = at_rest("refused", 5)
    for sensor, devid in (("adxl344", "E6"), ("adxl346", "E6"), ("adxl313", "AD")):
        rows, notes, served, stats = simrun("sensors-refused", stream, "--sensor", sensor, "--max-ms", 400, judge=False)
        assert not served and stats["sensor"] == sensor, served
        assert notes.count(f"# fault 2: no ADXL345 at 0x53: DEVID 0x{devid}, not 0xE5") == 1, notes
        assert not any(note.startswith("# sensor: ") for note in notes), notes
        # what comes are rows of a sensor that is gone: no acceleration, and flags that say so
        assert all(row[1:7] == [0] * 6 and row[9] & 2 for row in rows), rows


@test
def other_sensor_is_refused_again_after_a_fault_of_its_identity():
    """What the fault leaves behind is the identity of the sensor that is there."""
    stream = at_rest("refused", 5)
    for sensor, refused in (("adxl346", True), ("adxl345", False)):
        _, notes, served, _ = simrun("sensors-devid", stream, "--sensor", sensor, "--fault", "0ms:devid:1:50", "--max-ms", 2000, judge=False)
        assert any(note.startswith("# fault 2 over: ") for note in notes) is bool(served) is not refused, notes


@test
def sensor_of_the_same_identity_and_another_scale_is_believed_and_flagged():
    """Each is taken for an ADXL345 at first. Accelerations are wrong by the ratio of the scales; flag 512 says that it is no gravity."""
    for sensor, (g_per_lsb, noise_mg) in OTHER_SCALES.items():
        rows, notes, _, _ = simrun(f"sensors-{sensor}", at_rest(sensor, noise_mg), "--sensor", sensor, *WITHIN)
        assert "# sensor: ADXL345 at 0x53, I2C at 363.6 kHz" in notes and not any(note.startswith("# fault") for note in notes), notes
        settled = [row for row in rows if row[0] > SETTLED_US]
        mean_mg = sum(row[6] for row in settled) / len(settled)
        wanted_mg = 1000 * BELIEVED_G / g_per_lsb
        print(f"    {sensor}: 1 g reads {mean_mg:.1f} mg, by the scales {wanted_mg:.1f}")
        assert abs(mean_mg - wanted_mg) < 0.02 * wanted_mg, (sensor, mean_mg, wanted_mg)
        assert len(settled) > 280 and all(row[9] & FLAG_NO_GRAVITY for row in settled), [row for row in settled if not row[9] & FLAG_NO_GRAVITY][:3]


NAMED_S, FAULT_14, OVER_14 = 15, "# fault 14: not an ADXL345, or offsets beyond its data sheet: cal6", "# fault 14 over: after "
COARSE = {name: noise_mg for name, (g_per_lsb, noise_mg) in OTHER_SCALES.items() if g_per_lsb > 0.02}


def faults(notes):
    return [note for note in notes if note.startswith("# fault")]


def typed(*commands):
    return [word for at_ms, text in commands for word in ("--cmd", f"{at_ms}:{text}")]


@test
def sensor_of_200_g_is_named_within_15_s_at_rest():
    for sensor, noise_mg in COARSE.items():
        stream = at_rest(f"named-{sensor}", noise_mg, end_s=NAMED_S + 1)
        for rate in ("12.5", "100", "400"):
            _, notes, _, _ = simrun(f"sensors-named-{sensor}", stream, "--sensor", sensor, "--rate", rate, "--baud", "500000",
                                        "--max-ms", 1000 * NAMED_S, *typed((1000 * NAMED_S - 800, "status")))
            assert faults(notes) == [FAULT_14] and any(", fault 14, " in note for note in notes), (sensor, rate, notes)


@test
def sensor_that_reads_as_an_adxl345_may_is_not_named():
    """An ADXL312 at 1.35 g; the limits of the data sheet (p. 3): 250 mg on z, 150 mg on x and y, 10 % of scale."""
    tested = [("adxl312", (0, 0, 1), (0, 0, 0), 1.0, "100")]
    for sign in (1, -1):
        for offset_lsb in (64, -64):
            tested += [("adxl345", (0, 0, sign), (0, 0, offset_lsb), 1.1 if sign * offset_lsb > 0 else 0.9, rate) for rate in ("12.5", "100", "800")]
        tested += [("adxl343", (sign, 0, 0), (38 * sign, -38, 50), 1.1, "100"), ("adxl345", (0, sign, 0), (38, -38 * sign, -50), 0.9, "400")]
    for number, (sensor, tilt, offset_lsb, gain, rate) in enumerate(tested):
        part = f"offset={','.join(map(str, offset_lsb))} gain={gain},{gain},{gain}"
        stream = at_rest(f"sound-{number}", 5, tilt, end_s=NAMED_S + 1)
        _, notes, _, _ = simrun(f"sensors-sound-{number}", stream, "--sensor", sensor, "--part", part, "--rate", rate, "--baud", "500000",
                                "--every", "8" if rate == "800" else "1", "--max-ms", 1000 * NAMED_S, judge=False)
        assert not faults(notes), (sensor, tilt, part, rate, notes)


@test
def outages_of_a_sound_sensor_do_not_name_it():
    """Unplugged, without supply, frozen: what is held or repeated meanwhile is not counted."""
    stream = at_rest("outages", 5, end_s=61)
    for kind, last_ms in (("unplug", 15000), ("power", 1), ("frozen", 15000), ("sda", 15000)):
        words = [word for at_ms in (2000, 19500, 37200) for word in ("--fault", f"{at_ms}ms:{kind}:{last_ms}")]
        _, notes, _, _ = simrun(f"sensors-outages-{kind}", stream, *words, "--max-ms", 60000, judge=False)
        assert not any("fault 14" in note for note in notes) and len(faults(notes)) >= 6, (kind, notes)


@test
def other_faults_begin_and_end_while_fault_14_lasts():
    stream = at_rest("beside", COARSE["adxl375"], end_s=24)
    _, notes, _, _ = simrun("sensors-beside", stream, "--sensor", "adxl375", "--fault", "13000ms:unplug:500", "--fault", "16000ms:noint:500",
                            *typed((13300, "status"), (20000, "selftest"), (22500, "status")), "--max-ms", 23500, judge=False)
    begun = [note.split(":")[0] for note in faults(notes)]
    assert begun == ["# fault 14", "# fault 1", "# fault 1 over", "# fault 5", "# fault 5 over"], notes
    shown = [re.search(r", fault (\d+), ", note)[1] for note in notes if ", fault " in note]
    assert shown == ["1", "14"] and selftest_verdicts(notes) == ["FAIL", "FAIL", "pass"], notes


@test
def stop_and_go_leave_fault_14_as_it_is():
    stream = at_rest("stopped", COARSE["adxl314"], end_s=41)
    _, notes, _, _ = simrun("sensors-stopped", stream, "--sensor", "adxl314", *typed((13000, "stop"), (20000, "status"), (24000, "go")),
                            "--max-ms", 40000, judge=False)
    assert faults(notes) == [FAULT_14] and any(", fault 14, " in note for note in notes), notes


@test
def plot_has_no_line_of_fault_14():
    stream = at_rest("plotted", COARSE["adxl375"], end_s=21)
    _, notes, _, _ = simrun("sensors-plotted", stream, "--sensor", "adxl375", *typed((1000, "mode plot"), (18000, "mode csv")),
                            "--max-ms", 20000, judge=False)
    csv_again = len(notes) - 1 - notes[::-1].index(next(note for note in notes if note.startswith("t_us,")))
    assert faults(notes) == [FAULT_14] and notes.index(FAULT_14) > csv_again, notes


@test
def fault_14_ends_when_the_readings_are_those_of_gravity():
    """As with a sensor that was changed: 0.08 g, then 1 g."""
    path = at_rest("ends", 5, end_s=20)
    lines = path.read_text(encoding="ascii").splitlines()
    for i in range(1, 14 * STREAM_HZ):
        t_us, x, y, z = lines[i].split(",")
        lines[i] = f"{t_us},{x},{y},{int(z) - 236}"
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    _, notes, _, _ = simrun("sensors-ends", path, "--max-ms", 19000)
    begun, over = faults(notes)
    assert begun == FAULT_14 and re.fullmatch(OVER_14 + r"[45]000 ms, 0 lost, sensor at 0x53", over), notes


@test
def tilt_of_a_sensor_of_another_scale_is_right_within_its_resolution():
    """An angle is a ratio. A reading of 20 LSB has steps of 2.8 degrees, which noise and the filter smooth."""
    pitch_deg, roll_deg = 30.0, 15.0
    level = math.cos(math.radians(pitch_deg))
    gravity = (-math.sin(math.radians(pitch_deg)), level * math.sin(math.radians(roll_deg)), level * math.cos(math.radians(roll_deg)))
    at_3v3 = (265 / 256, 265 / 256, 1)  # what the firmware takes for granted of x and y (data sheet, p. 33)
    part = ("--part", "gain=" + ",".join(f"{gain:.5f}" for gain in at_3v3))
    for sensor, (_, noise_mg) in OTHER_SCALES.items():
        rows, _, _, _ = simrun(f"sensors-tilt-{sensor}", at_rest(f"tilt-{sensor}", noise_mg, gravity), "--sensor", sensor, *part, *WITHIN)
        settled = [row for row in rows if row[0] > SETTLED_US]
        roll, pitch = (sum(row[column] for row in settled) / len(settled) / 100 for column in (7, 8))
        print(f"    {sensor}: roll {roll:.2f}, pitch {pitch:.2f} degrees of {roll_deg:.0f} and {pitch_deg:.0f}")
        bound = 0.3 if sensor == "adxl312" else 2.0
        assert abs(roll - roll_deg) < bound and abs(pitch - pitch_deg) < bound, (sensor, roll, pitch)


@test
def selftest_fails_those_of_200_g_and_passes_an_adxl312():
    """Limits at 3.3 V: 88.5 to 955.8 LSB on x and y, 110.25 to 1286.25 on z."""
    for sensor, verdicts in (("adxl375", "FAIL FAIL pass"), ("adxl314", "FAIL FAIL FAIL"), ("adxl312", "pass pass pass")):
        _, notes, _, _ = simrun(f"sensors-selftest-{sensor}", at_rest(f"selftest-{sensor}", OTHER_SCALES[sensor][1]), "--sensor", sensor,
                                "--cmd", "1000:selftest")
        assert selftest_verdicts(notes) == verdicts.split(), (sensor, notes)


@test
def sensor_and_part_add_up_in_either_order():
    stream = at_rest("part", 5)
    part, named = ("--part", "gain=1,1,1.1 selftest=200,-200,300"), ("--sensor", "adxl312")
    served = [simrun(f"sensors-part-{i}", stream, *options, "--max-ms", 500)[2] for i, options in enumerate(((*part, *named), (*named, *part)))]
    assert served[0] == served[1]
    mean = sum(int(sample["z_lsb"]) for sample in served[0]) / len(served[0])
    assert abs(mean - 1.1 / 0.0029) < 3, mean
    _, notes, _, _ = simrun("sensors-part", stream, *part, *named, "--cmd", "1000:selftest")
    values = [float(note.split()[3]) for note in notes if re.match(r"# selftest [xyz] ", note)]
    assert all(abs(told - wanted) < 1 for told, wanted in zip(values, (200, 200, 300))), notes


@test
def unknown_sensor_is_refused_with_the_names():
    done = run(SIMRUN, "--fw", FW, "--in", at_rest("unknown", 5), "--out", OUT / "x.csv", "--sensor", "ADXL345", expect=2)
    names = done.stderr.partition("is none of ")[2].partition(" (")[0].split(", ")
    assert len(done.stderr.splitlines()) == 1 and {"adxl345", "adxl343", "adxl346", "adxl375", "adxl312", "adxl314"} <= set(names), done.stderr
    told = run(SIMRUN, "--help").stdout
    assert all(name in told for name in names), names
