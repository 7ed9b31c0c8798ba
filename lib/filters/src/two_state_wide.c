/* Two-state core with a wide covariance: see two_state_wide.h for the equations. */
#include "two_state_wide.h"

#define ONE_UQ16 0x10000U
/* After so many equal samples P is within a few per cent of where it settles, for gains above 0.05. */
#define SETTLE_STEPS 64U

#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

void two_state_wide_init(two_state_wide_t *s, uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    filter_zero(s, sizeof *s);
    s->flags = FILTER_WARMING_UP;
    (void)two_state_scales(rate_dhz, q_lsb2_s3, &s->drive_lsb2, &s->start_lsb2);
    two_state_wide_set_noise(s, r_lsb2_q8);
}

void two_state_wide_set_noise(two_state_wide_t *s, uint32_t r_lsb2_q8)
{
    r_lsb2_q8 = filter_limited_r_lsb2_q8(r_lsb2_q8);
    s->r_lsb2_q8 = r_lsb2_q8;
    fx_scaled_t r_lsb2 = fx_scaled(r_lsb2_q8);
    r_lsb2.exponent = (int8_t)(r_lsb2.exponent - 8);
    s->per_r = fx_scaled_div(fx_scaled(1), r_lsb2);
    s->q22_uq28 = two_state_per_r_uq28(s->drive_lsb2, r_lsb2, TWO_STATE_Q22_MIN_UQ28);
    s->p22_start_uq28 = two_state_per_r_uq28(s->start_lsb2, r_lsb2, s->q22_uq28);
}

void two_state_wide_start(two_state_wide_t *s, int32_t x_lsb_q16)
{
    s->x_lsb_q16 = x_lsb_q16;
    s->rate_lsb_q16 = 0;
    s->u.p.p11_uq16 = ONE_UQ16;
    s->u.p.p12_uq24 = 0;
    s->u.p.p22_uq28 = s->p22_start_uq28;
    s->size_lsb_uq8 = 0;
    s->gain_uq16 = 0;
    s->variance = 0;
    s->collected = FILTER_WARM_UP_SAMPLES;
}

/* An element of P limited to its range. */
static uint32_t limited(uint32_t p)
{
    return ((p & TWO_STATE_WIDE_P_END) != 0U) ? TWO_STATE_WIDE_P_END : p;
}

void two_state_wide_begin(two_state_wide_t *s, int32_t x_lsb_q16, int32_t rate_lsb_q16, uint32_t p11_uq16,
                          uint32_t p12_uq24, uint32_t p22_uq28)
{
    two_state_wide_start(s, fx_clamp(x_lsb_q16, X_MAX_LSB_Q16));
    s->rate_lsb_q16 = fx_clamp(rate_lsb_q16, X_MAX_LSB_Q16);
    s->u.p.p11_uq16 = limited(p11_uq16);
    s->u.p.p12_uq24 = limited(p12_uq24);
    s->u.p.p22_uq28 = limited(p22_uq28);
}

void two_state_wide_reset(two_state_wide_t *s, int16_t z0_lsb)
{
    int16_t z0 = filter_clamp_z(z0_lsb);
    two_state_wide_start(s, (int32_t)z0 * 65536);
    for (uint8_t step = 0; step < SETTLE_STEPS; step++) {
        (void)two_state_wide_predict(s, z0);
        two_state_wide_update(s, 0, 0);
    }
}

bool two_state_wide_reset_step(two_state_wide_t *s, int16_t z0_lsb, uint8_t step)
{
    int16_t z0 = filter_clamp_z(z0_lsb);
    if (step == 0U) {
        two_state_wide_start(s, (int32_t)z0 * 65536);
    } else {
        (void)two_state_wide_predict(s, z0);
        two_state_wide_update(s, 0, 0);
    }
    return step < SETTLE_STEPS;
}

