/*
 * What the synthesised laws share (synth, synth_opt, synth_plus): the start, and one step
 *
 *   x_e = 2 x1 - x2 + addend,   u = z - x_e,   x = x_e + b0 u
 *
 * where the addend is what distinguishes the filters. In the tracker's state this is v = x1 - x2: w1 = w2 = b0. The
 * papers have no limit of v. With one (ratemax of synth and synth_opt) a single outlier moves the estimate by b0 u, but
 * the predictions after it go on by no more than the limit. Internal to the library.
 */
#ifndef SYNTH_H
#define SYNTH_H

#include "tracker.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `count` of a filter with steady gains, and where the gains of the start begin and end. */
enum { SYNTH_STEADY = 255, SYNTH_FIRST_GAIN = FILTER_WARM_UP_SAMPLES, SYNTH_END_GAIN = 63 };

/* A gain below 0.01 would need more than 16 bits: the lag goes with 1 / b0. */
#define SYNTH_B0_MIN_UQ16 656
#define SYNTH_B0_MAX_UQ16 65535

/* Noise for the report, and to decide whether the rate is kept when samples are missing. */
void filter_synth_take_noise(filter_t *f, uint32_t r_lsb2_q8);

/* Starts at the median of the start; settled: at rest with the steady gains. */
void filter_synth_start(filter_t *f, bool settled);

/*
 * The gain for this sample, at least b0. During the start it is (4 n - 2) / (n (n + 1)) of a least-squares line through
 * n samples. The start ends with the first of these that is not above b0, or with sample SYNTH_END_GAIN.
 */
uint16_t filter_synth_next_gain_uq16(filter_t *f);

/*
 * One step: prediction by v, to which the law has added its addend, |addend| <= 18432 LSB (with |2 x1 - x2| <= 13824
 * the sum stays below 2^31 in Q16), then the correction with f->gain_uq16, or none without a sample.
 */
void filter_synth_step(filter_t *f, int16_t z_lsb, uint8_t what);

/* The same with v - a1 (v - v') in place of v, for an a1 of this magnitude. */
void filter_synth_bent_step(filter_t *f, int16_t z_lsb, uint8_t what, uint16_t a1_uq16);

/* One step with the steady gain and extrapolation. */
void filter_synth_steady_step(filter_t *f, int16_t z_lsb, uint8_t what);

/*
 * The rate is the difference of two estimates, with a noise of 0.3 to 0.7 sigmas of a sample. When samples begin to be
 * missing, rate and curvature are kept only if the rate exceeds three sigmas.
 */
void filter_synth_fade(filter_t *f, bool first);

/* Halves the last two steps. */
void filter_synth_damp(filter_t *f);

/* Steady-state noise gains, see synth.c and synth_plus.c; for the tools too. Divide. */
uint32_t filter_synth_noise_gain_uq16(uint16_t b0_uq16, int32_t a1_q16);
uint32_t filter_synth_taps_noise_gain_uq16(const filter_config_t *config);

/* Variance R x noise_gain, saturated. Divides. */
uint32_t filter_synth_variance_lsb2_q8(const filter_t *f, uint32_t noise_gain_uq16);

#ifdef __cplusplus
}
#endif
#endif
