"""Fewer points for the same picture: what is left of a long series shows every extreme, and every flag that was set."""
import numpy as np


def columns_of(t_s, count):
    """The pixel column (0..count - 1) of each time, over the span of t_s, which does not go back."""
    span = t_s[-1] - t_s[0]
    if span <= 0.0:
        return np.zeros(len(t_s), np.int64)
    return np.minimum(((t_s - t_s[0]) * (count / span)).astype(np.int64), count - 1)


def extremes(t_s, series, count):
    """Rows to keep (ascending): of each of `count` columns the first, the last, and where any of the series is least and greatest. NaN is
    neither. All rows where there are no more than that would be."""
    rows = len(t_s)
    if rows <= (2 + 2 * len(series)) * count:
        return np.arange(rows)
    column = columns_of(t_s, count)
    starts = np.flatnonzero(np.concatenate(([True], np.diff(column) > 0)))
    kept = [starts, np.concatenate((starts[1:] - 1, [rows - 1]))]
    for values in series:
        values = np.asarray(values, float)
        for filled in (np.where(np.isnan(values), np.inf, values), np.where(np.isnan(values), np.inf, -values)):
            least = np.minimum.reduceat(filled, starts)[np.cumsum(np.concatenate(([0], np.diff(column) > 0)))]
            hits = np.flatnonzero((filled == least) & np.isfinite(filled))
            kept.append(hits[np.concatenate(([True], np.diff(column[hits]) > 0))] if len(hits) else hits)  # the first of each column
    return np.unique(np.concatenate(kept))


def joined_flags(flags, kept):
    """Flags of the kept rows: each with those of the dropped rows before it, as the board does with `every N` (which says 512, 1024 and 4096 of
    the kept row alone). Rows behind the last kept
    one must not be (extremes() keeps the last)."""
    starts = np.concatenate(([0], kept[:-1] + 1))
    return np.bitwise_or.reduceat(flags, starts) if len(flags) else flags


def spots(t_s, values, columns, levels, limits):
    """Indices of points of which no two fall into one cell of a picture of columns x levels, and each of whose cells keeps one. Limits: the
    lowest and the highest value of the picture; what is outside counts as at the edge. NaN has no cell."""
    there = np.flatnonzero(~np.isnan(values))
    if len(there) == 0:
        return there
    low, high = limits
    level = np.clip((values[there] - low) * (levels / max(high - low, 1e-12)), 0, levels - 1).astype(np.int64)
    _, first = np.unique(columns_of(t_s, columns)[there] * levels + level, return_index=True)
    return there[np.sort(first)]


def shares(t_s, mask, count, span):
    """Of the rows in each of `count` columns over the span (begin, end), the share where the mask is true. A column between rows has that of
    the column before; 0 outside of the rows."""
    column = np.clip(((t_s - span[0]) * (count / (span[1] - span[0]))).astype(np.int64), 0, count - 1)
    rows = np.bincount(column, minlength=count)
    share = np.bincount(column, weights=mask, minlength=count) / np.maximum(rows, 1)
    before = np.maximum.accumulate(np.where(rows > 0, np.arange(count), 0))
    return np.where(np.arange(count) <= column[-1], share[before], 0.0)


def runs(mask):
    """(first, last) rows of each stretch where the mask is true."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return list(zip(edges[::2].tolist(), (edges[1::2] - 1).tolist()))
