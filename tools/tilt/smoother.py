"""What a recording without truth is judged by: itself, smoothed forwards and backwards (no lag), outliers left out.

A second-order Butterworth low pass both ways at 5 Hz, as `make default` has it, or at less where less predicts every second reading from the
others better: the slower the motion, the less of the readings' noise stays in what filters are judged by. A reading further than four sigmas from
it, sigma being the usual distance of the second around it, is left out; so are missing and clipped ones.
"""
import numpy as np

CUTS_HZ, RATE_SHARE = (5.0, 2.5, 1.25, 0.6), 0.2  # below 25 Hz at most a fifth of the rate
FAR_SIGMAS, ROUNDS, SIGMA_MIN_LSB = 4.0, 4, 0.6
SETTLE_S, GAP_PERIODS, NEAR_GAP_S = 1.0, 2.5, 0.2


def low_pass(readings, kept, cut_hz, rate_hz):
    """Of the kept readings of one axis, without lag."""
    from scipy import signal
    rows = np.arange(len(readings))
    values = np.interp(rows, rows[kept], readings[kept])
    if len(values) < 2:
        return values
    both = signal.butter(2, 2.0 * min(cut_hz, RATE_SHARE * rate_hz) / rate_hz)
    return signal.filtfilt(*both, values, padlen=min(len(values) - 1, int(rate_hz)))


def inliers(readings, there, rate_hz):
    """The readings of one axis that are no outliers, by the fastest low pass."""
    from scipy import ndimage

    rows, second = np.arange(len(readings)), max(5, int(rate_hz) // 2 * 2 + 1)
    middle, kept = ndimage.median_filter(np.interp(rows, rows[there], readings[there]), 5, mode="nearest"), there
    for _ in range(ROUNDS):
        away = np.where(there, np.abs(readings - middle), 0.0)
        sigma = np.maximum(ndimage.median_filter(away, second, mode="nearest") / 0.6745, SIGMA_MIN_LSB)
        kept = there & (away <= FAR_SIGMAS * sigma)
        middle = low_pass(readings, kept, CUTS_HZ[0], rate_hz)
    return kept


def missed(readings, kept, cut_hz, rate_hz):
    """Sum of squares by which each half of the readings misses the other."""
    halves = [kept & (np.arange(len(readings)) % 2 == half) for half in (0, 1)]
    if min(map(np.count_nonzero, halves)) < 2:
        return 0.0
    return sum(float(np.sum((readings - low_pass(readings, one, cut_hz, rate_hz))[other] ** 2)) for one, other in (halves, halves[::-1]))


def smoothed(lsb, there, rate_hz, cuts_hz=CUTS_HZ):
    """The reference in LSB, (rows, 3), at the best of these cuts; an axis without a reading stays as it is. there: per row and axis, whether a
    reading is one."""
    reference = lsb.astype(float)
    kept = {axis: inliers(reference[:, axis], there[:, axis], rate_hz) for axis in known(there) if there[:, axis].any()}
    cut_hz = min(cuts_hz, key=lambda cut: sum(missed(reference[:, axis], good, cut, rate_hz) for axis, good in kept.items()))
    for axis, good in kept.items():
        reference[:, axis] = low_pass(reference[:, axis], good, cut_hz, rate_hz)
    return reference


def known(there):
    """The axes with a reading, which alone may be judged; all if there is none."""
    return np.flatnonzero(there.any(axis=0) | (not there.any()))


def complete(there):
    """Rows with a reading on each of them."""
    return there[:, known(there)].all(axis=1)


def fair(t_us, rate_hz):
    """Rows that may be judged by it: after the first second, and away from gaps, over which it cannot know; without such rows, all."""
    use = np.arange(len(t_us)) >= SETTLE_S * rate_hz
    for row in np.flatnonzero(np.diff(t_us) > GAP_PERIODS * 1e6 / rate_hz):
        near = int(NEAR_GAP_S * rate_hz) + 1
        use[max(0, row + 1 - near):row + 1 + near] = False
    return use if use.any() else np.ones(len(t_us), bool)
