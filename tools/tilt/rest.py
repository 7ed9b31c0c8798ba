"""Finds where a recording is at rest, and how much its readings scatter there.

A one-second window is at rest if its scatter about its median equals the scatter that second differences show, which motion hardly affects.
Three or more consecutive such windows at one level are a stretch. Outliers are cut off before anything is measured.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

WINDOW_S, WINDOW_MIN = 1.0, 32
STRETCH_WINDOWS = 3
SCATTER_MAX = 1.5           # times the scatter of differences: four sigmas of the ratio at 100 samples
LEVEL_SIGMAS = 4.0          # allowed difference between the medians of two windows
CUT_SIGMAS = 3.5
KEPT_VARIANCE = 0.9939      # E(g^2 | |g| < 3.5) of a Gaussian g: 1 - 7 phi(3.5) / (2 Phi(3.5) - 1)
SCATTER_MIN_LSB = 0.4       # of whole numbers: rounding a constant leaves at most 0.29
MEDIAN_COST = 1.2533        # sigma of a median over sigma of a mean


@dataclass
class Rest:
    """stretches: slices of samples; seconds: their sum; r_lsb2: variance of a sample per axis, rounding to whole LSB included (1/12), or None
    if nothing is at rest; degrees: its degrees of freedom, the smallest of the axes."""
    stretches: list
    seconds: float
    r_lsb2: np.ndarray | None
    degrees: int


def kept(values):
    """The values without outliers: those within 3.5 sigmas of the median."""
    away = np.abs(values - np.median(values))
    scale = max(float(np.median(away)) / 0.6745, 0.5)
    for _ in range(10):
        inside = values[away <= CUT_SIGMAS * scale]
        again = max(float(np.std(inside)) / np.sqrt(KEPT_VARIANCE), SCATTER_MIN_LSB)
        if abs(again - scale) < 1e-3 * scale:
            break
        scale = again
    return values[away <= CUT_SIGMAS * scale]


def scatter(values):
    return max(float(np.std(kept(values))) / np.sqrt(KEPT_VARIANCE), SCATTER_MIN_LSB)


def _still(values, spacing):
    """(whether the window of one axis is at rest, its median, how much two medians may differ)"""
    differences = (values[2 * spacing:] - 2.0 * values[spacing:-spacing] + values[:-2 * spacing]) / np.sqrt(6.0)
    of_all, of_differences = scatter(values), scatter(differences)
    allowed = LEVEL_SIGMAS * min(of_all, of_differences) * MEDIAN_COST * np.sqrt(2.0 / len(values)) + 0.5  # + 0.5: medians of whole numbers
    return of_all <= SCATTER_MAX * of_differences, float(np.median(values)), allowed


def _windows(lsb, there, rate_hz):
    """(slice, medians of the axes, allowed difference) of each window at rest; windows with a missing sample are left out."""
    size = max(WINDOW_MIN, round(WINDOW_S * rate_hz))
    spacing = 2 if rate_hz >= 70 else 1  # as in the firmware's estimate: on a powered airframe neighbours share some noise
    for begin in range(0, len(lsb) - size + 1, size):
        part = slice(begin, begin + size)
        if there[part].all():
            axes = [_still(lsb[part, axis].astype(float), spacing) for axis in range(3)]
            if all(still for still, _, _ in axes):
                yield part, np.array([middle for _, middle, _ in axes]), np.array([allowed for _, _, allowed in axes])


def _stretches(windows):
    """Lists of consecutive windows at the level of the first."""
    found = []
    for part, level, allowed in windows:
        if found and found[-1][-1][0].stop == part.start and np.all(np.abs(level - found[-1][0][1]) <= allowed):
            found[-1].append((part, level))
        else:
            found.append([(part, level)])
    return [stretch for stretch in found if len(stretch) >= STRETCH_WINDOWS]


def find(lsb, there, rate_hz):
    """Rest of samples (n, 3), present or not (there), at this rate."""
    stretches = _stretches(_windows(lsb, there, rate_hz))
    if not stretches:
        return Rest([], 0.0, None, 0)
    squares, degrees = np.zeros(3), np.zeros(3, int)
    for part, _ in (window for stretch in stretches for window in stretch):
        for axis in range(3):
            values = kept(lsb[part, axis].astype(float))
            squares[axis] += np.sum((values - values.mean()) ** 2)
            degrees[axis] += len(values) - 1
    slices = [slice(stretch[0][0].start, stretch[-1][0].stop) for stretch in stretches]
    return Rest(slices, sum(part.stop - part.start for part in slices) / rate_hz, squares / degrees / KEPT_VARIANCE, int(degrees.min()))


def mask(rest, count):
    """Per sample: whether it is in a stretch."""
    inside = np.zeros(count, bool)
    for part in rest.stretches:
        inside[part] = True
    return inside
