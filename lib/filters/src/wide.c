/* Covariance with a wide range: see wide.h for the equations. */
#include "wide.h"

LAW_KEEPS_FROM(filter_wide_t, gate2_uq8);

#define ONE_UQ16 0x10000U

void filter_wide_set_up(filter_t *f, const filter_config_t *config)
{
    filter_wide_t *w = &f->own.wide;
    filter_kalman_scales(config, &w->drive_lsb2, &w->start_lsb2);
    f->rate_max_lsb = (uint32_t)TRACKER_X_MAX_LSB_Q16;
    filter_set_noise(f, (uint32_t)config->value[KALMAN_R]);
}

void filter_wide_set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_wide_t *w = &f->own.wide;
    fx_scaled_t r_lsb2 = filter_kalman_scaled_r(r_lsb2_q8);
    w->r_lsb2_q8 = r_lsb2_q8;
    w->per_r = filter_fx_scaled_div(filter_fx_scaled(1), r_lsb2);
    w->q22_uq28 = filter_kalman_per_r(w->drive_lsb2, r_lsb2, 28, WIDE_Q22_MIN_UQ28, WIDE_Q22_MAX_UQ28);
    f->q_limited = w->q22_uq28 == WIDE_Q22_MIN_UQ28 || w->q22_uq28 == WIDE_Q22_MAX_UQ28;
    w->p22_start_uq28 = filter_kalman_per_r(w->start_lsb2, r_lsb2, 28, w->q22_uq28, WIDE_Q22_MAX_UQ28);
}

void filter_wide_start(filter_t *f, bool settled)
{
    filter_wide_t *w = &f->own.wide;
    w->p.p11 = ONE_UQ16;
    w->p.p12 = 0;
    w->p.p22 = w->p22_start_uq28;
    if (settled) {
        filter_kalman_near(&w->p, w->q22_uq28 >> 2);
        w->p.p11 >>= 8;
        w->p.p12 >>= 2;
        w->p.p22 <<= 2;
    }
    w->variance = 0;
}

/* Predicts P / R; false if it is at the end of its range. */
static bool grow(filter_wide_t *w)
{
    uint32_t p11 = w->p.p11;
    uint32_t p12 = w->p.p12;
    uint32_t p22 = w->p.p22;
    bool grows = ((uint8_t)((uint8_t)(p11 >> 24) | (uint8_t)(p12 >> 24)) & (uint8_t)(WIDE_P_END >> 24)) == 0U;
    if (grows) {
        uint32_t sum = p12 + fx_sixteenth(p22);
        w->p.p12 = sum;
        w->p.p11 = p11 + ((p12 + 128U) >> 8) + ((sum + 128U) >> 8);
    }
    if ((p22 & WIDE_P_END) == 0U) {
        w->p.p22 = p22 + w->q22_uq28;
    }
    return grows;
}

bool filter_wide_predict(filter_t *f, int16_t z_lsb)
{
    filter_wide_t *w = &f->own.wide;
    tracker_predict(f);
    filter_tracker_meet(f, z_lsb);
    bool grows = grow(w);
    w->variance = filter_fx_leading(w->p.p11 + ONE_UQ16);
    w->inverse_uq16 = filter_fx_inverse_uq16(w->variance);
    return grows;
}

uint16_t filter_wide_distance_uq8(const filter_t *f)
{
    const filter_wide_t *w = &f->own.wide;
    fx_leading_t size = filter_fx_leading(f->size_lsb_uq16 >>
                                          8); /* |u| = mantissa x 2^(8 - places) LSB, places 10..31 */
    uint16_t mantissa = fx_mantissa(size);
    uint16_t square = filter_fx_high_u16(filter_fx_high_u16(mantissa, mantissa), w->per_r.mantissa);
    uint32_t product = fx_product_u16(square, w->inverse_uq16);
    /* |u|^2 / (R S) = product x 2^(per_r.exponent - 2 places + places of S + 17); product is 0 or >= 2^27 */
    int8_t shift = (int8_t)((int8_t)(2U * fx_places(size)) - (int8_t)fx_places(w->variance) - w->per_r.exponent - 25);
    if (shift > 31) {
        return 0;
    }
    uint32_t distance = (shift < 12) ? UINT32_MAX : filter_fx_shift_right(product, (uint8_t)shift);
    return (distance > UINT16_MAX) ? UINT16_MAX : (uint16_t)distance;
}

/* An element of P limited to its range. */
static uint32_t limited(uint32_t p)
{
    return ((p & WIDE_P_END) != 0U) ? WIDE_P_END : p;
}

/*
 * An element of P: what Kalman's update leaves, plus a fraction of what it removes; if it grows, the old value plus
 * eight times that fraction.
 */
static void give_back(uint32_t *p, uint32_t left, uint16_t fraction_uq16, bool grows)
{
    uint32_t before = *p;
    uint32_t taken = (before > left) ? before - left : 0U; /* rounding does not take it below 0 */
    uint32_t part = (fraction_uq16 == 0U) ? 0U : filter_fx_mul_uq16(taken, fraction_uq16);
    if (grows) {
        left = before;
        part = fx_eightfold(part);
    }
    *p = limited(left + part);
}

