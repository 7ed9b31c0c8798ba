#!/usr/bin/env python3
"""Makes the shipped accelerometer streams of sim/streams, byte for byte the same every time.

    python3 tools/make_streams.py            writes sim/streams/*.csv and their README.md
    python3 tools/make_streams.py --check    compares them with what would be written; exit 1 names each difference

Model: an ADXL345 in full resolution that rotates about its own centre, so it feels gravity and what a scenario adds:

    x = -sin(pitch)    y = cos(pitch) sin(roll)    z = cos(pitch) cos(roll)    in g
    roll = atan2(y, z)   pitch = atan2(-x, |(y, z)|)

Read with the sensitivities typical at 3.3 V (data sheet Rev. E, p. 33), white Gaussian noise per axis, rounded to
integers and clamped to the 13-bit rails. The truth columns are the angles of the noise-free attitude, whatever else
shakes the sensor. Noise is Box-Muller on random.Random(seed).random(), whose sequence Python guarantees.
"""
import argparse
import math
import pathlib
import random
import sys
from dataclasses import dataclass, field
from typing import Callable

LSB_PER_G = (265.0, 265.0, 256.0)
RAIL_LOW_LSB, RAIL_HIGH_LSB = -4096, 4095
Z_NOISE_RATIO = 1.3  # z is the noisier axis (data sheet Rev. E, p. 4: 1.1 to 0.75 LSB typical)
MAX_FILE_BYTES = 300_000
COMMAND = "python3 tools/make_streams.py"
HEADER = "t_us,x_lsb,y_lsb,z_lsb,roll_true_cdeg,pitch_true_cdeg"
STEPS_DEG, STEP_HOLD_S = (0.5, 2.0, 10.0, 45.0), 3.0
DEFAULT_FOLDER = pathlib.Path(__file__).resolve().parent.parent / "sim" / "streams"


@dataclass
class Sample:
    """One reading being made: noise-free force and noise in LSB as floats, then the integers to write."""

    t_us: int
    roll_deg: float
    pitch_deg: float
    force_g: list
    noise_lsb: list
    lsb: list = field(default_factory=list)


@dataclass
class Scenario:
    """A stream to make: `disturb` changes forces and noise before rounding, `misread` readings and rows after it."""

    name: str
    what: str
    truth: str
    seed: int
    seconds: float
    noise_lsb: tuple
    attitude: Callable
    rate_hz: int = 100
    jitter_us: int = 0
    disturb: Callable = lambda samples, rng: None
    misread: Callable = lambda samples, rng: samples


# --- arithmetic -------------------------------------------------------------------------------------------------------


def gaussian(rng):
    """One standard normal number (Box-Muller; 1 - u keeps the logarithm's argument above 0)."""
    radius = math.sqrt(-2.0 * math.log(1.0 - rng.random()))
    return radius * math.cos(2.0 * math.pi * rng.random())


def round_half_up(value):
    return math.floor(value + 0.5)


def gravity_g(roll_deg, pitch_deg):
    """The force at rest in this attitude; pitch may exceed 90 degrees."""
    roll, pitch = math.radians(roll_deg), math.radians(pitch_deg)
    return [-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll)]


def to_lsb(force_g):
    return [f * lsb for f, lsb in zip(force_g, LSB_PER_G)]


def truth_cdeg(roll_deg, pitch_deg):
    """Roll in -17999..18000 and pitch in -9000..9000 as the firmware defines them, from any attitude."""
    x, y, z = gravity_g(roll_deg, pitch_deg)
    roll = round_half_up(100.0 * math.degrees(math.atan2(y, z)))
    pitch = round_half_up(100.0 * math.degrees(math.atan2(-x, math.hypot(y, z))))
    return (18000 if roll == -18000 else roll), pitch


def minimum_jerk(u):
    """0 to 1 with no step in rate or acceleration; peak rate 15/8 of the mean, peak acceleration 5.77 / T^2."""
    u = min(max(u, 0.0), 1.0)
    return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)