void two_state_wide_warm_up(two_state_wide_t *s, int16_t z_lsb)
{
    filter_warm_up_insert(s->u.start_lsb, s->collected, z_lsb);
    s->collected++;
    s->x_lsb_q16 = filter_warm_up_median_q16(s->u.start_lsb, s->collected);
    s->flags = FILTER_WARMING_UP;
    if (s->collected == FILTER_WARM_UP_SAMPLES) {
        two_state_wide_start(s, s->x_lsb_q16);
    }
}

/* x or rate limited to its bound; the flag tells. By the high word: 4608 LSB + 65535/65536 counts as 4608. */
FX_INLINE int32_t limited_state(two_state_wide_t *s, int32_t v_lsb_q16)
{
    int16_t whole_lsb = (int16_t)(v_lsb_q16 >> 16);
    if (whole_lsb >= FILTER_X_MAX_LSB) {
        s->flags |= FILTER_SATURATED;
        return X_MAX_LSB_Q16;
    }
    if (whole_lsb < -FILTER_X_MAX_LSB) {
        s->flags |= FILTER_SATURATED;
        return -X_MAX_LSB_Q16;
    }
    return v_lsb_q16;
}

/* P / R one sample on; false when it is at the end of its range. */
static bool predict_covariance(two_state_wide_t *s)
{
    uint32_t p11 = s->u.p.p11_uq16;
    uint32_t p12 = s->u.p.p12_uq24;
    uint32_t p22 = s->u.p.p22_uq28;
    bool grows = ((uint8_t)((uint8_t)(p11 >> 24) | (uint8_t)(p12 >> 24)) & (uint8_t)(TWO_STATE_WIDE_P_END >> 24)) == 0U;
    if (grows) {
        uint32_t sum = p12 + fx_sixteenth(p22);
        s->u.p.p12_uq24 = sum;
        s->u.p.p11_uq16 = p11 + ((p12 + 128U) >> 8) + ((sum + 128U) >> 8);
    }
    if ((p22 & TWO_STATE_WIDE_P_END) == 0U) {
        s->u.p.p22_uq28 = p22 + s->q22_uq28;
    }
    return grows;
}

bool two_state_wide_predict(two_state_wide_t *s, int16_t z_lsb)
{
    s->flags = 0;
    int32_t x = limited_state(s, s->x_lsb_q16 + s->rate_lsb_q16); /* <= 2 x 4608 LSB: fits */
    s->x_lsb_q16 = x;
    int32_t innovation = (int32_t)z_lsb * 65536 - x;
    /*@ assert innovation < 0 || 0 <= innovation; */ /* for make proof, which takes the cases one by one */
    s->negative = innovation < 0;
    s->size_lsb_uq8 = fx_abs32(innovation) >> 8;
    FX_FENCE();
    bool grows = predict_covariance(s);
    s->variance = fx_leading(s->u.p.p11_uq16 + ONE_UQ16);
    s->inverse_uq16 = fx_inverse_uq16(s->variance);
    return grows;
}

uint16_t two_state_wide_distance_uq8(const two_state_wide_t *s)
{
    fx_leading_t size = fx_leading(s->size_lsb_uq8); /* |r| = mantissa x 2^(8 - places) LSB, places 10..31 */
    uint16_t mantissa = fx_mantissa(size);
    uint16_t square = fx_high_u16(fx_high_u16(mantissa, mantissa), s->per_r.mantissa);
    uint32_t product = fx_mul_u16(square, s->inverse_uq16);
    /* |r|^2 / (R S) = product x 2^(per_r.exponent - 2 places + places of S + 17); product is 0 or >= 2^27 */
    int8_t shift = (int8_t)((int8_t)(2U * fx_places(size)) - (int8_t)fx_places(s->variance) - s->per_r.exponent - 25);
    if (shift > 31) {
        return 0;
    }
    uint32_t distance = (shift < 12) ? UINT32_MAX : fx_shifted_right(product, (uint8_t)shift);
    return (distance > UINT16_MAX) ? UINT16_MAX : (uint16_t)distance;
}

/*
 * An element of P: what Kalman's update leaves of it, and a fraction of what that takes away; or, to grow, what was
 * there and eight times that fraction more.
 */
