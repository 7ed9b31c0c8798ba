/*
 * The bounds of two_state.h in ACSL, assumed before a call and proved after it, and the contracts of the
 * core's parts; each contract that an entry uses is itself proved on the body by an entry of proof_two_state.c.
 */
#ifndef TWO_STATE_BOUNDS_H
#define TWO_STATE_BOUNDS_H

#include "eva.h"
#include "fx_contracts.h"
#include "two_state.h"

#define ONE 0x10000000
#define X_MAX_Q16 301989888

/*
 * P / R: every element below 2, then it will be predicted; or P12 < max(1, P11 + 3/4), written by halves of P12 because
 * Eva's domains are intervals: P12 stays below P11 + 1/4 to P11 + 3/4, which is a little less than two_state.h allows.
 * What is assumed before a call is what is proved after it. P12 <= P11, which holds after each prediction, implies it.
 */
#define SMALL(p) ((p).p11_uq28 < 2 * ONE && (p).p12_uq28 < 2 * ONE && (p).p22_uq28 < 2 * ONE)
#define ROOM(p) ((p).p11_uq28 < 8 * ONE && (p).p22_uq28 < 3 * ONE)
#define HALF(p, h) \
    (ROOM(p) && ONE / 2 * (h) <= (p).p12_uq28 < ONE / 2 * ((h) + 1) && (p).p11_uq28 >= ONE / 4 * (2 * (h)-1))
#define HELD(p)                                                                                               \
    ((ROOM(p) && (p).p12_uq28 < ONE) || HALF(p, 2) || HALF(p, 3) || HALF(p, 4) || HALF(p, 5) || HALF(p, 6) || \
     HALF(p, 7))
#define COVARIANCE(s) (SMALL((s)->u.p) || HELD((s)->u.p))

/* -58..24 for q T^3 and the variance of the rate; the q T^5 of kf3 needs the rest. */
#define SCALED_LEAST (-77)
#define SCALED(v) ((v).mantissa >= 0x8000 && SCALED_LEAST <= (v).exponent <= 25)
/* R of a sample ends at R_END, the R_L of lrf at R_ANY; from 3 on, of which intervals prove 2 for R_L. */
#define R_LEAST 2
#define R_END 256000
#define R_ANY 0xFFFFFF
#define PARAMETERS(s)                                                                                        \
    (16 <= (s)->q22_uq28 <= ONE && 16 <= (s)->p22_start_uq28 <= ONE && (s)->rate_max_lsb_q16 <= X_MAX_Q16 && \
     R_LEAST <= (s)->r_lsb2_q8 <= R_ANY && SCALED((s)->drive_lsb2) && SCALED((s)->start_lsb2))
#define ESTIMATE(s)                                                                               \
    (-X_MAX_Q16 <= (s)->x_lsb_q16 <= X_MAX_Q16 && -X_MAX_Q16 <= (s)->rate_lsb_q16 <= X_MAX_Q16 && \
     (s)->size_lsb_uq8 <= 8704 * 256)
#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define SAMPLES(s)                                                                                \
    (SAMPLE((s)->u.start_lsb[0]) && SAMPLE((s)->u.start_lsb[1]) && SAMPLE((s)->u.start_lsb[2]) && \
     SAMPLE((s)->u.start_lsb[3]) && SAMPLE((s)->u.start_lsb[4]))
#define MODE(s) (((s)->collected == 5 && COVARIANCE(s)) || ((s)->collected < 5 && SAMPLES(s)))

#define CELL(k) (33554432 * (k) <= \result < 33554432 * ((k) + 1))
/*@ requires -2 * X_MAX_Q16 <= x_lsb_q16 <= 2 * X_MAX_Q16;
    assigns s->flags, \result \from s->flags, x_lsb_q16;
    ensures CELL(-9) || CELL(-8) || CELL(-7) || CELL(-6) || CELL(-5) || CELL(-4) || CELL(-3) || CELL(-2) || CELL(-1) ||
            CELL(0) || CELL(1) || CELL(2) || CELL(3) || CELL(4) || CELL(5) || CELL(6) || CELL(7) || CELL(8) ||
            \result == X_MAX_Q16;
*/
static inline int32_t clamp_x(two_state_t *s, int32_t x_lsb_q16);

