/*
 * The bounds of two_state_wide.h in ACSL and the contracts of the core's parts, proved by proof_two_state_wide.c.
 * Clauses with a name are relations that intervals do not keep; deliberate.txt says why they hold.
 */
#ifndef WIDE_BOUNDS_H
#define WIDE_BOUNDS_H

#include "two_state_bounds.h"

#include "two_state_wide.h"

/* After a prediction; an update leaves none above 0x80000000. 33033, 137 and 9 of R. */
#define P11_END 2164850688
#define P12_END 2298478592
#define P22_END 2415919104
#define WIDE_P(p) ((p).p11_uq16 < P11_END && (p).p12_uq24 < P12_END && (p).p22_uq28 < P22_END)
#define WIDE_PARAMETERS(s)                                                                             \
    (16 <= (s)->q22_uq28 <= ONE && 16 <= (s)->p22_start_uq28 <= ONE && 3 <= (s)->r_lsb2_q8 <= R_END && \
     SCALED((s)->drive_lsb2) && SCALED((s)->start_lsb2) && (s)->per_r.mantissa >= 0x8000 &&            \
     -28 <= (s)->per_r.exponent <= -6)
/* Places of S, and its inverse. */
#define S_PLACES(s) ((s)->variance % 256 <= 15)
#define WIDE_MODE(s) \
    (((s)->collected == 5 && WIDE_P((s)->u.p)) || ((s)->collected < 5 && (s)->variance == 0 && SAMPLES(s)))
#define WIDE_BOUND(s) (WIDE_PARAMETERS(s) && ESTIMATE(s) && WIDE_MODE(s))

/* By cells (X_CELLS) where the innovation is to be tied to the estimate. */
#ifdef X_CELLS
#define IN_CELLS                                                                                                \
    CELL(-9) || CELL(-8) || CELL(-7) || CELL(-6) || CELL(-5) || CELL(-4) || CELL(-3) || CELL(-2) || CELL(-1) || \
        CELL(0) || CELL(1) || CELL(2) || CELL(3) || CELL(4) || CELL(5) || CELL(6) || CELL(7) || CELL(8) || \
        \result == X_MAX_Q16
#else
#define IN_CELLS 1 == 1
#endif
/*@ requires -2 * X_MAX_Q16 - X_MAX_Q16 <= v_lsb_q16 <= 3 * X_MAX_Q16;
    assigns s->flags, \result \from s->flags, v_lsb_q16;
    ensures -X_MAX_Q16 <= \result <= X_MAX_Q16;
    ensures IN_CELLS;
*/
static inline int32_t limited_state(two_state_wide_t *s, int32_t v_lsb_q16);

/*@ requires 16 <= s->q22_uq28 <= ONE;
    requires WIDE_P(s->u.p);
    assigns s->u.p.p11_uq16, s->u.p.p12_uq24, s->u.p.p22_uq28, \result \from s->u.p, s->q22_uq28;
    ensures WIDE_P(s->u.p);
    ensures \result == 0 || \result == 1;
*/
static bool predict_wide_covariance(two_state_wide_t *s);

/*@ requires grows == 0 || *p < 0x10000000;
    requires *p < P22_END;
    assigns *p \from *p, left, fraction_uq16, grows;
    ensures *p <= 0x80000000;
*/
static void give_back(uint32_t *p, uint32_t left, uint16_t fraction_uq16, bool grows);

/*@ requires WIDE_P(s->u.p) && w2_uq24 <= 0xFFFFFF;
    assigns \result \from s->u.p, w2_uq24;
*/
static uint32_t left_of_p22(const two_state_wide_t *s, uint32_t w2_uq24);

/*@ requires WIDE_P(s->u.p) && w2_uq24 <= 0xFFFFFF && back_uq16 <= 0x7FFFF;
    assigns s->u.p.p11_uq16, s->u.p.p12_uq24, s->u.p.p22_uq28 \from s->u.p, w1_uq16, w2_uq24, back_uq16;
    ensures WIDE_P(s->u.p);
*/
static void update_covariance(two_state_wide_t *s, uint16_t w1_uq16, uint32_t w2_uq24, uint32_t back_uq16);

/*@ requires WIDE_BOUND(s) && s->collected == 5 && SAMPLE(z_lsb);
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u.p.p11_uq16, s->u.p.p12_uq24, s->u.p.p22_uq28, s->size_lsb_uq8,
            s->variance, s->inverse_uq16, s->flags, s->negative, \result \from *s, z_lsb;
    ensures WIDE_PARAMETERS(s) && ESTIMATE(s) && s->collected == 5;
    ensures WIDE_P(s->u.p);
    ensures s->inverse_uq16 >= 0x8000 && s->variance >= 0x80000000;
    ensures places: S_PLACES(s);
    ensures reach: s->collected == 5 && (REACH(s));
    ensures \result == 0 || \result == 1;
*/
bool two_state_wide_predict(two_state_wide_t *s, int16_t z_lsb);