FX_NOINLINE void give_back(uint32_t *p, uint32_t left, uint16_t fraction_uq16, bool grows)
{
    uint32_t before = *p;
    uint32_t taken = (before > left) ? before - left : 0U; /* not below 0 for rounding */
    uint32_t part = (fraction_uq16 == 0U) ? 0U : fx_times_uq16(taken, fraction_uq16);
    if (grows) {
        left = before;
        part = fx_eightfold(part);
    }
    *p = limited(left + part);
}

/* P22 less w2 P12, at least 0: by w2's mantissa, because in UQ8.24 the product would be too coarse for P22. */
static uint32_t left_of_p22(const two_state_wide_t *s, uint32_t w2_uq24)
{
    fx_leading_t w2 = fx_leading(w2_uq24); /* mantissa x 2^-(places - 8) x 2^-16, places >= 8 */
    uint32_t taken_uq24 = fx_times_uq16(s->u.p.p12_uq24, fx_mantissa(w2));
    uint8_t places = fx_places(w2);
    for (; places < 13U; places++) {
        taken_uq24 = fx_add_sat(taken_uq24, taken_uq24);
    }
    uint32_t taken_uq29 = fx_shifted_right(taken_uq24, (uint8_t)(places - 13U));
    uint32_t taken_uq28 = (taken_uq29 >> 1) + (taken_uq29 & 1U);
    uint32_t p22 = s->u.p.p22_uq28;
    return (p22 > taken_uq28) ? p22 - taken_uq28 : 0U;
}

static void update_covariance(two_state_wide_t *s, uint16_t w1_uq16, uint32_t w2_uq24, uint32_t back_uq16)
{
    uint16_t fraction_uq16 = (uint16_t)back_uq16;
    bool grows = back_uq16 >= ONE_UQ16;
    if (grows) {
        uint8_t high = (uint8_t)((uint8_t)(s->u.p.p11_uq16 >> 24) | (uint8_t)(s->u.p.p12_uq24 >> 24) |
                                 (uint8_t)(s->u.p.p22_uq28 >> 24));
        if (high >= (uint8_t)(TWO_STATE_WIDE_GROWTH_END >> 24)) {
            return;
        }
        fraction_uq16 = (uint16_t)fx_shifted_right(back_uq16 - ONE_UQ16, 3);
    }
    give_back(&s->u.p.p22_uq28, left_of_p22(s, w2_uq24), fraction_uq16, grows);
    give_back(&s->u.p.p12_uq24, w2_uq24, fraction_uq16, grows);
    give_back(&s->u.p.p11_uq16, w1_uq16, fraction_uq16, grows);
}

/* A gain times the innovation: by its magnitude, so that rounding is the same for both signs. */
FX_NOINLINE int32_t step_by(const two_state_wide_t *s, uint32_t gain_uq24)
{
    int32_t step = (int32_t)fx_mul24_uq24(s->size_lsb_uq8, gain_uq24); /* < 8704 LSB */
    return s->negative ? -step : step;
}

void two_state_wide_update(two_state_wide_t *s, uint16_t loss_uq16, uint32_t back_uq16)
{
    uint8_t halvings = (uint8_t)(15U - fx_places(s->variance)); /* S = 1..2 x 2^halvings */
    uint16_t w1_uq16 = (uint16_t)(0U - fx_shifted_right(s->inverse_uq16, halvings));
    s->gain_uq16 = (uint16_t)(w1_uq16 - fx_high_u16(w1_uq16, loss_uq16));
    s->x_lsb_q16 += step_by(s, (uint32_t)s->gain_uq16 << 8); /* towards the sample: within its bound */
    uint32_t w2_uq24 = fx_shifted_right(fx_times_uq16(s->u.p.p12_uq24, s->inverse_uq16), halvings);
    w2_uq24 = (w2_uq24 > 0xFFFFFFU) ? 0xFFFFFFU : w2_uq24;
    uint32_t gain2_uq24 = (loss_uq16 == 0U) ? w2_uq24 : w2_uq24 - fx_times_uq16(w2_uq24, loss_uq16);
    /*@ assert below_one: gain2_uq24 <= 0xFFFFFF; */
    s->rate_lsb_q16 = limited_state(s, s->rate_lsb_q16 + step_by(s, gain2_uq24));
    update_covariance(s, w1_uq16, w2_uq24, back_uq16);
}

