/*
 * The two-state core (two_state.h) for filters whose covariance may grow far: P / R to 32,768 instead of 8, and an
 * update by less, or by more, than Kalman's.
 *
 * With P divided by R and the rate per sample, S = P11 + 1, g = 1 / S and r the innovation, all filters of paper 002
 * are
 *
 *   x += P H' m r;  P -= (P H') (P H')' m2                           each a rule for the two numbers m and m2
 *
 * and with m = (1 - loss) g, m2 = (1 - back) g this is Kalman's update, of which a part is left out or undone:
 *
 *   w1 = 1 - g; w2 = P12 g
 *   x += (1 - loss) w1 r; rate += (1 - loss) w2 r
 *   P11 = w1 + back (P11 - w1); P12 = w2 + back (P12 - w2); P22 = P22 - w2 P12 + back w2 P12
 *
 * without a difference of nearly equal numbers, and without a sign to watch: 0 <= loss <= 1 and back >= 0 for every
 * rule, back > 1 where m2 < 0 and P grows. Internal to the library: filters wrap it.
 */
#ifndef TWO_STATE_WIDE_H
#define TWO_STATE_WIDE_H

#include "two_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * P11, P12, P22 per R in UQ16.16, UQ8.24, UQ4.28. P is predicted while P11 and P12 are below this number (32,768 and
 * 128), process noise is added while P22 is (8): what is left out leaves a covariance. Before and after every call
 * P11 < 33,033, P12 < 137, P22 < 9 (make proof): refused samples leave P as predicted, updates limit each element they
 * write to this number, and one that may not make P grow leaves it as predicted too.
 * So P11 reaches at least 1,300 for every legal q22: at q22 = 1 P12 comes to 128 first.
 */
#define TWO_STATE_WIDE_P_END 0x80000000U

/* P grows in an update (back > 1) only while each element is below this, so eightfold growth stays in range. */
#define TWO_STATE_WIDE_GROWTH_END 0x10000000U

/* back is limited to 8. */
#define TWO_STATE_WIDE_BACK_MAX_UQ16 0x7FFFFU

typedef struct {
    int32_t x_lsb_q16;    /* estimate, |x| <= FILTER_X_MAX_LSB */
    int32_t rate_lsb_q16; /* per sample, |rate| <= FILTER_X_MAX_LSB */
    union {
        struct {
            uint32_t p11_uq16; /* P / R, see TWO_STATE_WIDE_P_END */
            uint32_t p12_uq24;
            uint32_t p22_uq28;
        } p;
        int16_t start_lsb[FILTER_WARM_UP_SAMPLES]; /* while warming up: the samples seen, ascending */
    } u;
    uint32_t size_lsb_uq8;   /* |innovation| of the last step, <= 8704 LSB */
    fx_leading_t variance;   /* S of the last step, UQ16.16: places 0..15; 0: none yet */
    uint16_t inverse_uq16;   /* 1 / its mantissa, so g = inverse / 2^(15 - places) */
    fx_scaled_t per_r;       /* 1 / R, 1/LSB^2 */
    uint32_t q22_uq28;       /* process noise of the rate per sample / R */
    uint16_t gain_uq16;      /* of the last update */
    uint8_t flags;           /* FILTER_* */
    bool negative;           /* sign of the innovation */
    uint8_t collected;       /* start samples seen, FILTER_WARM_UP_SAMPLES: running */
    uint32_t p22_start_uq28; /* variance of the rate at the start / R */
    uint32_t r_lsb2_q8;      /* measurement variance in force */
    fx_scaled_t drive_lsb2;  /* q T^3 */
    fx_scaled_t start_lsb2;  /* variance of the rate per sample at the start */
} two_state_wide_t;

/* Legal parameters (two_state_legal) to a filter that begins to warm up. Divides. */
void two_state_wide_init(two_state_wide_t *s, uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3);

/* R (limited to its legal range) for the samples to come. Divides. The estimate stays, P / R is re-scaled by time. */
FX_ONCE void two_state_wide_set_noise(two_state_wide_t *s, uint32_t r_lsb2_q8);

/* Running from x: rate 0, P11 = R, rate as uncertain as after the warm-up. */
FX_ONCE void two_state_wide_start(two_state_wide_t *s, int32_t x_lsb_q16);

