/*
 * Measurement variance R of one axis, estimated on line and robust to outliers, because with a fixed data-sheet R a
 * 3-sigma gate refuses 9-69 % of healthy samples on real boards (measured).
 *
 * R = max(floor, 1.5 x variance); floor = 1.5 x 0.02 x rate LSB^2, times 1.7 on z; at most 1000 LSB^2.
 *
 * The variance comes from second differences, which position and rate do not affect. The smaller of two that share no
 * sample counts, so both must contain an outlier to be spoilt (15 % of the terms at 15 % outliers, against 48 % of
 * third differences). A term counts at most three times the estimate (winsorised; 4.5 times for the first 64). With 15
 * % outliers of any size the estimate settles below 4 times the variance. From 70 Hz on the differences use every
 * second sample, because the noise of powered frames is coloured (lag-1 correlation 0.1..0.3) and adjacent samples
 * would hide half of it.
 */
#ifndef NOISE_H
#define NOISE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint32_t floor_lsb2_q16; /* lowest variance before the factor 1.5 */
    uint32_t mean_lsb2_q16;  /* variance before the factor 1.5 */
    uint32_t r_lsb2_q8;      /* R in force: follows the estimate when the two differ by more than an eighth */
    int16_t history_lsb[5];  /* last raw samples, newest first */
    uint8_t filled;          /* samples in history */
    bool spaced;             /* uses every second sample: noise of powered frames is coloured */
    uint8_t terms;           /* terms seen, saturating: window half of them at first, then exponential over 256 */
} noise_t;

/*
 * Starts at the floor for this output data rate (0.1 Hz). noisy_axis: the z axis of the ADXL345, 1.7 times the
 * variance.
 */
void filter_noise_init(noise_t *n, uint16_t rate_dhz, bool noisy_axis);

/* Drops the differences across a gap, keeps the estimate. */
void filter_noise_gap(noise_t *n);

/* One raw sample in. True if R has changed enough to be passed on to the filter. */
bool filter_noise_update(noise_t *n, int16_t z_lsb);

/* R in force, LSB^2 in Q8. */
uint32_t filter_noise_r_lsb2_q8(const noise_t *n);

#ifdef __cplusplus
}
#endif
#endif