void two_state_wide_refuse(two_state_wide_t *s, bool grows)
{
    if (grows) {
        s->flags |= FILTER_GATED;
        s->gain_uq16 = 0;
    } else {
        two_state_wide_update(s, 0, 0);
        s->flags |= FILTER_REACQUIRED;
    }
}

int32_t two_state_wide_coast(two_state_wide_t *s)
{
    if (two_state_wide_warming_up(s)) {
        s->flags = FILTER_WARMING_UP;
    } else {
        (void)two_state_wide_predict(s, 0);
        s->size_lsb_uq8 = 0;
        s->gain_uq16 = 0;
    }
    s->flags |= FILTER_COASTED;
    return s->x_lsb_q16;
}

void two_state_wide_damp(two_state_wide_t *s)
{
    s->rate_lsb_q16 >>= 1;
    if (!two_state_wide_warming_up(s)) {
        filter_halve(&s->u.p.p12_uq24);
        filter_halve(&s->u.p.p22_uq28);
        filter_halve(&s->u.p.p22_uq28);
    }
}

/* The elements that predict_covariance looks at; while warming up there is no P yet. */
void two_state_wide_hold(two_state_wide_t *s)
{
    uint32_t either = s->u.p.p11_uq16 | s->u.p.p12_uq24;
    if (!two_state_wide_warming_up(s) && (either & TWO_STATE_WIDE_P_END) != 0U) {
        filter_halve(&s->u.p.p11_uq16);
        filter_halve(&s->u.p.p12_uq24);
        filter_halve(&s->u.p.p22_uq28);
    }
}

void two_state_wide_restart(two_state_wide_t *s)
{
    s->rate_lsb_q16 = 0;
    s->u.p.p11_uq16 = 0; /* where the samples of the start will be */
    s->u.p.p12_uq24 = 0;
    s->u.p.p22_uq28 = 0;
    s->size_lsb_uq8 = 0;
    s->variance = 0;
    s->gain_uq16 = 0;
    s->flags = FILTER_WARMING_UP;
    s->collected = 0;
}

void two_state_wide_probe(const two_state_wide_t *s, uint16_t gate2_uq8, filter_probe_t *out)
{
    out->x_lsb_q16 = s->x_lsb_q16;
    out->rate_lsb_q16 = s->rate_lsb_q16;
    int32_t size_lsb_q16 = (int32_t)(s->size_lsb_uq8 << 8);
    out->innovation_lsb_q16 = s->negative ? -size_lsb_q16 : size_lsb_q16;
    /* while warming up P is not there yet: the variance of one sample */
    uint32_t p11_uq16 = two_state_wide_warming_up(s) ? ONE_UQ16 : s->u.p.p11_uq16;
    fx_scaled_t p_lsb2 = fx_scaled_mul(fx_scaled(p11_uq16), fx_scaled(s->r_lsb2_q8));
    p_lsb2.exponent = (int8_t)(p_lsb2.exponent - 24); /* Q16, Q8 */
    out->p_lsb2_q8 = fx_scaled_fixed(p_lsb2, 8);
    out->gate_lsb2_q8 = UINT32_MAX;
    if (gate2_uq8 != 0U && s->variance != 0U) {
        fx_scaled_t gate = fx_scaled_mul(fx_scaled(gate2_uq8), fx_scaled(s->variance & 0xFFFFFF00U));
        fx_scaled_t gate_lsb2 = fx_scaled_mul(gate, fx_scaled(s->r_lsb2_q8));
        gate_lsb2.exponent = (int8_t)(gate_lsb2.exponent - 32 - (int8_t)fx_places(s->variance)); /* Q8, Q16, Q8 */
        out->gate_lsb2_q8 = fx_scaled_fixed(gate_lsb2, 8);
    }
    out->gain_uq16 = s->gain_uq16;
    out->flags = s->flags;
}
