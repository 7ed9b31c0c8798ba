"""Fewer points for the same picture: what is left of a long series shows every extreme and every flag that occurs."""
import numpy as np


def columns_of(t_s, count):
    """The pixel column (0..count - 1) of each time over the span of t_s, which must not go backwards."""
    span = t_s[-1] - t_s[0]
    if span <= 0.0:
        return np.zeros(len(t_s), np.int64)
    return np.minimum(((t_s - t_s[0]) * (count / span)).astype(np.int64), count - 1)


def extremes(t_s, series, count):
    """Rows to keep (ascending): in each of `count` columns the first, the last, and those with the minimum and maximum of each series. NaN is
    neither. All rows if there are no more than that."""
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
    """Flags of the kept rows: each with those of the dropped rows before it, as the board does with `every N` (except 512, 1024 and 4096, which
    it takes from the kept row alone). The last row must be a kept one, as extremes() does."""
    starts = np.concatenate(([0], kept[:-1] + 1))
    return np.bitwise_or.reduceat(flags, starts) if len(flags) else flags


def spots(t_s, values, columns, levels, limits):
    """Indices of points, one in each occupied cell of a picture of columns x levels. limits: the lowest and the highest value of the picture;
    values outside count as at the edge. NaN has no cell."""
    there = np.flatnonzero(~np.isnan(values))
    if len(there) == 0:
        return there
    low, high = limits
    level = np.clip((values[there] - low) * (levels / max(high - low, 1e-12)), 0, levels - 1).astype(np.int64)
    _, first = np.unique(columns_of(t_s, columns)[there] * levels + level, return_index=True)
    return there[np.sort(first)]


def shares(t_s, mask, count, span):
    """Share of the rows in each of `count` columns over the span (begin, end) where the mask is true. A column without rows has the share of
    the previous one; 0 outside of the rows."""
    column = np.clip(((t_s - span[0]) * (count / (span[1] - span[0]))).astype(np.int64), 0, count - 1)
    rows = np.bincount(column, minlength=count)
    share = np.bincount(column, weights=mask, minlength=count) / np.maximum(rows, 1)
    before = np.maximum.accumulate(np.where(rows > 0, np.arange(count), 0))
    return np.where(np.arange(count) <= column[-1], share[before], 0.0)


def runs(mask):
    """(first, last) row of each stretch where the mask is true."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return list(zip(edges[::2].tolist(), (edges[1::2] - 1).tolist()))
