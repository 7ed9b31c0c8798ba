"""What is compared: ours as the firmware runs them (noise estimate, defaults), and the peers of host_tests/support, one axis at a time; Fusion, which
takes three, where PEERS has it. Samples and estimates are in LSB, runs x samples."""
import ctypes
import functools
import pathlib
from ctypes import c_double

import numpy as np
from figures_traces import library
from laws import DEFAULT, PLAIN
from resilience.filters import ENTRIES, MERGED
from synthesis import batch
from synthesis.batch import pointer

FUSION, FUSION_LIBRARY = "fusion", pathlib.Path("build/papers/libfusion.so")
# of ours the default, the two that come back, the one that merges, and the Kalman filter
RETURNING = tuple(name for name, entry in ENTRIES.items() if entry.reacquire)
OURS = (DEFAULT, *RETURNING, MERGED, PLAIN)
PEERS = ("ema", "median3_ema", "median5_ema", "hampel7_ema", "one_euro")  # in the order of peers.h
WEIGHED = ("huber", "student_t", "correntropy", "imm3")                   # and of robust_peers.h
NAMES = (*OURS, *PEERS, *WEIGHED)
OF_PAPER = {"one_gate": "own_gates", "eq11": "alone"}                     # of paper_axes.h, and what each is but for that
WORDS = {"ema": "EMA, 4 Hz", "median3_ema": "median of 3 + EMA", "median5_ema": "median of 5 + EMA", "hampel7_ema": "Hampel of 7 + EMA",
         "one_euro": "1-euro", "huber": "Huber Kalman filter", "student_t": "Student's t Kalman filter",
         "correntropy": "maximum correntropy Kalman filter",
         "one_gate": "one gate over three axes", "own_gates": "a gate for each axis", "eq11": "mixture by (11)", "alone": "mixture without (11)",
         "imm3": "IMM of three",
         FUSION: "Fusion, accelerometer alone", "raw": "no filter"}
START_LSB_S = 200.0  # of the rate, as kalman.c
FLOOR_LSB2 = 1.5 * 0.02  # R of the data sheet by the rate in Hz, as noise.c
NOISE = 1.5              # and how many times the variance the estimator gives


def words(name):
    return WORDS.get(name, f"`{name}`")


def kalman_variances(rate_hz, variance_lsb2):
    """R, growth of the rate in a sample and variance of the rate at the start, as kf has them by default."""
    q = batch.default_of(PLAIN, round(10 * rate_hz), "q") / rate_hz ** 3
    return max(FLOOR_LSB2 * rate_hz, NOISE * variance_lsb2), q, (START_LSB_S / rate_hz) ** 2


def weighed(name, variances, start, z):
    """Of robust_peers.h with variances of its own; start: x, v, P11, P22, or None."""
    z, x = np.ascontiguousarray(z), np.empty_like(z)
    of = lambda values: pointer(np.array(values, dtype=float))
    library().trace_robust(WEIGHED.index(name), of(variances), of(start) if start else None, *z.shape, pointer(z), pointer(x))
    return x


def filtered(name, rate_hz, axis, z, variance_lsb2=4.0):
    """axis: 2 is the noisier z. variance_lsb2: of a good sample, of which those that estimate nothing are told R as the estimator would."""
    z, x = np.ascontiguousarray(np.rint(z)), np.empty_like(z)
    if name == "raw":
        return z
    if name in WEIGHED:
        return weighed(name, kalman_variances(rate_hz, variance_lsb2), None, z)
    if name in PEERS:
        library().trace_peer(PEERS.index(name), c_double(rate_hz), *z.shape, pointer(z), pointer(x))
        return x
    if library().trace_chain(name.encode(), round(10 * rate_hz), axis, *z.shape, pointer(z), pointer(x)):
        raise batch.Refused(f"{name}: not in the list, or refuses {rate_hz:g} Hz")
    return x


@functools.cache
def fusion_library():
    return ctypes.CDLL(str(FUSION_LIBRARY.resolve())) if FUSION_LIBRARY.is_file() else None


def compared():
    """The names, Fusion's where it is built."""
    return (*NAMES, FUSION) if fusion_library() else NAMES


def roll_of(name, rate_hz, y, z):
    """Roll in degrees from two axes in LSB (256 per g), runs x samples."""
    if name == FUSION:
        rolls = []
        for one in np.stack([np.zeros_like(y), y * 265.0 / 256.0, z], axis=-1):
            one, gravity = np.ascontiguousarray(np.rint(one)), np.empty_like(one)
            fusion_library().trace_fusion(c_double(rate_hz), len(one), pointer(one), pointer(gravity))
            rolls.append(np.arctan2(gravity[:, 1], gravity[:, 2]))
        return np.degrees(np.array(rolls))
    return np.degrees(np.arctan2(filtered(name, rate_hz, 1, y, 4.0), filtered(name, rate_hz, 2, z, 4.0 * 1.69)))
