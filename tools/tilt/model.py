"""R, q and gate of the two-state filters, estimated from a recording with the predictions of the shipped code.

The model of kf and sprf: a position whose rate is driven by white acceleration of power density q, measured with noise of variance R.
R comes from the stretches at rest. q maximises the likelihood of the innovations in motion, computed with sprf at 4 sigmas, so that outliers
do not enter the estimate; each term counts as 4 sigmas at most, so that they do not dominate the sum.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tilt import ROBUST, judge, native, rest

CUT = 4.0                   # sigmas, of the gate and of the sum
GAP_SAMPLES_S = 0.3         # a longer gap counts as one of this length: the filter restarts after it
GRID = np.arange(0.0, 9.01, 0.5)  # log10 of q in LSB2/s3: its legal range
WIDTHS = (0.25, 0.1, 0.2)   # decades of three parabolas: the last gives the curvature, which integer filters blur below 0.1
CHI2_95 = 3.84
EDGE = 0.05                 # decades from the end of the range
NIS_MAX, CORRELATION_MAX, RUNS_MAX = 1.25, 0.10, 0.20  # limits of a model that fits
FAR_MIN = 20                # samples beyond 4 sigmas that make a share of runs meaningful
R_ROUNDS, R_SETTLED = 6, 0.03
KEPT_NIS = 0.99884          # mean of g^2 within 4 sigmas: 1 - 8 phi(4) / (2 Phi(4) - 1) - its complement's share
MOTION_MIN = 300            # samples of motion needed to estimate q
GATES = (2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0)


@dataclass
class Samples:
    """A recording on an even grid: readings (n, 3), states (n, 3) as native.axis takes them, samples in motion, rate."""
    lsb: np.ndarray
    state: np.ndarray
    moving: np.ndarray
    rate_dhz: int
    rest: rest.Rest


def gridded(stream, rate_dhz):
    """Samples with the missing ones inserted, as a filter counts them."""
    step_us = max(stream.step_us, 1)
    steps = np.round(np.diff(stream.t_us) / step_us).astype(np.int64)
    begins = np.zeros(len(stream) - 1, bool)
    begins[[part.start - 1 for part in stream.segments[1:]]] = True
    longest = max(3, round(GAP_SAMPLES_S * rate_dhz / 10))
    steps = np.where(begins, longest, np.clip(steps, 1, longest))
    place = np.concatenate(([0], np.cumsum(steps)))
    lsb = np.zeros((place[-1] + 1, 3), np.int16)
    state = np.full((place[-1] + 1, 3), native.MISSING, np.uint8)
    lsb[place] = stream.lsb
    state[place] = np.where(stream.missing[:, None], native.MISSING,
                            np.where((stream.lsb >= 4095) | (stream.lsb <= -4096), native.AT_RAIL, native.THERE))
    found = rest.find(lsb, (state == native.THERE).all(axis=1), rate_dhz / 10)
    return Samples(lsb, state, ~rest.mask(found, len(lsb)), rate_dhz, found)


def board_r_lsb2(samples):
    """The board's R per axis: median over the recording."""
    return np.array([float(np.median(probes["r_lsb2_q8"])) / 256.0 for probes in run(samples, ROBUST, {})])


def run(samples, name, values, r_lsb2=None):
    """Probes of the three axes."""
    return [native.axis(name, samples.rate_dhz, samples.lsb[:, i], samples.state[:, i], values, None if r_lsb2 is None else r_lsb2[i], i == 2)
            for i in range(3)]


def deviance(samples, r_lsb2, log_q, use):
    """-2 log likelihood of the innovations in use, up to a constant."""
    total = 0.0
    for probes in run(samples, ROBUST, {"q": 10.0 ** log_q, "gate": CUT}, r_lsb2):
        variance = judge.variance_of(probes)
        part = use & (probes["judged"] == 1) & np.isfinite(variance)
        ratio = judge.innovations(probes)[part] ** 2 / variance[part]
        total += float(np.sum(np.log(variance[part]) + np.minimum(ratio, CUT ** 2)))
    return total


@dataclass
class Drive:
    """q with its 95 % interval in LSB2/s3, and why it cannot be estimated, or None."""
    q: float
    low: float
    high: float
    trouble: str | None = None


def _parabola(at, values):
    """Position of the minimum of the parabola through three points, and its second derivative."""
    second = (values[0] - 2.0 * values[1] + values[2]) / (at[1] - at[0]) ** 2
    if second <= 0.0:
        return at[1], 0.0
    return at[1] - 0.5 * (values[2] - values[0]) / (at[2] - at[0]) * 2.0 / second, second


def find_q(samples, r_lsb2, report=lambda done, whole: None):
    """Drive of the samples in motion: a grid search, then ever narrower parabolas."""
    use = samples.moving
    if np.count_nonzero(use & (samples.state != native.MISSING).all(axis=1)) < MOTION_MIN:
        return Drive(0.0, 0.0, 0.0, "too little motion to estimate q")
    coarse = []
    for i, log_q in enumerate(GRID):
        coarse.append(deviance(samples, r_lsb2, log_q, use))
        report(i + 1, len(GRID) + 9)
    best, second = float(GRID[int(np.argmin(coarse))]), 0.0
    for i, width in enumerate(WIDTHS):
        at = np.clip(best + width * np.array([-1.0, 0.0, 1.0]), GRID[0], GRID[-1])
        if at[0] == at[1] or at[1] == at[2]:
            break
        place, second = _parabola(at, [deviance(samples, r_lsb2, log_q, use) for log_q in at])
        best = float(np.clip(place, at[0], at[2]))
        report(len(GRID) + 3 * i + 3, len(GRID) + 9)
    if best < GRID[0] + EDGE or best > GRID[-1] - EDGE or second <= 0.0:
        return Drive(10.0 ** best, 0.0, float("inf"), "no best q within its range of 1 to 1e9 LSB2/s3")
    half = np.sqrt(2.0 * CHI2_95 / second)
    return Drive(10.0 ** best, 10.0 ** (best - half), 10.0 ** (best + half))


