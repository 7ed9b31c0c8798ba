/*
 * Covariance and gains of the Kalman laws: kf, lrf, sprf, soft. Internal to the library.
 *
 * White acceleration drives the rate. With P divided by R and the rate per sample the recursion is
 *
 *   predict  P11 += 2 P12 + P22; P12 += P22; P22 += q22                    q22 = q T^3 / R
 *   update   g = 1 / (P11 + 1); w1 = 1 - g; w2 = P12 g; P22 -= w2 P12; P12 = w2; P11 = w1
 *
 * This is Kalman's update for H = [1 0], R = 1, with the differences P - K H P replaced by what they equal: one
 * reciprocal, no cancellation (notes: robust-filters, section 6).
 *
 * P / R is predicted only while P11 < 4, P12 < 16, P22 < 16. Then P11 < 52, P12 < 32, P22 < 30 afterwards, S = P11 + 1
 * fits UQ8.24, and P, kept as a whole when it may not grow, stays a covariance. Updates never raise an element, so
 * these bounds hold before and after every call (make proof).
 *
 * Scaling:
 *   P / R    P11 UQ8.24, P12 and P22 UQ6.26; P12 <= P11 after a prediction, so w2 < 1, and it is limited to that
 *   g, w1    UQ0.16 within 1.5 counts of 1/S; w2 UQ0.24; q22 and P22 rounded to 2^-26 per step, of which w2 P12 with
 *            P12 rounded down to 2^-18
 *   u        magnitude rounded down to 2^-8 LSB; x and rate steps rounded half away from zero to 2^-16: an estimate
 *            within 1/256 LSB of a constant input stays where it is
 *   gate     limit of u^2: gate^2 R rounded to 1/64 LSB^2 (from 1024 on down to 4 LSB^2, with u in whole LSB); times S
 *            rounded down to 2^-10
 */
#ifndef KALMAN_H
#define KALMAN_H

#include "tracker.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KALMAN_ONE_UQ24 0x1000000U

/*
 * Limits of q22 and of the rate's start variance, per R. Below 6e-8 (gain 0.022) P22 would round to zero and stay
 * there. At 14 (gain 0.95, P22 15.5 after the update) the filter follows the raw samples, and P22 stays below 16. With
 * the default q and R they are reached at 1,500 and at 12.4 Hz.
 */
#define KALMAN_Q22_MIN_UQ26 4U
#define KALMAN_Q22_MAX_UQ26 0x38000000U

/* Legal range of a gate in sigmas of the innovation, Q8. */
#define KALMAN_GATE_MIN_SIGMA_Q8 256
#define KALMAN_GATE_MAX_SIGMA_Q8 4096

/*
 * At rates up to this, 0.1 Hz, the default run is three samples, not five: five are 200 ms at 25 Hz, in which a hand
 * turns a board by 18 degrees.
 */
#define KALMAN_SHORT_RUN_DHZ 300U
#define KALMAN_SHORT_RUN 3

/* Indices of the parameters that every Kalman law begins with, and of the first further one of a law with a gate. */
enum { KALMAN_R, KALMAN_Q, KALMAN_GATE };

/* Two shifts written out: given a shift by two the AVR compiler makes a loop. */
static inline uint32_t kalman_quarter(uint32_t v)
{
    v >>= 1;
    MACHINE_FENCE(v);
    return v >> 1;
}

static inline uint32_t kalman_fourfold(uint32_t v)
{
    v <<= 1;
    MACHINE_FENCE(v);
    return v << 1;
}

/* An element of P less the part that an update removes, both < 2^31; rounding does not take it below 0. */
static inline uint32_t kalman_less(uint32_t p, uint32_t taken)
{
    int32_t left = (int32_t)p - (int32_t)taken;
    return (left < 0) ? 0U : (uint32_t)left;
}

/* Limits a gain to below 1, so that a step stays below |u|. */
static inline uint32_t kalman_limited_uq24(uint32_t w_uq24)
{
    return ((uint8_t)(w_uq24 >> 24) != 0U) ? 0xFFFFFFU : w_uq24;
}

/* q T^3 and the start variance of the rate, LSB^2 per sample^2, from a configuration. Divides. */
void filter_kalman_scales(const filter_config_t *config, fx_scaled_t *drive_lsb2, fx_scaled_t *start_lsb2);

/* A variance over R with the given fraction bits, limited to min..max. Divides. */
uint32_t filter_kalman_per_r(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint8_t fraction_bits, uint32_t min, uint32_t max);

/* r_lsb2_q8 as a scaled number, LSB^2. */
fx_scaled_t filter_kalman_scaled_r(uint32_t r_lsb2_q8);

/* Process noise, rate limit and R of a Kalman law; rate_max_lsb_s 0: the bound of the format. Divides. */
void filter_kalman_set_up(filter_t *f, const filter_config_t *config, uint32_t rate_max_lsb_s);

/* R for the following samples, 2..2^24 - 1. The estimate is kept, P / R rescales itself over time. Divides. */
void filter_kalman_set_variance(filter_t *f, uint32_t r_lsb2_q8);

/*
 * The same two for a law whose first further parameter is the gate of its update. `reacquire` is the index of the run
 * length, and ratemax follows it. Divide.
 */
void filter_kalman_set_up_gated(filter_t *f, const filter_config_t *config, uint8_t reacquire);
void filter_kalman_set_noise_gated(filter_t *f, uint32_t r_lsb2_q8);

/* P11 = R, rate as uncertain as at the start. */
void filter_kalman_start(filter_t *f, bool settled);

/* P close to where it settles. */
void filter_kalman_near(filter_covariance_t *p, uint32_t q22_uq26);

/*
 * One step: prediction of x and P, innovation, and, unless the gate refuses it, Kalman's update. The update works on
 * the innovation's magnitude, so that rounding is the same for both signs. A step of x is at most |u|, < 2^30, and x
 * stays between the prediction and the sample, hence within its bound. Returns true if the sample was used; false if it
 * is missing or beyond the gate, u^2 > gate^2 R (P11 + 1).
 */
bool filter_kalman_step(filter_t *f, int16_t z_lsb, uint8_t what);

/*
 * Consistency re-acquisition: refused samples that agree among themselves are not outliers but where the signal is. L
 * refused raw samples in a row, each within `agree` of the one before, restart the filter at the last of them, with the
 * slope from the first to the last. Until then each of them halves a rate that is uncertain. A sample that is not
 * refused ends the run; a missing one makes the slope unknown. Returns true if this sample completed a run.
 */
bool filter_kalman_refused(filter_t *f, int16_t z_lsb);

/* Run lengths over which a slope can be fitted without a division: 3, 5, 9; 0: never. */
bool filter_kalman_run_legal(int32_t samples);

/* Variance and gate of the probe. */
void filter_kalman_report(const filter_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
