/*
 * The core that all two-state filters share: position (LSB) and rate (LSB/sample), measured position only.
 *
 * White acceleration drives the rate. With P divided by R and the rate per sample the recursion is
 *
 *   predict  x += v; P11 += 2 P12 + P22; P12 += P22; P22 += q22            q22 = q T^3 / R
 *   update   g = 1 / (P11 + 1); w1 = 1 - g; w2 = P12 g; x += w1 r; v += w2 r; P22 -= w2 P12; P12 = w2; P11 = w1
 *
 * which is Kalman's update for H = [1 0], R = 1 with the differences P - K H P replaced by what they equal: one
 * reciprocal, no cancellation (notes: robust-filters, section 6). Internal to the library: filters wrap it.
 */
#ifndef TWO_STATE_H
#define TWO_STATE_H

#include "filter_common.h"
#include "fx.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Legal range of the drive, shared by the configurations of all two-state filters. */
#define TWO_STATE_Q_MIN_LSB2_S3 1U
#define TWO_STATE_Q_MAX_LSB2_S3 1000000000U

/*
 * Power density of the white acceleration that the filters ship with: the trade-off is tabled in the README of the
 * library.
 */
#define TWO_STATE_Q_DEFAULT_LSB2_S3 10000U

/* Legal range of a gate in sigmas of the innovation, Q8: 1..16; 0: none. */
#define TWO_STATE_GATE_MIN_SIGMA_Q8 256U
#define TWO_STATE_GATE_MAX_SIGMA_Q8 4096U
#define TWO_STATE_GATE_DEFAULT_SIGMA_Q8 768U

/*
 * Bounds of q22 and of the rate's start variance (UQ4.28, per R): below 6e-8 (gain 0.022) P22 would round to a
 * standstill; at 1 (gain 0.77, P22 1.60 after the update) the filter nearly follows the raw samples, and P22 stays
 * below 2.
 */
#define TWO_STATE_Q22_MIN_UQ28 16U
#define TWO_STATE_Q22_MAX_UQ28 0x10000000U

/*
 * P / R (UQ4.28) is predicted only while all elements are below 2: then P11 < 8, P12 < 4, P22 < 3 afterwards, S = P11 +
 * 1 fits UQ4.28, and P, kept as a whole when it may not grow, stays a covariance. Updates never raise an element.
 *
 * The bound that holds before and after every call (make proof): all elements below 2, or P11 < 8, P12 < 4, P22 < 3 and
 * P12 < max(1, P11 + 3/4). The last is needed: with P12 = 3.9, P11 = 0 nothing is predicted, w2 is 3.9, and the step of
 * the rate overflows. P12 <= P11, true after each prediction, implies it.
 */
#define TWO_STATE_P11_END_UQ28 0x80000000U

typedef struct {
    int32_t x_lsb_q16;    /* estimate, |x| <= FILTER_X_MAX_LSB */
    int32_t rate_lsb_q16; /* per sample, |rate| <= rate_max_lsb_q16 */
    union {
        struct {
            uint32_t p11_uq28; /* P / R, see TWO_STATE_P11_END_UQ28 */
            uint32_t p12_uq28;
            uint32_t p22_uq28;
        } p;
        int16_t start_lsb[FILTER_WARM_UP_SAMPLES]; /* while warming up: the samples seen, ascending */
    } u;
    uint32_t q22_uq28;       /* process noise of the rate per sample / R */
    uint32_t p22_start_uq28; /* variance of the rate at the start / R */
    uint32_t rate_max_lsb_q16;
    uint32_t size_lsb_uq8;  /* |innovation| of the last step, <= 8704 LSB */
    uint16_t gate_lsb2_uq4; /* gate^2 R, UQ12.4; when coarse, in 16 LSB^2 */
    uint32_t limit_lsb2;    /* of the squared innovation at the last step: UQ16.16, UQ24.8 when coarse; 0: none yet */
    uint32_t r_lsb2_q8;     /* measurement variance in force */
    fx_scaled_t drive_lsb2; /* q T^3 */
    fx_scaled_t start_lsb2; /* variance of the rate per sample at the start */
    uint16_t gain_uq16;     /* w1 of the last update */
    uint8_t flags;
    bool negative; /* sign of the innovation */
    bool gated;    /* there is a gate */
    bool coarse;
    uint8_t collected; /* start samples seen, FILTER_WARM_UP_SAMPLES: running */
} two_state_t;

/* True when rate, R and q are legal. */
bool two_state_legal(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3);

/* True when the gate is in its range or off. */
FX_ONCE bool two_state_gate_legal(uint16_t gate_sigma_q8);

/*
 * What R is to be divided into: q T^3, which drives the rate per sample, and the variance of that rate at the start.
 * Returns the period T in seconds. Divides.
 */
