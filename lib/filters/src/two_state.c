/* Two-state Kalman core: see two_state.h for the equations. */
#include "two_state.h"

/* Spread of the rate of a sensor picked up at any moment: 200 LSB/s, 45 degree/s around level. */
#define START_RATE_VARIANCE_LSB2_S2 40000U

#define ONE_UQ28 0x10000000U
/* After so many equal samples P is within a few per cent of where it settles, for gains above 0.05. */
#define SETTLE_STEPS 64U

/* Ends of P after a prediction, see TWO_STATE_P11_END_UQ28. */
#define P11_MAX_UQ28 0x7FFFFFFFU
#define P12_MAX_UQ28 0x3FFFFFFFU
#define P22_MAX_UQ28 0x2FFFFFFFU

#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

bool two_state_legal(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    return filter_common_legal(rate_dhz, r_lsb2_q8) && q_lsb2_s3 >= TWO_STATE_Q_MIN_LSB2_S3 &&
           q_lsb2_s3 <= TWO_STATE_Q_MAX_LSB2_S3;
}

bool two_state_gate_legal(uint16_t gate_sigma_q8)
{
    return gate_sigma_q8 == 0U ||
           (gate_sigma_q8 >= TWO_STATE_GATE_MIN_SIGMA_Q8 && gate_sigma_q8 <= TWO_STATE_GATE_MAX_SIGMA_Q8);
}

fx_scaled_t two_state_scales(uint16_t rate_dhz, uint32_t q_lsb2_s3, fx_scaled_t *drive_lsb2, fx_scaled_t *start_lsb2)
{
    fx_scaled_t period_s = fx_scaled_div(fx_scaled(10), fx_scaled(rate_dhz));
    fx_scaled_t period2 = fx_scaled_mul(period_s, period_s);
    *drive_lsb2 = fx_scaled_mul(fx_scaled(q_lsb2_s3), fx_scaled_mul(period2, period_s));
    *start_lsb2 = fx_scaled_mul(fx_scaled(START_RATE_VARIANCE_LSB2_S2), period2);
    return period_s;
}

void two_state_init(two_state_t *s, uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3, uint32_t rate_max_lsb_s)
{
    filter_zero(s, sizeof *s);
    s->flags = FILTER_WARMING_UP;
    fx_scaled_t period_s = two_state_scales(rate_dhz, q_lsb2_s3, &s->drive_lsb2, &s->start_lsb2);
    uint32_t limit = (uint32_t)X_MAX_LSB_Q16;
    if (rate_max_lsb_s != 0U) {
        limit = fx_scaled_fixed(fx_scaled_mul(fx_scaled(rate_max_lsb_s), period_s), 16);
    }
    s->rate_max_lsb_q16 = (limit < (uint32_t)X_MAX_LSB_Q16) ? limit : (uint32_t)X_MAX_LSB_Q16;
    two_state_set_noise(s, r_lsb2_q8);
}

uint32_t two_state_per_r_uq28(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint32_t min_uq28)
{
    uint32_t quotient = fx_scaled_fixed(fx_scaled_div(lsb2, r_lsb2), 28);
    if (quotient < min_uq28) {
        return min_uq28;
    }
    return (quotient > TWO_STATE_Q22_MAX_UQ28) ? TWO_STATE_Q22_MAX_UQ28 : quotient;
}

void two_state_set_noise(two_state_t *s, uint32_t r_lsb2_q8)
{
    two_state_set_variance(s, filter_limited_r_lsb2_q8(r_lsb2_q8));
}

void two_state_set_variance(two_state_t *s, uint32_t r_lsb2_q8)
{
    s->r_lsb2_q8 = r_lsb2_q8;
    fx_scaled_t r_lsb2 = fx_scaled(r_lsb2_q8);
    r_lsb2.exponent = (int8_t)(r_lsb2.exponent - 8);
    s->q22_uq28 = two_state_per_r_uq28(s->drive_lsb2, r_lsb2, TWO_STATE_Q22_MIN_UQ28);
    s->p22_start_uq28 = two_state_per_r_uq28(s->start_lsb2, r_lsb2, s->q22_uq28);
}

