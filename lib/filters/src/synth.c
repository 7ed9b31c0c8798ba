/*
 * synth: the synthesised polynomial filter with constant parameters (Zimchuk and Shapar; paper 000 equation 7, paper
 * 001).
 *
 *   x_e = (2 - a1) x1 - (1 - 2 a1) x2 - a1 x3        extrapolation from the last three estimates
 *   x   = x_e + b0 (z - x_e)
 *
 * It is computed in the incremental form x_e = x1 + v - a1 (v - v'), v = x1 - x2, v' = x2 - x3: two products instead of
 * four, algebraically the same. The papers feed back the estimates, not x_e (as one example prints): with x_e fed back
 * no measurement would reach the prediction. Not robust: every outlier passes with the gain b0. With a1 <= 0 the
 * variance of the estimate cannot fall below R / 2, whatever b0 (notes on the papers: synthesised-filter).
 *
 * Parameters a1 (0: a straight line through two estimates), b0, r (for start and probe), ratemax. Together a1 and b0
 * must lie inside the stability region: 1 + 2 a1 (1 - b0) > 0, which is exact within their ranges. The papers'
 * b0 > -a1 - 0.3 is only sufficient. Paper 001's preset is a1 = -0.3, b0 = 0.1 (-19661, 6554): it overshoots a step by
 * 69 % and hardly smooths (variance 0.82 R).
 *
 * ratemax is not in the papers: without it one outlier changes the rate of every prediction after it. At its largest
 * value v is limited to 4608 LSB a sample up to 217 Hz, to less above: only steps of over 10 g reach that. The default
 * is 1 LSB a sample at 800 Hz, where the noise of v is more than that: it is limited too, and x varies less than the
 * closed forms and the probe say.
 *
 * Scaling:
 *   a1, b0   UQ0.16 magnitudes, within 2^-17 of the configured ones
 *   rounding each product half away from zero to 2^-16 LSB; both together reach the output with the noise gain over
 *            b0^2 of the filter: 0.0002 LSB rms at (-0.3, 0.1). The bound that the tests assert against the double
 *            reference is (1 + |1 - b0|) 2^-17 times the sum of the error's impulse response
 */
#include "synth.h"

LAW_PARAMETER(a1, "a1\0", 16, 0, -65535, 65535, 0);
LAW_PARAMETER(b0, "b0\0", 16, 0, SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16, 19661);
static const filter_parameter_t *const parameters[] IN_FLASH = { &a1, &b0, &filter_parameter_r,
                                                                 &filter_parameter_ratemax };

/* |a1| (1 - b0), UQ0.32, exact. */
static uint32_t memory_uq32(uint16_t b0_uq16, uint16_t a1_uq16)
{
    return fx_product_u16(a1_uq16, (uint16_t)(0U - b0_uq16));
}

/* (4 - 3 b0) / 4, UQ0.32, exact. */
static uint32_t margin_uq32(uint16_t b0_uq16)
{
    return (0x40000U - 3U * (uint32_t)b0_uq16) << 14;
}

static uint16_t magnitude(int32_t a1_q16)
{
    return (uint16_t)filter_fx_abs32(a1_q16);
}

/*
 * 1 + 2 a1 (1 - b0) > 0 in exact integers. The other border of the region is outside the ranges of the parameters: with
 * a1 < 1 and 0 < b0 < 1, 4 - 3 b0 - 4 a1 (1 - b0) > 4 - 3 b0 - 4 (1 - b0) = b0 > 0.
 */
static bool stable(uint16_t b0_uq16, int32_t a1_q16)
{
    return a1_q16 >= 0 || memory_uq32(b0_uq16, magnitude(a1_q16)) < 0x80000000U;
}

/*
 * Steady-state variance of the estimate's error per R, white noise, UQ16.16, saturated; 1 (65536) and more: the filter
 * amplifies noise. Relative error below 2^-11 for a1 <= 0.95, 4e-3 at the upper corner of the region:
 *
 * (2 - b0 - 2 ac (b0 + ac)) / ((1 + 2 ac) (4 - 3 b0 - 4 ac)), ac = a1 (1 - b0): the stationary variance solved from the
 * closed loop. The factors that vanish on the border of the region are formed exactly.
 */
