"""Every filter of paper 002: the double references and the shipped fixed-point code, as handles of host_tests/papers/contest.cpp."""
import ctypes
import functools
from ctypes import c_char_p, c_double, c_int, c_uint64, c_void_p
from typing import NamedTuple

import numpy as np
from synthesis.batch import Refused, accepted, c, has, names, pointer

TABLE1, MEDIAN, SHIPPED = range(3)  # starts: estimate and P of Table 1; running median of five, the rate as uncertain; as on the chip
PERIOD_S, R_DEG2, Q_RATE, CLEAN, RATIO, LSB_DEG = 0.0247, 0.0064, 0.0009, 0.85, 20.0, 0.02  # Table 1
RATE_MAX_DEG_S = 3.0            # the library's rule in degrees
SHIPPED_RATE_VARIANCE = 16.0    # on the chip the rate is thought uncertain by 200 LSB/s = 4 degree/s
# A filter knows time as samples only: q22 = q T^3 / R and P22(0) = (200 LSB/s)^2 T^2 / R. In counts of 0.02 degree Table 1 has R = 16 LSB^2 and a
# rate known to 0.2 degree/s = 10 LSB/s: a twentieth of the library's. So time is in units of a twentieth of a second; only with SHIPPED it is in
# seconds, 40.5 Hz, as a user has it.
HURRY = 20.0
SAMPLES, GROUP = 400, 50  # of a run; runs of an experiment, the paper's N_p
STAY = 0.8                # an outlier follows an outlier: runs of five on average; what (11) is told is the truth where the runs are of five

PLAIN, LINEAR, PUBLISHED, GATED, MERGED = "kf", "lrf", "sprf_paper", "sprf", "pbf"
LEARNING = ("af", "af_grid")
(CORRECTED, PRINTED_15, PRINTED_GRID, PRINTED_21, PRINTED_24, PRINTED_25, PRINTED_26, PRINTED_27, PRINTED_30, PRINTED_33, PRINTED_34,
 PRINTED_39) = range(12)  # as robust_reading_t


class Entry(NamedTuple):
    """reference: its name in reference/robust.h; returns_within: of those that are the library's too, samples after a step within which each trial
    is to be back; products, sums: of Table 2; stay: (11), that an outlier follows an outlier."""

    reference: str
    reading: int = CORRECTED
    gate_sigma: float = 3.0
    reacquire: int = 0
    returns_within: int = 0
    products: int = 0
    sums: int = 0
    stay: float = 0.0


ENTRIES = {
    "kf": Entry("kf", returns_within=1200),
    "lrf": Entry("lrf", returns_within=800, products=47, sums=38),
    "sprf_paper": Entry("sprf", gate_sigma=2.0, returns_within=1200, products=53, sums=36),
    "sprf_paper_3sigma": Entry("sprf", returns_within=1200),
    "sprf": Entry("sprf", reacquire=5, returns_within=200),
    "soft": Entry("soft", reacquire=5, returns_within=200),
    "shrf": Entry("shrf", returns_within=1200, products=49, sums=37),
    "pbf": Entry("pbf", returns_within=800, products=84, sums=41),
    "af": Entry("af", returns_within=800),
    "af_grid": Entry("af_grid", products=584, sums=292),
    "clairvoyant": Entry("clairvoyant"),
    "shrf(eq11)": Entry("shrf", stay=STAY),
    "pbf(eq11)": Entry("pbf", stay=STAY),
    "af_grid_eq15": Entry("af_grid", PRINTED_15),
    "af_grid_i_by_50": Entry("af_grid", PRINTED_GRID),
    "pbf_eq21": Entry("pbf", PRINTED_21),
    "shrf_eq24": Entry("shrf", PRINTED_24),
    "shrf_eq25": Entry("shrf", PRINTED_25),
    "pbf_eq26": Entry("pbf", PRINTED_26),
    "shrf_eq29_cut": Entry("shrf", PRINTED_27),
    "shrf_eq30": Entry("shrf", PRINTED_30),
    "sprf_eq33": Entry("sprf", PRINTED_33, 2.0),
    "sprf_eq34": Entry("sprf", PRINTED_34, 2.0),
    "lrf_eq39": Entry("lrf", PRINTED_39),
}
IN_RUNS = [name for name, entry in ENTRIES.items() if entry.stay]
REFERENCES = [name for name, entry in ENTRIES.items() if entry.reading == CORRECTED and not entry.stay]  # the errata applied
READINGS = [name for name, entry in ENTRIES.items() if entry.reading != CORRECTED]    # that the errata refute
LIBRARY = [name for name, entry in ENTRIES.items() if entry.returns_within]