void two_state_set_gate(two_state_t *s, uint16_t gate_sigma_q8)
{
    s->gated = gate_sigma_q8 != 0U;
    fx_scaled_t gate_sigma = fx_scaled(gate_sigma_q8);
    fx_scaled_t gate = fx_scaled_mul(fx_scaled_mul(gate_sigma, gate_sigma), fx_scaled(s->r_lsb2_q8));
    gate.exponent = (int8_t)(gate.exponent - 24); /* Q8 three times */
    uint32_t gate_uq4 = fx_scaled_fixed(gate, 4);
    s->coarse = gate_uq4 > 0xFFFFU;
    if (s->coarse) {
        gate_uq4 >>= 8;
    }
    s->gate_lsb2_uq4 = (gate_uq4 == 0U) ? 1U : (uint16_t)gate_uq4;
}

void two_state_start(two_state_t *s, int32_t x_lsb_q16)
{
    s->x_lsb_q16 = x_lsb_q16;
    s->rate_lsb_q16 = 0;
    s->u.p.p11_uq28 = ONE_UQ28;
    s->u.p.p12_uq28 = 0;
    s->u.p.p22_uq28 = s->p22_start_uq28;
    s->size_lsb_uq8 = 0;
    s->gain_uq16 = 0;
    s->limit_lsb2 = 0;
    s->collected = FILTER_WARM_UP_SAMPLES;
}

static uint32_t at_most(uint32_t v, uint32_t limit)
{
    return (v < limit) ? v : limit;
}

void two_state_begin(two_state_t *s, int32_t x_lsb_q16, int32_t rate_lsb_q16, uint32_t p11_uq28, uint32_t p12_uq28,
                     uint32_t p22_uq28)
{
    two_state_start(s, fx_clamp(x_lsb_q16, X_MAX_LSB_Q16));
    s->rate_lsb_q16 = fx_clamp(rate_lsb_q16, (int32_t)s->rate_max_lsb_q16);
    s->flags = 0;
    s->u.p.p11_uq28 = at_most(p11_uq28, P11_MAX_UQ28);
    s->u.p.p12_uq28 = at_most(p12_uq28, at_most(s->u.p.p11_uq28, P12_MAX_UQ28));
    s->u.p.p22_uq28 = at_most(p22_uq28, P22_MAX_UQ28);
}

void two_state_settle(two_state_t *s)
{
    int16_t z_lsb = (int16_t)(s->x_lsb_q16 >> 16);
    for (uint8_t step = 0; step < SETTLE_STEPS; step++) {
        (void)two_state_step(s, z_lsb, true);
    }
}

bool two_state_reset_step(two_state_t *s, int16_t z0_lsb, uint8_t step)
{
    int16_t z0 = filter_limited_z(z0_lsb);
    if (step == 0U) {
        s->flags = 0;
        two_state_start(s, (int32_t)z0 * 65536);
    } else {
        (void)two_state_step(s, z0, true);
    }
    return step < SETTLE_STEPS;
}

int16_t two_state_reset(two_state_t *s, int16_t z0_lsb)
{
    (void)two_state_reset_step(s, z0_lsb, 0);
    two_state_settle(s);
    return filter_limited_z(z0_lsb);
}

void two_state_warm_up(two_state_t *s, int16_t z_lsb)
{
    filter_warm_up_insert(s->u.start_lsb, s->collected, z_lsb);
    s->collected++;
    s->x_lsb_q16 = filter_warm_up_median_q16(s->u.start_lsb, s->collected);
    s->flags = FILTER_WARMING_UP;
    if (s->collected == FILTER_WARM_UP_SAMPLES) {
        two_state_start(s, s->x_lsb_q16);
    }
}

