/* Binary gate as published, without re-acquisition: see sprf_paper.h for what that means. */
#include "sprf_paper.h"

#define GATE_MIN_SIGMA_Q8 256U
#define GATE_MAX_SIGMA_Q8 4096U
#define GATE_PUBLISHED_SIGMA_Q8 512U

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(sprf_paper_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(sprf_paper_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3,
      TWO_STATE_Q_MAX_LSB2_S3 },
    { "gate", "sigma", offsetof(sprf_paper_config_t, gate_sigma_q8), 2, 8, 0, 0, GATE_MIN_SIGMA_Q8, GATE_MAX_SIGMA_Q8 },
};

const filter_descriptor_t sprf_paper_descriptor FX_FLASH = { "sprf_paper", sizeof parameters / sizeof parameters[0],
                                                             parameters };

void sprf_paper_defaults(sprf_paper_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->gate_sigma_q8 = GATE_PUBLISHED_SIGMA_Q8;
}

void sprf_paper_configure(sprf_paper_t *f, const sprf_paper_config_t *config)
{
    uint16_t gate = config->gate_sigma_q8;
    two_state_wide_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3);
    /* below the saturated distance: 16 sigma are 15.9998 */
    uint32_t gate2_uq8 = fx_mul_u16(gate, gate) >> 8;
    f->gate2_uq8 = (gate2_uq8 >= UINT16_MAX) ? UINT16_MAX - 1U : (uint16_t)gate2_uq8;
}

bool sprf_paper_init(sprf_paper_t *f, const sprf_paper_config_t *config)
{
    uint16_t gate = config->gate_sigma_q8;
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) || gate < GATE_MIN_SIGMA_Q8 ||
        gate > GATE_MAX_SIGMA_Q8) {
        return false;
    }
    sprf_paper_configure(f, config);
    return true;
}

void sprf_paper_set_noise(sprf_paper_t *f, uint32_t r_lsb2_q8)
{
    two_state_wide_set_noise(&f->core, r_lsb2_q8);
}

void sprf_paper_reset(sprf_paper_t *f, int16_t z0_lsb)
{
    two_state_wide_reset(&f->core, z0_lsb);
}

bool sprf_paper_reset_step(sprf_paper_t *f, int16_t z0_lsb, uint8_t step)
{
    return two_state_wide_reset_step(&f->core, z0_lsb, step);
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; r^2 / (R S) against the squared
 * gate in UQ8.8; the rest as in two_state_wide.h. Cost: docs/benchmarks.md.
 */
int32_t sprf_paper_update(sprf_paper_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_wide_warming_up(&f->core)) {
        two_state_wide_start(&f->core, (int32_t)z * 65536);
        f->core.flags = FILTER_WARMING_UP;
        return f->core.x_lsb_q16;
    }
    bool grows = two_state_wide_predict(&f->core, z);
    if (two_state_wide_distance_uq8(&f->core) <= f->gate2_uq8) {
        two_state_wide_update(&f->core, 0, 0);
    } else {
        two_state_wide_refuse(&f->core, grows);
    }
    return f->core.x_lsb_q16;
}

int32_t sprf_paper_coast(sprf_paper_t *f)
{
    return two_state_wide_coast(&f->core);
}

void sprf_paper_damp(sprf_paper_t *f)
{
    two_state_wide_damp(&f->core);
}

void sprf_paper_hold(sprf_paper_t *f)
{
    two_state_wide_hold(&f->core);
}

void sprf_paper_restart(sprf_paper_t *f)
{
    two_state_wide_restart(&f->core);
}

uint8_t sprf_paper_flags(const sprf_paper_t *f)
{
    return f->core.flags;
}

void sprf_paper_probe(const sprf_paper_t *f, filter_probe_t *out)
{
    two_state_wide_probe(&f->core, f->gate2_uq8, out);
}
