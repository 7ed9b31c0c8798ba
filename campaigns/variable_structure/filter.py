"""The Kalman filter of the channel, many runs at once: the block of estimation algorithms of paper 004's Fig. 4."""
import numpy as np

from .observability import ins_channel
from .scenario import PROCESS

DRIVE = 4.0  # the filter's process noise by the true one, in variance
START_VARIANCE = np.array([4.0, 1e-6, 1e-9])


class Filter:
    """x: runs x 3 and its covariance, runs x 3 x 3; begins at zero."""

    def __init__(self, runs):
        self.transition, self.noise = ins_channel(), np.diag(np.square(PROCESS) * DRIVE)
        self.twice = np.kron(self.transition, self.transition).T  # F P F' of all runs as one product
        self.state = np.zeros((runs, 3))
        self.covariance = np.tile(np.diag(START_VARIANCE), (runs, 1, 1))

    def spread(self, covariance):
        """The covariance one sample later, runs x 3 x 3."""
        return (covariance.reshape(-1, 9) @ self.twice).reshape(-1, 3, 3) + self.noise

    def predict(self):
        self.state = self.state @ self.transition.T
        self.covariance = self.spread(self.covariance)

    def update(self, measured, variance):
        """measured: runs, dV in m/s; variance: runs, infinite where the sensor is not taken."""
        innovation = measured - self.state[:, 0]
        gain = self.covariance[:, :, 0] / (self.covariance[:, 0, 0] + variance)[:, None]
        self.state = self.state + gain * innovation[:, None]
        self.covariance = self.covariance - gain[:, :, None] * self.covariance[:, None, 0, :]

    def propagated(self, samples):
        """(states runs x samples x 3, variance of dV runs x samples) of the model alone from here on."""
        state, covariance = self.state, self.covariance
        states, variances = np.empty((len(state), samples, 3)), np.empty((len(state), samples))
        for k in range(samples):
            state = state @ self.transition.T
            covariance = self.spread(covariance)
            states[:, k], variances[:, k] = state, covariance[:, 0, 0]
        return states, variances
