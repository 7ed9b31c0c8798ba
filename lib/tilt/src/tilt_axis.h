/*
 * One axis of the path from readings to tilt: noise estimate, filter, and the handling of missing samples and of those
 * after a gap. tilt_filter.h has three of them, and so has the firmware's sample path.
 */
#ifndef TILT_AXIS_H
#define TILT_AXIS_H

#include <stdbool.h>
#include <stdint.h>

#include "filter.h"
#include "noise.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Flags of a sample; the numbers are those of the column `flags` that the firmware sends. */
enum tilt_flag {
    TILT_GATED = 1,             /* an axis refused its sample, or used part of it */
    TILT_COASTED = 2,           /* a prediction, no sample */
    TILT_REACQUIRED = 4,        /* an axis restarted where samples agree with each other, not with the estimate */
    TILT_CLIPPED = 8,           /* an axis is at the rail of its range: its sample counts as missing */
    TILT_WARMING_UP = 128,      /* an axis is collecting the samples of its start */
    TILT_NOT_GRAVITY = 512,     /* filtered |a| is outside 0.85..1.15 g: do not trust the tilt */
    TILT_ROLL_UNDEFINED = 1024, /* x points up or down: the last roll is held */
    TILT_SWITCHED = 2048        /* `auto` has switched to another of its members */
};

typedef struct {
    uint8_t away; /* after a hold: 1, plus 1 for each sample away from the held value; otherwise 0 */
    noise_t noise;
    filter_t filter;
} tilt_axis_t;

/* rail_high_lsb is the highest reading of a range; it and the lowest, its complement, are the rails. */
static inline bool tilt_at_rail(int16_t lsb, int16_t rail_high_lsb)
{
    return lsb >= rail_high_lsb || lsb <= (int16_t)(-rail_high_lsb - 1);
}

/* The estimate in LSB: with 8 fraction bits, and whole, rounded half up. */
int32_t tilt_axis_estimate_q8(const tilt_axis_t *a);
int16_t tilt_axis_estimate_lsb(const tilt_axis_t *a);

/* Attaches an initialised filter to the axis and sets the noise to that of a sensor at rest; noisy_axis: z. */
void tilt_axis_begin(tilt_axis_t *a, uint16_t rate_dhz, bool noisy_axis);

/*
 * One sample. own_r: R is the caller's, not the estimated one; a law that identifies its own is not given one. The
 * estimate is in a->filter; returns the flags of the sample on this axis.
 *
 * A sample at the rail of its range only shows that the value is outside, so it counts as missing. After a hold (100 ms
 * without a sample) the filter continues from the held value if the sample is near it. A single sample away from it may
 * be a bad reading. At the second in a row the filter restarts and keeps what it knows about the noise.
 */
uint8_t tilt_axis_update(tilt_axis_t *a, int16_t lsb, int16_t rail_high_lsb, bool own_r);

/* No sample: the filter predicts, and holds after 100 ms. */
uint8_t tilt_axis_missing(tilt_axis_t *a);

#ifdef __cplusplus
}
#endif
#endif