/*@ requires COVARIANCE(s);
    requires 16 <= s->q22_uq28 <= ONE;
    assigns s->u.p.p11_uq28, s->u.p.p12_uq28, s->u.p.p22_uq28 \from s->u.p, s->q22_uq28;
    ensures HELD(s->u.p);
*/
static inline void predict_covariance(two_state_t *s);

/*
 * What a gate of gate_lsb2_uq4 leaves outside: size^2 > 4096 gate, where P11 + 1 is at least 1; sizes by four (when
 * coarse, 16 times as large). So that gate / size^2, of which soft's weight is made, is known to a factor of 16.
 */
#define FAR(s, k, from, to, gate) \
    ((s)->coarse == (k) && (from) <= (s)->size_lsb_uq8 <= (to) && (s)->gate_lsb2_uq4 < (gate))
#define FARTHER(s)                                                                                               \
    FAR(s, 0, 1, 63, 1) || FAR(s, 0, 64, 255, 16) || FAR(s, 0, 256, 1023, 256) || FAR(s, 0, 1024, 4095, 4096) || \
        FAR(s, 0, 4096, 8704 * 256, 65536) || FAR(s, 1, 16, 1023, 1) || FAR(s, 1, 1024, 4095, 16) ||             \
        FAR(s, 1, 4096, 16383, 256) || FAR(s, 1, 16384, 65535, 4096) || FAR(s, 1, 65536, 8704 * 256, 65536)

/* x in a cell of 512 LSB, and the innovation towards a sample from -4096 to 4095 LSB. */
#define BACK(s, k)                                                                    \
    (33554432 * (k) <= (s)->x_lsb_q16 < 33554432 * ((k) + 1) && (s)->negative == 1 && \
     (s)->size_lsb_uq8 < (512 * (k) + 4608) * 256)
#define FORTH(s, k)                                                                   \
    (33554432 * (k) <= (s)->x_lsb_q16 < 33554432 * ((k) + 1) && (s)->negative == 0 && \
     (s)->size_lsb_uq8 <= (4095 - 512 * (k)) * 256)
#define REACH(s)                                                                                                    \
    BACK(s, -8) || BACK(s, -7) || BACK(s, -6) || BACK(s, -5) || BACK(s, -4) || BACK(s, -3) || BACK(s, -2) ||        \
        BACK(s, -1) || BACK(s, 0) || BACK(s, 1) || BACK(s, 2) || BACK(s, 3) || BACK(s, 4) || BACK(s, 5) ||          \
        BACK(s, 6) || BACK(s, 7) || BACK(s, 8) || ((s)->x_lsb_q16 == X_MAX_Q16 && (s)->negative == 1) ||            \
        FORTH(s, -9) || FORTH(s, -8) || FORTH(s, -7) || FORTH(s, -6) || FORTH(s, -5) || FORTH(s, -4) ||             \
        FORTH(s, -3) || FORTH(s, -2) || FORTH(s, -1) || FORTH(s, 0) || FORTH(s, 1) || FORTH(s, 2) || FORTH(s, 3) || \
        FORTH(s, 4) || FORTH(s, 5) || FORTH(s, 6) || FORTH(s, 7)

#define WIDTH(p) (ROOM(p) && (p).p12_uq28 < 4 * ONE)

/*@ requires SAMPLE(z_lsb);
    requires PARAMETERS(s) && ESTIMATE(s) && COVARIANCE(s) && s->collected == 5;
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u.p.p11_uq28, s->u.p.p12_uq28, s->u.p.p22_uq28, s->size_lsb_uq8,
            s->limit_lsb2, s->gain_uq16, s->flags, s->negative, \result \from *s, z_lsb, present;
    ensures PARAMETERS(s) && s->collected == 5;
    ensures ESTIMATE(s);
    ensures \result == 0 || \result == 1;
    ensures HELD(s->u.p);
*/
bool two_state_step(two_state_t *s, int16_t z_lsb, bool present);

