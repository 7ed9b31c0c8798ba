/*
 * Binary-gated Kalman filter with consistency re-acquisition: gate and re-acquisition around the core of two_state.h.
 */
#include "sprf.h"

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(sprf_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(sprf_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3,
      TWO_STATE_Q_MAX_LSB2_S3 },
    { "gate", "sigma", offsetof(sprf_config_t, gate_sigma_q8), 2, 8, 1, 0, TWO_STATE_GATE_MIN_SIGMA_Q8,
      TWO_STATE_GATE_MAX_SIGMA_Q8 },
    { "reacquire", "samples", offsetof(sprf_config_t, reacquire_samples), 2, 0, 1, 0, REACQUIRE_SAMPLES_MIN,
      REACQUIRE_SAMPLES_MAX },
    { "ratemax", "LSB/s", offsetof(sprf_config_t, rate_max_lsb_s), 4, 0, 0, 0, REACQUIRE_RATE_MAX_MIN_LSB_S,
      REACQUIRE_RATE_MAX_MAX_LSB_S },
};

const filter_descriptor_t sprf_descriptor FX_FLASH = { "sprf", sizeof parameters / sizeof parameters[0], parameters };

void sprf_defaults(sprf_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->gate_sigma_q8 = TWO_STATE_GATE_DEFAULT_SIGMA_Q8;
    config->reacquire_samples = REACQUIRE_SAMPLES_DEFAULT;
    config->rate_max_lsb_s = REACQUIRE_RATE_MAX_DEFAULT_LSB_S;
}

void sprf_configure(sprf_t *f, const sprf_config_t *config)
{
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3, config->rate_max_lsb_s);
    reacquire_init(&f->again, config->reacquire_samples);
    f->gate_sigma_q8 = config->gate_sigma_q8;
    f->refused = 0;
    sprf_set_noise(f, config->r_lsb2_q8);
}

bool sprf_together(const sprf_config_t *config)
{
    return reacquire_steps_legal(config->reacquire_samples);
}

bool sprf_init(sprf_t *f, const sprf_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) ||
        !two_state_gate_legal(config->gate_sigma_q8) ||
        !reacquire_legal(config->reacquire_samples, config->rate_max_lsb_s)) {
        return false;
    }
    sprf_configure(f, config);
    return true;
}

void sprf_set_noise(sprf_t *f, uint32_t r_lsb2_q8)
{
    two_state_set_noise(&f->core, r_lsb2_q8);
    two_state_set_gate(&f->core, f->gate_sigma_q8);
    reacquire_set_noise(&f->again, &f->core);
}

void sprf_reset(sprf_t *f, int16_t z0_lsb)
{
    reacquire_reset(&f->again, two_state_reset(&f->core, z0_lsb));
}

bool sprf_reset_step(sprf_t *f, int16_t z0_lsb, uint8_t step)
{
    reacquire_reset(&f->again, filter_limited_z(z0_lsb));
    return two_state_reset_step(&f->core, z0_lsb, step);
}

/*
 * The rate stands for a motion of which nothing was seen since the last accepted sample. Where nothing agrees for long,
 * as on a frame that shakes, the filter would run on by it. Without re-acquisition it does, as published.
 */
FX_INLINE void forget_rate(sprf_t *f)
{
    if (f->again.run == 0U) { /* the first since one was accepted */
        f->refused = 0;
    }
    if (f->refused < SPRF_RATE_HELD_SAMPLES) {
        f->refused++;
    } else if (f->again.steps != 0U) {
        f->core.rate_lsb_q16 = 0;
    }
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; formats, bounds and rounding
 * errors as two_state_step; the restart's slope is exact (power-of-two steps). Cost: docs/benchmarks.md.
 */
int32_t sprf_update(sprf_t *f, int16_t z_lsb)
{
    int16_t z = filter_limited_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
    } else if (two_state_step(&f->core, z, true)) {
        f->again.run = 0;
    } else {
        forget_rate(f);
        (void)reacquire_refused(&f->again, &f->core, z);
    }
    f->again.previous_lsb = z;
    return f->core.x_lsb_q16;
}

int32_t sprf_coast(sprf_t *f)
{
    f->again.broken = true;
    return two_state_coast(&f->core);
}

void sprf_damp(sprf_t *f)
{
    two_state_damp(&f->core);
}

void sprf_hold(sprf_t *f)
{
    reacquire_hold(&f->again);
}

void sprf_restart(sprf_t *f)
{
    two_state_restart(&f->core);
    f->again.run = 0;
}

uint8_t sprf_flags(const sprf_t *f)
{
    return f->core.flags;
}

void sprf_probe(const sprf_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
}
