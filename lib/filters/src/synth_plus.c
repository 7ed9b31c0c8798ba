/* The synthesised filter with a memory of innovations: see synth_plus.h for the equations. */
#include "synth_plus.h"

#include "filter_common.h"
#include "fx.h"

#define ONE_Q16 65536
#define K_MAX 8U /* rho = 1 */

/* Of the defaults: kf's gains at the ends of its range of process noise, 6e-8 and 1 R per sample. */
#define ALPHA_MIN_UQ16 1442U
#define ALPHA_MAX_UQ16 50403U

static const filter_parameter_t synth_plus_parameters[] FX_FLASH = {
    { "k", "", offsetof(synth_plus_config_t, k), 2, 0, 0, 0, 0, K_MAX },
    { "b0", "", offsetof(synth_plus_config_t, b0_uq16), 2, 16, 0, 0, SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16 },
    { "b1", "", offsetof(synth_plus_config_t, b1_q16), 4, 16, 0, 1, -SYNTH_A1_MAX_Q16, SYNTH_A1_MAX_Q16 },
    { "b2", "", offsetof(synth_plus_config_t, b2_q16), 4, 16, 0, 1, -SYNTH_A1_MAX_Q16, SYNTH_A1_MAX_Q16 },
    { "r", "LSB2", offsetof(synth_plus_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
};

const filter_descriptor_t synth_plus_descriptor FX_FLASH = {
    "synth_plus", sizeof synth_plus_parameters / sizeof synth_plus_parameters[0], synth_plus_parameters
};

/*
 * - b1 of the alpha-beta form of a least-squares line through n samples, (4 n - 8) / (n (n + 1)), n = 6..31, UQ0.16.
 * With the gains of synth_next_gain_uq16 the start is that line. A slower filter goes on with its own from there: they
 * are at most 0.13 apart.
 */
enum { LINE_END = 31 };
static const uint16_t line_memory_uq16[(uint8_t)LINE_END - (uint8_t)SYNTH_FIRST_GAIN] FX_FLASH = {
    24966, 23406, 21845, 20389, 19065, 17873, 16804, 15844, 14980, 14199, 13493, 12850, 12264,
    11727, 11235, 10781, 10361, 9973,  9612,  9276,  8962,  8669,  8394,  8136,  7893,  7663,
};

/*
 * Gains of kf: alpha^4 / ((2 - alpha)^2 (1 - alpha)) = q T^3 / R = g^4, g = 24.03 Hz / rate. alpha = sqrt(2) g /
 * (1 + g / sqrt(2) + 0.13 g^2) is exact for small g; with the rate in 0.1 Hz, numerator and denominator times it:
 */
void synth_plus_defaults(synth_plus_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    uint16_t alpha_uq16 = (uint16_t)(22271000U / ((uint32_t)rate_dhz + 170U + (uint16_t)(7500U / rate_dhz)));
    if (alpha_uq16 < ALPHA_MIN_UQ16) {
        alpha_uq16 = ALPHA_MIN_UQ16;
    } else if (alpha_uq16 > ALPHA_MAX_UQ16) {
        alpha_uq16 = ALPHA_MAX_UQ16;
    }
    uint16_t beta_uq16 = (uint16_t)(fx_mul_u16(alpha_uq16, alpha_uq16) / (0x20000U - alpha_uq16));
    config->b0_uq16 = alpha_uq16;
    config->b1_q16 = (int32_t)beta_uq16 - (int32_t)alpha_uq16;
    config->k = 0;
    config->b2_q16 = 0;
}

/* A call of its own for the products that run rarely. */
FX_NOINLINE uint32_t product_u16(uint16_t a, uint16_t b)
{
    return fx_mul_u16(a, b);
}

/* m = (1 - b0) rho, UQ0.32, exact. */
static uint32_t plus_memory_uq32(const synth_plus_config_t *config)
{
    uint32_t c_uq32 = ((uint32_t)0x10000 - config->b0_uq16) << 16;
    return (config->k < K_MAX) ? c_uq32 - (c_uq32 >> config->k) : c_uq32;
}

/* The three conditions of synth_plus.h in units of 2^-16, exact. The first and third contain 2 b0 + b1 > 0. */
static bool plus_stable(const synth_plus_config_t *config)
{
    uint32_t memory = plus_memory_uq32(config);
    int32_t b0 = (int32_t)config->b0_uq16;
    int32_t twice = 2 * b0 + config->b1_q16;
    int32_t at_minus_one = b0 - config->b1_q16 + config->b2_q16 + 4 * (ONE_Q16 - b0) + (int32_t)(memory >> 14);
    if (b0 + config->b1_q16 + config->b2_q16 <= 0 || twice <= 0 || at_minus_one < 0 ||
        (at_minus_one == 0 && (memory & 0x3FFFU) == 0U)) {
        return false;
    }
    /* m (2 b0 + b1) by halves of 16 bits: the product has 50; what it has beyond 32 fraction bits makes it larger */
    uint16_t low = (uint16_t)memory;
    uint16_t high = (uint16_t)(memory >> 16);
    uint16_t twice_low = (uint16_t)(uint32_t)twice;
    uint16_t twice_high = (uint16_t)((uint32_t)twice >> 16); /* <= 2 */
    uint32_t left = product_u16(high, twice_low);
    uint32_t right = product_u16(low, twice_high);
    uint32_t middle = (product_u16(low, twice_low) >> 16) + (left & 0xFFFFU) + (right & 0xFFFFU);
    uint32_t whole = (middle >> 16) + (left >> 16) + (right >> 16) + product_u16(high, twice_high);
    return b0 - config->b2_q16 > (int32_t)whole;
}

static bool within(int32_t q16)
{
    return q16 >= -SYNTH_A1_MAX_Q16 && q16 <= SYNTH_A1_MAX_Q16;
}

void synth_plus_configure(synth_plus_t *f, const synth_plus_config_t *config)
{
    synth_begin(&f->core, sizeof *f);
    f->b0_uq16 = config->b0_uq16;
    f->k = (uint8_t)config->k;
    f->rest_uq8 = (uint8_t)((0x100U >> f->k) & 0xFEU); /* of k = 0 and 8 nothing */
    f->b1_uq16 = (uint16_t)fx_abs32(config->b1_q16);
    f->b1_negative = config->b1_q16 < 0;
    f->b2_uq16 = (uint16_t)fx_abs32(config->b2_q16);
    f->b2_negative = config->b2_q16 < 0;
    synth_spread_of_rate(&f->spread, config->rate_dhz);
    synth_plus_set_noise(f, config->r_lsb2_q8);
}

bool synth_plus_together(const synth_plus_config_t *config)
{
    return plus_stable(config);
}

FX_ONCE bool synth_plus_init(synth_plus_t *f, const synth_plus_config_t *config)
{
    if (!filter_common_legal(config->rate_dhz, config->r_lsb2_q8) || config->b0_uq16 < SYNTH_B0_MIN_UQ16 ||
        config->k > K_MAX || !within(config->b1_q16) || !within(config->b2_q16) || !plus_stable(config)) {
        return false;
    }
    synth_plus_configure(f, config);
    return true;
}

void synth_plus_set_noise(synth_plus_t *f, uint32_t r_lsb2_q8)
{
    synth_take_noise_and_spread(&f->core, &f->spread, r_lsb2_q8);
}

bool synth_plus_reset_step(synth_plus_t *f, int16_t z0_lsb, uint8_t step)
{
    (void)step;
    synth_plus_reset(f, z0_lsb);
    return false;
}

FX_ONCE void synth_plus_reset(synth_plus_t *f, int16_t z0_lsb)
{
    synth_at_rest(&f->core, z0_lsb);
    f->memory_lsb_q16 = 0;
}

/* The last innovation x a tap. */
FX_NOINLINE int32_t tapped(const int32_t *innovation, bool negative, uint16_t tap_uq16)
{
    if (negative) {
        return synth_scaled(fx_minus(0, innovation, 0), tap_uq16);
    }
    return synth_scaled(*innovation, tap_uq16);
}

/* b2 u of the last sample, for the x_e after the next. */
FX_INLINE int32_t older_q16(const synth_plus_t *f)
{
    return (f->b2_uq16 == 0U) ? 0 : tapped(&f->core.innovation_lsb_q16, f->b2_negative, f->b2_uq16);
}

/*
 * What the next x_e adds to the straight line: b1 u, besides the b2 u1 that is there, and rho (x1 - 2 x2 + x3). Both
 * limited on the way so that |memory| <= 18432 LSB, which the extrapolation takes: only steps over most of the range
 * come there. Returns the estimate.
 */
FX_NOINLINE int32_t remember(synth_plus_t *f)
{
    int32_t memory_q16 = fx_plus(tapped(&f->core.innovation_lsb_q16, f->b1_negative, f->b1_uq16), &f->memory_lsb_q16,
                                 0);
    if (f->k != 0U) {
        f->memory_lsb_q16 = fx_clamp_high(memory_q16, 54);
        memory_q16 = synth_bend(&f->core, false);
        FX_FENCE();
        memory_q16 = fx_without_part(memory_q16, f->rest_uq8);
        memory_q16 = fx_clamp_high(fx_plus(memory_q16, &f->memory_lsb_q16, 0), 72);
    }
    f->memory_lsb_q16 = memory_q16;
    return f->core.u.run.x_lsb_q16[0];
}

/*
 * A sample of the start, with the gain and the b1 of the line and no other memory. The one that ends it has the own
 * gain and b1.
 */
FX_NOINLINE int32_t start_step(synth_plus_t *f, int16_t z_lsb)
{
    uint16_t b1_uq16;
    bool negative;
    f->core.gain_uq16 = synth_next_gain_uq16(&f->core, f->b0_uq16);
    if (f->core.collected > (uint8_t)LINE_END) {
        f->core.collected = SYNTH_STEADY;
        f->core.gain_uq16 = f->b0_uq16;
        b1_uq16 = f->b1_uq16;
        negative = f->b1_negative;
    } else {
        uint8_t place = (uint8_t)(f->core.collected - ((uint8_t)SYNTH_FIRST_GAIN + 1U)); /* counted already */
        b1_uq16 = fx_flash_u16(&line_memory_uq16[place]);
        negative = true;
    }
    synth_extrapolate(&f->core, f->memory_lsb_q16);
    (void)synth_correct(&f->core, z_lsb);
    f->memory_lsb_q16 = tapped(&f->core.innovation_lsb_q16, negative, b1_uq16);
    return f->core.u.run.x_lsb_q16[0];
}

/* One sample on. */
FX_NOINLINE int32_t plus_step(synth_plus_t *f, int16_t z_lsb)
{
    f->core.flags = 0;
    if (f->core.collected != SYNTH_STEADY) {
        return start_step(f, z_lsb);
    }
    f->core.gain_uq16 = f->b0_uq16;
    synth_extrapolate(&f->core, f->memory_lsb_q16);
    f->memory_lsb_q16 = older_q16(f);
    (void)synth_correct(&f->core, z_lsb);
    return remember(f);
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x        Q15.16; |x_e| <= 4608 LSB by clamps; the update moves x_e towards a sample within 4096, so |x| <= 4608 and
 *            the bound is inductive; |z - x_e| <= 8704 LSB < 2^30 / 2^16
 *   memory   Q15.16, b1 u1 + b2 u2 - a1 (x1 - 2 x2 + x3): |b1 u1 + b2 u2| <= 17410 LSB; with a curvature, below 18432
 *            LSB, the two are limited to 13824 and the sum to 18432: with 2 x1 - x2 each sum is below 2^31 in Q16
 *   b0..b2   UQ0.16 magnitudes, within 2^-17 of the wanted ones; rho exact
 *   products b0, b1, b2: three of 32 x 16 bits, and of b2 that is 0 none; rho is a shift that rounds (fx_without_part)
 *   rounding products half away from zero to 2^-16 LSB, the shift half up; with n half counts in x_e (one for each of
 *            b1, b2 and the shift) and the one of b0 the error is below
 *            2^-17 (sum |g0| + n sum |g1|), g0, g1 the impulse responses of (B + (1 - b0)) / D and (1 - b0) / D
 *   cost     docs/benchmarks.md
 */
int32_t synth_plus_update(synth_plus_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (f->core.collected >= FILTER_WARM_UP_SAMPLES) {
        return plus_step(f, z);
    }
    return synth_warm_up(&f->core, z, &f->spread);
}

/* A missing sample is one with the innovation 0. */
int32_t synth_plus_coast(synth_plus_t *f)
{
    bool steady = f->core.collected == SYNTH_STEADY;
    int32_t memory_q16 = f->memory_lsb_q16;
    f->memory_lsb_q16 = steady ? older_q16(f) : 0;
    if (!synth_coasts(&f->core)) {
        return synth_estimate(&f->core);
    }
    synth_extrapolate(&f->core, memory_q16);
    return steady ? remember(f) : f->core.u.run.x_lsb_q16[0];
}

void synth_plus_damp(synth_plus_t *f)
{
    synth_core_damp(&f->core);
    f->memory_lsb_q16 >>= 1;
}

/* Takes every sample as it is: nothing to be held back. */
void synth_plus_hold(synth_plus_t *f)
{
    (void)f;
}

void synth_plus_restart(synth_plus_t *f)
{
    synth_core_restart(&f->core);
    f->memory_lsb_q16 = 0;
}

uint8_t synth_plus_flags(const synth_plus_t *f)
{
    return f->core.flags;
}

/* v x factor / 2^16, |factor| <= 65535. */
FX_NOINLINE int32_t times(int32_t v, int32_t factor_q16)
{
    return synth_scaled((factor_q16 < 0) ? -v : v, (uint16_t)fx_abs32(factor_q16));
}

/* Q7.25 from Q16. */
static int32_t q25(int32_t v_q16)
{
    return v_q16 * 512;
}

/*
 * With m = (1 - b0) rho the stationary variance, solved from the closed loop, is N / ((b0 - b1 + b2 + 4 (1 - b0) + 4 m)
 * (b0 - b2 - m (2 b0 + b1))), the factors those of the stability test (the third cancels),
 *
 *   N = b0 (2 - b0 - 3 b1 - 8 b2 + b2 (6 b0 + 2 b1 - 2 b2)) + 2 (b1 + b2) + b2 (b2 - b1)
 *       - m (b0 (6 b2 - b1 - 2 b0) + b1 (b2 - b1) + 2 m (b0 + b1 + b2))
 *
 * In Q25: |N| < 46 for any coefficients of the format.
 */
uint32_t synth_plus_noise_gain_uq16(const synth_plus_config_t *config)
{
    int32_t b0 = (int32_t)config->b0_uq16;
    int32_t b1 = config->b1_q16;
    int32_t b2 = config->b2_q16;
    uint32_t memory = plus_memory_uq32(config);
    int32_t m = (int32_t)(memory >> 16);
    int32_t n = q25(2 * ONE_Q16 - b0 - 3 * b1 - 8 * b2) + times(q25(6 * b0 + 2 * b1 - 2 * b2), b2);
    n = times(n, b0) + q25(2 * (b1 + b2)) + times(q25(b2 - b1), b2);
    int32_t by_m = times(q25(6 * b2 - b1 - 2 * b0), b0) + times(q25(b2 - b1), b1) + 2 * times(q25(b0 + b1 + b2), m);
    n -= times(by_m, m);
    int32_t left = q25(b0 - b1 + b2 + 4 * (ONE_Q16 - b0)) + (int32_t)(memory >> 7) * 4;
    int32_t right = q25(b0 - b2) - times(q25(2 * b0 + b1), m);
    fx_scaled_t above = fx_scaled((n > 0) ? (uint32_t)n : 1U);
    fx_scaled_t below = fx_scaled_mul(fx_scaled((left > 0) ? (uint32_t)left : 1U),
                                      fx_scaled((right > 0) ? (uint32_t)right : 1U));
    fx_scaled_t gain = fx_scaled_div(above, below);
    gain.exponent = (int8_t)(gain.exponent + 25);
    return fx_scaled_fixed(gain, 16);
}

/* The variance is that of one sample until the gains are steady, then R times the noise gain, limited to 32 bits. */
void synth_plus_probe(const synth_plus_t *f, filter_probe_t *out)
{
    synth_probe_core(&f->core, out);
    if (f->core.collected == SYNTH_STEADY) {
        synth_plus_config_t config = { 0 };
        config.b0_uq16 = f->b0_uq16;
        config.k = f->k;
        config.b1_q16 = f->b1_negative ? -(int32_t)f->b1_uq16 : (int32_t)f->b1_uq16;
        config.b2_q16 = f->b2_negative ? -(int32_t)f->b2_uq16 : (int32_t)f->b2_uq16;
        out->p_lsb2_q8 = synth_variance_lsb2_q8(&f->core, synth_plus_noise_gain_uq16(&config));
    }
}
