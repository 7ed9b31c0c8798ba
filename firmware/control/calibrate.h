/*
 * What `tare`, `cal` and `cal6` make of the means at rest that measure.h brings them: a calibration that takes effect
 * at once and stays until another one, or until the power goes, unless it is saved. Main only.
 */
#ifndef CALIBRATE_H
#define CALIBRATE_H

#include <stdbool.h>
#include <stdint.h>

#include "calibration.h"
#include "control/measure.h"

/* What the lines of the last reply are about. */
typedef struct {
    calibration_verdict_t verdict; /* with MEASURE_WRONG */
    uint16_t residual_mg;          /* of cal6: how far the worst of its positions is from 1 g */
    uint8_t position;              /* of cal6: CALIBRATION_POSITIONS, the newest one; none: that number */
    uint8_t left;                  /* positions that are not known yet */
} calibrate_told_t;
const calibrate_told_t *calibrate_told(void);

/* No position is known. */
void calibrate_start(void);

/*
 * A mean at rest, LSB in Q4, for the command of this notice_kind_t. DONE: a new calibration is in force. WRONG:
 * refused, by the verdict, and the old one stays. Of cal6 also: POSITION, one of the six is known and others are not;
 * REPEATED: it was known before; UNCHANGED: it lies as it did; BEGUN: it was the last, and calibrate_step follows.
 */
measure_outcome_t calibrate_take(uint8_t kind, const int16_t mean_lsb_q4[3]);

/* Begins with the six positions in this memory, which stays the caller's. */
void calibrate_start_six(calibration_six_t *six);

/* A piece of that, shorter than a sample of an axis: BEGUN while there are more, then DONE or WRONG. */
measure_outcome_t calibrate_step(calibration_six_t *six);

#endif
