/* Covariance, gains and re-acquisition of the Kalman laws: see kalman.h for the equations. */
#include "kalman.h"

LAW_KEEPS_FROM(filter_kalman_t, q22_uq26);

/* Variance of the rate of a sensor picked up at any moment: (200 LSB/s)^2, 45 degree/s around level. */
#define START_RATE_VARIANCE_LSB2_S2 40000U

void filter_kalman_scales(const filter_config_t *config, fx_scaled_t *drive_lsb2, fx_scaled_t *start_lsb2)
{
    fx_scaled_t period_s = filter_fx_scaled_div(filter_fx_scaled(10), filter_fx_scaled(config->rate_dhz));
    fx_scaled_t period2 = filter_fx_scaled_mul(period_s, period_s);
    *drive_lsb2 = filter_fx_scaled_mul(filter_fx_scaled((uint32_t)config->value[KALMAN_Q]),
                                       filter_fx_scaled_mul(period2, period_s));
    *start_lsb2 = filter_fx_scaled_mul(filter_fx_scaled(START_RATE_VARIANCE_LSB2_S2), period2);
}

uint32_t filter_kalman_per_r(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint8_t fraction_bits, uint32_t min, uint32_t max)
{
    uint32_t quotient = filter_fx_scaled_fixed(filter_fx_scaled_div(lsb2, r_lsb2), fraction_bits);
    if (quotient < min) {
        quotient = min;
    }
    return (quotient > max) ? max : quotient;
}

fx_scaled_t filter_kalman_scaled_r(uint32_t r_lsb2_q8)
{
    fx_scaled_t r_lsb2 = filter_fx_scaled(r_lsb2_q8);
    r_lsb2.exponent = (int8_t)(r_lsb2.exponent - 8);
    return r_lsb2;
}

void filter_kalman_set_up(filter_t *f, const filter_config_t *config, uint32_t rate_max_lsb_s)
{
    filter_kalman_t *k = &f->own.kalman;
    filter_kalman_scales(config, &k->drive_lsb2, &k->start_lsb2);
    filter_tracker_limit_rate(f, rate_max_lsb_s, 16);
    filter_set_noise(f, (uint32_t)config->value[KALMAN_R]);
}

static uint32_t per_r_uq26(fx_scaled_t lsb2, fx_scaled_t r_lsb2, uint32_t min_uq26)
{
    return filter_kalman_per_r(lsb2, r_lsb2, 26, min_uq26, KALMAN_Q22_MAX_UQ26);
}

void filter_kalman_set_variance(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_t *k = &f->own.kalman;
    fx_scaled_t r_lsb2 = filter_kalman_scaled_r(r_lsb2_q8);
    k->r_lsb2_q8 = r_lsb2_q8;
    k->q22_uq26 = per_r_uq26(k->drive_lsb2, r_lsb2, KALMAN_Q22_MIN_UQ26);
    f->q_limited = k->q22_uq26 == KALMAN_Q22_MIN_UQ26 || k->q22_uq26 == KALMAN_Q22_MAX_UQ26;
    k->p22_start_uq26 = per_r_uq26(k->start_lsb2, r_lsb2, k->q22_uq26);
}

/*
 * Gate of gate_sigma_q8 (<= 16 sigma) for the R in force, and how far apart two samples of one run may lie: 3 sqrt(2 R)
 * plus one period at ratemax, < 135 + 4609 LSB.
 */
static void set_gate(filter_t *f, uint16_t gate_sigma_q8)
{
    filter_kalman_t *k = &f->own.kalman;
    /* gate^2 R; from UQ10.22, two products in Q8 give UQ.6 */
    uint32_t gate_uq6 = filter_fx_mul_uq16(filter_fx_mul_uq16(k->r_lsb2_q8 << 14, gate_sigma_q8), gate_sigma_q8);
    k->coarse = gate_uq6 > 0xFFFFU;
    if (k->coarse) {
        gate_uq6 >>= 8;
    }
    k->gated = gate_sigma_q8 != 0U;
    k->gate_lsb2_uq6 = (gate_uq6 == 0U) ? 1U : (uint16_t)gate_uq6;
    k->agree_lsb = (uint16_t)((filter_fx_isqrt32(18U * k->r_lsb2_q8) + (f->rate_max_lsb >> 12)) >> 4);
}

