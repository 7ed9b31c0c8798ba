/*
 * synth_plus: the synthesised filter with a memory of innovations, B(z) = b0 + b1 z^-1 + b2 z^-2 (paper 001 equation
 * 16, the past innovations inside x_e):
 *
 *   x_e = 2 x1 - x2 - a1 (x1 - 2 x2 + x3) + b1 u1 + b2 u2,   u = z - x_e,   x = x_e + b0 u
 *
 * so x / z = B / D with D = B + (1 - b0) A, A = (1 - z^-1)^2 (1 + a1 z^-1). It contains filters that `synth` does not.
 * With rho = -a1 the correlation of the acceleration from sample to sample, and gains k1, k2, k3 of x' = x + v, v' = v
 * + a, a' = rho a:
 *
 *   alpha-beta        rho = 0: b0 = alpha, b1 = beta - alpha, b2 = 0
 *   steady Singer     b0 = k1, b1 = k2 - (1 + rho) k1, b2 = rho (k1 - k2) + k3; of a Kalman filter that is
 *   filter            b2 = rho (1 - b0) (b1 + (2 + rho) b0)
 *   alpha-beta-gamma  the same with rho = 1
 *
 * At most three products a sample: b0 u, b1 u and, unless b2 is 0, b2 u, each of a 32-bit state and a 16-bit tap, that
 * is two multiplications of 16 x 16 bits or eight of the chip's. Four free coefficients would need a fourth, so rho = 1
 * - 2^-k: what is subtracted from the curvature is a shift. The chip, which shifts one place at a time, does that shift
 * with four byte multiplications by 2^(8-k), half the cost of a product. A process whose rho lies between two of these
 * is tracked with the taps for the nearer one (test_synth_plus_reference.c shows the cost). Not robust: every outlier
 * passes with the gain b0.
 *
 * Parameters k (rho = 1 - 2^-k; 8: 1), b0, b1, b2, r (for start and probe). Together the four must be stable: D has its
 * zeros inside the unit circle, which is (Jury's test of the third order)
 *
 *   b0 + b1 + b2 > 0,   b0 - b1 + b2 + 4 (1 - b0) (1 + rho) > 0,   b0 - b2 > (1 - b0) rho (2 b0 + b1)
 *
 * and is decided in exact integers.
 *
 * Scaling:
 *   memory   Q15.16, b1 u1 + b2 u2 - a1 (x1 - 2 x2 + x3): |b1 u1 + b2 u2| <= 17410 LSB; with a curvature, below 18432
 *            LSB, the two are limited to 13824 and the sum to 18432: with 2 x1 - x2 each sum is below 2^31 in Q16
 *   b0..b2   UQ0.16 magnitudes, within 2^-17 of the configured ones; rho exact
 *   products b0, b1, b2: three of 32 x 16 bits, none for b2 = 0; rho is a shift that rounds (fx_without_part)
 *   rounding products half away from zero to 2^-16 LSB, the shift half up; with n half counts in x_e (one for each of
 *            b1, b2 and the shift) and the one of b0 the error is below
 *            2^-17 (sum |g0| + n sum |g1|), g0, g1 the impulse responses of (B + (1 - b0)) / D and (1 - b0) / D
 */
#include "synth.h"

#define ONE_Q16 65536
#define K_MAX 8 /* rho = 1 */

/* For the defaults: kf's gains with process noise of 6e-8 and of 1 R per sample. */
#define ALPHA_MIN_UQ16 1442U
#define ALPHA_MAX_UQ16 50403U

LAW_PARAMETER(k_parameter, "k\0", 0, 0, 0, K_MAX, 0);
LAW_PARAMETER(b0_parameter, "b0\0", 16, 0, SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16, 0);
LAW_PARAMETER(b1_parameter, "b1\0", 16, 0, -65535, 65535, 0);
LAW_PARAMETER(b2_parameter, "b2\0", 16, 0, -65535, 65535, 0);
static const filter_parameter_t *const parameters[] IN_FLASH = { &k_parameter, &b0_parameter, &b1_parameter,
                                                                 &b2_parameter, &filter_parameter_r };

/*
 * - b1 of the alpha-beta form of a least-squares line through n samples, (4 n - 8) / (n (n + 1)), n = 6..31, UQ0.16.
 * With the gains of filter_synth_next_gain_uq16 the start is that line. A slower filter continues with its own from
 * there: they differ by at most 0.13.
 */
