/*
 * What the filters share inside: legal ranges, the default of R and the robust start, the running median of the first
 * FILTER_WARM_UP_SAMPLES samples. Internal to the library; main or interrupt.
 */
#ifndef FILTER_COMMON_H
#define FILTER_COMMON_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

/* filter_clamp_z as a function: 20 bytes less for each and 8 cycles more. */
int16_t filter_limited_z(int16_t z_lsb);

/* All of a state to 0, gaps too. */
void filter_zero(void *state, size_t size);

/* True when rate and R are within their legal ranges. */
bool filter_common_legal(uint16_t rate_dhz, uint32_t r_lsb2_q8);

/*
 * R to start from at an output data rate: 1.5 x 0.02 x rate LSB^2 (0.14 LSB per root Hz, measured on real boards),
 * limited.
 */
uint32_t filter_default_r_lsb2_q8(uint16_t rate_dhz);

/* R limited to its legal range. */
uint32_t filter_limited_r_lsb2_q8(uint32_t r_lsb2_q8);

/*
 * k = 2 / memory in samples, UQ0.16 rounded down, of a fading memory of memory_ms (1..60000) at a rate (50..40000):
 * k_min_uq16 to FILTER_K_MAX_UQ16, 0.6: with a memory below 3.3 samples a filter nearly follows the raw samples.
 */
#define FILTER_K_MAX_UQ16 39322U
uint16_t filter_memory_k_uq16(uint16_t memory_ms, uint16_t rate_dhz, uint16_t k_min_uq16);

/* Median of `count` ascending samples, LSB in Q16: the mean of the middle two when count is even; count >= 1. */
int32_t filter_warm_up_median_q16(const int16_t *ascending_lsb, uint8_t count);

/* An element of a covariance halved. */
void filter_halve(uint32_t *p);

/* One sample more, kept ascending; count samples are there before. */
void filter_warm_up_insert(int16_t *ascending_lsb, uint8_t count, int16_t z_lsb);

#ifdef __cplusplus
}
#endif
#endif