void filter_kalman_set_noise_gated(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_set_variance(f, r_lsb2_q8);
    set_gate(f, f->own.kalman.of.gated.gate_sigma_q8);
}

void filter_kalman_set_up_gated(filter_t *f, const filter_config_t *config, uint8_t reacquire)
{
    uint8_t samples = (uint8_t)config->value[reacquire];
    f->own.kalman.of.gated.gate_sigma_q8 = (uint16_t)config->value[KALMAN_GATE];
    f->own.kalman.steps = (samples == 0U) ? 0U : (uint8_t)(samples - 1U);
    filter_kalman_set_up(f, config, (uint32_t)config->value[reacquire + 1]);
}

/* State that the law clears together with its run of refused samples and its last gate. */
static MACHINE_APART void fresh(filter_kalman_t *k)
{
    k->p.p11 = KALMAN_ONE_UQ24;
    k->p.p12 = 0;
    k->p.p22 = k->p22_start_uq26;
    k->limit_lsb2 = 0;
    k->run = 0;
}

/* For small q P settles at P12 = sqrt q, P11 = sqrt(2 P12), P22 = P11 P12; for q = 14 it settles at 3.7, 2.7, 10.2. */
void filter_kalman_near(filter_covariance_t *p, uint32_t q22_uq26)
{
    uint16_t p12_uq13 = filter_fx_isqrt32(q22_uq26);
    uint16_t p11_uq13 = filter_fx_isqrt32((uint32_t)p12_uq13 << 14);
    p->p11 = (uint32_t)p11_uq13 << 11;
    p->p12 = (uint32_t)p12_uq13 << 13;
    p->p22 = fx_product_u16(p11_uq13, p12_uq13);
}

void filter_kalman_start(filter_t *f, bool settled)
{
    f->own.kalman.refused = 0;
    fresh(&f->own.kalman);
    if (settled) {
        filter_kalman_near(&f->own.kalman.p, f->own.kalman.q22_uq26);
    }
}

/* Predicts P / R, while P11 < 4, P12 < 16, P22 < 16. */
static void grow(filter_kalman_t *k)
{
    uint8_t high = (uint8_t)((uint8_t)(k->p.p12 >> 24) | (uint8_t)(k->p.p22 >> 24));
    if ((high & 0xC0U) == 0U && (uint8_t)(k->p.p11 >> 24) < 4U) {
        uint32_t p12 = k->p.p12;
        uint32_t sum = p12 + k->p.p22;
        k->p.p12 = sum;
        k->p.p11 += kalman_quarter(p12 + sum);
        k->p.p22 += k->q22_uq26;
    }
}

/* S = P11 + 1 < 53. */
static uint16_t variance_uq10(const filter_kalman_t *k)
{
    return (uint16_t)(kalman_fourfold(k->p.p11 + KALMAN_ONE_UQ24) >> 16);
}

/* Sixteen bits of S and of u are enough: what does not fit is beyond any limit. */
static bool within_gate(filter_t *f)
{
    filter_kalman_t *k = &f->own.kalman;
    uint32_t limit_lsb2 = fx_product_u16(variance_uq10(k), k->gate_lsb2_uq6);
    k->limit_lsb2 = limit_lsb2;
    uint32_t size_lsb_uq16 = f->size_lsb_uq16;
    if (k->coarse) { /* UQ24.8: whole LSB are enough */
        limit_lsb2 >>= 8;
        size_lsb_uq16 >>= 8;
    }
    uint16_t size = (uint16_t)(size_lsb_uq16 >> 8);
    return (uint8_t)(size_lsb_uq16 >> 24) == 0U && fx_product_u16(size, size) <= limit_lsb2;
}

