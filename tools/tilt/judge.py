"""Judges filters by distance from the truth, else from a smoother without lag; and tests whether two of them differ."""
from dataclasses import dataclass

import numpy as np

from tilt import native, smoother
from tilt.angles import LSB_PER_G, angle_deg, direction, wrapped_deg

COASTED, CLIPPED, FAULT, WARMING, ROLL_UNDEFINED = 2, 8, 16, 128, 1024
BATCHES, BATCHES_MOST, BATCH_MIN, BATCH_S = 20, 200, 10, 0.5  # half a second: the memory of most filters
NOISE_T = 3.5               # Student's t with 14 degrees of freedom: 5 % two-sided, shared by the twelve comparisons with the best
INTERVAL_T = 2.14           # and 5 % for one
CUT = 4.0                   # sigmas of an innovation, above which compare counts an outlier
BOARD_FACTOR = 1.5          # the board's R over the variance (noise.h)
MOVES_DEG_S = 0.5           # least rms rate of the truth at which a lag can be measured
LAG_KNOWN_MS = 2.0
JUMP_DEG_S = 400.0          # above this rate the truth steps, or wraps at 180 degrees
CHI2_MEDIAN = 0.4549


def rms(values):
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else float("nan")


@dataclass
class Difference:
    """Of two filters' losses per sample, in units of its standard error."""
    mean: float
    t: float

    @property
    def significant(self):
        return abs(self.t) >= NOISE_T

    @property
    def interval(self):
        """Of the mean, 95 %."""
        half = INTERVAL_T * abs(self.mean / self.t) if self.t else float("inf")
        return self.mean - half, self.mean + half


def difference(loss, best, rate_hz):
    """Mean of loss - best, with its standard error from the readings' noise: batches of consecutive samples, long enough to be nearly
    uncorrelated, each compared with the next but one, so that a stretch that suits one filter does not count as noise. Fewer than 200
    samples prove nothing."""
    away = loss - best
    if len(away) < BATCHES * BATCH_MIN:
        return Difference(float(away.mean()) if len(away) else 0.0, 0.0)
    count = int(np.clip(len(away) / max(BATCH_MIN, BATCH_S * rate_hz), BATCHES, BATCHES_MOST))
    means = np.array([part.mean() for part in np.array_split(away, count)])
    error = np.sqrt(np.mean((means[2:] - means[:-2]) ** 2) / 2.0 / count)
    if error == 0.0:
        return Difference(float(means.mean()), 0.0 if means.mean() == 0.0 else float(np.copysign(np.inf, means.mean())))
    return Difference(float(means.mean()), float(means.mean() / error))


# --- with truth -------------------------------------------------------------------------------------------------------


def scored(tables):
    """Rows with a sample, after the start of every filter."""
    rows = list(tables.values())
    return np.all([(part["source"] >= 0) & ((part["flags"] & (COASTED | FAULT | WARMING)) == 0) for part in rows], axis=0)


def lag_ms(t_us, errors_deg, truth_deg):
    """Delay of the estimate after the truth: -sum(e v) / sum(v^2) over roll and pitch, v the truth's rate. None if it is not known to 2 ms or
    half its value: at rest, or with large errors (a fifth of the samples counts as independent)."""
    products = squares = spread = count = 0.0
    for error, truth in zip(errors_deg, truth_deg):
        step_s = np.maximum(t_us[2:] - t_us[:-2], 1) * 1e-6
        rate = wrapped_deg(truth[2:] - truth[:-2]) / step_s
        steady = (np.abs(rate) < JUMP_DEG_S) & (step_s < 4.0 * np.median(step_s))
        products += np.sum(error[1:-1][steady] * rate[steady])
        squares += np.sum(rate[steady] ** 2)
        spread += 5.0 * np.sum((error[1:-1][steady] * rate[steady]) ** 2)
        count += np.count_nonzero(steady)
    if not count or squares / count < MOVES_DEG_S ** 2:
        return None
    lag, known_to = -1000.0 * products / squares, 1000.0 * np.sqrt(spread) / squares
    return float(lag) if known_to <= max(LAG_KNOWN_MS, 0.5 * abs(lag)) else None


