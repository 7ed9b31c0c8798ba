"""Converts values to LSB of 256 per g. An ADXL345 gives whole numbers, so the file's unit and scale are those with the smallest remainder.

A scale is the value of one LSB in the unit, for x, y, z. The public drivers use five: 1/256 g; the data sheet's typical 3.9 mg; 4 mg
(Adafruit, older Klipper); 1/265, 1/265, 1/256 g (UPM, for 3.3 V); 0.003774, 0.003774, 0.003906 g (Klipper).
"""
from dataclasses import dataclass

import numpy as np

from tilt.errors import TiltError

UNITS = ("raw", "g", "mg", "m/s2", "mm/s2", "k/265")
G_MPS2 = (9.80665, 9.81, 9.8)
PER_LSB_G = (("1/256 g", (1 / 256,) * 3), ("4 mg", (0.004,) * 3), ("3.9 mg", (0.0039,) * 3), ("1/265, 1/265, 1/256 g", (1 / 265, 1 / 265, 1 / 256)),
             ("0.003774, 0.003774, 0.003906 g", (0.003774, 0.003774, 0.003906)))
LSB_MIN, LSB_MAX = -4096, 4095
SAMPLE = 200_000
FITS_SHARE = 0.99  # of the values are as near to a whole number as their printed digits allow
MARGIN_LSB = 0.02  # in addition to half a digit
TELLING_LSB = 0.8  # a coarser digit shows nothing about whole numbers
PLAUSIBLE = (150.0, 420.0)  # LSB, median magnitude: gravity, a sensor 16 % off, and some motion
FREE_DIGIT = 1e-7
LEAST_LSB = 2.0


@dataclass
class Scale:
    """per_lsb: the value of one LSB of x, y, z in the file's unit. residual_lsb: rms distance to whole numbers."""
    unit: str
    words: str
    per_lsb: np.ndarray
    residual_lsb: float = 0.0
    magnitude_lsb: float = 0.0
    digit_lsb: float = 0.0
    fits: bool = False


def candidates(unit):
    """All scales of a unit, the usual ones first; of all units if it is None."""
    found = []
    if unit in (None, "raw"):
        found.append(Scale("raw", "1 per LSB", np.ones(3)))
    for name, factors in (("g", (1.0,)), ("m/s2", G_MPS2), ("mm/s2", (9806.65,)), ("mg", (1000.0,))):
        for factor in factors if unit in (None, name) else ():
            for words, scale in PER_LSB_G:
                by = "" if name in ("g", "mg", "mm/s2") or factor == 9.80665 else f" of {factor:g} m/s2"
                found.append(Scale(name, words + by, np.array(scale) * factor))
    if unit == "k/265":
        found = [Scale("g", words, np.array(scale)) for words, scale in PER_LSB_G if words.startswith("1/265")]
    return found


def tried(scale, values, digit):
    """The scale with its scores. digit: the smallest step of the printed values."""
    lsb = values / scale.per_lsb
    off = lsb - np.rint(lsb)
    scale.residual_lsb = float(np.sqrt(np.mean(off ** 2)))
    scale.magnitude_lsb = float(np.median(np.sqrt((lsb ** 2).sum(axis=1))))
    scale.digit_lsb = float(digit / scale.per_lsb.min())
    near = np.abs(off) <= 0.5 * scale.digit_lsb + MARGIN_LSB
    scale.fits = bool(scale.digit_lsb < TELLING_LSB and near.mean() >= FITS_SHARE)
    if scale.unit == "raw":
        scale.fits = bool(scale.residual_lsb < 1e-6)
    elif np.abs(lsb).max() < LEAST_LSB:
        scale.fits = False  # all round to 0, which fits anything
    elif ((lsb < LSB_MIN) | (lsb > LSB_MAX)).mean() > 1.0 - FITS_SHARE:
        scale.fits = False
    return scale


def plausible(scale):
    return PLAUSIBLE[0] <= scale.magnitude_lsb <= PLAUSIBLE[1]


