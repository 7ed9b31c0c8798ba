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


def at_rest(name, noise_mg, tilt=(0.0, 0.0, 1.0)):
    """A stream of END_S: this direction of gravity, with noise. It is at the rate of a self-test, so that no reading comes twice."""
    dice, path = random.Random(name), OUT / f"{name}-rest.csv"
    with open(path, "w", encoding="ascii") as file:
        file.write("t_us,x_lsb,y_lsb,z_lsb\n")
        for i in range(END_S * STREAM_HZ):
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
    """Each is taken for an ADXL345 without a fault. Accelerations are wrong by the ratio of the scales; flag 512 says that it is no gravity."""
    for sensor, (g_per_lsb, noise_mg) in OTHER_SCALES.items():
        rows, notes, _, _ = simrun(f"sensors-{sensor}", at_rest(sensor, noise_mg), "--sensor", sensor, *WITHIN)
        assert "# sensor: ADXL345 at 0x53, I2C at 363.6 kHz" in notes and not any(note.startswith("# fault") for note in notes), notes
        settled = [row for row in rows if row[0] > SETTLED_US]
        mean_mg = sum(row[6] for row in settled) / len(settled)
        wanted_mg = 1000 * BELIEVED_G / g_per_lsb
        print(f"    {sensor}: 1 g reads {mean_mg:.1f} mg, by the scales {wanted_mg:.1f}")
        assert abs(mean_mg - wanted_mg) < 0.02 * wanted_mg, (sensor, mean_mg, wanted_mg)
        assert len(settled) > 280 and all(row[9] & FLAG_NO_GRAVITY for row in settled), [row for row in settled if not row[9] & FLAG_NO_GRAVITY][:3]


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