/* P22 less w2 P12, at least 0. Uses w2's mantissa, because in UQ8.24 the product would be too coarse for P22. */
static uint32_t left_of_p22(const filter_wide_t *w, uint32_t w2_uq24)
{
    fx_leading_t w2 = filter_fx_leading(w2_uq24); /* mantissa x 2^-(places - 8) x 2^-16, places >= 8 */
    uint32_t taken_uq24 = filter_fx_mul_uq16(w->p.p12, fx_mantissa(w2));
    uint8_t places = fx_places(w2);
    for (; places < 13U; places++) {
        taken_uq24 = fx_add_sat(taken_uq24, taken_uq24);
    }
    uint32_t taken_uq29 = filter_fx_shift_right(taken_uq24, (uint8_t)(places - 13U));
    uint32_t taken_uq28 = (taken_uq29 >> 1) + (taken_uq29 & 1U);
    uint32_t p22 = w->p.p22;
    return (p22 > taken_uq28) ? p22 - taken_uq28 : 0U;
}

static void correct_covariance(filter_wide_t *w, uint16_t w1_uq16, uint32_t w2_uq24, uint32_t back_uq16)
{
    uint16_t fraction_uq16 = (uint16_t)back_uq16;
    bool grows = back_uq16 >= ONE_UQ16;
    if (grows) {
        uint8_t high = (uint8_t)((uint8_t)(w->p.p11 >> 24) | (uint8_t)(w->p.p12 >> 24) | (uint8_t)(w->p.p22 >> 24));
        if (high >= (uint8_t)(WIDE_GROWTH_END >> 24)) {
            return;
        }
        fraction_uq16 = (uint16_t)filter_fx_shift_right(back_uq16 - ONE_UQ16, 3);
    }
    give_back(&w->p.p22, left_of_p22(w, w2_uq24), fraction_uq16, grows);
    give_back(&w->p.p12, w2_uq24, fraction_uq16, grows);
    give_back(&w->p.p11, w1_uq16, fraction_uq16, grows);
}

/* A gain times the innovation's magnitude, so that rounding is the same for both signs; < 8704 LSB. */
static int32_t step_by(const filter_t *f, uint32_t gain_uq24)
{
    return (int32_t)filter_fx_mul24_uq24(f->size_lsb_uq16 >> 8, gain_uq24);
}

void filter_wide_correct(filter_t *f, uint16_t loss_uq16, uint32_t back_uq16)
{
    filter_wide_t *w = &f->own.wide;
    uint8_t halvings = (uint8_t)(15U - fx_places(w->variance)); /* S = 1..2 x 2^halvings */
    uint16_t w1_uq16 = (uint16_t)(0U - filter_fx_shift_right(w->inverse_uq16, halvings));
    f->gain_uq16 = (uint16_t)(w1_uq16 - filter_fx_high_u16(w1_uq16, loss_uq16));
    filter_tracker_move(f, step_by(f, (uint32_t)f->gain_uq16 << 8)); /* towards the sample: within its bound */
    uint32_t w2_uq24 = filter_fx_shift_right(filter_fx_mul_uq16(w->p.p12, w->inverse_uq16), halvings);
    w2_uq24 = (w2_uq24 > 0xFFFFFFU) ? 0xFFFFFFU : w2_uq24;
    uint32_t gain2_uq24 = (loss_uq16 == 0U) ? w2_uq24 : w2_uq24 - filter_fx_mul_uq16(w2_uq24, loss_uq16);
    /*@ assert below_one: gain2_uq24 <= 0xFFFFFF; */
    filter_tracker_turn(f, step_by(f, gain2_uq24));
    correct_covariance(w, w1_uq16, w2_uq24, back_uq16);
}

void filter_wide_refuse(filter_t *f, bool grows)
{
    if (grows) {
        f->flags |= FILTER_GATED;
        f->gain_uq16 = 0;
    } else {
        filter_wide_correct(f, 0, 0);
        f->flags |= FILTER_REACQUIRED;
    }
}

void filter_wide_report(const filter_t *f, filter_probe_t *out)
{
    const filter_wide_t *w = &f->own.wide;
    /* P is not set while warming up: the variance of one sample */
    bool running = f->collected == FILTER_RUNNING;
    fx_scaled_t p_lsb2 = filter_fx_scaled_mul(filter_fx_scaled(running ? w->p.p11 : ONE_UQ16),
                                              filter_fx_scaled(w->r_lsb2_q8));
    p_lsb2.exponent = (int8_t)(p_lsb2.exponent - 24); /* Q16, Q8 */
    out->p_lsb2_q8 = filter_fx_scaled_fixed(p_lsb2, 8);
    if (running && w->gate2_uq8 != 0U && w->variance != 0U) {
        fx_scaled_t gate = filter_fx_scaled_mul(filter_fx_scaled(w->gate2_uq8),
                                                filter_fx_scaled(w->variance & 0xFFFFFF00U));
        fx_scaled_t gate_lsb2 = filter_fx_scaled_mul(gate, filter_fx_scaled(w->r_lsb2_q8));
        gate_lsb2.exponent = (int8_t)(gate_lsb2.exponent - 32 - (int8_t)fx_places(w->variance)); /* Q8, Q16, Q8 */
        out->gate_lsb2_q8 = filter_fx_scaled_fixed(gate_lsb2, 8);
    }
}
