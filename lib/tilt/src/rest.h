/*
 * Mean, variance and stillness of a sensor at rest, from 256 readings of its three axes: enough that noise of 8 LSB rms
 * (an airframe with running motors) leaves 0.5 LSB in the mean, and a number that needs no division.
 *
 * Only sums of differences from the first reading are kept, so nothing is rounded before the end. A reading too far
 * from the first ends it: the board has moved.
 *
 * Scaling: -128 <= difference <= 127 LSB, and the first is 0, so |sum| <= 255 x 128 = 32,640, |second half - first| <=
 * 32,640 too, and squares <= 255 x 16,384 < 2^22: all exact.
 */
#ifndef REST_H
#define REST_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define REST_SAMPLES 256U

/* A first reading beyond this (7.4 g) is not a rest, and a mean in Q4 must fit 16 bits: 1,900 + 128 < 2,048 LSB. */
#define REST_LIMIT_LSB 1900

typedef struct {
    uint32_t squares_lsb2; /* of the differences from the first reading */
    int16_t sum_lsb;       /* of the differences */
    int16_t half_lsb;      /* of the first half of them */
    int16_t first_lsb;
} rest_axis_t;

typedef struct {
    rest_axis_t axes[3];
    uint8_t samples; /* 0 again after REST_SAMPLES */
    bool moved; /* a reading was 128 LSB or more from the first (127 above it), or the first beyond REST_LIMIT_LSB */
} rest_t;

/* Call before the first reading. As with all functions here, from main only. */
void rest_start(rest_t *rest);

/* Adds one reading of all axes, any numbers. True if it was the last: all are in, or the board has moved. */
bool rest_add(rest_t *rest, const int16_t lsb[3]);

/* The functions below are valid once rest_add has returned true. Mean of an axis, LSB in Q4, rounded half up. */
int16_t rest_mean_lsb_q4(const rest_axis_t *axis);

/* Variance of an axis (about the mean, divided by the number of readings), LSB^2 in Q8, rounded up; below 2^22. */
uint32_t rest_variance_lsb2_q8(const rest_axis_t *axis);

/*
 * Whether the board was still, at an output data rate in 0.1 Hz: it has not moved, and on every axis
 *
 *   - the variance is below 62.5 times the sensor's own on x and y, 0.02 LSB^2 per Hz: 125 LSB^2 at 100 Hz (z, whose
 *     own is 1.7 times that, has the same limit). A desk shows 1 to 3 times the sensor's own, an airframe with running
 *     motors 16 to 30 (33-60 LSB^2 at 100 Hz, measured): that is at rest, and its mean is good. A hand that holds the
 *     board as still as it can may pass; its mean is good too, to 0.7 LSB.
 *   - the mean of the second half is within 2 LSB of that of the first, which is slow rotation by 4 LSB (0.9 degree)
 *     that the variance does not show. White noise of variance V makes this sqrt(V / 64) rms: 0.18 LSB on a desk at
 *     100 Hz.
 */
bool rest_still(const rest_t *rest, uint16_t rate_dhz);

#ifdef __cplusplus
}
#endif
#endif