enum { LINE_END = 31 };
static const uint16_t line_memory_uq16[(uint8_t)LINE_END - (uint8_t)SYNTH_FIRST_GAIN] IN_FLASH = {
    24966, 23406, 21845, 20389, 19065, 17873, 16804, 15844, 14980, 14199, 13493, 12850, 12264,
    11727, 11235, 10781, 10361, 9973,  9612,  9276,  8962,  8669,  8394,  8136,  7893,  7663,
};

/*
 * Alpha-beta with the steady gains of `kf` at its defaults (q = 10,000 LSB^2/s^3, R by rate). alpha is a rational
 * function of the rate, within 0.1 % of them from 25 to 800 Hz, limited as they are to 0.022..0.769; beta = alpha^2 /
 * (2 - alpha), as in kf.
 *
 * Gains of kf: alpha^4 / ((2 - alpha)^2 (1 - alpha)) = q T^3 / R = g^4, g = 24.03 Hz / rate. alpha = sqrt(2) g / (1 + g
 * / sqrt(2) + 0.13 g^2) is exact for small g; with the rate in 0.1 Hz, numerator and denominator times it:
 */
static void standard(filter_config_t *config)
{
    uint16_t rate_dhz = config->rate_dhz;
    uint16_t alpha_uq16 = (uint16_t)(22271000U / ((uint32_t)rate_dhz + 170U + (uint16_t)(7500U / rate_dhz)));
    if (alpha_uq16 < ALPHA_MIN_UQ16) {
        alpha_uq16 = ALPHA_MIN_UQ16;
    } else if (alpha_uq16 > ALPHA_MAX_UQ16) {
        alpha_uq16 = ALPHA_MAX_UQ16;
    }
    uint16_t beta_uq16 = (uint16_t)(fx_product_u16(alpha_uq16, alpha_uq16) / (0x20000U - alpha_uq16));
    config->value[SYNTH_PLUS_B0_UQ16] = alpha_uq16;
    config->value[SYNTH_PLUS_B1_Q16] = (int32_t)beta_uq16 - (int32_t)alpha_uq16;
}

/* Not inlined, for products that run rarely. */
static uint32_t product_u16(uint16_t a, uint16_t b)
{
    return fx_product_u16(a, b);
}

/* m = (1 - b0) rho, UQ0.32, exact. */
static uint32_t memory_uq32(const filter_config_t *config)
{
    uint32_t c_uq32 = ((uint32_t)0x10000 - (uint32_t)config->value[SYNTH_PLUS_B0_UQ16]) << 16;
    return (config->value[SYNTH_PLUS_K] < K_MAX) ? c_uq32 - (c_uq32 >> config->value[SYNTH_PLUS_K]) : c_uq32;
}

/* The three conditions at the top of this file in units of 2^-16, exact. The first and third imply 2 b0 + b1 > 0. */
static bool together(const filter_config_t *config)
{
    uint32_t memory = memory_uq32(config);
    int32_t b0 = config->value[SYNTH_PLUS_B0_UQ16];
    int32_t twice = 2 * b0 + config->value[SYNTH_PLUS_B1_Q16];
    int32_t at_minus_one = b0 - config->value[SYNTH_PLUS_B1_Q16] + config->value[SYNTH_PLUS_B2_Q16] +
                           4 * (ONE_Q16 - b0) + (int32_t)(memory >> 14);
    if (b0 + config->value[SYNTH_PLUS_B1_Q16] + config->value[SYNTH_PLUS_B2_Q16] <= 0 || twice <= 0 ||
        at_minus_one < 0 || (at_minus_one == 0 && (memory & 0x3FFFU) == 0U)) {
        return false;
    }
    /* m (2 b0 + b1) from 16-bit halves: the product has 50 bits; bits beyond 32 fraction bits make it larger */
    uint16_t low = (uint16_t)memory;
    uint16_t high = (uint16_t)(memory >> 16);
    uint16_t twice_low = (uint16_t)(uint32_t)twice;
    uint16_t twice_high = (uint16_t)((uint32_t)twice >> 16); /* <= 2 */
    uint32_t left = product_u16(high, twice_low);
    uint32_t right = product_u16(low, twice_high);
    uint32_t middle = (product_u16(low, twice_low) >> 16) + (left & 0xFFFFU) + (right & 0xFFFFU);
    uint32_t whole = (middle >> 16) + (left >> 16) + (right >> 16) + product_u16(high, twice_high);
    return b0 - config->value[SYNTH_PLUS_B2_Q16] > (int32_t)whole;
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_synth_t *s = &f->own.synth;
    s->b0_uq16 = (uint16_t)config->value[SYNTH_PLUS_B0_UQ16];
    s->of.plus.k = (uint8_t)config->value[SYNTH_PLUS_K];
    s->of.plus.rest_uq8 = (uint8_t)((0x100U >> s->of.plus.k) & 0xFEU); /* 0 for k = 0 and 8 */
    s->of.plus.b1_uq16 = (uint16_t)filter_fx_abs32(config->value[SYNTH_PLUS_B1_Q16]);
    s->of.plus.b1_negative = config->value[SYNTH_PLUS_B1_Q16] < 0;
    s->of.plus.b2_uq16 = (uint16_t)filter_fx_abs32(config->value[SYNTH_PLUS_B2_Q16]);
    s->of.plus.b2_negative = config->value[SYNTH_PLUS_B2_Q16] < 0;
    f->rate_max_lsb = 2U * (uint32_t)TRACKER_X_MAX_LSB_Q16; /* between two estimates: no limit */
    filter_set_noise(f, (uint32_t)config->value[SYNTH_PLUS_R_LSB2_Q8]);
}

