/*
 * huber: kf that follows an outlier with a bounded step.
 *
 * The weight of Huber's M-estimate on the innovation u (Huber 1964): within c sigmas of the innovation it is kf; beyond
 * them gain and the fall of the covariance are multiplied by w = c sqrt(S) / |u|, so that the step is that of a sample
 * c sigmas off, however far it lies. With c = 1.345 it has 95 % of kf's efficiency on Gaussian noise. No sample is
 * refused, so it cannot lock out; none is flagged, because 18 % of healthy ones lie beyond. Parameters r, q, huber,
 * ratemax; huber 0: kf.
 *
 * Scaling, beyond what kalman.h says of the step within:
 *   w        UQ0.16, rounded down, of u rounded down to 2^-8 LSB and c sqrt(S) to 2^-8 LSB (2^-4 coarse)
 *   w1, w2   kf's times w; P11 and P12 times 1 - w1 - 2^-16, P22 less P12 w2, not below 0: none rises
 */
#include "kalman.h"

static const filter_parameter_t huber FX_FLASH = {
    "huber", "sigma", 8, 1, KALMAN_GATE_MIN_SIGMA_Q8, KALMAN_GATE_MAX_SIGMA_Q8, 344
};
static const filter_parameter_t *const parameters[] FX_FLASH = { &filter_parameter_r, &filter_parameter_q, &huber,
                                                                 &filter_parameter_ratemax };

static void set_up(filter_t *f, const filter_config_t *config)
{
    f->own.kalman.of.gated.gate_sigma_q8 = (uint16_t)config->value[HUBER_SIGMA_Q8];
    filter_kalman_set_up(f, config, (uint32_t)config->value[HUBER_RATE_MAX_LSB_S]);
}

static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_set_variance(f, r_lsb2_q8);
    filter_kalman_set_gate(f, f->own.kalman.of.gated.gate_sigma_q8);
}

/* c sqrt(S) / |u|, below 1 because u^2 is beyond its limit, which the core left in limit_lsb2. */
static uint16_t weight_uq16(const filter_t *f)
{
    const filter_kalman_t *k = &f->own.kalman;
    uint32_t limit_lsb = filter_fx_isqrt32(k->limit_lsb2); /* UQ8.8, coarse UQ12.4 */
    uint32_t size_lsb = k->coarse ? f->size_lsb_uq16 >> 12 : f->size_lsb_uq16 >> 8;
    uint32_t weight = (limit_lsb << 16) / size_lsb;
    return (weight > 0xFFFFU) ? 0xFFFFU : (uint16_t)weight;
}

static void take_part(filter_t *f)
{
    filter_kalman_t *k = &f->own.kalman;
    uint16_t w_uq16 = weight_uq16(f);
    uint16_t g_uq16 = fx_reciprocal_uq16(k->p.p11 + KALMAN_ONE_UQ28);
    uint32_t p12 = k->p.p12;
    uint32_t w2_uq24 = fx_sixteenth(fx_mul_uq16(fx_mul_uq16(p12, g_uq16), w_uq16));
    f->gain_uq16 = fx_mul16_uq16((uint16_t)(0U - g_uq16), w_uq16);
    k->p.p11 = fx_mul24_uq16(k->p.p11 >> 8, (uint16_t)~f->gain_uq16);
    k->p.p12 = fx_mul24_uq16(p12 >> 8, (uint16_t)~f->gain_uq16);
    int32_t p22_q28 = (int32_t)k->p.p22 - (int32_t)fx_mul_uq24(p12, w2_uq24); /* < 3 less < 4: fits */
    k->p.p22 = (p22_q28 < 0) ? 0U : (uint32_t)p22_q28;
    tracker_move(f, (int32_t)fx_mul24_uq16(f->size_lsb_uq16 >> 8, f->gain_uq16));
    tracker_turn(f, (int32_t)fx_mul24_uq24(f->size_lsb_uq16 >> 8, w2_uq24));
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    if (!filter_kalman_step(f, z_lsb, what) && what != STEP_MISSING) {
        take_part(f);
    }
}

const filter_law_t filter_law_huber FX_FLASH = { .name = "huber",
                                                 .parameter_count = 4,
                                                 .traits = LAW_COVARIANCE | LAW_SETTLES,
                                                 .worst_cycles = 2000,
                                                 .parameters = parameters,
                                                 .set_up = set_up,
                                                 .set_noise = set_noise,
                                                 .start = filter_kalman_start,
                                                 .step = step,
                                                 .report = LAW_REPORT(filter_kalman_report) };
