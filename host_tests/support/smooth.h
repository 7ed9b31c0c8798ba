/*
 * What a filter's output is compared with on a recording without a truth: the recording itself, smoothed without lag;
 * and a recording as the sensor would have given it at a lower output data rate. PC only.
 */
#ifndef SUPPORT_SMOOTH_H
#define SUPPORT_SMOOTH_H

#include "stream.h"

#include <stdbool.h>
#include <stddef.h>

/*
 * Second-order Butterworth low pass forwards and backwards: no lag, half the amplitude at cut_hz (0 < cut_hz <
 * rate_hz / 4). The ends go on for up to a second as their point reflection. False: out of memory, or fewer than two
 * values.
 */
bool smooth_both_ways(double *value, size_t count, double rate_hz, double cut_hz);

/* A stream at 1 / divide of its rate: means of so many rows in a row, rounded, at the time of the last. */
typedef struct {
    stream_t stream;
    size_t *last;  /* row of the original that ends each group */
    size_t divide; /* rows of a group */
} divided_t;

/*
 * The mean of `divide` rows stands for the low pass with which the sensor itself halves its rate; groups that a gap of
 * more than 1.5 periods would cut are left out. False: out of memory, or fewer than two groups.
 */
bool stream_divide(divided_t *divided, const stream_t *whole, unsigned divide);
void divided_free(divided_t *divided);

/* Mean of the values that belong to the rows of a group. */
double divided_mean(const divided_t *divided, size_t group, const double *value);

#endif
