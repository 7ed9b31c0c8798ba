"""Paper 002 sample by sample: realisations of Table 1 and every filter in double on them, by host_tests/papers/figures/traces.cpp."""
import ctypes
import functools
import pathlib
from ctypes import c_double

import numpy as np
from resilience.filters import PERIOD_S, Scenario
from synthesis.batch import ROOT, Refused, pointer, run_seed

PATH = ROOT / "build/papers/libtraces.so"
GRID = 50  # points of the distribution of q1
# the library's re-acquisition and rule of the rate, as campaigns/resilience/filters.py has them
REACQUIRE, RATE_MAX_DEG_S = 5, 3.0


@functools.cache
def library():
    try:
        return ctypes.CDLL(str(pathlib.Path(PATH)))
    except OSError as missing:
        raise Refused(f"{PATH}: make figures builds it") from missing


def seconds(samples):
    return PERIOD_S * np.arange(samples)


def realisations(seed, first, runs, samples, scenario=None):
    """(truth, y, outlier) of runs first .. first + runs - 1, each runs x samples."""
    seeds = np.array([run_seed(seed, run) for run in range(first, first + runs)], dtype=np.uint64)
    truth, y, outlier = (np.empty((runs, samples)) for _ in range(3))
    library().trace_realisations(ctypes.byref(scenario or Scenario()), pointer(seeds), runs, samples, *map(pointer, (truth, y, outlier)))
    return truth, y, outlier


def joint(name, y, limit):
    """Estimates of a gated filter that comes back, components x runs x samples as y: one gate over all components."""
    y, x = np.ascontiguousarray(y), np.empty(y.shape)
    if library().trace_joint(name.encode(), c_double(limit), REACQUIRE, c_double(RATE_MAX_DEG_S), *y.shape, pointer(y), pointer(x)):
        raise Refused(f"{name}: reference/robust.h has no such filter")
    return x


def reference(name, y, outlier, gate_sigma=2.0, reacquire=False, stay=0.0, density=False):
    """{x, p11, abnormal, q_mean: runs x samples, and density: samples x GRID of the first run, where it is asked for}"""
    facts = np.empty((4, *y.shape))
    grid = np.empty((y.shape[1], GRID)) if density else None
    if library().trace_reference(name.encode(), c_double(gate_sigma), REACQUIRE if reacquire else 0, c_double(RATE_MAX_DEG_S if reacquire else 0.0),
                                 c_double(stay), *y.shape, pointer(np.ascontiguousarray(y)), pointer(np.ascontiguousarray(outlier)), pointer(facts),
                                 pointer(grid)):
        raise Refused(f"{name}: reference/robust.h has no such filter, or refuses its parameters")
    return {**dict(zip(("x", "p11", "abnormal", "q_mean"), facts)), "density": grid}