/* The last innovation times a tap: by magnitudes, so that rounding is the same for both signs. */
static int32_t tapped(const filter_t *f, bool negative, uint16_t tap_uq16)
{
    int32_t tapped_q16 = (int32_t)filter_fx_mul_uq16(f->size_lsb_uq16, tap_uq16);
    return (f->negative != negative) ? -tapped_q16 : tapped_q16;
}

/* b2 u of the last sample, for the x_e after the next. */
static int32_t older_q16(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    return (s->of.plus.b2_uq16 == 0U) ? 0 : tapped(f, s->of.plus.b2_negative, s->of.plus.b2_uq16);
}

/*
 * What the next x_e adds to the straight line: b1 u, on top of the b2 u1 already stored, and rho (v - v'). Both are
 * limited on the way so that |memory| <= 18432 LSB, which the prediction allows: only steps over most of the range
 * reach that.
 */
static void remember(filter_t *f)
{
    filter_synth_t *s = &f->own.synth;
    int32_t memory_q16 = s->memory_lsb_q16 + tapped(f, s->of.plus.b1_negative, s->of.plus.b1_uq16);
    if (s->of.plus.k != 0U) {
        memory_q16 = fx_clamp_high(memory_q16, 54);
        memory_q16 += fx_without_part(f->rate_lsb - s->rate_before_lsb_q16, s->of.plus.rest_uq8);
        memory_q16 = fx_clamp_high(memory_q16, 72);
    }
    s->memory_lsb_q16 = memory_q16;
}

/*
 * A sample of the start, with the gain and the b1 of the line and no other memory. The last one uses the filter's own
 * gain and b1.
 */
static void start_step(filter_t *f, int16_t z_lsb)
{
    filter_synth_t *s = &f->own.synth;
    uint16_t b1_uq16 = s->of.plus.b1_uq16;
    bool negative = s->of.plus.b1_negative;
    f->gain_uq16 = filter_synth_next_gain_uq16(f);
    if (s->count > (uint8_t)LINE_END) {
        s->count = SYNTH_STEADY;
        f->gain_uq16 = s->b0_uq16;
    } else {
        uint8_t place = (uint8_t)(s->count - ((uint8_t)SYNTH_FIRST_GAIN + 1U)); /* count already includes this sample */
        b1_uq16 = flash_u16(&line_memory_uq16[place]);
        negative = true;
    }
    f->rate_lsb += s->memory_lsb_q16;
    filter_synth_step(f, z_lsb, STEP_SAMPLE);
    s->memory_lsb_q16 = tapped(f, negative, b1_uq16);
}

/* A missing sample counts as one with innovation 0; during the start it leaves no memory. */
static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_synth_t *s = &f->own.synth;
    int32_t memory_q16 = s->memory_lsb_q16;
    bool steady = s->count == SYNTH_STEADY;
    if (!steady) {
        if (what != STEP_MISSING) {
            start_step(f, z_lsb);
            return;
        }
    }
    s->memory_lsb_q16 = steady ? older_q16(f) : 0;
    if (what == STEP_MISSING) {
        filter_tracker_nothing(f);
    } else {
        f->gain_uq16 = s->b0_uq16;
    }
    s->rate_before_lsb_q16 = f->rate_lsb;
    f->rate_lsb += memory_q16;
    filter_synth_step(f, z_lsb, what);
    if (steady) {
        remember(f);
    }
}

static void fade(filter_t *f, bool first)
{
    if (!first) {
        filter_synth_damp(f);
        f->own.synth.memory_lsb_q16 >>= 1;
    }
}

