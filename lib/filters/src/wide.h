/*
 * Covariance with a wide range, for the laws of paper 002: P / R up to 32,768 instead of the 52 of kalman.h, and an
 * update by less, or by more, than Kalman's. Internal to the library.
 *
 * With P divided by R and the rate per sample, S = P11 + 1, g = 1 / S and u the innovation, all filters of paper 002
 * are
 *
 *   x += P H' m u;  P -= (P H') (P H')' m2                           each a rule for the two numbers m and m2
 *
 * With m = (1 - loss) g, m2 = (1 - back) g this is Kalman's update, part of which is left out or undone:
 *
 *   w1 = 1 - g; w2 = P12 g
 *   x += (1 - loss) w1 u; rate += (1 - loss) w2 u
 *   P11 = w1 + back (P11 - w1); P12 = w2 + back (P12 - w2); P22 = P22 - w2 P12 + back w2 P12
 *
 * without a difference of nearly equal numbers, and without a sign to handle: 0 <= loss <= 1 and back >= 0 for every
 * rule, back > 1 where m2 < 0 and P grows.
 *
 * P11, P12, P22 per R are in UQ16.16, UQ8.24, UQ4.28. P is predicted while P11 and P12 are below WIDE_P_END (32,768 and
 * 128), process noise is added while P22 is (8): leaving a part out still leaves a covariance. Before and after every
 * call P11 < 33,033, P12 < 137, P22 < 9 (make proof): refused samples leave P as predicted, updates limit each element
 * they write to this number, and one that may not make P grow leaves it as predicted too. So P11 reaches at least 1,300
 * for every legal q22: at q22 = 1, P12 reaches 128 first.
 *
 * Scaling: S to 32 bits, g 16 bits with a relative error <= 4e-5; w1 UQ0.16 within 1.75 counts, w2 UQ0.24, limited to
 * below 1; back to 2^-16, to 2^-13 above 1; P rounded to half a count per step (8 counts when it grows); u, x and rate
 * as kalman.h.
 */
#ifndef WIDE_H
#define WIDE_H

#include "kalman.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Bounds of q22 and of the rate's start variance per R, 6e-8 and 1: see kalman.h for the lower one. */
#define WIDE_Q22_MIN_UQ28 16U
#define WIDE_Q22_MAX_UQ28 0x10000000U

#define WIDE_P_END 0x80000000U

/* P grows in an update (back > 1) only while each element is below this, so that eightfold growth stays in range. */
#define WIDE_GROWTH_END 0x10000000U

/* back is limited to 8. */
#define WIDE_BACK_MAX_UQ16 0x7FFFFU

/* Process noise and R from the parameters r and q. Divides. */
void filter_wide_set_up(filter_t *f, const filter_config_t *config);
void filter_wide_set_noise(filter_t *f, uint32_t r_lsb2_q8);

/* P11 = R, rate as uncertain as at the start. Divides. */
void filter_wide_start(filter_t *f, bool settled);

/*
 * First half of a step: predicts x and P, then innovation of the sample, S and 1/S. True if P could grow, false at the
 * end of its range.
 */
bool filter_wide_predict(filter_t *f, int16_t z_lsb);

/*
 * u^2 / (R S) of the current step: squared innovation over its variance, UQ8.8, saturated; relative error 3e-4, plus
 * 1/256.
 */
uint16_t filter_wide_distance_uq8(const filter_t *f);

/*
 * Second half: gains, x, rate and P. loss and back as above. The largest loss is 65535, just below 1; for a loss of 1
 * see filter_wide_refuse.
 */
void filter_wide_correct(filter_t *f, uint16_t loss_uq16, uint32_t back_uq16);

/*
 * Second half for a sample that a rule does not use: sets the flag. But if P could not grow (as returned by
 * filter_wide_predict), the sample is used, FILTER_REACQUIRED: in exact arithmetic P would have grown until it is,
 * whereas here the filter would refuse for ever.
 */
void filter_wide_refuse(filter_t *f, bool grows);

/* Variance and gate of the probe; the gate is the limit of filter_wide_distance_uq8, 0: none. */
void filter_wide_report(const filter_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