def sample_of(values):
    whole = values[np.isfinite(values).all(axis=1)]
    return whole[::max(1, len(whole) // SAMPLE)]


def choose(path, values, decimals, unit, notes, other_sensors=False):
    """The Scale of a recording. unit: None, one of UNITS, or as the file states it. TiltError if none can be determined."""
    sample = sample_of(values)
    if len(sample) == 0:
        raise TiltError(f"{path}: every reading is missing: record again")
    digit = FREE_DIGIT if decimals is None else 10.0 ** -decimals
    found = [tried(scale, sample, digit) for scale in candidates(unit)]
    fitting = [scale for scale in found if scale.fits]
    if not fitting:
        return too_coarse(path, found, unit, notes, other_sensors)
    if any(plausible(scale) for scale in fitting):
        fitting = [scale for scale in fitting if plausible(scale)]
    best = min(fitting, key=lambda scale: round(scale.residual_lsb, 2))
    others = [scale for scale in fitting if scale is not best and scale.residual_lsb < best.residual_lsb + 0.01
              and (np.rint(sample / scale.per_lsb) != np.rint(sample / best.per_lsb)).any()]
    if others:
        notes.append(f"the numbers also fit {others[0].unit} of {others[0].words} (give --unit to choose)")
    return best


def too_coarse(path, found, unit, notes, other_sensors):
    """No scale gives whole numbers: too few digits, or not an ADXL345."""
    coarse = [scale for scale in found if scale.digit_lsb >= TELLING_LSB and scale.unit != "raw" and (unit is not None or plausible(scale))]
    if coarse:
        best = coarse[0]
        notes.append(f"steps of {best.digit_lsb:.2g} LSB: too coarse to find the sensor's whole numbers, {best.words} assumed")
        return best
    best = min(found, key=lambda scale: (not plausible(scale), scale.residual_lsb))
    hint = ", or choose another sensor of the file: --sensor N" if other_sensors else ""
    raise TiltError(f"{path}: no whole numbers of LSB in any known unit (nearest: {best.unit} with {best.words} per LSB, residual "
                    f"{best.residual_lsb:.2f} LSB rms): not unprocessed readings of an ADXL345. Give the value of one LSB: --unit N{hint}")


def forced(text, values, decimals, notes):
    """The Scale for --unit N or N,N,N: the value of one LSB."""
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 3) or not all(np.isfinite(numbers)) or min(numbers) <= 0.0:
        raise TiltError(f"--unit {text}: give one of {', '.join(UNITS)}, or the value of one LSB: a number, or three for x, y, z")
    scale = tried(Scale("given", text, np.array(numbers) * np.ones(3)), sample_of(values), FREE_DIGIT if decimals is None else 10.0 ** -decimals)
    if scale.residual_lsb > 0.5 * scale.digit_lsb + MARGIN_LSB:
        notes.append(f"values are {scale.residual_lsb:.2f} LSB rms from whole numbers, rounded")
    return scale


def to_lsb(readings, scale, notes):
    """((n, 3) int64, missing) by the scale; a missing row repeats the last reading. TiltError, with the line, beyond the registers' range."""
    lsb = readings.values / scale.per_lsb
    missing = ~np.isfinite(lsb).all(axis=1)
    if missing.any():
        notes.append(f"{int(missing.sum())} readings missing, flagged {2}")
        rows = np.where(missing, 0, np.arange(len(lsb)))
        lsb = np.nan_to_num(lsb[np.maximum.accumulate(rows)], nan=0.0)
    whole = np.rint(lsb).astype(np.int64)
    bad = np.flatnonzero(((whole < LSB_MIN) | (whole > LSB_MAX)).any(axis=1))
    if len(bad):
        row = int(bad[0])
        raise readings.fault(row, f"{', '.join(str(v) for v in whole[row])} LSB by {scale.unit} of {scale.words}: outside an ADXL345's "
                             f"{LSB_MIN}..{LSB_MAX}: correct or delete this line, or give --unit")
    return whole, missing
