"""Quaternions, scalar first, along the last axis of arrays."""
import numpy as np


def product(left, right):
    """left * right: the rotation `right`, then `left`."""
    a, b, c, d = np.moveaxis(np.asarray(left, float), -1, 0)
    e, f, g, h = np.moveaxis(np.asarray(right, float), -1, 0)
    return np.stack([a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f,
                     a * h + b * g - c * f + d * e], axis=-1)


def inverse(quaternion):
    """Of a unit quaternion."""
    return np.asarray(quaternion, float) * np.array([1.0, -1.0, -1.0, -1.0])


def normalised(quaternion):
    quaternion = np.asarray(quaternion, float)
    return quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True)


def matrix(quaternion):
    """(..., 3, 3): b to n."""
    a, b, c, d = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    rows = [[a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def of_euler(roll, pitch, heading):
    """From angles in radian: heading about down, then pitch, then roll."""
    zero = np.zeros(np.broadcast(roll, pitch, heading).shape)
    turns = [np.stack([np.cos(angle / 2) + zero, *(np.sin(angle / 2) * own + zero for own in axis)], axis=-1)
             for angle, axis in ((heading, (0, 0, 1)), (pitch, (0, 1, 0)), (roll, (1, 0, 0)))]
    return product(product(turns[0], turns[1]), turns[2])


def euler(quaternion):
    """(..., 3): roll, pitch, heading in radian."""
    turn = matrix(quaternion)
    return np.stack([np.arctan2(turn[..., 2, 1], turn[..., 2, 2]), -np.arcsin(np.clip(turn[..., 2, 0], -1.0, 1.0)),
                     np.arctan2(turn[..., 1, 0], turn[..., 0, 0])], axis=-1)


def vector_between(true, computed):
    """(..., 3): the small rotation about the axes n, in radian, from the computed attitude to the true one."""
    between = product(true, inverse(normalised(computed)))
    return 2 * between[..., 1:] * np.where(between[..., :1] < 0, -1.0, 1.0)
