"""Local observability and the degree of observability, paper 004 (3)-(16)."""
import numpy as np

GRAVITY_M_S2 = 9.81
EARTH_RADIUS_M = 6.371e6


def ins_channel(period_s=1.0, drift_decay_per_s=1.0 / 300.0):
    """(1) for one horizontal channel of an inertial system, the model of the experiments (the paper prints none).

    State [dV, phi, eps]: error of velocity in m/s, tilt of the platform in rad, drift of its gyro in rad/s. Returns F, 3 x 3:
    dV -= g T phi, phi += T dV / Re + T eps, eps decays."""
    return np.array([[1.0, -GRAVITY_M_S2 * period_s, 0.0],
                     [period_s / EARTH_RADIUS_M, 1.0, period_s],
                     [0.0, 0.0, 1.0 - drift_decay_per_s * period_s]])


def local_observability(transitions, outputs):
    """O_k of (4), (n m) x n: the rows H_k, H_k+1 F_k+1,k, H_k+2 F_k+2,k+1 F_k+1,k ...

    transitions: the n - 1 matrices F (n x n), the earliest first; outputs: the n matrices H (m x n, or n for one measurement)."""
    outputs = [np.atleast_2d(np.asarray(output, dtype=float)) for output in outputs]
    if len(outputs) != outputs[0].shape[1] or len(transitions) != len(outputs) - 1:
        raise ValueError(f"local observability of {outputs[0].shape[1]} states takes as many outputs and one transition fewer, "
                         f"not {len(outputs)} and {len(transitions)}")
    rows, product = [outputs[0]], np.eye(len(outputs))
    for transition, output in zip(transitions, outputs[1:]):
        product = np.asarray(transition, dtype=float) @ product
        rows.append(output @ product)
    return np.vstack(rows)


def constant_observability(transition, output):
    """O of (4) where F (n x n) and H (n) do not change: [H; H F; H F^2 ...]."""
    states = len(transition)
    return local_observability([transition] * (states - 1), [output] * states)


def is_observable(observability):
    """(5): rank O_k = n."""
    return int(np.linalg.matrix_rank(observability)) == observability.shape[1]


def pseudo_inverse(observability):
    """O_k^+ of (9), n x (n m); row i holds the a_j of (10) for state i."""
    return np.linalg.pinv(observability)


def equivalent_measurements(inverse, measured):
    """(10): y_k = O^+ z*_k, the states as n consecutive measurements tell them.

    inverse: n x n; measured: ... x M, one measurement a sample. Returns ... x (M - n + 1) x n."""
    return np.lib.stride_tricks.sliding_window_view(measured, inverse.shape[1], axis=-1) @ inverse.T


def noise_gains(inverse):
    """The sums of squares in (12), one for each state: R*_i = (sum over j of a_ij^2) R+. That holds for components of v* that are white and have
    one variance, so without process noise only: w of (3) makes them grow and ties them together."""
    return np.sum(np.square(inverse), axis=1)


def noise_variances(inverse, variance):
    """R* of (12) for each state, from the variance R+ of one direct measurement."""
    return noise_gains(inverse) * variance


def mean_square(values):
    """(15), (16): the mean of squares over the window. values: ... x samples x n; returns ... x n. The paper averages over n samples, the order of
    the system; any window will do, and the experiments take the 20 s for which a structure holds."""
    return np.mean(np.square(values), axis=-2)


def degree_by_variances(state_square, measured_square, variance, state_variances):
    """(13): D_i = E[x_i^2] R+ / (E[y_i^2] R*_i)."""
    with np.errstate(divide="ignore"):
        return state_square * variance / (measured_square * state_variances)


def degree(state_square, measured_square, gains):
    """(14): D_i = E[x_i^2] / (E[y_i^2] sum a_ij^2), what is left of (13) once R+ has cancelled: the noise of a sensor is not in it. Infinite for a
    sensor that reads zero for a whole window."""
    with np.errstate(divide="ignore"):
        return state_square / (measured_square * gains)


def window_degree(inverse, states, measured):
    """D of each state over a window, (14) with (15) and (16) over the same samples.

    states: ... x M x n, what the filter holds for x (the truth is not known); measured: ... x M. Returns ... x n."""
    equivalent = equivalent_measurements(inverse, measured)
    return degree(mean_square(states[..., :equivalent.shape[-2], :]), mean_square(equivalent), noise_gains(inverse))
