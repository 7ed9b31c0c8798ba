/*
 * What the synthesised filters (synth, synth_opt, synth_plus) share inside: three estimates, the start, and one step
 *
 *   x_e = 2 x1 - x2 + addend,   u = z - x_e,   x = x_e + gain u
 *
 * with the addend that makes the filter. Internal to the library; main or interrupt.
 */
#ifndef SYNTH_COMMON_H
#define SYNTH_COMMON_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `collected` behind the start, whose gains are those of samples 6..63 at most. */
enum { SYNTH_STEADY = 255, SYNTH_FIRST_GAIN = FILTER_WARM_UP_SAMPLES, SYNTH_END_GAIN = 63 };

/* A lower gain than 0.01 would need more than 16 bits of it: the lag goes with 1 / b0. */
#define SYNTH_B0_MIN_UQ16 656
#define SYNTH_B0_MAX_UQ16 65535
#define SYNTH_A1_MAX_Q16 65535

typedef struct {
    union {
        struct {
            int32_t x_lsb_q16[3];   /* estimates, newest first; each |x| <= FILTER_X_MAX_LSB */
            int32_t median_lsb_q16; /* of the start: the output until the next step */
        } run;
        struct {
            int16_t seen_lsb[FILTER_WARM_UP_SAMPLES];      /* in the order of time */
            int16_t ascending_lsb[FILTER_WARM_UP_SAMPLES]; /* and of size */
        } start;
    } u;
    int32_t innovation_lsb_q16; /* of the last step, |innovation| <= 8704 LSB; 0 after a coast */
    uint32_t r_lsb2_q8;
    uint16_t gain_uq16; /* of the last step */
    uint8_t flags;
    uint8_t collected; /* samples since init: 0..4 warming up, 5..63 gains of the start, SYNTH_STEADY */
} synth_core_t;

/* What limits a start sample's distance from the median in the line of synth_warm_up. */
typedef struct {
    uint16_t motion_lsb; /* part of spread_lsb that motion may cause */
    int16_t spread_lsb;  /* a start sample further from the median than this counts as lying this far from it */
} synth_spread_t;

/* Nothing collected; `size` bytes from the core on, of the filter that it begins, are 0. */
void synth_begin(synth_core_t *c, size_t size);

/* The measurement variance, limited to its legal range. */
void synth_take_noise(synth_core_t *c, uint32_t r_lsb2_q8);

/* Motion of two samples at that rate. */
void synth_spread_of_rate(synth_spread_t *spread, uint16_t rate_dhz);

/* synth_take_noise, and for the line of the start 6 sigma of it and the motion, limited. */
void synth_take_noise_and_spread(synth_core_t *c, synth_spread_t *spread, uint32_t r_lsb2_q8);

/* As if z0 had been read for ever. */
void synth_at_rest(synth_core_t *c, int16_t z0_lsb);

/*
 * One sample of the start, z within its clamp. Returns the running median. When all are there the estimates are those
 * of the line of least squares through them, each limited to the median -+ spread; or, without a spread, all equal to
 * the median.
 */
int32_t synth_warm_up(synth_core_t *c, int16_t z_lsb, const synth_spread_t *spread);

/* Estimate in force: the running median while warming up. */
int32_t synth_estimate(const synth_core_t *c);

/*
 * The gain for this sample, at least b0: (4 n - 2) / (n (n + 1)) of a least-squares line through n samples in the
 * start, which ends with the first of them that is not above b0 or with sample SYNTH_END_GAIN.
 */
uint16_t synth_next_gain_uq16(synth_core_t *c, uint16_t b0_uq16);

/* v x factor, rounded half away from zero; a call of its own for the products. */
int32_t synth_scaled(int32_t v, uint16_t factor_uq16);

/* x1 - 2 x2 + x3, or minus that; < 18432 LSB. */
int32_t synth_bend(const synth_core_t *c, bool negative);

/*
 * The estimates moved on and 2 x1 - x2 + addend, limited, in the place of the newest. |addend| <= 18432 LSB: with
 * |2 x1 - x2| <= 13824 the sum stays below 2^31 in Q16.
 */
void synth_extrapolate(synth_core_t *c, int32_t addend_q16);

/* The newest estimate towards z by gain_uq16. Returns it. */
int32_t synth_correct(synth_core_t *c, int16_t z_lsb);

/* Flags, innovation and gain of a missing sample; true when there are estimates to be extrapolated. */
bool synth_coasts(synth_core_t *c);

/* The last steps of the estimate halved, and with them its rate and its curvature; nothing in the start. */
void synth_core_damp(synth_core_t *c);

/*
 * For a filter whose rate is the difference of two estimates, the noise of which is 0.3 to 0.7 sigmas of a sample:
 * unless it is more than three it is taken as 0, and so is the curvature. Nothing in the start.
 */
void synth_core_gap(synth_core_t *c);

/* Nothing collected any more; the estimate is unknown until the next sample. */
void synth_core_restart(synth_core_t *c);

/* All of the probe; the variance is R, and the gate none. */
void synth_probe_core(const synth_core_t *c, filter_probe_t *out);

/* R x noise_gain, saturated. */
uint32_t synth_variance_lsb2_q8(const synth_core_t *c, uint32_t noise_gain_uq16);

#ifdef __cplusplus
}
#endif
#endif