class Scenario(ctypes.Structure):
    """As host_tests/papers/model.hpp has it."""

    _fields_ = [("outliers", c_double), ("stay", c_double), ("first_clean", ctypes.c_bool), ("step_at", c_int), ("step_sigma", c_double),
                ("burst_at", c_int), ("burst_length", c_int)]

    def __init__(self, outliers=1.0 - CLEAN, first_clean=False, stay=0.0):
        super().__init__(outliers, stay, first_clean, -1, 0.0, -1, 0)


class Filter(NamedTuple):
    name: str
    arithmetic: str
    handle: int

    def gain_at_rest(self, y_deg, count):
        gain = c().contest_gain_at_rest
        gain.restype = c_double
        return gain(c_void_p(self.handle), c_double(y_deg), count)


def in_double(name, start=TABLE1, r_factor=1.0, gate_sigma=0.0):
    """gate_sigma 0: the filter's own."""
    entry = ENTRIES[name]
    kalman_core = entry.reference in ("kf", "lrf") or entry.reacquire  # the library has it on the core of kalman.h, not on that of wide.h
    as_published = entry.reference == GATED and not entry.reacquire
    make = c().contest_in_double
    make.restype = c_void_p
    handle = make(entry.reference.encode(), entry.reading, c_double(r_factor), c_double(gate_sigma or entry.gate_sigma),
                  entry.reacquire, c_double(RATE_MAX_DEG_S), 0 if start == TABLE1 or as_published else 5,
                  c_double(SHIPPED_RATE_VARIANCE if start == SHIPPED else 0.0), c_double(14.0 if kalman_core else 1.0), c_double(entry.stay))
    if not handle:
        raise Refused(f"{name}: a parameter is outside its legal range")
    return Filter(name, "double", handle)


def fixed(name, start=TABLE1, r_factor=1.0, gate_sigma=0.0):
    rate_dhz = round((1.0 if start == SHIPPED else HURRY) * 10.0 / PERIOD_S)
    t_s = 10.0 / rate_dhz
    law = name.removesuffix("(eq11)")
    learns = c().contest_learns(law.encode())  # (15) begins with all values alike
    table1 = {"r": R_DEG2 / (LSB_DEG * LSB_DEG) * r_factor,
              "q": Q_RATE / (LSB_DEG * LSB_DEG) * PERIOD_S * PERIOD_S / (t_s * t_s * t_s),
              "ratemax": RATE_MAX_DEG_S / LSB_DEG * PERIOD_S / t_s, "clean": 0.5 if learns else CLEAN, "ratio": RATIO}
    parameters = {word: value for word, value in table1.items() if has(law, word)} | ({"gate": gate_sigma} if gate_sigma else {})
    parameters |= {"stay": ENTRIES[name].stay} if name in IN_RUNS else {}
    words, handle = (c_char_p * len(parameters))(*(word.encode() for word in parameters)), c_void_p()
    accepted(name, c().contest_fixed(law.encode(), rate_dhz, len(parameters), words, pointer(np.array(list(parameters.values()), dtype=float)),
                                     int(start == TABLE1), ctypes.byref(handle)))
    return Filter(name, "fixed", handle.value)


def fixed_names():
    """Of the filters of FILTER_LIST that are the paper's."""
    return [name for name in names() if c().contest_of_the_paper(name.encode())]


def contestants(chosen, *settings):
    """In both arithmetics, the fixed ones as far as they are in FILTER_LIST."""
    shipped = fixed_names() + IN_RUNS
    return [make(name, *settings) for name in chosen for make in ((in_double, fixed) if name in shipped else (in_double,))]


def others():
    """Of FILTER_LIST beside the paper's: as on the chip at 40.5 Hz, where they know no Q."""
    paper = fixed_names()
    return [fixed(name, SHIPPED)._replace(name=f"{name}(as_shipped)") for name in names() if name not in paper]


