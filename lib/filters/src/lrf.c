/* Linear robust filter: the core of two_state.h without a gate, made for R_L. */
#include "lrf.h"

#define CLEAN_MIN_UQ16 656U
#define CLEAN_MAX_UQ16 65535U
#define CLEAN_DEFAULT_UQ16 55706U
#define RATIO_MIN_UQ8 256U
#define RATIO_MAX_UQ8 8192U
#define RATIO_DEFAULT_UQ8 5120U

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(lrf_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(lrf_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3, TWO_STATE_Q_MAX_LSB2_S3 },
    { "clean", "", offsetof(lrf_config_t, clean_uq16), 2, 16, 0, 0, CLEAN_MIN_UQ16, CLEAN_MAX_UQ16 },
    { "ratio", "", offsetof(lrf_config_t, ratio_uq8), 2, 8, 0, 0, RATIO_MIN_UQ8, RATIO_MAX_UQ8 },
};

const filter_descriptor_t lrf_descriptor FX_FLASH = { "lrf", sizeof parameters / sizeof parameters[0], parameters };

void lrf_defaults(lrf_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->clean_uq16 = CLEAN_DEFAULT_UQ16;
    config->ratio_uq8 = RATIO_DEFAULT_UQ8;
}

/* N^2 - q1 (N^2 - 1), rounded to 2^-16. */
static uint32_t factor_uq16(uint16_t clean_uq16, uint16_t ratio_uq8)
{
    uint32_t square_uq16 = fx_mul_u16(ratio_uq8, ratio_uq8);
    return square_uq16 - fx_mul_uq16(square_uq16 - 65536U, clean_uq16);
}

void lrf_configure(lrf_t *f, const lrf_config_t *config)
{
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3, 0);
    f->factor_uq16 = factor_uq16(config->clean_uq16, config->ratio_uq8);
    lrf_set_noise(f, config->r_lsb2_q8);
}

bool lrf_init(lrf_t *f, const lrf_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) ||
        config->clean_uq16 < CLEAN_MIN_UQ16 || config->ratio_uq8 < RATIO_MIN_UQ8 || config->ratio_uq8 > RATIO_MAX_UQ8) {
        return false;
    }
    lrf_configure(f, config);
    return true;
}

void lrf_set_noise(lrf_t *f, uint32_t r_lsb2_q8)
{
    fx_scaled_t product = fx_scaled_mul(fx_scaled(filter_limited_r_lsb2_q8(r_lsb2_q8)), fx_scaled(f->factor_uq16));
    product.exponent = (int8_t)(product.exponent - 16);
    uint32_t r_mixed_lsb2_q8 = fx_scaled_fixed(product, 0);
    two_state_set_variance(&f->core, (r_mixed_lsb2_q8 > LRF_R_MAX_LSB2_Q8) ? LRF_R_MAX_LSB2_Q8 : r_mixed_lsb2_q8);
}

void lrf_reset(lrf_t *f, int16_t z0_lsb)
{
    (void)two_state_reset(&f->core, z0_lsb);
}

bool lrf_reset_step(lrf_t *f, int16_t z0_lsb, uint8_t step)
{
    return two_state_reset_step(&f->core, z0_lsb, step);
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; formats, bounds and rounding
 * errors as two_state_step, with P in units of R_L. R_L within 2^-13 of the formula. Cost: docs/benchmarks.md.
 */
int32_t lrf_update(lrf_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
    } else {
        (void)two_state_step(&f->core, z, true);
    }
    return f->core.x_lsb_q16;
}

int32_t lrf_coast(lrf_t *f)
{
    return two_state_coast(&f->core);
}

void lrf_damp(lrf_t *f)
{
    two_state_damp(&f->core);
}

/* Takes every sample as it is: nothing to be held back. */
void lrf_hold(lrf_t *f)
{
    (void)f;
}

void lrf_restart(lrf_t *f)
{
    two_state_restart(&f->core);
}

uint8_t lrf_flags(const lrf_t *f)
{
    return f->core.flags;
}

void lrf_probe(const lrf_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
}