def through(points, t):
    """Value at t of a path through (time, value) points with a minimum-jerk move between each two."""
    for (t0, v0), (t1, v1) in zip(points, points[1:]):
        if t < t1:
            return v0 + (v1 - v0) * minimum_jerk((t - t0) / (t1 - t0))
    return points[-1][1]


# --- attitudes: seconds -> (roll, pitch) in degrees -------------------------------------------------------------------


def lying(_t):
    return 12.0, -7.0


def slow_tilt(t):
    """Roll +-30 degrees at 0.05 Hz, pitch +-20 degrees at 0.03 Hz: at most 9.4 degrees/s."""
    return 30.0 * math.sin(2.0 * math.pi * 0.05 * t), 20.0 * math.sin(2.0 * math.pi * 0.03 * t)


def uav_roll(still_s):
    """Still, 5 s of rolling to +-45 degrees (77 degrees/s, 142 degrees/s^2 at most) with some pitch, still again."""
    roll = [(0.0, 0.0), (still_s, 0.0), (still_s + 1.35, 45.0), (still_s + 3.55, -45.0), (still_s + 5.0, 0.0)]
    pitch = [(0.0, 3.0), (still_s, 3.0), (still_s + 2.5, 11.0), (still_s + 5.0, 3.0)]
    return lambda t: (through(roll, t), through(pitch, t))


def over_the_top(t):
    """Turned about y from 0 over 90 to 180 degrees, held, and back: 28 degrees/s at most."""
    return 10.0, through([(0.0, 0.0), (2.0, 0.0), (14.0, 180.0), (18.0, 180.0), (30.0, 0.0), (32.0, 0.0)], t)


def around_the_back(t):
    """Rolled from 0 to 180, held on the seam for 4 s, on to 360, then back in one move: 85 degrees/s at most."""
    return through([(0.0, 0.0), (2.0, 0.0), (8.0, 180.0), (12.0, 180.0), (18.0, 360.0), (20.0, 360.0), (28.0, 0.0),
                    (30.0, 0.0)], t), 5.0