/*
 * x limited to its bound; the flag, the first of the step, tells. By the high word: 4608 LSB + 65535/65536 counts as
 * 4608.
 */
FX_INLINE int32_t clamp_x(two_state_t *s, int32_t x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        s->flags = FILTER_SATURATED;
        return (x_lsb_q16 < 0) ? -X_MAX_LSB_Q16 : X_MAX_LSB_Q16;
    }
    return x_lsb_q16;
}

/* P / R one sample on, while all its elements are below 2. */
FX_INLINE void predict_covariance(two_state_t *s)
{
    uint8_t high = (uint8_t)((uint8_t)(s->u.p.p11_uq28 >> 24) | (uint8_t)(s->u.p.p12_uq28 >> 24) |
                             (uint8_t)(s->u.p.p22_uq28 >> 24));
    if ((high & 0xE0U) == 0U) {
        FX_FENCE();
        uint32_t p12 = s->u.p.p12_uq28;
        uint32_t sum = p12 + s->u.p.p22_uq28;
        s->u.p.p12_uq28 = sum;
        FX_FENCE();
        s->u.p.p11_uq28 += p12 + sum;
        FX_FENCE();
        s->u.p.p22_uq28 += s->q22_uq28;
    }
}

/* r^2 <= gate^2 R (P11 + 1), all in LSB^2; |r| <= 8704 LSB. Innovations of more than 16 bits lie outside any limit. */
FX_NOINLINE bool within_gate(two_state_t *s)
{
    uint32_t size_lsb_uq8 = s->size_lsb_uq8;
    if (s->coarse) {
        size_lsb_uq8 = fx_sixteenth(size_lsb_uq8 & ~(uint32_t)15U); /* >> 4, which would be a loop on AVR */
    }
    /* UQ4.28 x UQ12.4 >> 16 = UQ16.16, < 9 x 4096; coarse: UQ24.8 */
    s->limit_lsb2 = fx_mul_uq16(s->u.p.p11_uq28 + ONE_UQ28, s->gate_lsb2_uq4);
    uint16_t size = (uint16_t)size_lsb_uq8;
    return (uint8_t)(size_lsb_uq8 >> 16) == 0U && fx_mul_u16(size, size) <= s->limit_lsb2;
}

/*
 * Gains, x, rate and P from the innovation's magnitude, so that rounding is the same for both signs. A step is at most
 * |r|, < 2^30, and x stays between the prediction and the sample, hence within its bound.
 */
FX_INLINE void update(two_state_t *s)
{
    uint16_t g = fx_reciprocal_uq16(s->u.p.p11_uq28 + ONE_UQ28);
    uint16_t w1_uq16 = (uint16_t)(0U - g);
    s->gain_uq16 = w1_uq16;
    s->u.p.p11_uq28 = fx_shift12(w1_uq16);
    int32_t x_step = (int32_t)fx_mul24_uq16(s->size_lsb_uq8, w1_uq16);
    if (s->negative) {
        s->x_lsb_q16 -= x_step;
    } else {
        s->x_lsb_q16 += x_step;
    }
    FX_FENCE();
    uint32_t p12 = s->u.p.p12_uq28;
    uint32_t w2_uq28 = fx_mul_uq16(p12, g);
    s->u.p.p12_uq28 = w2_uq28;
    uint32_t w2_uq24 = fx_sixteenth(w2_uq28); /* < 1 because P12 <= P11 after a prediction */
    int32_t p22_q28 = (int32_t)s->u.p.p22_uq28 - (int32_t)fx_mul_uq24(p12, w2_uq24); /* < 3 less < 4: fits */
    s->u.p.p22_uq28 = (p22_q28 < 0) ? 0U : (uint32_t)p22_q28;
    FX_FENCE();
    int32_t rate_step = (int32_t)fx_mul24_uq24(s->size_lsb_uq8, w2_uq24);
    int32_t rate = s->rate_lsb_q16;
    if (s->negative) {
        rate -= rate_step;
    } else {
        rate += rate_step;
    }
    /* for make proof, which takes the cases one by one */
    /*@ assert -301989888 <= rate <= 301989888 || rate < -301989888 || 301989888 < rate; */
    s->rate_lsb_q16 = rate;
    if (fx_abs32(rate) > s->rate_max_lsb_q16) {
        s->rate_lsb_q16 = (rate < 0) ? -(int32_t)s->rate_max_lsb_q16 : (int32_t)s->rate_max_lsb_q16;
        s->flags = FILTER_SATURATED;
    }
}