uint32_t filter_synth_noise_gain_uq16(uint16_t b0_uq16, int32_t a1_q16)
{
    uint32_t memory = memory_uq32(b0_uq16, magnitude(a1_q16)) >> 1; /* |ac|, UQ1.31 */
    uint32_t margin = margin_uq32(b0_uq16) >> 1;
    uint16_t ac_uq16 = (uint16_t)(memory >> 15);
    int32_t ac_q16 = (a1_q16 < 0) ? -(int32_t)ac_uq16 : (int32_t)ac_uq16;
    int32_t sum_q16 = (int32_t)b0_uq16 + ac_q16;
    int32_t product_q16 = (int32_t)filter_fx_mul_uq16(filter_fx_abs32(sum_q16), ac_uq16);
    bool negative = (sum_q16 < 0) != (ac_q16 < 0);
    int32_t above_q16 = 0x20000 - (int32_t)b0_uq16 - (negative ? -2 * product_q16 : 2 * product_q16);
    uint32_t left = (a1_q16 < 0) ? 0x40000000U - memory : 0x40000000U + memory; /* (1 + 2 ac) / 2, UQ1.31 */
    uint32_t right = (a1_q16 < 0) ? margin + memory : margin - memory;          /* (4 - 3 b0 - 4 ac) / 4 */
    fx_scaled_t above = filter_fx_scaled((above_q16 > 0) ? (uint32_t)above_q16 : 1U);
    above.exponent = (int8_t)(above.exponent - 16 - 3);
    fx_scaled_t below = filter_fx_scaled_mul(filter_fx_scaled(left), filter_fx_scaled(right));
    below.exponent = (int8_t)(below.exponent - 62);
    return filter_fx_scaled_fixed(filter_fx_scaled_div(above, below), 16);
}

static bool together(const filter_config_t *config)
{
    return stable((uint16_t)config->value[SYNTH_B0_UQ16], config->value[SYNTH_A1_Q16]);
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_synth_t *s = &f->own.synth;
    s->a1_uq16 = magnitude(config->value[SYNTH_A1_Q16]);
    s->a1_negative = config->value[SYNTH_A1_Q16] < 0;
    s->b0_uq16 = (uint16_t)config->value[SYNTH_B0_UQ16];
    filter_tracker_limit_rate(f, (uint32_t)config->value[SYNTH_RATE_MAX_LSB_S], 16);
    filter_set_noise(f, (uint32_t)config->value[SYNTH_R_LSB2_Q8]);
}

/* During the start the gain is that of a line, and the prediction is the straight line alone. */
static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_synth_t *s = &f->own.synth;
    if (s->count != SYNTH_STEADY && what != STEP_MISSING) {
        f->gain_uq16 = filter_synth_next_gain_uq16(f);
    }
    if (s->count == SYNTH_STEADY) {
        filter_synth_steady_step(f, z_lsb, what);
    } else {
        s->rate_before_lsb_q16 = f->rate_lsb;
        filter_synth_step(f, z_lsb, what);
    }
    filter_tracker_turn(f, 0); /* within ratemax */
}

/* Variance of one sample until the gain is steady, then R times the noise gain, limited to 32 bits. */
static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_synth_t *s = &f->own.synth;
    out->p_lsb2_q8 = s->r_lsb2_q8;
    if (f->collected == FILTER_RUNNING && s->count == SYNTH_STEADY) {
        int32_t a1_q16 = (int32_t)s->a1_uq16;
        a1_q16 = s->a1_negative ? -a1_q16 : a1_q16;
        out->p_lsb2_q8 = filter_synth_variance_lsb2_q8(f, filter_synth_noise_gain_uq16(s->b0_uq16, a1_q16));
    }
}

const filter_law_t filter_law_synth IN_FLASH = { .parameter_count = 4,
                                                 .worst_cycles = 745,
                                                 .parameters = parameters,
                                                 .together = together,
                                                 .set_up = set_up,
                                                 .set_noise = filter_synth_take_noise,
                                                 .start = filter_synth_start,
                                                 .step = step,
                                                 .fade = filter_synth_fade,
                                                 .report = LAW_REPORT(report),
                                                 .name = "synth" };
