"""The noise of a recording: a robust standard deviation of third differences, which tilt hardly affects and outliers not at all."""
import csv
import math

from .synthesis import Infeasible

ROWS_MIN = 50
MEDIAN_PER_SIGMA = 0.674489750196  # of |x|, x normal
THIRD_DIFFERENCE = math.sqrt(20.0)  # 1 + 9 + 9 + 1


def columns(path):
    """The x, y, z samples of a stream."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        rows = csv.reader(line for line in file if line.strip() and not line.startswith("#"))
        head = [name.strip() for name in next(rows, [])]
        names = next((names for names in (("x", "y", "z"), ("x_lsb", "y_lsb", "z_lsb")) if set(names) <= set(head)), None)
        if names is None:
            raise Infeasible(f"{path}: no columns x, y, z or x_lsb, y_lsb, z_lsb in its header; nearest: a stream by docs/protocol.md")
        places = [head.index(name) for name in names]
        found = ([], [], [])
        for number, row in enumerate(rows, 2):
            try:
                values = [float(row[place]) for place in places]
            except (ValueError, IndexError):
                raise Infeasible(f"{path}: row {number} does not have three numbers in {', '.join(names)}; "
                                 "nearest: a stream by docs/protocol.md") from None
            for column, value in zip(found, values):
                column.append(value)
    return found


def sigma_of(samples):
    """Sigma of g from the median of |g - 3 g1 + 3 g2 - g3|. Integers make it too coarse below 0.5, where the mean takes over."""
    thirds = sorted(abs(a - 3 * b + 3 * c - d) for a, b, c, d in zip(samples[3:], samples[2:], samples[1:], samples))
    median = thirds[len(thirds) // 2] / MEDIAN_PER_SIGMA / THIRD_DIFFERENCE
    kept = [x for x in thirds if x <= 4.0 * max(thirds[len(thirds) // 2], 1.0) / MEDIAN_PER_SIGMA]
    mean = math.sqrt(sum(x * x for x in kept) / len(kept)) / THIRD_DIFFERENCE
    return mean if median < 2.0 else median


def sigma_of_stream(path):
    """The largest of the three axes' noise, LSB."""
    axes = columns(path)
    if len(axes[0]) < ROWS_MIN:
        raise Infeasible(f"{path}: {len(axes[0])} samples are too few to measure the noise; nearest: {ROWS_MIN}")
    return max(sigma_of(axis) for axis in axes)
