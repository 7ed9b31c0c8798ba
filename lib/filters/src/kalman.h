/*
 * Covariance and gains of the Kalman laws: kf, lrf, sprf, soft. Internal to the library.
 *
 * White acceleration drives the rate. With P divided by R and the rate per sample the recursion is
 *
 *   predict  P11 += 2 P12 + P22; P12 += P22; P22 += q22                    q22 = q T^3 / R
 *   update   g = 1 / (P11 + 1); w1 = 1 - g; w2 = P12 g; P22 -= w2 P12; P12 = w2; P11 = w1
 *
 * which is Kalman's update for H = [1 0], R = 1 with the differences P - K H P replaced by what they equal: one
 * reciprocal, no cancellation (notes: robust-filters, section 6).
 *
 * P / R (UQ4.28) is predicted only while all elements are below 2: then P11 < 8, P12 < 4, P22 < 3 afterwards, S = P11 +
 * 1 fits UQ4.28, and P, kept as a whole when it may not grow, stays a covariance. Updates never raise an element. The
 * bound that holds before and after every call (make proof): all elements below 2, or P11 < 8, P12 < 4, P22 < 3 and P12
 * < max(1, P11 + 3/4). The last is needed: with P12 = 3.9, P11 = 0 nothing is predicted, w2 is 3.9, and the step of the
 * rate overflows. P12 <= P11, true after each prediction, implies it.
 *
 * Scaling:
 *   P / R    UQ4.28; P12 <= P11 after a prediction, so w2 < 1
 *   g, w1    UQ0.16 within 1.5 counts of 1/S; w2 UQ0.24; q22 and P22 rounded to 2^-28 per step, of which w2 P12 with
 *            P12 rounded down to 2^-20
 *   u        rounded down to 2^-8 LSB in magnitude; x and rate steps rounded half away from zero to 2^-16: an estimate
 *            within 1/256 LSB of a constant input stays where it is
 *   gate     limit of u^2: gate^2 R rounded to 1/16 LSB^2 (16 LSB^2 from 4096 on, with u in whole LSB): 1 % at
 *            gate^2 R = 3; times S rounded down to 2^-12
 */
#ifndef KALMAN_H
#define KALMAN_H

#include "tracker.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KALMAN_ONE_UQ28 0x10000000U

/*
 * Bounds of q22 and of the rate's start variance (UQ4.28, per R): below 6e-8 (gain 0.022) P22 would round to a
 * standstill; at 1 (gain 0.77, P22 1.60 after the update) the filter nearly follows the raw samples, and P22 stays
 * below 2.
 */
#define KALMAN_Q22_MIN_UQ28 16U
#define KALMAN_Q22_MAX_UQ28 0x10000000U

/* Legal range of a gate in sigmas of the innovation, Q8. */
#define KALMAN_GATE_MIN_SIGMA_Q8 256
#define KALMAN_GATE_MAX_SIGMA_Q8 4096

/* Places of the parameters that every Kalman law begins with. */
enum { KALMAN_R, KALMAN_Q };

/* q T^3 and the start variance of the rate, LSB^2 per sample^2, of a configuration. Divides. */
void filter_kalman_scales(const filter_config_t *config, fx_scaled_t *drive_lsb2, fx_scaled_t *start_lsb2);

/* A variance over R in UQ4.28, within min_uq28..KALMAN_Q22_MAX_UQ28. Divides. */
uint32_t filter_kalman_per_r_uq28(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint32_t min_uq28);

/* r_lsb2_q8 as a number that spans decades, LSB^2. */
fx_scaled_t filter_kalman_scaled_r(uint32_t r_lsb2_q8);

/* Drive, limit of the rate and noise of a Kalman law; rate_max 0: the bound of the format. Divides. */
void filter_kalman_set_up(filter_t *f, const filter_config_t *config, uint32_t rate_max_lsb_s);

/* R for the samples to come, 2..2^24 - 1. The estimate stays, P / R is re-scaled by time. Divides. */
void filter_kalman_set_variance(filter_t *f, uint32_t r_lsb2_q8);

/* Gate of so many sigmas (<= 16) with the R in force, and how far two samples of one run may lie apart. */
void filter_kalman_set_gate(filter_t *f, uint16_t gate_sigma_q8);

/* P11 = R, rate as uncertain as at the start. */
void filter_kalman_start(filter_t *f, bool settled);

/* P near where it settles, UQ4.28. */
void filter_kalman_near(filter_covariance_t *p, uint32_t q22_uq28);

/*
 * One step: prediction of x and P, innovation, and unless the gate refuses it Kalman's update by the innovation's
 * magnitude, so that rounding is the same for both signs. A step of x is at most |u|, < 2^30, and x stays between the
 * prediction and the sample, hence within its bound. True: the sample was used; false: it lies beyond the gate, u^2 >
 * gate^2 R (P11 + 1), or is missing.
 */
bool filter_kalman_step(filter_t *f, int16_t z_lsb, uint8_t what);

/*
 * Consistency re-acquisition: refused samples that agree among themselves are no outliers but where the signal is now.
 * L refused raw samples in a row, each within `agree` of the sample before it, restart the filter at the last of them,
 * on the slope from the first to the last. A sample that is not refused ends the run; a missing one makes the slope
 * unknown. True: this sample was the last of a run.
 */
bool filter_kalman_refused(filter_t *f, int16_t z_lsb);

/* A number of samples over which a slope can be fitted without a division: 3, 5, 9; 0: never. */
bool filter_kalman_run_legal(int32_t samples);

/* Variance and gate of the probe. */
void filter_kalman_report(const filter_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
