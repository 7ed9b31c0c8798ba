/*
 * Gravity from two axes when the third is known to be bad: |a| = 1 g gives the magnitude of the third, and its sign is
 * the last one known. Angles from the completed vector are asin and acos of the remaining axes, in any position.
 *
 * The cost (paper 004's degree of observability, (12), for tilt): an error of the remaining axes enters the missing one
 * amplified, and the sigma of the direction is that of an axis over the missing component, 1 / cos for asin and 1 / sin
 * for acos. It grows without bound where the missing axis is perpendicular to gravity: there the angle was measured by
 * the bad axis.
 */
#ifndef TILT_PARTIAL_H
#define TILT_PARTIAL_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Largest sigma that is reported, 90 degrees: nothing is known. */
#define TILT_PARTIAL_SIGMA_MAX_CDEG 9000U

/*
 * Magnitude of the component that, perpendicular to (x, y, z), completes it to 1 g: 1/256 g in Q6, 0..16384; 0 if they
 * are 1 g or more already. Inputs 1/256 g in Q8, any int32; truncated to Q6, so that the square is too large by 2 (x +
 * y + z) + 3 at most: error <= 56760 / result + 1 units. Any context; no float, no division.
 */
uint16_t tilt_missing_q6(int32_t x_q8, int32_t y_q8, int32_t z_q8);

/*
 * Sigma of the direction, 0.01 degree, at most TILT_PARTIAL_SIGMA_MAX_CDEG: sigma of an axis (1/256 g in Q8) over the
 * missing component from tilt_missing_q6. First order: within 4 % while it is below 1.4 degrees. Any context; divides.
 */
uint16_t tilt_partial_sigma_cdeg(uint16_t sigma_q8, uint16_t missing_q6);

#ifdef __cplusplus
}
#endif
#endif