/* v x factor / 2^16, |factor| <= 65535. */
static int32_t times(int32_t v, int32_t factor_q16)
{
    int32_t product = (int32_t)filter_fx_mul_uq16(filter_fx_abs32(v), (uint16_t)filter_fx_abs32(factor_q16));
    return ((v < 0) != (factor_q16 < 0)) ? -product : product;
}

/* Q7.25 from Q16. */
static int32_t q25(int32_t v_q16)
{
    return v_q16 * 512;
}

/*
 * Steady-state variance of the estimate's error per R, white noise, UQ16.16, saturated. Relative error below 2^-9 where
 * the poles are within 0.99.
 *
 * With m = (1 - b0) rho the stationary variance, solved from the closed loop, is N / ((b0 - b1 + b2 + 4 (1 - b0) + 4 m)
 * (b0 - b2 - m (2 b0 + b1))), the factors those of the stability test (the third cancels),
 *
 *   N = b0 (2 - b0 - 3 b1 - 8 b2 + b2 (6 b0 + 2 b1 - 2 b2)) + 2 (b1 + b2) + b2 (b2 - b1)
 *       - m (b0 (6 b2 - b1 - 2 b0) + b1 (b2 - b1) + 2 m (b0 + b1 + b2))
 *
 * In Q25: |N| < 46 for any coefficients of the format.
 */
uint32_t filter_synth_taps_noise_gain_uq16(const filter_config_t *config)
{
    int32_t b0 = config->value[SYNTH_PLUS_B0_UQ16];
    int32_t b1 = config->value[SYNTH_PLUS_B1_Q16];
    int32_t b2 = config->value[SYNTH_PLUS_B2_Q16];
    uint32_t memory = memory_uq32(config);
    int32_t m = (int32_t)(memory >> 16);
    int32_t n = q25(2 * ONE_Q16 - b0 - 3 * b1 - 8 * b2) + times(q25(6 * b0 + 2 * b1 - 2 * b2), b2);
    n = times(n, b0) + q25(2 * (b1 + b2)) + times(q25(b2 - b1), b2);
    int32_t by_m = times(q25(6 * b2 - b1 - 2 * b0), b0) + times(q25(b2 - b1), b1) + 2 * times(q25(b0 + b1 + b2), m);
    n -= times(by_m, m);
    int32_t left = q25(b0 - b1 + b2 + 4 * (ONE_Q16 - b0)) + (int32_t)(memory >> 7) * 4;
    int32_t right = q25(b0 - b2) - times(q25(2 * b0 + b1), m);
    fx_scaled_t above = filter_fx_scaled((n > 0) ? (uint32_t)n : 1U);
    fx_scaled_t below = filter_fx_scaled_mul(filter_fx_scaled((left > 0) ? (uint32_t)left : 1U),
                                             filter_fx_scaled((right > 0) ? (uint32_t)right : 1U));
    fx_scaled_t gain = filter_fx_scaled_div(above, below);
    gain.exponent = (int8_t)(gain.exponent + 25);
    return filter_fx_scaled_fixed(gain, 16);
}

/* Variance of one sample until the gains are steady, then R times the noise gain, limited to 32 bits. */
static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_synth_t *s = &f->own.synth;
    out->p_lsb2_q8 = s->r_lsb2_q8;
    if (f->collected == FILTER_RUNNING && s->count == SYNTH_STEADY) {
        filter_config_t config = { 0 };
        config.value[SYNTH_PLUS_B0_UQ16] = s->b0_uq16;
        config.value[SYNTH_PLUS_K] = s->of.plus.k;
        config.value[SYNTH_PLUS_B1_Q16] = s->of.plus.b1_negative ? -(int32_t)s->of.plus.b1_uq16
                                                                 : (int32_t)s->of.plus.b1_uq16;
        config.value[SYNTH_PLUS_B2_Q16] = s->of.plus.b2_negative ? -(int32_t)s->of.plus.b2_uq16
                                                                 : (int32_t)s->of.plus.b2_uq16;
        out->p_lsb2_q8 = filter_synth_variance_lsb2_q8(f, filter_synth_taps_noise_gain_uq16(&config));
    }
}

const filter_law_t filter_law_synth_plus IN_FLASH = { .parameter_count = 5,
                                                      .worst_cycles = 745,
                                                      .parameters = parameters,
                                                      .standard = standard,
                                                      .together = together,
                                                      .set_up = set_up,
                                                      .set_noise = filter_synth_take_noise,
                                                      .start = filter_synth_start,
                                                      .step = step,
                                                      .fade = fade,
                                                      .report = LAW_REPORT(report),
                                                      .name = "synth_plus" };
