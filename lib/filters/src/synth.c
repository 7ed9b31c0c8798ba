/* The synthesised filter: see synth.h for the equations. */
#include "synth.h"

#include "filter_common.h"
#include "fx.h"

static const filter_parameter_t parameters[] FX_FLASH = {
    { "a1", "", offsetof(synth_config_t, a1_q16), 4, 16, 0, 1, -SYNTH_A1_MAX_Q16, SYNTH_A1_MAX_Q16 },
    { "b0", "", offsetof(synth_config_t, b0_uq16), 2, 16, 0, 0, SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16 },
    { "r", "LSB2", offsetof(synth_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
};

const filter_descriptor_t synth_descriptor FX_FLASH = { "synth", sizeof parameters / sizeof parameters[0], parameters };

void synth_defaults(synth_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->b0_uq16 = 19661; /* 0.3 */
    config->a1_q16 = 0;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
}

void synth_paper(synth_config_t *config, uint16_t rate_dhz)
{
    synth_defaults(config, rate_dhz);
    config->b0_uq16 = 6554;  /* 0.1 */
    config->a1_q16 = -19661; /* -0.3 */
}

/* |a1| (1 - b0), UQ0.32, exact. */
static uint32_t memory_uq32(uint16_t b0_uq16, uint16_t a1_uq16)
{
    return fx_mul_u16(a1_uq16, (uint16_t)(0U - b0_uq16));
}

/* (4 - 3 b0) / 4, UQ0.32, exact. */
static uint32_t margin_uq32(uint16_t b0_uq16)
{
    return (0x40000U - 3U * (uint32_t)b0_uq16) << 14;
}

static uint16_t magnitude(int32_t a1_q16)
{
    return (uint16_t)fx_abs32(a1_q16);
}

/*
 * 1 + 2 a1 (1 - b0) > 0 in exact integers. The region's other border lies outside the ranges of the parameters: with a1
 * < 1 and 0 < b0 < 1, 4 - 3 b0 - 4 a1 (1 - b0) > 4 - 3 b0 - 4 (1 - b0) = b0 > 0.
 */
static bool stable(uint16_t b0_uq16, int32_t a1_q16)
{
    return a1_q16 >= 0 || memory_uq32(b0_uq16, magnitude(a1_q16)) < 0x80000000U;
}

/*
 * (2 - b0 - 2 ac (b0 + ac)) / ((1 + 2 ac) (4 - 3 b0 - 4 ac)), ac = a1 (1 - b0): the stationary variance solved from the
 * closed loop. The factors that vanish on the border of the region are formed exactly.
 */
uint32_t synth_noise_gain_uq16(uint16_t b0_uq16, int32_t a1_q16)
{
    uint32_t memory = memory_uq32(b0_uq16, magnitude(a1_q16)) >> 1; /* |ac|, UQ1.31 */
    uint32_t margin = margin_uq32(b0_uq16) >> 1;
    uint16_t ac_uq16 = (uint16_t)(memory >> 15);
    int32_t ac_q16 = (a1_q16 < 0) ? -(int32_t)ac_uq16 : (int32_t)ac_uq16;
    int32_t sum_q16 = (int32_t)b0_uq16 + ac_q16;
    int32_t product_q16 = (int32_t)fx_mul_uq16(fx_abs32(sum_q16), ac_uq16);
    bool negative = (sum_q16 < 0) != (ac_q16 < 0);
    int32_t above_q16 = 0x20000 - (int32_t)b0_uq16 - (negative ? -2 * product_q16 : 2 * product_q16);
    uint32_t left = (a1_q16 < 0) ? 0x40000000U - memory : 0x40000000U + memory; /* (1 + 2 ac) / 2, UQ1.31 */
    uint32_t right = (a1_q16 < 0) ? margin + memory : margin - memory;          /* (4 - 3 b0 - 4 ac) / 4 */
    fx_scaled_t above = fx_scaled((above_q16 > 0) ? (uint32_t)above_q16 : 1U);
    above.exponent = (int8_t)(above.exponent - 16 - 3);
    fx_scaled_t below = fx_scaled_mul(fx_scaled(left), fx_scaled(right));
    below.exponent = (int8_t)(below.exponent - 62);
    return fx_scaled_fixed(fx_scaled_div(above, below), 16);
}

void synth_configure(synth_t *f, const synth_config_t *config)
{
    synth_begin(&f->core, sizeof *f);
    f->a1_uq16 = magnitude(config->a1_q16);
    f->a1_negative = config->a1_q16 < 0;
    f->b0_uq16 = config->b0_uq16;
    synth_spread_of_rate(&f->spread, config->rate_dhz);
    synth_set_noise(f, config->r_lsb2_q8);
}

bool synth_together(const synth_config_t *config)
{
    return stable(config->b0_uq16, config->a1_q16);
}

FX_ONCE bool synth_init(synth_t *f, const synth_config_t *config)
{
    bool legal = filter_common_legal(config->rate_dhz, config->r_lsb2_q8) && config->b0_uq16 >= SYNTH_B0_MIN_UQ16 &&
                 config->a1_q16 >= -SYNTH_A1_MAX_Q16 && config->a1_q16 <= SYNTH_A1_MAX_Q16;
    if (!legal || !synth_together(config)) {
        return false;
    }
    synth_configure(f, config);
    return true;
}

void synth_set_noise(synth_t *f, uint32_t r_lsb2_q8)
{
    synth_take_noise_and_spread(&f->core, &f->spread, r_lsb2_q8);
}

bool synth_reset_step(synth_t *f, int16_t z0_lsb, uint8_t step)
{
    (void)step;
    synth_reset(f, z0_lsb);
    return false;
}

FX_ONCE void synth_reset(synth_t *f, int16_t z0_lsb)
{
    synth_at_rest(&f->core, z0_lsb);
}

/* - a1 (x1 - 2 x2 + x3); 0 while the start's gains are in force: the straight line alone. */
FX_NOINLINE int32_t curvature(const synth_t *f)
{
    if (f->core.collected != SYNTH_STEADY || f->a1_uq16 == 0U) {
        return 0;
    }
    return synth_scaled(synth_bend(&f->core, !f->a1_negative), f->a1_uq16);
}

/* One sample on. */
FX_NOINLINE int32_t step(synth_t *f, int16_t z_lsb)
{
    f->core.flags = 0;
    f->core.gain_uq16 = f->b0_uq16;
    if (f->core.collected != SYNTH_STEADY) {
        f->core.gain_uq16 = synth_next_gain_uq16(&f->core, f->b0_uq16);
    }
    synth_extrapolate(&f->core, curvature(f));
    return synth_correct(&f->core, z_lsb);
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x        Q15.16; |x_e| <= 4608 LSB by a clamp; the update moves x_e towards a sample within 4096, so |x| <= 4608
 *            and the bound is inductive; |z - x_e| <= 8704 LSB < 2^30 / 2^16
 *   a1, b0   UQ0.16 magnitudes, within 2^-17 of the wanted ones
 *   rounding each product half away from zero to 2^-16 LSB; both together reach the output with the noise gain over
 *            b0^2 of the filter: 0.0002 LSB rms at (-0.3, 0.1). The bound that the tests hold against the double
 *            reference is (1 + |1 - b0|) 2^-17 times the sum of the error's impulse response
 *   cost     docs/benchmarks.md
 */
int32_t synth_update(synth_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (f->core.collected >= FILTER_WARM_UP_SAMPLES) {
        return step(f, z);
    }
    return synth_warm_up(&f->core, z, &f->spread);
}

int32_t synth_coast(synth_t *f)
{
    if (synth_coasts(&f->core)) {
        synth_extrapolate(&f->core, curvature(f));
        return f->core.u.run.x_lsb_q16[0];
    }
    return synth_estimate(&f->core);
}

void synth_damp(synth_t *f)
{
    synth_core_damp(&f->core);
}

void synth_gap(synth_t *f)
{
    synth_core_gap(&f->core);
}

/* Takes every sample as it is: nothing to be held back. */
void synth_hold(synth_t *f)
{
    (void)f;
}

void synth_restart(synth_t *f)
{
    synth_core_restart(&f->core);
}

uint8_t synth_flags(const synth_t *f)
{
    return f->core.flags;
}

/* The variance is that of one sample until the gain is steady, then R times the noise gain, limited to 32 bits. */
void synth_probe(const synth_t *f, filter_probe_t *out)
{
    synth_probe_core(&f->core, out);
    if (f->core.collected == SYNTH_STEADY) {
        int32_t a1_q16 = f->a1_negative ? -(int32_t)f->a1_uq16 : f->a1_uq16;
        out->p_lsb2_q8 = synth_variance_lsb2_q8(&f->core, synth_noise_gain_uq16(f->b0_uq16, a1_q16));
    }
}
