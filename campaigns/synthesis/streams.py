"""Roll filtered as an angle, as paper 000 prints it, against axes filtered first and the angle taken from their estimates, on the shipped tilt
streams: in the open, near a pitch of 90 degrees and across a roll of 180."""
import math

import numpy as np

from . import batch
from .estimators import Shipping, shipped, synthesised

NAMES = ("tilt-slow", "tilt-fast", "tilt-400hz", "through-pitch-90", "through-roll-180")
DEGREE = math.acos(-1.0) / 180.0
LSB_PER_DEGREE = 256.0 * DEGREE  # near level, 256 LSB/g: so that a filter's q and R mean the same for both
Y_TO_Z = 256.0 / 265.0           # the streams' sensitivities, LSB/g
NOISE_LSB, Z_RATIO = 2.0, 1.3    # of the streams' x and y at 100 Hz; z has 1.3 times that
FEWEST = 20  # samples in a region

# of |roll| and |pitch|; at more than 89 degrees of pitch y and z together are below 4.5 LSB: there is no roll
REGIONS = {"open": lambda roll, pitch: (pitch < 60.0) & (roll < 150.0), "near_90": lambda roll, pitch: (pitch >= 75.0) & (pitch <= 89.0),
           "near_180": lambda roll, pitch: (roll > 170.0) & (pitch < 60.0), "all": lambda roll, pitch: pitch <= 89.0}


def read(name):
    """(rate in Hz, y, z in LSB, true roll, true pitch in degrees)"""
    path = batch.ROOT / "sim/streams" / f"{name}.csv"
    lines = [line for line in path.read_text(encoding="ascii").splitlines() if line[:1].isdigit()]
    times_us, _, y, z, roll, pitch = np.loadtxt(lines, delimiter=",").T
    return round(1e6 * (len(times_us) - 1) / (times_us[-1] - times_us[0])), Y_TO_Z * y, z, 0.01 * roll, 0.01 * pitch


def wrapped(angles):
    """To -180..180."""
    return np.array([math.remainder(angle, 360.0) for angle in angles])


def roll_of(y, z):
    return np.array([math.atan2(*pair) for pair in zip(y, z)]) / DEGREE


def unwrapped(angles):
    found = [angles[0]]
    for angle in angles:
        found.append(found[-1] + math.remainder(angle - found[-1], 360.0))
    return np.array(found[1:])


def tracks(stream, filters):
    """{way: the roll by it, sample by sample}; filters: of the angle, of y, of z."""
    _, y, z, _, _ = stream
    of_angle, of_y, of_z = ((lambda values, run=run: run(values[None])[0]) for run in filters)
    raw = roll_of(y, z)
    return {"angle": wrapped(of_angle(raw)), "angle_unwrapped": wrapped(of_angle(unwrapped(raw))), "axes": roll_of(of_y(y), of_z(z))}


def stream_rows(stream_name, stream, name, arithmetic, filters):
    """Root mean square of the wrapped difference in each region that has samples, without the first second."""
    rate_hz, _, _, roll, pitch = stream
    later = np.arange(len(roll)) >= rate_hz
    for way, track in tracks(stream, filters).items():
        square = np.square(wrapped(track - roll))
        for region, holds in REGIONS.items():
            chosen = square[later & holds(np.abs(roll), np.abs(pitch))]
            if len(chosen) >= FEWEST:
                yield f"roll_{stream_name}", name, arithmetic, f"rmse_{region}_{way}", math.sqrt(np.mean(chosen)), 1


def shipped_for(name, rate_hz):
    variance = NOISE_LSB * NOISE_LSB * rate_hz / 100.0
    of_axis = [Shipping(rate_hz, 1.0, r=r) for r in (variance, variance * (Z_RATIO * Z_RATIO))]
    of_angle = Shipping(rate_hz, LSB_PER_DEGREE, r=variance / (LSB_PER_DEGREE * LSB_PER_DEGREE))
    return [shipped(name, shipping) for shipping in (of_angle, *of_axis)]


def roll_as_angle(_options):
    in_double = {"unfiltered": lambda z: z, "synth(0:0.3)": synthesised(0.0, 0.3), "synth(-0.3:0.1)": synthesised(-0.3, 0.1)}
    for stream_name in NAMES:
        stream = read(stream_name)
        for name, estimator in in_double.items():
            yield from stream_rows(stream_name, stream, name, "double", [estimator] * 3)
        for name in batch.names():
            yield from stream_rows(stream_name, stream, name, "fixed", shipped_for(name, stream[0]))