/* Corrects gains, x, rate and P. */
static void correct(filter_t *f)
{
    filter_kalman_t *k = &f->own.kalman;
    uint16_t g = fx_reciprocal_uq16(k->p.p11 + KALMAN_ONE_UQ24);
    uint16_t w1_uq16 = (uint16_t)(0U - g);
    f->gain_uq16 = w1_uq16;
    k->p.p11 = (uint32_t)w1_uq16 << 8;
    filter_tracker_move(f, (int32_t)filter_fx_mul24_uq16(f->size_lsb_uq16 >> 8, w1_uq16));
    uint32_t p12 = k->p.p12;
    uint32_t w2_uq26 = filter_fx_mul_uq16(p12, g);
    k->p.p12 = w2_uq26;
    uint32_t w2_uq24 = kalman_limited_uq24(kalman_quarter(w2_uq26));
    uint32_t taken_uq26 = filter_fx_mul24_uq24(p12 >> 8, w2_uq24);
    k->p.p22 = kalman_less(k->p.p22, taken_uq26);
    filter_tracker_turn(f, (int32_t)filter_fx_mul24_uq24(f->size_lsb_uq16 >> 8, w2_uq24));
}

bool filter_kalman_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    tracker_predict(f);
    filter_tracker_meet(f, z_lsb);
    grow(&f->own.kalman);
    if (what == STEP_MISSING) {
        return false;
    }
    if (f->own.kalman.gated && !within_gate(f)) {
        return false;
    }
    correct(f);
    return true;
}

/* Position and rate from the ends of a run of L samples: variances R, R / (L-1), 2 R / (L-1)^2. */
static void restart(filter_t *f, int16_t z_lsb)
{
    filter_kalman_t *k = &f->own.kalman;
    fresh(k);
    f->x_lsb_q16 = (int32_t)z_lsb * 65536;
    f->rate_lsb = 0;
    if (!f->broken) {
        uint16_t share_uq12 = 0x1000; /* becomes 1 / (L - 1) */
        for (uint8_t steps = k->steps; steps > 1U; steps >>= 1) {
            share_uq12 >>= 1;
        }
        int32_t slope = (int32_t)(z_lsb - k->first_lsb) * (int32_t)(uint16_t)(share_uq12 << 4); /* exact: a shift */
        f->rate_lsb = fx_clamp(slope, (int32_t)f->rate_max_lsb);
        k->p.p12 = (uint32_t)share_uq12 << 14;
        k->p.p22 = 8U * fx_product_u16(share_uq12, share_uq12) + k->q22_uq26;
    }
    filter_tracker_nothing(f);
    f->flags = (uint8_t)((f->flags & FILTER_SATURATED) | FILTER_REACQUIRED);
}

/*
 * A sample was refused although the prediction is less certain than a sample: the motion changes within a few samples,
 * so half of the rate (towards 0) is as likely to last as all of it.
 */
static void doubt_rate(filter_t *f)
{
    int32_t rate = f->rate_lsb;
    if (f->own.kalman.p.p11 >= KALMAN_ONE_UQ24) {
        if (rate < 0) {
            rate++;
        }
        f->rate_lsb = rate >> 1;
    }
}

bool filter_kalman_refused(filter_t *f, int16_t z_lsb)
{
    filter_kalman_t *k = &f->own.kalman;
    int16_t step = (int16_t)(z_lsb - f->previous_lsb);
    uint16_t distance = (uint16_t)((step < 0) ? -step : step);
    if (k->run == 0U || distance > k->agree_lsb) {
        k->run = 1;
        k->first_lsb = z_lsb;
        f->broken = false;
    } else if (k->steps != 0U) {
        if (k->run >= k->steps) {
            restart(f, z_lsb);
            return true;
        }
        k->run++;
    }
    if (k->steps != 0U) {
        doubt_rate(f);
    }
    return false;
}

bool filter_kalman_run_legal(int32_t samples)
{
    return samples == 0 || samples == 3 || samples == 5 || samples == 9;
}

void filter_kalman_report(const filter_t *f, filter_probe_t *out)
{
    const filter_kalman_t *k = &f->own.kalman;
    /* P is not set while warming up: the variance of one sample */
    bool running = f->collected == FILTER_RUNNING;
    out->p_lsb2_q8 = filter_fx_mul_uq24(running ? k->p.p11 : KALMAN_ONE_UQ24, k->r_lsb2_q8);
    if (running && k->limit_lsb2 != 0U) {
        out->gate_lsb2_q8 = k->coarse ? k->limit_lsb2 : k->limit_lsb2 >> 8;
    }
}
