/*
 * Gravity from two axes where the third is known bad: |a| = 1 g leaves of the third its size, and its sign is the last
 * one known. Angles taken from the completed vector are asin and acos of the axes that remain, in any position.
 *
 * What it costs (paper 004's degree of observability, (12), for tilt): an error of the axes that remain comes into the
 * missing one enlarged, and the direction's sigma is that of an axis over the missing component, 1 / cos for asin and
 * 1 / sin for acos. It grows without bound where the missing axis lies across gravity: there the bad axis is the one
 * that told the angle.
 */
#ifndef TILT_PARTIAL_H
#define TILT_PARTIAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The largest sigma that is reported, 90 degrees: it means that nothing is known. */
#define TILT_PARTIAL_SIGMA_MAX_CDEG 9000U

/*
 * Size of the component that makes (x, y, z) 1 g, at right angles to it: 1/256 g in Q6, 0..16384; 0 where they are 1 g
 * or more already. Inputs 1/256 g in Q8, any int32; cut to Q6, so that the square is too large by 2 (x + y + z) + 3 at
 * most: error <= 56760 / result + 1 units. Any context; no float, no division.
 */
uint16_t tilt_missing_q6(int32_t x_q8, int32_t y_q8, int32_t z_q8);

/*
 * Sigma of the direction, 0.01 degree, at most TILT_PARTIAL_SIGMA_MAX_CDEG: sigma of an axis (1/256 g in Q8) over the
 * missing component of tilt_missing_q6. First order: within 4 % while it is below 1.4 degrees. Any context; divides.
 */
uint16_t tilt_partial_sigma_cdeg(uint16_t sigma_q8, uint16_t missing_q6);

#ifdef __cplusplus
}
#endif
#endif