# --- does it fit ------------------------------------------------------------------------------------------------------


@dataclass
class Fit:
    """Of innovations in motion: mean square over the model's variance, per axis (expected 1); correlation of neighbours (0); share beyond 4
    sigmas, and how many of those are followed by another one (for single outliers the same share)."""
    nis_axes: np.ndarray
    correlation: float
    outliers: float
    runs: float
    count: int

    @property
    def nis(self):
        return float(np.mean(self.nis_axes))

    def troubles(self):
        """Evidence against the model, beyond chance and of practical size."""
        chance = 3.3 / np.sqrt(max(self.count, 1))
        said = []
        if not 1.0 / NIS_MAX - chance <= self.nis <= NIS_MAX + chance:
            said.append(f"squared innovations are {self.nis:.2f} times their expected value")
        if abs(self.correlation) > CORRELATION_MAX + chance:
            said.append(f"neighbouring innovations are correlated ({self.correlation:+.2f})")
        if self.outliers * self.count >= FAR_MIN and self.runs > RUNS_MAX + self.outliers:
            said.append(f"readings beyond 4 sigmas come in runs ({100 * self.runs:.0f} % precede another): jumps or shaking, no single outliers")
        return said


def fit_of(samples, r_lsb2, q):
    """Fit of the samples in motion."""
    squares, inliers = np.zeros(3), np.zeros(3, int)
    products = power = far = again = 0.0
    for axis, probes in enumerate(run(samples, ROBUST, {"q": q, "gate": CUT}, r_lsb2)):
        variance = judge.variance_of(probes)
        use = samples.moving & (probes["judged"] == 1) & np.isfinite(variance)
        ratio = np.where(use, judge.innovations(probes) / np.sqrt(np.where(use, variance, 1.0)), 0.0)
        inside, beyond = use & (np.abs(ratio) <= CUT), use & (np.abs(ratio) > CUT)
        pairs = inside[1:] & inside[:-1]
        squares[axis], inliers[axis] = np.sum(ratio[inside] ** 2), np.count_nonzero(inside)
        products += float(np.sum(ratio[1:][pairs] * ratio[:-1][pairs]))
        power += 0.5 * float(np.sum(ratio[1:][pairs] ** 2 + ratio[:-1][pairs] ** 2))
        far += np.count_nonzero(beyond)
        again += np.count_nonzero(beyond[1:] & beyond[:-1])
    count = int(inliers.sum())
    return Fit(squares / np.maximum(inliers, 1) / KEPT_NIS, products / power if power else 0.0, far / max(far + count, 1), again / max(far, 1), count)


def find_both(samples, r_lsb2, report=lambda done, whole: None):
    """(R, Drive) of a recording without rest: R is adjusted until the innovations match it, from a first estimate by differences."""
    for _ in range(R_ROUNDS):
        drive = find_q(samples, r_lsb2, report)
        if drive.trouble:
            break
        factor = fit_of(samples, r_lsb2, drive.q).nis_axes
        r_lsb2 = r_lsb2 * factor
        if np.all(np.abs(factor - 1.0) < R_SETTLED):
            break
    return r_lsb2, drive


# --- gate, and comparison with the defaults ----------------------------------------------------------------------------


def losses(samples, name, values, sigma_lsb):
    """(per sample: squared innovations in sigmas, at most 4, mean of the axes; where they count), as the board runs the filter."""
    axes = run(samples, name, values)
    use = np.all([probes["judged"] == 1 for probes in axes], axis=0)
    return np.mean([np.minimum((judge.innovations(probes) / sigma) ** 2, CUT ** 2) for probes, sigma in zip(axes, sigma_lsb)], axis=0), use


def compared(samples, name, first, second, sigma_lsb):
    """judge.Difference of two sets of parameters, first - second, and the mean loss of each."""
    (a, use_a), (b, use_b) = (losses(samples, name, values, sigma_lsb) for values in (first, second))
    use = use_a & use_b
    return judge.difference(a[use], b[use], samples.rate_dhz / 10), float(a[use].mean()), float(b[use].mean())


def find_gate(samples, name, q, sigma_lsb, usual):
    """(gate, gates that are equally good): the best, or of those not significantly worse the one nearest to the default."""
    means = {gate: float(np.mean(loss[use])) for gate in GATES for loss, use in [losses(samples, name, {"q": q, "gate": gate}, sigma_lsb)]}
    best = min(means, key=means.get)
    equal = [gate for gate in GATES if gate == best or
             not compared(samples, name, {"q": q, "gate": gate}, {"q": q, "gate": best}, sigma_lsb)[0].significant]
    return min(equal, key=lambda gate: abs(np.log(gate / usual))), equal
