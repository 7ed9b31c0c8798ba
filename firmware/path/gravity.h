/*
 * Whether the sensor at rest reads gravity. Outside 0.8..1.28 g for ten seconds it is no ADXL345 within its data sheet:
 * a part with another scale, or one that lacks a calibration of its offsets. Seconds in which the board moves prove
 * nothing and do not count. Main only.
 */
#ifndef GRAVITY_H
#define GRAVITY_H

#include <stdbool.h>
#include <stdint.h>

/* Samples of another stretch, or of another sensor, follow. */
void gravity_forget(void);

/* The filtered, calibrated acceleration at the end of a second at rest, 1/256 g in Q8. */
void gravity_second(const int32_t a_q8[3]);

bool gravity_absent(void);

#endif
