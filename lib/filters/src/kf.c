/* Two-state Kalman filter: the core of two_state.h without a gate. */
#include "kf.h"

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(kf_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(kf_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3, TWO_STATE_Q_MAX_LSB2_S3 },
};

const filter_descriptor_t kf_descriptor FX_FLASH = { "kf", sizeof parameters / sizeof parameters[0], parameters };

void kf_defaults(kf_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
}

void kf_configure(kf_t *f, const kf_config_t *config)
{
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3, 0);
}

bool kf_init(kf_t *f, const kf_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3)) {
        return false;
    }
    kf_configure(f, config);
    return true;
}

void kf_set_noise(kf_t *f, uint32_t r_lsb2_q8)
{
    two_state_set_noise(&f->core, r_lsb2_q8);
}

void kf_reset(kf_t *f, int16_t z0_lsb)
{
    (void)two_state_reset(&f->core, z0_lsb);
}

bool kf_reset_step(kf_t *f, int16_t z0_lsb, uint8_t step)
{
    return two_state_reset_step(&f->core, z0_lsb, step);
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; formats, bounds and rounding
 * errors as two_state_step. Cost: docs/benchmarks.md.
 */
int32_t kf_update(kf_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
    } else {
        (void)two_state_step(&f->core, z, true);
    }
    return f->core.x_lsb_q16;
}

int32_t kf_coast(kf_t *f)
{
    return two_state_coast(&f->core);
}

void kf_damp(kf_t *f)
{
    two_state_damp(&f->core);
}

/* Takes every sample as it is: nothing to be held back. */
void kf_hold(kf_t *f)
{
    (void)f;
}

void kf_restart(kf_t *f)
{
    two_state_restart(&f->core);
}

uint8_t kf_flags(const kf_t *f)
{
    return f->core.flags;
}

void kf_probe(const kf_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
}
