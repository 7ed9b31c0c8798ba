"""The functions of host_tests/papers/batch.cpp over numpy arrays, runs x samples."""
import ctypes
import functools
import pathlib
from ctypes import c_char_p, c_double, c_int

import numpy as np
from page_sources import Fault

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATH = ROOT / "build/papers/libbatch.so"


class Refused(Fault):
    """One sentence about what the library does not take."""


@functools.cache
def c():
    try:
        library = ctypes.CDLL(str(PATH))
    except OSError as missing:
        raise Refused(f"{PATH}: make paper_programs builds it") from missing
    for name in ("batch_largest_r_lsb2", "batch_largest_rate_drive", "reference_closed_noise_gain", "reference_closed_lag"):
        getattr(library, name).restype = c_double
    for name in ("batch_name", "batch_parameter", "batch_shipped", "contest_fixed"):
        getattr(library, name).restype = c_char_p
    return library


def pointer(array):
    return None if array is None else array.ctypes.data_as(ctypes.c_void_p)


def accepted(name, refusal):
    if refusal:
        raise Refused(f"{name}: {refusal.decode()}")


def names():
    """Of FILTER_LIST, in its order."""
    found = []
    while name := c().batch_name(len(found)):
        found.append(name.decode())
    return found


def default_of(name, rate_dhz, parameter):
    value = c_double()
    accepted(name, c().batch_parameter(name.encode(), rate_dhz, parameter.encode(), ctypes.byref(value)))
    return value.value


def has(name, parameter):
    return c().batch_parameter(name.encode(), 1000, parameter.encode(), ctypes.byref(c_double())) is None


def largest_r_lsb2():
    return c().batch_largest_r_lsb2()


def largest_rate_drive():
    return c().batch_largest_rate_drive()


def run_seed(seed, run):
    """A seed for each run of an experiment, as host_tests/papers/model.cpp has it: neighbouring runs start far from each other."""
    z = (seed * 0x9E3779B97F4A7C15 + run * 0xBF58476D1CE4E5B9) % 2 ** 64
    z = ((z ^ z >> 30) * 0xBF58476D1CE4E5B9) % 2 ** 64
    z = ((z ^ z >> 27) * 0x94D049BB133111EB) % 2 ** 64
    return z ^ z >> 31


def draws(seeds, samples, normal=True, uniform=True):
    """(normal numbers, uniform numbers) or those that are wanted, drawn by turns."""
    seeds = np.array(seeds, dtype=np.uint64)
    found = [np.empty((len(seeds), samples)) if wanted else None for wanted in (normal, uniform)]
    c().batch_draws(pointer(seeds), len(seeds), samples, *map(pointer, found))
    return found


def shipped(name, rate_dhz, parameters, r_lsb2, reset, z_lsb):
    """Estimates in LSB x 65536."""
    z_lsb = np.ascontiguousarray(z_lsb, dtype=float)
    x, values = np.empty_like(z_lsb), np.array(list(parameters.values()), dtype=float)
    words = (c_char_p * len(parameters))(*(word.encode() for word in parameters))
    accepted(name, c().batch_shipped(name.encode(), rate_dhz, len(parameters), words, pointer(values), c_double(r_lsb2), int(reset), *z_lsb.shape,
                                     pointer(z_lsb), pointer(x)))
    return x


def noise_identified(rate_dhz, z_lsb):
    """R in LSB^2 x 256 at the end of each run."""
    z_lsb, found = np.ascontiguousarray(z_lsb, dtype=float), np.empty(len(z_lsb))
    c().batch_noise(rate_dhz, *z_lsb.shape, pointer(z_lsb), pointer(found))
    return found


def noise_expected(rate_dhz, truth_lsb, variance_lsb2, bad):
    """(estimate, weight, again) of reference/noise.h."""
    truth_lsb, found = np.ascontiguousarray(truth_lsb, dtype=float), np.empty(3)
    c().batch_noise_expected(rate_dhz, len(truth_lsb), pointer(truth_lsb), c_double(variance_lsb2), c_double(bad), pointer(found))
    return found


def gains(f, q, p0, order, steps=0):
    """Of a Kalman filter, steps x 3, or 3 in the steady state."""
    found = np.empty((steps, 3) if steps else 3)
    if c().batch_gains(pointer(f), pointer(q), c_double(p0), order, steps, pointer(found)):
        raise Refused("a Riccati recursion does not settle")
    return found


def run(function, model, gain, x0, z):
    """Estimates of z; gain: constant or, with one dimension more, of each step."""
    z, gain = np.ascontiguousarray(z, dtype=float), np.ascontiguousarray(gain, dtype=float)
    x = np.empty_like(z)
    function(*model, pointer(gain), int(gain.ndim > 1), c_double(np.nan if x0 is None else x0), *z.shape, pointer(z), pointer(x))
    return x


def linear(f, gain, x0, z):
    return run(c().batch_linear, [pointer(f)], gain, x0, z)


def synthesised(gain, x0, z):
    return run(c().batch_synthesised, [], gain, x0, z)


def schedule(kind, clamped, r, p, before, steps):
    """Of each step: solved, a1, b0, true variance, Pe, P, stretch."""
    facts = np.empty((steps, 7))
    c().batch_schedule(kind, int(clamped), c_double(r), pointer(np.array(p, dtype=float)), before, steps, pointer(facts))
    return facts


def exact_schedule(r, a1_min, p0, steps):
    """a1, b0 of each step."""
    found = np.empty((steps, 2))
    c().batch_exact(c_double(r), c_double(a1_min), c_double(p0), steps, pointer(found))
    return found


def closed_noise_gain(a1, b0):
    return c().reference_closed_noise_gain(c_double(a1), c_double(b0))


def closed_lag(a1, b0):
    return c().reference_closed_lag(c_double(a1), c_double(b0))