def against_truth(stream, rows, use):
    """(numbers, loss per row) of one filter over the rows in use."""
    rows = rows[use]
    truth = [stream.roll_true_cdeg[rows["source"]] / 100.0, stream.pitch_true_cdeg[rows["source"]] / 100.0]
    shown = [rows["roll_cdeg"] / 100.0, rows["pitch_cdeg"] / 100.0]
    errors = [wrapped_deg(own - true) for own, true in zip(shown, truth)]
    tilt = angle_deg(direction(*shown), direction(*truth))
    defined = (rows["flags"] & ROLL_UNDEFINED) == 0
    return {"tilt_rms_deg": rms(tilt), "roll_rms_deg": rms(errors[0][defined]), "pitch_rms_deg": rms(errors[1]), "worst_deg": float(tilt.max()),
            "lag_ms": lag_ms(rows["t_us"], errors, truth)}, tilt ** 2


# --- without truth ----------------------------------------------------------------------------------------------------


def states(rows):
    """Per row and axis: missing, present, or at a rail of 16 g."""
    found = np.full(rows["lsb"].shape, native.THERE, np.uint8)
    found[(rows["lsb"] >= 4095) | (rows["lsb"] <= -4096)] = native.AT_RAIL
    found[(rows["flags"] & (COASTED | FAULT)) != 0] = native.MISSING
    return found


def probes_of(name, rate_dhz, rows, state):
    """{axis: probes} of each axis with a reading, as the board runs the filter."""
    return {i: native.axis(name, rate_dhz, rows["lsb"][:, i], state[:, i], noisy_axis=i == 2) for i in smoother.known(state == native.THERE)}


def variance_of(probes):
    """Variance of each innovation according to the gain: R / (1 - K), K that of the last accepted sample; inf before the first."""
    gain = probes["gain_uq16"] / 65536.0
    newest = np.maximum.accumulate(np.where((gain > 0.0) & ((probes["flags"] & native.GATED) == 0), np.arange(len(gain)), -1))
    taken = np.where(newest >= 0, gain[newest], 0.0)
    return np.where(newest >= 0, probes["r_lsb2_q8"] / 256.0 / (1.0 - np.minimum(taken, 0.9999)), np.inf)


def innovations(probes):
    return probes["innovation_lsb_q16"] / 65536.0


def against_smoothed(t_us, axes, reference, use):
    """(numbers, loss per row) of one filter over the rows in use. axes: {axis: its probes}; reference: smoother.smoothed."""
    errors = np.stack([probes["x_lsb_q16"][use] / 65536.0 - reference[use, axis] for axis, probes in axes.items()], axis=1)
    loss = np.mean(errors ** 2, axis=1)
    turned = [np.degrees(part.T / LSB_PER_G[list(axes), None]) for part in (errors, reference[use][:, list(axes)])]
    ratios = [float(np.median(innovations(probes)[use] ** 2 / variance_of(probes)[use])) / CHI2_MEDIAN for probes in axes.values()]
    return {"error_lsb": float(np.sqrt(loss.mean())) if len(loss) else float("nan"), "nis": float(np.mean(ratios)),
            "lag_ms": lag_ms(t_us[use], *turned)}, loss


def judged(tables_of_probes):
    """Rows for which every filter predicted a sample on every axis."""
    return np.all([probes["judged"] == 1 for axes in tables_of_probes for probes in axes.values()], axis=0)


def wander_deg(rows, stretches):
    """Rms angle of the filtered direction from its mean over each stretch at rest; None without such a stretch."""
    away = []
    for part in stretches:
        shown = direction(rows["roll_cdeg"][part] / 100.0, rows["pitch_cdeg"][part] / 100.0)
        middle = shown.mean(axis=0)
        away.append(angle_deg(shown, middle / np.linalg.norm(middle)))
    return rms(np.concatenate(away)) if away else None