/* Running from a state and a covariance per R; each element is limited to TWO_STATE_WIDE_P_END. For tests. */
void two_state_wide_begin(two_state_wide_t *s, int32_t x_lsb_q16, int32_t rate_lsb_q16, uint32_t p11_uq16,
                          uint32_t p12_uq24, uint32_t p22_uq28);

/* As if z0 (clamped) had been read for long: 64 of Kalman's updates without innovation. */
FX_ONCE void two_state_wide_reset(two_state_wide_t *s, int16_t z0_lsb);

/* The same in steps of at most one update: step 0, 1, ... until it is false. */
FX_ONCE bool two_state_wide_reset_step(two_state_wide_t *s, int16_t z0_lsb, uint8_t step);

static inline bool two_state_wide_warming_up(const two_state_wide_t *s)
{
    return s->collected < FILTER_WARM_UP_SAMPLES;
}

/* One sample of the warm-up: running median of what was seen. */
FX_ONCE void two_state_wide_warm_up(two_state_wide_t *s, int16_t z_lsb);

/*
 * First half of a step: flags cleared, x and P predicted, innovation of a sample within FILTER_Z_MIN..MAX, S and 1/S.
 * True when P could grow, false at the end of its range.
 *
 * Scaling:
 *   input    Q0, clamped by the caller to -4096..4095 LSB
 *   x, rate  Q15.16; |x| <= 4608 LSB by a clamp after the prediction (the update moves x towards a sample within 4096),
 *            |rate| <= 4608 LSB per sample by a clamp after the update; so |r| <= 8704 LSB < 2^30 / 2^16 and no sum
 *            overflows
 *   P / R    P11 < 32768 + 128 + 137, P12 < 128 + 9, P22 < 8 + 1 (see TWO_STATE_WIDE_P_END); w2 is limited to
 *            below 1
 *   g        16 bits, relative error <= 4e-5, of S >= 1 taken to 32 bits
 */
FX_ONCE bool two_state_wide_predict(two_state_wide_t *s, int16_t z_lsb);

/* r^2 / (R S) of the step begun: the squared innovation in variances, UQ8.8, saturated; error <= 3e-4 of it + 1/256. */
FX_ONCE uint16_t two_state_wide_distance_uq8(const two_state_wide_t *s);

/*
 * Second half: gains, x, rate and P from the innovation's magnitude, so that rounding is the same for both signs. loss
 * and back: see above; loss 65535 is the largest below 1, for more: two_state_wide_refuse.
 *
 * Scaling: w1 UQ0.16 within 1.75 counts, w2 UQ0.24; back to 2^-16, to 2^-13 above 1; P rounded to half a count per step
 * (8 counts when it grows); r, x and rate as two_state_step.
 */
FX_ONCE void two_state_wide_update(two_state_wide_t *s, uint16_t loss_uq16, uint32_t back_uq16);

/*
 * Second half for a sample that a rule does not use: flag set. But where P could not grow (what two_state_wide_predict
 * told) the sample is taken, FILTER_REACQUIRED: in exact arithmetic P would have grown until it is, and here the filter
 * would refuse for ever.
 */
FX_ONCE void two_state_wide_refuse(two_state_wide_t *s, bool grows);

/* Sample missing, during the warm-up or not: prediction. Returns the estimate. */
FX_ONCE int32_t two_state_wide_coast(two_state_wide_t *s);

/* The rate halved, and P with it. */
FX_ONCE void two_state_wide_damp(two_state_wide_t *s);

/*
 * Before a sample that tells no position, so that it is not taken only because P is at the end of its range: P is
 * halved there, which leaves a covariance.
 */
FX_ONCE void two_state_wide_hold(two_state_wide_t *s);

/* Warming up anew, with the same parameters and R; the estimate is the old one until the next sample. */
FX_ONCE void two_state_wide_restart(two_state_wide_t *s);

/* Snapshot, see filter.h; gate2_uq8: limit of two_state_wide_distance_uq8, 0: no gate. */
FX_ONCE void two_state_wide_probe(const two_state_wide_t *s, uint16_t gate2_uq8, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
