"""Self-organisation with redundant trends, paper 004 Fig. 1, (24) and (25), and the action acceptor that compares what is predicted with what is
measured."""
import numpy as np

from .trends import TRENDS

TINY = 1e-12  # of a sum of squares: data that are all zero divide no one


def minimum_deviation(of_part_p, of_part_q, measured):
    """(24): how far the predictions of two models, one fitted to each part of the data, are apart. All ... x n; returns ... ."""
    return np.sum(np.square(of_part_p - of_part_q), axis=-1) / (np.sum(np.square(measured), axis=-1) + TINY)


def regularity(predicted, measured):
    """(25): what a prediction misses of the measurements, as a part of their energy. ... x n; returns ... ."""
    return np.sum(np.square(measured - predicted), axis=-1) / (np.sum(np.square(measured), axis=-1) + TINY)


def score(trend, data):
    """(24) between fits to the even and to the odd samples plus (25) of the second half by a fit to the first. data: ... x n; returns ... ."""
    times, half = np.arange(data.shape[-1], dtype=float), data.shape[-1] // 2
    parts = (slice(0, None, 2), slice(1, None, 2))
    models = [trend(times[part], data[..., part], times) for part in parts]
    later = trend(times[:half], data[..., :half], times[half:])
    return minimum_deviation(models[0], models[1], data) + regularity(later, data[..., half:])


def self_organised(data, ahead):
    """The trend of the least score fitted to all data, at the next `ahead` samples.

    data: ... x n. Returns (... x ahead, the number of the trend in TRENDS for each)."""
    times = np.arange(data.shape[-1], dtype=float)
    wanted = data.shape[-1] + np.arange(ahead, dtype=float)
    chosen = np.argmin(np.stack([score(trend, data) for trend in TRENDS.values()]), axis=0)
    values = np.stack([trend(times, data, wanted) for trend in TRENDS.values()])
    return np.take_along_axis(values, chosen[None, ..., None], axis=0)[0], chosen


def acceptor(predicted, measured):
    """The action acceptor: (25) of each sensor against the prediction. predicted: ... x M, measured: ... x M x sensors; ... x sensors."""
    return regularity(predicted[..., None, :], np.swapaxes(measured, -1, -2))


def misses(predicted, measured):
    """Mean square of what each sensor differs from the prediction, in its unit squared. Shapes as of acceptor()."""
    return np.mean(np.square(measured - predicted[..., None]), axis=-2)
