"""Numbers of many runs with their 95 % intervals: order statistics for quantiles, the bootstrap over runs for everything else."""
from collections import namedtuple

import numpy as np

Interval = namedtuple("Interval", "value low high")
CONFIDENCE = 0.95
RESAMPLES = 1000
CHUNK = 100  # resamples at a time


def binomial_cumulative(count, part):
    """P(K <= k) for k = 0 .. count of a binomial K."""
    k = np.arange(1, count + 1)
    logarithms = np.concatenate(([0.0], np.cumsum(np.log((count - k + 1) / k)))) + np.arange(count + 1) * np.log(part)
    return np.cumsum(np.exp(logarithms + np.arange(count, -1, -1) * np.log1p(-part)))


def quantile(values, part=0.5):
    """A quantile between the order statistics that hold it with 95 %; where there are too few of them the interval is None."""
    ordered = np.sort(np.asarray(values, dtype=float))
    cumulative, tail = binomial_cumulative(len(ordered), part), (1.0 - CONFIDENCE) / 2.0
    below = int(np.searchsorted(cumulative, tail, side="right")) - 1  # the largest k with P(K <= k) <= tail
    above = int(np.searchsorted(cumulative, 1.0 - tail))  # the least k with P(K <= k) >= 1 - tail
    found = float(np.quantile(ordered, part))
    if below < 0 or above >= len(ordered):
        return Interval(found, None, None)
    return Interval(found, float(ordered[below]), float(ordered[above]))


def bootstrap(statistic, seed, *columns):
    """`statistic` takes arrays resamples x runs x ..., one for each column (runs x ...), and gives a number for each resample."""
    columns = [np.asarray(column, dtype=float) for column in columns]
    chance, runs, found = np.random.default_rng([seed, len(columns[0])]), len(columns[0]), []
    for _ in range(RESAMPLES // CHUNK):
        drawn = chance.integers(0, runs, (CHUNK, runs))
        found.append(statistic(*(column[drawn] for column in columns)))
    low, high = np.quantile(np.concatenate(found), ((1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0))
    return Interval(float(statistic(*(column[None] for column in columns))[0]), float(low), float(high))


def mean(values, seed):
    return bootstrap(lambda part: np.mean(part, axis=1), seed, values)


def ratio(above, below, seed):
    """The sum of one column by the sum of another."""
    return bootstrap(lambda a, b: np.sum(a, axis=1) / np.maximum(np.sum(b, axis=1), 1e-300), seed, above, below)


def pooled_median(values, seed):
    """The median of all values, runs x values: those of one run are not independent, so whole runs are drawn."""
    return bootstrap(lambda part: np.median(part.reshape(len(part), -1), axis=1), seed, values)