def at_rest(name, noise=()):
    """(P, gain, R of a sample and for both kinds, variances of the error in white noise of those variances) of a linear filter."""
    p, gain, r, variance = (np.empty(size) for size in (4, 2, 2, len(noise)))
    c().contest_at_rest(name.encode(), pointer(p), pointer(gain), pointer(r), len(noise), pointer(np.array(noise, dtype=float)), pointer(variance))
    return p, gain, r, variance


@functools.cache
def steady_sigma_deg(name):
    """Standard deviation of the filter's error in the steady state by its own P: "back" means within four of them."""
    return float(np.sqrt(at_rest(LINEAR if name.startswith(LINEAR) else PLAIN)[0][0]))


def back_deg(filters):
    return np.array([4.0 * steady_sigma_deg(f.name) for f in filters])


# --- all filters over the same realisations ---------------------------------------------------------------------------


def handles(filters):
    return (c_void_p * len(filters))(*(f.handle for f in filters)), len(filters)


def scored(filters, scenario, seeds):
    """(square errors, filters x windows (steady, transient, transient late) x runs; runs in which each is locked out; variance of the error at each
    sample within each whole experiment of GROUP runs, experiments x filters x samples)"""
    squares, locked, variances, back = np.empty((len(filters), 3, len(seeds))), np.zeros(len(filters)), [], back_deg(filters)
    for begin in range(0, len(seeds), GROUP):
        part = np.ascontiguousarray(seeds[begin:begin + GROUP])
        found, errors = np.empty((len(filters), 3, len(part))), np.empty((len(filters), len(part), SAMPLES))
        c().contest_score(*handles(filters), ctypes.byref(scenario), pointer(part), len(part), pointer(back), pointer(found), pointer(locked),
                          pointer(errors))
        squares[:, :, begin:begin + GROUP] = found
        variances += [errors.var(axis=1)] if len(part) == GROUP else []
    variances = np.array(variances)
    variances[variances == 0.0] = np.inf  # all at the bound of contest.cpp: as wrong as can be
    return squares, locked, variances


def shares(filters, scenario, seeds, part):
    """(mean over the runs of q1 as each has it after each sample, filters x samples; from which sample on it stays within a part of the truth,
    filters x runs)"""
    mean, within = np.zeros((len(filters), SAMPLES)), np.ones((len(filters), len(seeds)))
    c().contest_shares(*handles(filters), ctypes.byref(scenario), pointer(seeds), len(seeds), c_double(part), pointer(mean), pointer(within))
    return mean, within


def gated(filters, scenario, seeds):
    """(steady square errors, filters x runs; of each filter: samples that are no outliers, outliers, false alarms, misses)"""
    squares, counts = np.empty((len(filters), len(seeds))), np.zeros((len(filters), 4))
    c().contest_gate(*handles(filters), ctypes.byref(scenario), pointer(seeds), len(seeds), pointer(squares), pointer(counts))
    return squares, counts


def returned(filters, scenario, low_sigma, high_sigma, seeds, limits, back):
    """Samples until back after a step, filters x runs; infinite when not within the limit."""
    scenarios, found = (Scenario * len(seeds))(*(scenario for _ in seeds)), np.empty((len(filters), len(seeds)))
    c().contest_steps(pointer(seeds), len(seeds), c_double(scenario.outliers), c_double(low_sigma), c_double(high_sigma), scenarios)
    c().contest_return(*handles(filters), scenarios, pointer(seeds), len(seeds), pointer(np.array(limits, dtype=np.int32)), pointer(back),
                       pointer(found))
    return found


def through_burst(filters, length, seeds):
    """(peak of the error in steady sigmas, samples from the burst's end until back), filters x runs."""
    peak, back = (np.empty((len(filters), len(seeds))) for _ in range(2))
    c().contest_burst(*handles(filters), length, pointer(seeds), len(seeds), c_double(steady_sigma_deg(PLAIN)), pointer(peak), pointer(back))
    return peak, back


def ratios(above, below, seed):
    """(sum of a by sum of b, 95 % of resampled runs) of each column: columns x 3."""
    above, below, found = np.ascontiguousarray(above), np.ascontiguousarray(below), np.empty((len(above), 3))
    c().contest_ratios(*above.shape, pointer(above), pointer(below), c_uint64(seed), pointer(found))
    return found