FX_ONCE fx_scaled_t two_state_scales(uint16_t rate_dhz, uint32_t q_lsb2_s3, fx_scaled_t *drive_lsb2,
                                     fx_scaled_t *start_lsb2);

/* A variance divided by R, limited to min_uq28..TWO_STATE_Q22_MAX_UQ28. Divides. */
FX_ONCE uint32_t two_state_per_r_uq28(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint32_t min_uq28);

/*
 * Legal parameters to a filter that begins to warm up, no gate. rate_max in LSB/s, 0: the bound of the format. Divides.
 */
void two_state_init(two_state_t *s, uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3, uint32_t rate_max_lsb_s);

/*
 * R (limited to its legal range) for the samples to come. Divides: 2,000 cycles. The estimate stays, P / R is re-scaled
 * by time.
 */
FX_ONCE void two_state_set_noise(two_state_t *s, uint32_t r_lsb2_q8);

/* As two_state_set_noise for a filter whose R is not that of a sample: 2..2^24 - 1, no limit is laid on it here. */
FX_ONCE void two_state_set_variance(two_state_t *s, uint32_t r_lsb2_q8);

/* Running from x: rate 0, P11 = R, rate as uncertain as after the warm-up. */
FX_ONCE void two_state_start(two_state_t *s, int32_t x_lsb_q16);

/*
 * Running from a state and a covariance per R (UQ4.28), each limited to its range: P11 below 8, P12 below 4 and P11,
 * P22 below 3. For tests that start where a paper starts.
 */
FX_ONCE void two_state_begin(two_state_t *s, int32_t x_lsb_q16, int32_t rate_lsb_q16, uint32_t p11_uq28,
                             uint32_t p12_uq28, uint32_t p22_uq28);

static inline bool two_state_warming_up(const two_state_t *s)
{
    return s->collected < FILTER_WARM_UP_SAMPLES;
}

/* Running as if z0, limited to its range, had been read for ever. Returns z0 limited. */
FX_ONCE int16_t two_state_reset(two_state_t *s, int16_t z0_lsb);

/* The same in steps of at most one two_state_step: step 0, 1, ... until it is false. */
FX_ONCE bool two_state_reset_step(two_state_t *s, int16_t z0_lsb, uint8_t step);

/*
 * P as if the whole-numbered estimate had been read for long: SETTLE_STEPS updates without innovation, 45,000 cycles.
 */
void two_state_settle(two_state_t *s);

/* One sample of the warm-up: running median of what was seen. */
void two_state_warm_up(two_state_t *s, int16_t z_lsb);

/* Sample missing, during the warm-up or not: prediction. Returns the estimate. */
int32_t two_state_coast(two_state_t *s);

/* The rate halved: of a motion that was not seen for a while only a part is likely to go on. */
FX_ONCE void two_state_damp(two_state_t *s);

/* Warming up anew, with the same parameters and R; the estimate is the old one until the next sample. */
FX_ONCE void two_state_restart(two_state_t *s);

/* Gate of so many sigmas of the innovation (Q8, <= 16), with the R in force; 0: none. Call after init and set_noise. */
void two_state_set_gate(two_state_t *s, uint16_t gate_sigma_q8);

/*
 * One sample within FILTER_Z_MIN..MAX of a filter that runs: flags cleared, prediction, gate, update. False: refused by
 * the gate (flag set) or not present, predicted only.
 *
 * Scaling:
 *   input    Q0, clamped by the caller to -4096..4095 LSB
 *   x, rate  Q15.16; |x| <= 4608 LSB by a clamp after the prediction (the update moves x towards a sample within 4096),
 *            |rate| <= rate_max <= 4608 LSB per sample by a clamp after the update; so |r| <= 8704 LSB < 2^30 / 2^16
 *            and no sum overflows
 *   P / R    UQ4.28; P11 < 8, P12 < 4, P22 < 3 (see TWO_STATE_P11_END_UQ28); P12 <= P11 after a prediction, so w2 < 1
 *   g, w1    UQ0.16 within 1.5 counts of 1/S; w2 UQ0.24; q22 and P22 rounded to 2^-28 per step
 *   r        rounded down to 2^-8 LSB in magnitude; x and rate steps rounded half away from zero to 2^-16: an estimate
 *            within 1/256 LSB of a constant input stays where it is
 *   gate     limit of r^2: gate^2 R rounded to 1/16 LSB^2 (16 LSB^2 from 4096 on): 1 % at gate^2 R = 3
 *   cost     on ATmega328P, avr-gcc 5.4 -Os: 690 cycles without gate, 850 with one; 1,354 B of flash and 258 B of table
 */
FX_ONCE bool two_state_step(two_state_t *s, int16_t z_lsb, bool present);

/* Snapshot, see filter.h. */
void two_state_probe(const two_state_t *s, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
