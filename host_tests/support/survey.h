/* What the filters do on one stream, counted per axis. PC only. */
#ifndef SUPPORT_SURVEY_H
#define SUPPORT_SURVEY_H

#include "stream.h"
#include "support/envelope.h"

/* Of the rows themselves. */
typedef struct {
    size_t rows;
    size_t clipped;    /* an axis at the rail of the range */
    size_t duplicates; /* equal to the row before */
    size_t zeros;      /* 0,0,0 */
    size_t ones;       /* -1,-1,-1 */
} row_counts_t;
row_counts_t survey_rows(const stream_t *stream, uint8_t range_g);

/* Of one axis through one filter. */
typedef struct {
    size_t samples; /* after the warm-up */
    size_t gated;
    size_t reacquired;
    size_t saturated;
    size_t longest_gated;     /* in a row */
    double last_reacquired_s; /* after the first sample */
    size_t bounds_broken;     /* of the filter's documentation */
    const char *first_broken;
    size_t envelope_judged; /* by the rule band or run of support/envelope.h, and what breaks it */
    size_t envelope_broken;
    double envelope_worst; /* largest share of the allowed distance that was used */
    size_t hull_judged;
    size_t hull_broken;
    double hull_left_lsb; /* smallest distance left */
    size_t outside;       /* further than 9 sqrt(R) outside the range of the last second's raw samples */
    double outside_worst_lsb;
} axis_counts_t;

typedef struct {
    uint16_t rate_dhz;
    uint8_t range_g;
    double from_s, to_s; /* part of the stream that counts; the filter begins there */
} survey_t;

/* False: the filter refuses the rate. */
bool survey_axis(const stream_t *stream, const survey_t *survey, filter_kind_t kind, int axis, axis_counts_t *counts);

/* Shares of the samples of a resting part further from its mean than 3 and 5 standard deviations. */
typedef struct {
    size_t samples;
    double sd_lsb;
    double beyond3, beyond5;
} tails_t;
tails_t survey_tails(const stream_t *stream, double from_s, double to_s, int axis);

#endif