bool two_state_step(two_state_t *s, int16_t z_lsb, bool present)
{
    s->flags = 0;
    int32_t x = clamp_x(s, s->x_lsb_q16 + s->rate_lsb_q16); /* <= 2 x 4608 LSB: fits */
    s->x_lsb_q16 = x;
    int32_t innovation = (int32_t)z_lsb * 65536 - x;
    bool negative = false;
    if (innovation < 0) {
        innovation = -innovation;
        negative = true;
    }
    s->negative = negative;
    s->size_lsb_uq8 = (uint32_t)innovation >> 8;
    FX_FENCE();
    predict_covariance(s);
    if (!present) {
        s->size_lsb_uq8 = 0;
        s->gain_uq16 = 0;
        return false;
    }
    if (s->gated && !within_gate(s)) {
        s->flags |= FILTER_GATED;
        s->gain_uq16 = 0;
        return false;
    }
    update(s);
    return true;
}

int32_t two_state_coast(two_state_t *s)
{
    if (two_state_warming_up(s)) {
        s->flags = FILTER_WARMING_UP;
    } else {
        (void)two_state_step(s, 0, false);
    }
    s->flags |= FILTER_COASTED;
    return s->x_lsb_q16;
}

/*
 * Rounded down to 2^-16 LSB per sample, so within the bound of the rate. P is that of (x, v / 2), so it stays a
 * covariance within its bounds, and the sample behind a gap meets no gain that grew with a rate no longer believed.
 */
void two_state_damp(two_state_t *s)
{
    s->rate_lsb_q16 >>= 1;
    if (!two_state_warming_up(s)) {
        filter_halve(&s->u.p.p12_uq28);
        filter_halve(&s->u.p.p22_uq28);
        filter_halve(&s->u.p.p22_uq28);
    }
}

void two_state_restart(two_state_t *s)
{
    s->rate_lsb_q16 = 0;
    s->u.p.p11_uq28 = 0; /* where the samples of the start will be */
    s->u.p.p12_uq28 = 0;
    s->u.p.p22_uq28 = 0;
    s->size_lsb_uq8 = 0;
    s->limit_lsb2 = 0;
    s->gain_uq16 = 0;
    s->flags = FILTER_WARMING_UP;
    s->collected = 0;
}

void two_state_probe(const two_state_t *s, filter_probe_t *out)
{
    out->x_lsb_q16 = s->x_lsb_q16;
    out->rate_lsb_q16 = s->rate_lsb_q16;
    int32_t size_lsb_q16 = (int32_t)(s->size_lsb_uq8 << 8);
    out->innovation_lsb_q16 = s->negative ? -size_lsb_q16 : size_lsb_q16;
    /* while warming up P is not there yet: the variance of one sample */
    uint32_t p11_uq28 = two_state_warming_up(s) ? ONE_UQ28 : s->u.p.p11_uq28;
    out->p_lsb2_q8 = (fx_mul_uq24(p11_uq28, s->r_lsb2_q8) + 8U) >> 4;
    out->gate_lsb2_q8 = UINT32_MAX;
    if (s->gated && s->limit_lsb2 != 0U) {
        out->gate_lsb2_q8 = s->coarse ? s->limit_lsb2 : s->limit_lsb2 >> 8;
    }
    out->gain_uq16 = s->gain_uq16;
    out->flags = s->flags;
}