/*@ requires WIDE_PARAMETERS(s) && ESTIMATE(s) && s->inverse_uq16 >= 0x8000;
    requires places: S_PLACES(s);
    assigns \result \from *s;
*/
uint16_t two_state_wide_distance_uq8(const two_state_wide_t *s);

/*@ requires WIDE_PARAMETERS(s) && ESTIMATE(s) && s->collected == 5 && back_uq16 <= 0x7FFFF;
    requires WIDE_P(s->u.p);
    requires s->inverse_uq16 >= 0x8000;
    requires places: S_PLACES(s);
    requires reach: s->collected == 5 && (REACH(s));
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u.p.p11_uq16, s->u.p.p12_uq24, s->u.p.p22_uq28, s->gain_uq16,
            s->flags \from *s, loss_uq16, back_uq16;
    ensures ESTIMATE(s);
    ensures WIDE_P(s->u.p);
*/
void two_state_wide_update(two_state_wide_t *s, uint16_t loss_uq16, uint32_t back_uq16);

/*@ requires SCALED(s->drive_lsb2) && SCALED(s->start_lsb2);
    assigns s->r_lsb2_q8, s->per_r, s->q22_uq28, s->p22_start_uq28 \from *s, r_lsb2_q8;
    ensures WIDE_PARAMETERS(s);
*/
void two_state_wide_set_noise(two_state_wide_t *s, uint32_t r_lsb2_q8);

/*@ requires WIDE_PARAMETERS(s);
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u, s->size_lsb_uq8, s->variance, s->inverse_uq16, s->gain_uq16, s->flags,
            s->negative, s->collected \from *s, z0_lsb;
    ensures ESTIMATE(s) && s->collected == 5;
    ensures WIDE_P(s->u.p);
*/
void two_state_wide_reset(two_state_wide_t *s, int16_t z0_lsb);

/*@ requires WIDE_PARAMETERS(s);
    requires step == 0 || (ESTIMATE(s) && s->collected == 5 && WIDE_P(s->u.p));
    assigns s->x_lsb_q16, s->rate_lsb_q16, s->u, s->size_lsb_uq8, s->variance, s->inverse_uq16, s->gain_uq16, s->flags,
            s->negative, s->collected, \result \from *s, z0_lsb, step;
    ensures ESTIMATE(s) && s->collected == 5;
    ensures WIDE_P(s->u.p);
    ensures \result == 0 || \result == 1;
*/
bool two_state_wide_reset_step(two_state_wide_t *s, int16_t z0_lsb, uint8_t step);

/*@ requires s->variance == 0 || S_PLACES(s);
    assigns *out \from *s, gate2_uq8;
*/
void two_state_wide_probe(const two_state_wide_t *s, uint16_t gate2_uq8, filter_probe_t *out);

/* To be included in this order; the cores each have a function of that name. */
#include "filter_common.c"
#include "fx.c"
#include "two_state.c"
#define predict_covariance predict_wide_covariance
#include "two_state_wide.c"

/* Every field at every value of its bound, S with so many places (16: none yet). */
static void any_wide(two_state_wide_t *s, uint8_t places)
{
    s->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    s->rate_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    s->u.p.p11_uq16 = ANY_U32(0, P11_END - 1);
    s->u.p.p12_uq24 = ANY_U32(0, P12_END - 1);
    s->u.p.p22_uq28 = ANY_U32(0, P22_END - 1);
    s->size_lsb_uq8 = ANY_U32(0, 8704UL * 256U);
    s->variance = (places > 15) ? 0 : (ANY_U32(0x800000, 0xFFFFFF) * 256U) + places;
    s->inverse_uq16 = ANY_U16(0x8000, UINT16_MAX);
    s->per_r.mantissa = ANY_U16(0x8000, UINT16_MAX);
    s->per_r.exponent = ANY_S8(-28, -6);
    s->q22_uq28 = ANY_U32(16, ONE);
    s->gain_uq16 = ANY_U16(0, UINT16_MAX);
    s->flags = ANY_U8(0, UINT8_MAX);
    s->negative = ANY_BOOL();
    s->p22_start_uq28 = ANY_U32(16, ONE);
    s->r_lsb2_q8 = ANY_U32(3, R_END);
    s->drive_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    s->drive_lsb2.exponent = ANY_S8(-58, 24);
    s->start_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    s->start_lsb2.exponent = ANY_S8(-58, 24);
    s->collected = FILTER_WARM_UP_SAMPLES;
}

static void any_wide_start(two_state_wide_t *s, uint8_t from_collected, uint8_t to_collected)
{
    any_wide(s, 16);
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        s->u.start_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    s->collected = ANY_U8(from_collected, to_collected);
}

#endif