def stepping(t):
    """From rest to 0.5, 2, 10 and 45 degrees of roll and back, then of pitch; every step from one sample to the next."""
    piece = int(t / STEP_HOLD_S + 1e-6)
    step = STEPS_DEG[piece // 2 % len(STEPS_DEG)] if piece % 2 else 0.0
    roll, pitch = lying(t)
    return (roll + step, pitch) if piece < 2 * len(STEPS_DEG) else (roll, pitch + step)


# --- what shakes the sensor (before rounding) -------------------------------------------------------------------------


def random_direction(rng):
    vector = [gaussian(rng) for _ in range(3)]
    length = math.sqrt(sum(v * v for v in vector))
    return [v / length for v in vector]


def add_force(sample, direction, size_g):
    sample.force_g = [f + size_g * d for f, d in zip(sample.force_g, direction)]


def outliers(samples, rng):
    """Each axis of each sample has, with probability 0.15, noise 20 times larger."""
    for sample in samples:
        sample.noise_lsb = [n * (20.0 if rng.random() < 0.15 else 1.0) for n in sample.noise_lsb]


def vibration_bursts(samples, rng):
    """Sine bursts of 20..150 ms every 0.3..1.5 s: 30..500 / 256 g (log-uniform), 20..45 Hz, any direction and phase."""
    end_us = samples[-1].t_us
    begin_us = 2_000_000
    while begin_us < end_us:
        length_us = rng.uniform(20e3, 150e3)
        size_g = 30.0 / 256.0 * (500.0 / 30.0) ** rng.random()
        turn_per_us = 2.0 * math.pi * rng.uniform(20.0, 45.0) * 1e-6
        phase, direction = rng.uniform(0.0, 2.0 * math.pi), random_direction(rng)
        for sample in samples:
            if begin_us <= sample.t_us < begin_us + length_us:
                add_force(sample, direction, size_g * math.sin(turn_per_us * (sample.t_us - begin_us) + phase))
        begin_us += length_us + rng.uniform(0.3e6, 1.5e6)


def shocks(samples, rng):
    """Half-sine shocks of 20..50 ms and 20..30 g every 1..3 s, mostly along one axis: clipped at 16 g."""
    end_us = samples[-1].t_us
    begin_us = 2_000_000
    while begin_us < end_us:
        length_us, size_g = rng.uniform(20e3, 50e3), rng.uniform(20.0, 30.0)
        direction = [0.2 * gaussian(rng) for _ in range(3)]
        direction[rng.randrange(3)] = rng.choice((-1.0, 1.0))
        for sample in samples:
            if begin_us <= sample.t_us < begin_us + length_us:
                add_force(sample, direction, size_g * math.sin(math.pi * (sample.t_us - begin_us) / length_us))
        begin_us += rng.uniform(1e6, 3e6)


def drops(samples, _rng):
    """Two drops of 1 s with the attitude held: no force at all, then 60 ms of 6 g where gravity is felt, then rest."""
    for sample in samples:
        for begin_us in (6_000_000, 16_000_000):
            since_us = sample.t_us - begin_us
            if 0 <= since_us < 1_000_000:
                sample.force_g = [0.0, 0.0, 0.0]
            elif 1_000_000 <= since_us < 1_060_000:
                sample.force_g = [6.0 * f for f in sample.force_g]


def sideways(samples, _rng):
    """0.5 g along the board's y axis for 3 s (from 8 s), with 0.2 s to rise and to fall."""
    rise = [(0.0, 0.0), (8.0, 0.0), (8.2, 1.0), (11.0, 1.0), (11.2, 0.0)]
    for sample in samples:
        add_force(sample, (0.0, 1.0, 0.0), 0.5 * through(rise, sample.t_us * 1e-6))


# --- what goes wrong on the bus (after rounding) ----------------------------------------------------------------------


def doubled_axis(lsb, rng):
    axis = rng.randrange(3)
    return [2 * v if i == axis else v for i, v in enumerate(lsb)]


def bad_reads(samples, rng):
    """About 1 % single bad reads, the three kinds alike: 0,0,0; one axis doubled; -1,-1,-1. Never two in a row."""
    kinds = (lambda lsb: [0, 0, 0], lambda lsb: doubled_axis(lsb, rng), lambda lsb: [-1, -1, -1])
    last_was_bad = False
    for sample in samples:
        last_was_bad = not last_was_bad and rng.random() < 0.01
        if last_was_bad:
            sample.lsb = rng.choice(kinds)(sample.lsb)
    return samples


def missing_stretches(samples, rng):
    """Rows of a stretch of 30 ms..1 s (log-uniform) are dropped, then 1..4 s go well."""
    kept, begin_us, end_us = [], 3_000_000.0, 0.0
    for sample in samples:
        if sample.t_us >= begin_us:
            end_us = begin_us + 30e3 * (1000.0 / 30.0) ** rng.random()
            begin_us = end_us + rng.uniform(1e6, 4e6)
        if sample.t_us >= end_us:
            kept.append(sample)
    return kept


# --- the list ---------------------------------------------------------------------------------------------------------


def noise(xy_lsb):
    return xy_lsb, xy_lsb, Z_NOISE_RATIO * xy_lsb


def rest(rms_lsb, seed):
    return Scenario(f"rest-{rms_lsb:g}lsb", f"{LYING}; white noise of {rms_lsb:g} LSB rms on each axis", ATTITUDE,
                    seed, 60.0, (rms_lsb,) * 3, lying)


ATTITUDE = "the attitude"
LYING = "lying at roll 12, pitch -7 degrees"
SLOW = "roll +-30 degrees at 0.05 Hz, pitch +-20 degrees at 0.03 Hz"
UAV = "still, 5 s rolling to +-45 degrees (77 degrees/s, 142 degrees/s^2 at most) with 8 degrees of pitch, still"
STEPS = "at roll 12, pitch -7 degrees; steps of 0.5, 2, 10, 45 degrees in roll, then in pitch, 3 s there, 3 s back"
SCENARIOS = (
    rest(0.7, 1), rest(2, 2), rest(4, 3), rest(8, 4),
    Scenario("tilt-slow", SLOW, ATTITUDE, 5, 60.0, noise(2.0), slow_tilt),
    Scenario("tilt-fast", f"UAV roll: 5 s {UAV} for 5 s", ATTITUDE, 6, 15.0, noise(2.0), uav_roll(5.0)),
    Scenario("tilt-400hz", f"UAV roll at 400 Hz: 2.5 s {UAV} for 2.5 s; noise density as tilt-fast", ATTITUDE, 7,
             10.0, noise(4.0), uav_roll(2.5), rate_hz=400),
    Scenario("through-pitch-90",
             "turned about y from 0 over 90 to 180 degrees and back (28 degrees/s at most), roll 10",
             "atan2 of the noise-free vector: pitch folds back at 90 and roll, undefined there, flips by 180",
             8, 32.0, noise(2.0), over_the_top),
    Scenario("through-roll-180",
             "rolled from 0 to 180, held there 4 s, on to 360, back (85 degrees/s at most), pitch 5",
             "the attitude, roll wrapped to -180 < roll <= 180: compare wrapped differences",
             9, 30.0, noise(2.0), around_the_back),
    Scenario("outliers-15pct", f"{SLOW}; 4 LSB rms, each axis of each sample 20 times that with probability 0.15",
             ATTITUDE, 10, 60.0, (4.0,) * 3, slow_tilt, disturb=outliers),
    Scenario("vibration", f"{SLOW}; bursts of 20..150 ms, 30..500 LSB, 20..45 Hz every 0.3..1.5 s",
             "the attitude, not the shaking", 11, 60.0, noise(2.0), slow_tilt, disturb=vibration_bursts),
    Scenario("bad-reads", f"{SLOW}; about 1 % single bad reads: 0,0,0 or one axis doubled or -1,-1,-1", ATTITUDE, 12,
             60.0, noise(2.0), slow_tilt, misread=bad_reads),
    Scenario("clipping", f"{SLOW}; shocks of 20..50 ms and 20..30 g every 1..3 s, clipped at the 16 g rails",
             "the attitude, not the shocks", 13, 60.0, noise(2.0), slow_tilt, disturb=shocks),
    Scenario("free-fall", f"{LYING}; drops of 1 s (no force at all) at 6 s and 16 s, each ended by 60 ms of 6 g",
             "the attitude, held through the drop (the sensor cannot know it)", 14, 26.0, noise(2.0), lying, disturb=drops),
    Scenario("sideways-0.5g", f"{LYING}; 0.5 g along y for 3 s from 8 s (0.2 s to rise and to fall)",
             "the real tilt: no accelerometer can tell it from the acceleration", 15, 20.0, noise(2.0), lying, disturb=sideways),
    Scenario("gaps-jitter", f"{SLOW}; t_us off the grid by up to +-1 ms, stretches of 30 ms..1 s missing every 1..4 s",
             "the attitude at the row's t_us", 16, 60.0, noise(2.0), slow_tilt, jitter_us=1000, misread=missing_stretches),
    Scenario("steps", STEPS, ATTITUDE, 17, 51.0, noise(2.0), stepping),
    Scenario("steps-outliers", f"{STEPS}; each axis of each sample 20 times the noise with probability 0.15",
             ATTITUDE, 18, 51.0, noise(2.0), stepping, disturb=outliers),
)


# --- making and writing -----------------------------------------------------------------------------------------------


def make_samples(scenario, rng):
    """The scenario's samples up to the noise, before rounding. The first is at t_us 0."""
    samples = []
    for i in range(round(scenario.seconds * scenario.rate_hz)):
        t_us = i * 1_000_000 // scenario.rate_hz
        if scenario.jitter_us and i:
            t_us += rng.randint(-scenario.jitter_us, scenario.jitter_us)
        roll, pitch = scenario.attitude(t_us * 1e-6)
        noise_lsb = [sigma * gaussian(rng) for sigma in scenario.noise_lsb]
        samples.append(Sample(t_us, roll, pitch, gravity_g(roll, pitch), noise_lsb))
    return samples


def quantise(sample):
    analog = [f + n for f, n in zip(to_lsb(sample.force_g), sample.noise_lsb)]
    sample.lsb = [min(max(round_half_up(value), RAIL_LOW_LSB), RAIL_HIGH_LSB) for value in analog]


def make_stream(scenario):
    """(text of the CSV file, number of rows)."""
    rng = random.Random(scenario.seed)
    samples = make_samples(scenario, rng)
    scenario.disturb(samples, rng)
    for sample in samples:
        quantise(sample)
    samples = scenario.misread(samples, rng)
    lines = [f"# {scenario.name}: {scenario.what}",
             f"# truth: {scenario.truth}",
             f"# noise rms before rounding (LSB): {noise_text(scenario)}; x, y 265, z 256 LSB/g, {scenario.rate_hz} Hz",
             f"# made by: {COMMAND} (seed {scenario.seed}); do not edit",
             HEADER]
    for s in samples:
        roll, pitch = truth_cdeg(s.roll_deg, s.pitch_deg)
        lines.append(f"{s.t_us},{s.lsb[0]},{s.lsb[1]},{s.lsb[2]},{roll},{pitch}")
    return "\n".join(lines) + "\n", len(samples)


def noise_text(scenario):
    return ", ".join(f"{axis} {sigma:g}" for axis, sigma in zip("xyz", scenario.noise_lsb))


def make_readme(rows_of):
    lines = ["# Shipped streams", "",
             f"Made by `{COMMAND}` (fixed seeds; `--check` compares). Columns",
             f"`{HEADER}`: time in microseconds, readings",
             "in LSB (13 bit; 265 per g on x and y, 256 on z: typical at 3.3 V, data sheet Rev. E, p. 33), true roll and pitch in",
             "0.01 degree. Lines beginning with `#` say what a file is. Noise is white and Gaussian, rms in LSB before rounding, which adds",
             "1/12 to the variance; a second number is z's. Real sensors differ: coloured noise, outliers that are not Gaussian.", "",
             "| file | s | Hz | rows | noise x y, z | seed | what | truth |", "|---|---|---|---|---|---|---|---|"]
    for s in SCENARIOS:
        levels = ", ".join(f"{sigma:g}" for sigma in sorted(set(s.noise_lsb)))
        lines.append(f"| [{s.name}.csv]({s.name}.csv) | {s.seconds:g} | {s.rate_hz} | {rows_of[s.name]} | {levels} | "
                     f"{s.seed} | {s.what} | {s.truth} |")
    return "\n".join(lines) + "\n"


def make_all():
    """{file name: bytes} of everything in the folder."""
    files, rows_of = {}, {}
    for scenario in SCENARIOS:
        text, rows_of[scenario.name] = make_stream(scenario)
        files[scenario.name + ".csv"] = text.encode("ascii")
        if len(text) > MAX_FILE_BYTES:
            raise ValueError(f"{scenario.name}: {len(text)} bytes, more than {MAX_FILE_BYTES}")
    files["README.md"] = make_readme(rows_of).encode("ascii")
    return files


def check(folder, files):
    """Prints every file that is missing, extra or different; returns their number."""
    complaints = []
    for name, data in files.items():
        path = folder / name
        if not path.is_file():
            complaints.append(f"{path}: missing")
        elif path.read_bytes() != data:
            complaints.append(f"{path}: differs from what {COMMAND} writes")
    extra = sorted(p for p in folder.glob("*.csv") if p.name not in files)
    complaints += [f"{p}: not made by this generator" for p in extra]
    for complaint in complaints:
        print(f"make_streams: {complaint}", file=sys.stderr)
    return len(complaints)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare instead of writing; exit 1 if a file differs")
    parser.add_argument("--dir", type=pathlib.Path, default=DEFAULT_FOLDER, help="folder (default: sim/streams)")
    arguments = parser.parse_args()
    files = make_all()
    if arguments.check:
        if check(arguments.dir, files):
            return 1
        print(f"make_streams: {len(files)} files in {arguments.dir} are as generated")
        return 0
    arguments.dir.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        (arguments.dir / name).write_bytes(data)
        print(f"{arguments.dir / name}: {len(data)} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
