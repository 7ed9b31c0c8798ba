"""Trends that predict a state, paper 004 (17)-(23): linear, harmonic, modified DeMark.

A trend is linear in the data, so that a fit to n samples and its values at m others are one m x n matrix; samples are at 0, 1, ... n - 1 in units
of the sampling period, and histories are arrays ... x n. Amplitudes are found together by least squares, unless a name says `separate`."""
import functools

import numpy as np

PERIODS_S = (60.0, 90.0, 150.0, 300.0, 600.0, 5064.0)  # of the harmonic trend; the last is Schuler's, 2 pi sqrt(Re / g)
SHARES = (0.5, 0.5)  # zeta of (21): of the linear and of the harmonic trend
START_SAMPLES = 3  # whose mean begins the modified DeMark trend, at the time of the middle one


def linear_basis(times):
    """(18): a slope and a constant. times: m; returns m x 2."""
    times = np.asarray(times, dtype=float)
    return np.stack([times, np.ones_like(times)], axis=1)


def harmonic_basis(times, period):
    """(19) with one frequency and a constant: A sin wt + B cos wt + C. m x 3. The paper's two frequencies and two phases fit the same data by
    infinitely many pairs of phases: a phase is already in A and B."""
    times = np.asarray(times, dtype=float)
    angle = 2.0 * np.pi / period * times
    return np.stack([np.sin(angle), np.cos(angle), np.ones_like(times)], axis=1)


def joint_amplitudes(basis):
    """Least squares over all basis functions together: L x n, applied to the data gives the amplitudes a_i of (17)."""
    return np.linalg.pinv(basis)


def separate_amplitudes(basis):
    """(22), (23): each amplitude as if its function were alone, a_i = sum chi mu_i / sum mu_i^2. L x n. Right only for orthogonal functions."""
    return (basis / np.sum(np.square(basis), axis=0)).T


def linear_matrix(fitted, wanted, amplitudes=joint_amplitudes):
    """Times at which data are, times at which the linear trend is wanted: m x n."""
    return linear_basis(wanted) @ amplitudes(linear_basis(fitted))


def harmonic_matrix(fitted, wanted, period):
    return harmonic_basis(wanted, period) @ joint_amplitudes(harmonic_basis(fitted, period))


@functools.lru_cache(maxsize=None)
def _matrices(fitted, wanted):
    """Linear and, for each period, harmonic matrices with what the harmonic leaves of the data."""
    identity = np.eye(len(fitted))
    harmonic = [(harmonic_matrix(fitted, wanted, period), identity - harmonic_matrix(fitted, fitted, period)) for period in PERIODS_S]
    return linear_matrix(fitted, wanted), harmonic


def linear(fitted, data, wanted):
    """(18). fitted: times of the data, wanted: times of the answer; data: ... x n. Returns ... x m."""
    return data @ _matrices(tuple(fitted), tuple(wanted))[0].T


def harmonic(fitted, data, wanted):
    """(19): of PERIODS_S the one that leaves least of the data. ... x m."""
    candidates = _matrices(tuple(fitted), tuple(wanted))[1]
    left = np.stack([np.sum(np.square(data @ rest.T), axis=-1) for _, rest in candidates])
    values = np.stack([data @ matrix.T for matrix, _ in candidates])
    return np.take_along_axis(values, np.argmin(left, axis=0)[None, ..., None], axis=0)[0]


def demark(fitted, data, wanted):
    """(20), (21) with what the trends grow by: x_k = x_k-1 + zeta_L (L_k - L_k-1) + zeta_N (N_k - N_k-1), begun at the mean of the last samples."""
    wanted, begin = tuple(wanted), fitted[-1 - START_SAMPLES // 2]
    grown = [trend(fitted, data, (begin,) + wanted) for trend in (linear, harmonic)]
    steps = sum(share * np.diff(values, axis=-1) for share, values in zip(SHARES, grown))
    start = np.mean(data[..., -START_SAMPLES:], axis=-1, keepdims=True)
    return start + np.cumsum(steps, axis=-1)


def demark_as_printed(fitted, data, wanted):
    """(20), (21) literally: the values of the trends are added at every step. A constant 1 m/s becomes 21 m/s in 20 steps."""
    steps = sum(share * trend(fitted, data, wanted) for share, trend in zip(SHARES, (linear, harmonic)))
    return data[..., -1:] + np.cumsum(steps, axis=-1)


TRENDS = {"linear": linear, "harmonic": harmonic, "demark": demark}
