"""Runs of the filters over streams by the firmware's own sample path on the PC (build/host/pipeline_replay), and what they are worth."""
import pathlib
import random
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

import make_streams
from results import Fault, output_of

REPLAY = "build/host/pipeline_replay"
STREAMS = pathlib.Path("sim/streams")
MADE = pathlib.Path("build/robust")  # streams made for one table only
RANGE_G = 16
ROW_COLUMNS = 10
FLAG_GATED, FLAG_COASTED, FLAG_REACQUIRED, FLAG_WARMING_UP = 1, 2, 4, 128
MG_PER_LSB = 1000.0 / np.array(make_streams.LSB_PER_G)
# roll grows undefined towards pitch 90: noise of the y axis counts 1 / cos(pitch) times, here 5.8 times at most
PITCH_LIMIT_CDEG = 8000
AXES = "xyz"

# The same shaking felt at two output data rates: bursts of 1 s, 1 s apart, each with its own phase and direction.
SHAKE_HZ = (30, 70, 100, 130, 200, 400)
SHAKE_RATES_HZ = (100, 400)
SHAKE_G, SHAKE_SECONDS, SHAKE_SEED = 100.0 / 256.0, 21.0, 400


@dataclass
class Stream:
    name: str
    path: pathlib.Path
    rate_dhz: int
    t_s: np.ndarray
    lsb: np.ndarray         # rows x 3
    truth_cdeg: np.ndarray  # rows x 2: roll, pitch


@dataclass
class Run:
    """What a filter made of a stream, row by row."""

    angles_cdeg: np.ndarray  # rows x 2: roll, pitch
    mg: np.ndarray           # rows x 3
    flags: np.ndarray


def filters():
    """The names of FILTER_LIST, in its order."""
    return output_of([REPLAY, "--filters"]).split()


def table_of(lines):
    """Rows of whole numbers; ValueError where one is cut or holds anything else."""
    lines = list(lines)
    return np.loadtxt(lines, delimiter=",", dtype=np.int64, ndmin=2) if lines else np.empty((0, ROW_COLUMNS), np.int64)


def load_stream(path):
    try:
        table = table_of(line for line in path.read_text(encoding="ascii").splitlines() if line[:1].isdigit())
    except (OSError, ValueError) as problem:
        raise Fault(f"{path}: cannot be read: {str(problem).splitlines()[0]}") from problem
    if len(table) < 2:
        raise Fault(f"{path}: {len(table)} rows, two at least are needed for the rate")
    if table.shape[1] < 6:
        raise Fault(f"{path}: {table.shape[1]} columns, {make_streams.HEADER} was expected")
    period_us = float(np.median(np.diff(table[:, 0])))
    if period_us <= 0.0:
        raise Fault(f"{path}: the time stands still")
    return Stream(path.stem, path, round(1e7 / period_us), table[:, 0] * 1e-6, table[:, 1:4], table[:, 4:6])


def shipped():
    """The shipped streams in the order in which their generator lists them."""
    return [load_stream(STREAMS / f"{scenario.name}.csv") for scenario in make_streams.SCENARIOS]


def replay(stream, name, changes=()):
    """The stream through the filter of this name; changes: NAME=VALUE, see host_tests/system/pipeline_replay.c."""
    text = output_of([REPLAY, stream.path, name, stream.rate_dhz, RANGE_G, 0, *changes])
    try:
        rows = table_of(text.splitlines())
    except ValueError as problem:
        raise Fault(f"{stream.path}: {REPLAY} prints a row that cannot be read: {str(problem).splitlines()[0]}") from problem
    rows = rows[rows[:, 9] & FLAG_COASTED == 0]  # predictions, in the stead of samples that are missing
    if rows.shape != (len(stream.lsb), ROW_COLUMNS):
        raise Fault(f"{stream.path}: {len(stream.lsb)} rows in, {rows.shape[0]} out")
    return Run(rows[:, 7:9], rows[:, 4:7], rows[:, 9])


def unfiltered(stream, flags):
    """The raw readings as if a filter had passed them; flags: of any run, for its warm-up."""
    mg = stream.lsb * MG_PER_LSB
    x, y, z = mg.T
    angles = np.degrees([np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))]).T * 100.0
    return Run(angles, mg, flags & FLAG_WARMING_UP)


def true_mg(stream):
    roll, pitch = np.radians(stream.truth_cdeg / 100.0).T
    return 1000.0 * np.array([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)]).T


def errors_cdeg(stream, run):
    """Roll and pitch less the truth, wrapped to -180..180 degrees."""
    return (run.angles_cdeg - stream.truth_cdeg + 18000) % 36000 - 18000


def rms(values):
    return float(np.sqrt(np.mean(np.square(values, dtype=float))))


def scores(stream, run):
    """Root mean square errors (degrees, mg), share of gated rows in per cent, re-acquisitions; rows of the warm-up do not count."""
    counts = (run.flags & FLAG_WARMING_UP) == 0
    roll_defined = counts & (np.abs(stream.truth_cdeg[:, 1]) <= PITCH_LIMIT_CDEG)
    angles, mg = errors_cdeg(stream, run) / 100.0, run.mg - true_mg(stream)
    result = {"roll": rms(angles[roll_defined, 0]), "pitch": rms(angles[counts, 1])}
    result.update({axis: rms(mg[counts, i]) for i, axis in enumerate(AXES)})
    result["gated"] = 100.0 * float(np.mean(run.flags[counts] & FLAG_GATED != 0))
    result["reacquired"] = int(np.sum(run.flags[counts] & FLAG_REACQUIRED != 0))
    return result


def in_parallel(function, jobs):
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(lambda job: function(*job), jobs))


# --- the same shaking at two rates ------------------------------------------------------------------------------------


def shake(samples, frequency_hz):
    """What shakes is drawn from the frequency alone, so that every output data rate feels the same."""
    rng = random.Random(SHAKE_SEED + frequency_hz)
    for begin_s in range(1, int(SHAKE_SECONDS), 2):
        phase, direction = rng.uniform(0.0, 2.0 * np.pi), make_streams.random_direction(rng)
        for sample in samples:
            t_s = sample.t_us * 1e-6
            if begin_s <= t_s < begin_s + 1.0:
                make_streams.add_force(sample, direction, SHAKE_G * np.sin(2.0 * np.pi * frequency_hz * t_s + phase))


def shaken(frequency_hz, rate_hz):
    """A stream of that shaking; its noise has one density: 2 LSB rms at 100 Hz, twice that at 400 Hz."""
    scenario = make_streams.Scenario(
        f"shake-{frequency_hz}hz-at-{rate_hz}hz", "shaking", make_streams.ATTITUDE, SHAKE_SEED, SHAKE_SECONDS,
        make_streams.noise(2.0 * (rate_hz / 100.0) ** 0.5), make_streams.slow_tilt, rate_hz=rate_hz,
        disturb=lambda samples, _rng: shake(samples, frequency_hz))
    MADE.mkdir(parents=True, exist_ok=True)
    path = MADE / f"{scenario.name}.csv"
    path.write_text(make_streams.make_stream(scenario)[0], encoding="ascii")
    return load_stream(path)
