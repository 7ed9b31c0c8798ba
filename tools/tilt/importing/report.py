"""The messages of an import: one line, and one for each thing worth knowing."""
import numpy as np

from tilt.importing import clock

DUPLICATES_SHARE = 0.03  # if every value is even, 2 % repeat by chance
LEAST_SHOWN = 8


def summary(path, out, readings, scale, t_us, source):
    """One line. source: the reason for this unit."""
    rate, _, _, _ = clock.seen(t_us)
    span_s = (int(t_us[-1]) - int(t_us[0])) / 1e6
    rows = len(t_us)
    speed = f"{rate:.6g} Hz" if rate else "no rate"
    return (f"{path}: {readings.form}, {rows:,} rows, {span_s:.6g} s, {speed}; unit {scale.unit}, {scale.words} ({source}, residual "
            f"{scale.residual_lsb:.3f} LSB rms, |a| {scale.magnitude_lsb:.0f} LSB) -> {out}")


def notes_of(t_us, lsb, missing):
    """What the numbers themselves show."""
    return steps_of(lsb) + repeats_of(lsb, missing) + pauses_of(t_us)


def steps_of(lsb):
    step = int(np.gcd.reduce(np.abs(lsb).ravel()))
    if step == 2 and len(lsb) >= LEAST_SHOWN:
        return ["every value is even: recorded at 1600 or 3200 Hz, where the sensor's lowest bit is 0"]
    if step > 1 and len(lsb) >= LEAST_SHOWN:
        return [f"coarse: every value is a multiple of {step} LSB (10 bit at a wide range)"]
    return []


def repeats_of(lsb, missing):
    notes = []
    for reading, words in ((-1, "no sensor answered"), (0, "failed reads")):
        count = int(((lsb == reading).all(axis=1) & ~missing).sum())
        if count:
            notes.append(f"{count:,} rows read {reading},{reading},{reading}: {words}")
    same = (np.diff(lsb, axis=0) == 0).all(axis=1)
    if len(same) and same.mean() > DUPLICATES_SHARE:
        notes.append(f"{100 * same.mean():.1f} % of the rows repeat the row before: polled faster than the output data rate, or coarse")
    return notes


def pauses_of(t_us):
    _, gaps, longest_us, equal = clock.seen(t_us)
    notes = [f"{gaps:,} gaps, the longest {longest_us / 1e3:.1f} ms"] if gaps else []
    if equal:
        notes.append(f"{100 * equal:.1f} % of the rows repeat the time of the previous row")
    return notes
