/*
 * What goes with the filter `auto`: the choices of its banks reported, and an axis that is known bad left out of the
 * angles, which then come from the other two and |a| = 1 g (tilt_partial.h). Main only.
 *
 * An axis is bad when it has stood at the rail of its range for 16 samples or repeated a reading for 250 while another
 * axis changes: a centred axis of 0.265 LSB rms, the data sheet's 0.75 at 100 Hz taken to 12.5 Hz, did so once in ten
 * days of it. Two bad axes leave too little: none is left out then. The sign of the missing component is that of the
 * last estimate before its readings began to repeat.
 *
 * In images with `auto` only (mk/images.mk), and while it is in force.
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

/* No axis is left out, nothing is known of their readings. */
void supervisor_reset(void);

/* The readings of a sample, and those of the one before. */
void supervisor_look(const int16_t before[3], const int16_t lsb[3]);

/* What the sample path has of the newest sample. */
typedef struct {
    const tilt_axis_t *axes; /* three */
    const int16_t *lsb;      /* the readings */
    int16_t rail_high_lsb;
    const calibration_t *calibration;
    const calibration_applied_t *applied; /* the same, prepared */
} supervisor_view_t;

/* After each sample or prediction: which axis is bad, and what is missing without it. */
void supervisor_sample(const supervisor_view_t *view);

/* In the place of the bad axis' estimate (LSB in Q8) what the others leave of 1 g: true; false: no axis is bad. */
bool supervisor_complete(const calibration_t *calibration, int32_t estimates_q8[3]);

/*
 * "x slow y fast z fast", and of an axis left out "without z sigma cdeg 93", for `status`; nothing of other
 * filters.
 */
void supervisor_say(const tilt_axis_t axes[3]);

#endif
