/*
 * Goes with the filter `auto`: reports the choices of its banks, and leaves an axis that is known to be bad out of the
 * angles, which then come from the other two and |a| = 1 g (tilt_partial.h). Main only.
 *
 * An axis is bad when it has been at the rail of its range for 16 samples, or has repeated a reading for 250, while
 * another axis changes: a centred axis of 0.265 LSB rms, the data sheet's 0.75 at 100 Hz scaled to 12.5 Hz, repeats
 * itself that often once in ten days. With two bad axes too little is left: then none is left out. The sign of the
 * missing component is that of the last estimate before the readings began to repeat.
 *
 * Only in images with `auto` (mk/images.mk), and while it is in force.
 */
#ifndef SUPERVISOR_H
#define SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "calibration.h"
#include "tilt_axis.h"

#ifndef SUPERVISOR
#define SUPERVISOR 0
#endif

enum { SUPERVISOR_RAIL_SAMPLES = 16, SUPERVISOR_REPEATED_SAMPLES = 250 };

/* No axis is left out, nothing is known about the readings. */
void supervisor_reset(void);

/* The readings of a sample, and of the one before. */
void supervisor_look(const int16_t before[3], const int16_t lsb[3]);

/* What the sample path knows of the newest sample. */
typedef struct {
    const tilt_axis_t *axes; /* three of them */
    const int16_t *lsb;      /* the readings */
    int16_t rail_high_lsb;
    const calibration_t *calibration;
    const calibration_applied_t *applied; /* the same, prepared */
} supervisor_view_t;

/* Call after each sample or prediction: finds the bad axis, and what is missing without it. */
void supervisor_sample(const supervisor_view_t *view);

/* Replaces the bad axis' estimate (LSB in Q8) by what the others lack to 1 g. False: no axis is bad. */
bool supervisor_complete(const calibration_t *calibration, int32_t estimates_q8[3]);

/*
 * Prints "x slow y fast z fast", and for an axis left out "without z sigma cdeg 93", for `status`; nothing for other
 * filters.
 */
void supervisor_say(const tilt_axis_t axes[3]);

#endif
