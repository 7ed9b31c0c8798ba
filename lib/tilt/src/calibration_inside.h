/* Shared by the calibration files. */
#ifndef CALIBRATION_INSIDE_H
#define CALIBRATION_INSIDE_H

#include <stdint.h>

#include "calibration.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 g in Q14, and the squared limits of the length of a level vector, 0.85 and 1.15 g, in Q28. */
#define CALIBRATION_ONE_Q14 16384
#define CALIBRATION_LEVEL_MIN_Q28 ((uint32_t)193944617UL)
#define CALIBRATION_LEVEL_MAX_Q28 ((uint32_t)355005890UL)

/*
 * a x 2^16 / b, rounded half away from zero; |a| < 2^16, b > 1. The only division of the calibration; the formats are
 * chosen to suit it: LSB in Q4 over LSB/g in UQ9.6 gives g in Q14, LSB in Q4 over g in Q14 gives LSB/g in UQ9.6.
 */
int32_t calibration_over(int32_t a, uint16_t b);

uint32_t calibration_square(int16_t a);

/*
 * A reading of one of the sensor's axes, Q4, in g, Q14, limited to 2 g. A mean that is 2,048 LSB or more from a legal
 * offset also gives 2 g, with the opposite sign.
 */
int16_t calibration_gravity_q14(const calibration_t *c, uint8_t axis, int16_t lsb_q4);

/* The sensor axis, 0..2, that an entry of `axes` names. */
static inline uint8_t calibration_named(int8_t axis)
{
    return (uint8_t)((axis < 0 ? -axis : axis) - 1);
}

static inline calibration_verdict_t calibration_verdict(calibration_why_t why, uint8_t where)
{
    return (calibration_verdict_t){ (uint8_t)why, where };
}

/* Copies found to *c if it is legal. */
calibration_verdict_t calibration_commit(calibration_t *c, const calibration_t *found);

#ifdef __cplusplus
}
#endif
#endif
