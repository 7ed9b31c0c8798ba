/*
 * Turns the means at rest from measure.h into a calibration, for `tare`, `cal` and `cal6`. It takes effect at once and
 * stays in force until the next one or, unless it is saved, until power-off. Main only.
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
    uint16_t residual_mg;          /* cal6: how far its worst position is from 1 g */
    uint8_t position;              /* cal6: the newest one; CALIBRATION_POSITIONS: none */
    uint8_t left;                  /* cal6: positions still missing */
} calibrate_report_t;
const calibrate_report_t *calibrate_report(void);

/* Forgets all positions. */
void calibrate_start(void);

/*
 * Takes a mean at rest, LSB in Q4, for the command of this notice_kind_t. DONE: a new calibration is in force. WRONG:
 * refused, for the reason in the verdict; the old one stays. Also for cal6: POSITION, one of the six is known and
 * others are missing; REPEATED, it was known before; UNCHANGED, the board lies as before, or between two positions;
 * BEGUN, it was the last, and calibrate_step follows.
 */
measure_outcome_t calibrate_take(uint8_t kind, const int16_t mean_lsb_q4[3]);

/* Starts to solve the six positions, in this memory, which stays the caller's. */
void calibrate_start_six(calibration_six_t *six);

/* One step of that, shorter than a sample of an axis: BEGUN while more follow, then DONE or WRONG. */
measure_outcome_t calibrate_step(calibration_six_t *six);

#endif