/*@ requires SCALED(s->drive_lsb2) && SCALED(s->start_lsb2) && s->rate_max_lsb_q16 <= X_MAX_Q16;
    assigns s->r_lsb2_q8, s->q22_uq28, s->p22_start_uq28 \from *s, r_lsb2_q8;
    ensures PARAMETERS(s) && s->r_lsb2_q8 <= R_END;
*/
void two_state_set_noise(two_state_t *s, uint32_t r_lsb2_q8);

/*@ requires SCALED(s->drive_lsb2) && SCALED(s->start_lsb2) && s->rate_max_lsb_q16 <= X_MAX_Q16;
    requires R_LEAST <= r_lsb2_q8 <= R_ANY;
    assigns s->r_lsb2_q8, s->q22_uq28, s->p22_start_uq28 \from *s, r_lsb2_q8;
    ensures PARAMETERS(s);
*/
void two_state_set_variance(two_state_t *s, uint32_t r_lsb2_q8);

/*@ requires gate_sigma_q8 <= 4096 && R_LEAST <= s->r_lsb2_q8 <= R_END;
    assigns s->gated, s->coarse, s->gate_lsb2_uq4 \from gate_sigma_q8, s->r_lsb2_q8;
    ensures (s->gated == 0 || s->gated == 1) && (s->coarse == 0 || s->coarse == 1);
*/
void two_state_set_gate(two_state_t *s, uint16_t gate_sigma_q8);

#define X_START 268435456 /* 4096 LSB */
/*@ requires PARAMETERS(s) && COVARIANCE(s) && ESTIMATE(s) && s->collected == 5;
    requires -X_START <= s->x_lsb_q16 < X_START;
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u, s->size_lsb_uq8, s->limit_lsb2, s->gain_uq16, s->flags,
            s->negative \from *s;
    ensures PARAMETERS(s) && ESTIMATE(s);
    ensures s->collected == 5;
    ensures HELD(s->u.p);
*/
void two_state_settle(two_state_t *s);

/*@ requires PARAMETERS(s);
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u, s->size_lsb_uq8, s->limit_lsb2, s->gain_uq16, s->flags,
            s->negative, s->collected, \result \from *s, z0_lsb;
    ensures PARAMETERS(s) && ESTIMATE(s);
    ensures s->collected == 5;
    ensures HELD(s->u.p);
    ensures SAMPLE(\result);
*/
int16_t two_state_reset(two_state_t *s, int16_t z0_lsb);

/* Every field at every value of its bound; what the bounds say of P or of the samples is left to an admit. */
static void any_state_of(two_state_t *s, uint32_t r_end_lsb2_q8)
{
    s->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    s->rate_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    s->u.p.p11_uq28 = ANY_U32(0, UINT32_MAX);
    s->u.p.p12_uq28 = ANY_U32(0, UINT32_MAX);
    s->u.p.p22_uq28 = ANY_U32(0, UINT32_MAX);
    s->q22_uq28 = ANY_U32(16, ONE);
    s->p22_start_uq28 = ANY_U32(16, ONE);
    s->rate_max_lsb_q16 = ANY_U32(0, X_MAX_Q16);
    s->size_lsb_uq8 = ANY_U32(0, 8704UL * 256U);
    s->gate_lsb2_uq4 = ANY_U16(0, UINT16_MAX);
    s->limit_lsb2 = ANY_U32(0, UINT32_MAX);
    s->r_lsb2_q8 = ANY_U32(R_LEAST, r_end_lsb2_q8);
    s->drive_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    s->drive_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    s->start_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    s->start_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    s->gain_uq16 = ANY_U16(0, UINT16_MAX);
    s->flags = ANY_U8(0, UINT8_MAX);
    s->negative = ANY_BOOL();
    s->gated = ANY_BOOL();
    s->coarse = ANY_BOOL();
    s->collected = FILTER_WARM_UP_SAMPLES;
}

static void any_state(two_state_t *s)
{
    any_state_of(s, R_END);
}

static void any_start_of(two_state_t *s, uint32_t r_end_lsb2_q8)
{
    any_state_of(s, r_end_lsb2_q8);
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        s->u.start_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    s->collected = ANY_U8(0, FILTER_WARM_UP_SAMPLES - 1);
}

static void any_start(two_state_t *s)
{
    any_start_of(s, R_END);
}

#endif
