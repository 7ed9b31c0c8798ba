"""Fits a filter's parameters to a recording: the least distance from the recording smoothed without lag (tilt.smoother), as the shipped code runs it.

Each parameter in turn is tried at values around the best so far, in steps of its own scale. The time is cut into parts: what the best of all but
one part earns on that one is what the fit is worth. Where that is little, or where a part loses, the defaults stay. All that is tried comes from
one search over the whole recording.
"""
from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from tilt import judge, native, rest, smoother
from tilt.errors import TiltError

PARTS = 4
ROUNDS = 3
SCALED = (0.25, 0.5, 0.8, 1.25, 2.0, 4.0)     # factors tried on a time, a sigma, a noise density
FAR, GATE_FAR = (8.0, 8.0), (1.2, 1.5)  # below and above the default: a gate is for outliers that the recording may lack
SHIFTED = (-0.2, -0.05, 0.05, 0.2)            # added to a coefficient
SCALES = ("ms", "sigma", "LSB2/s3", "LSB2/s5")
FIXED = ("r", "ratemax", "identify", "u", "p0", "reacquire")  # noise is estimated, the others are switches and limits
NEAR = 1.002            # of equal ones the nearest to the defaults
WORTH, LOST = 0.97, 1.03  # rms against the defaults': held back, at most; on any part, at most
MOTION_MIN_S = 15.0


@dataclass
class Samples:
    """A recording as rows of the sample path, few in a silence: readings (n, 3), states (n, 3) as native.axis takes them, its smoothed forms,
    samples that may be judged, its rest, the rate."""
    lsb: np.ndarray
    state: np.ndarray
    references: list
    use: np.ndarray
    rest: rest.Rest
    rate_dhz: int

    @property
    def motion_s(self):
        return float(np.count_nonzero(self.use & ~rest.mask(self.rest, len(self.lsb)))) * 10.0 / self.rate_dhz


def samples_of(stream, rate_dhz):
    """The samples that the board would take at this rate, the missing ones among them."""
    rows = native.replay(stream, native.filters()[:1], rate_dhz)[native.filters()[0]]
    if len(rows) < 2:
        raise TiltError(f"{stream.path}: too few readings to tune by: record at least {MOTION_MIN_S:.0f} s of motion")
    rate_hz, state = rate_dhz / 10, judge.states(rows)
    there = state == native.THERE
    references = [smoother.smoothed(rows["lsb"], there, rate_hz, cuts) for cuts in (smoother.CUTS_HZ, smoother.CUTS_HZ[:1])]
    use = smoother.complete(there) & smoother.fair(rows["t_us"], rate_hz)
    return Samples(rows["lsb"], state, references, use, rest.find(rows["lsb"], smoother.complete(there), rate_hz), rate_dhz)


def run(samples, name, values):
    """Probes of the three axes."""
    return [native.axis(name, samples.rate_dhz, samples.lsb[:, i], samples.state[:, i], values, noisy_axis=i == 2) for i in range(3)]


def losses(samples, name, values):
    """Mean square error in LSB from each reference, per part of the time; inf where the filter rejects the values."""
    try:
        axes = run(samples, name, values)
    except TiltError:
        return np.full((len(samples.references), PARTS), np.inf)
    shown, known = np.stack([probes["x_lsb_q16"] / 65536.0 for probes in axes], axis=1), smoother.known(samples.state == native.THERE)
    each = [np.where(samples.use, np.mean((shown - reference)[:, known] ** 2, axis=1), 0.0) for reference in samples.references]
    return np.array([[part.sum() for part in np.array_split(one, PARTS)] for one in each]) / max(np.count_nonzero(samples.use), 1)


def around(parameter, value):
    """Values to try, as the console takes them."""
    if parameter.unit in SCALES:
        below, above = GATE_FAR if parameter.unit == "sigma" else FAR
        tried = [min(max(value * factor, parameter.default / below), parameter.default * above) for factor in SCALED]
    else:
        tried = [value + step for step in SHIFTED]
    return [float(parameter.text(one)) for one in tried]


def tunable(name, rate_dhz):
    return {key: parameter for key, parameter in native.parameters(name, rate_dhz).items() if key not in FIXED}


def search(samples, name, report=lambda done, whole: None):
    """{values as sorted pairs: squared errors over those of the defaults} of all that was tried; () are the defaults."""
    every, default = tunable(name, samples.rate_dhz), losses(samples, name, {})
    total = np.maximum(default.sum(axis=1, keepdims=True), 1e-9)
    found = {(): default / total}
    for turn, (key, parameter) in itertools.product(range(ROUNDS), every.items()):
        best = dict(min(found, key=lambda values: found[values].sum()))
        for value in around(parameter, best.get(key, parameter.default)):
            values = tuple(sorted((best | {key: value}).items()))
            if values not in found:
                found[values] = losses(samples, name, dict(values)) / total
        report(turn * len(every) + list(every).index(key) + 1, ROUNDS * len(every))
    return found


def distance(values, every):
    """How far values are from the defaults, in steps."""
    return sum(abs(np.log(value / every[key].default)) if every[key].unit in SCALES else 4.0 * abs(value - every[key].default)
               for key, value in values if every[key].default != 0.0 or every[key].unit not in SCALES)


@dataclass
class Fit:
    """values: the parameters that change, empty: keep the defaults, and why. Errors in LSB rms from the smoothed recording, with the defaults
    and with the values; held_back: what values from the other parts of the time leave of the defaults' error, 1: all."""
    values: dict
    default_lsb: float
    fitted_lsb: float
    held_back: float
    reason: str = ""


def chosen(found, every):
    """(values, reason to keep the defaults or "", what is left of the error on parts held back)"""
    default, parts = found[()], range(PARTS)
    others = [min(found.values(), key=lambda loss, part=part: np.delete(loss, part, axis=1).sum())[:, part] for part in parts]
    held_back = float(np.sqrt(np.max(np.sum(others, axis=0))))
    least = min(loss.sum() for loss in found.values())
    best = min((values for values, loss in found.items() if loss.sum() <= NEAR ** 2 * least), key=lambda values: distance(values, every))
    if not best:
        return {}, "no other values are better", held_back
    if held_back > WORTH:
        return {}, "values that suit one part of the recording do not suit the others", held_back
    if (found[best] > LOST ** 2 * default).any():
        return {}, "better values for the whole are worse in a part of it", held_back
    return dict(best), "", held_back


def fitted(samples, name, report=lambda done, whole: None):
    """The Fit of a filter to a recording."""
    values, reason, held_back = {}, f"only {samples.motion_s:.1f} s of motion, and what suits rest alone would lag", 1.0
    if samples.motion_s >= MOTION_MIN_S:
        values, reason, held_back = chosen(search(samples, name, report), tunable(name, samples.rate_dhz))
    before, after = (float(np.sqrt(losses(samples, name, used)[0].sum())) for used in ({}, values))
    return Fit(values, before, after, held_back, reason)
