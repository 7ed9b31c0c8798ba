/*
 * Binary-gated Kalman filter with consistency re-acquisition: gate and re-acquisition around the core of two_state.h.
 */
#include "sprf.h"

#define GATE_MIN_SIGMA_Q8 256U
#define GATE_MAX_SIGMA_Q8 4096U
#define GATE_DEFAULT_SIGMA_Q8 768U
#define REACQUIRE_DEFAULT 5U
#define REACQUIRE_MIN 3U
#define REACQUIRE_MAX 9U
#define RATE_MAX_MIN_LSB_S 10U
#define RATE_MAX_MAX_LSB_S 1000000U
#define RATE_MAX_DEFAULT_LSB_S 800U

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(sprf_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(sprf_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3,
      TWO_STATE_Q_MAX_LSB2_S3 },
    { "gate", "sigma", offsetof(sprf_config_t, gate_sigma_q8), 2, 8, 1, 0, GATE_MIN_SIGMA_Q8, GATE_MAX_SIGMA_Q8 },
    { "reacquire", "samples", offsetof(sprf_config_t, reacquire_samples), 2, 0, 1, 0, REACQUIRE_MIN, REACQUIRE_MAX },
    { "ratemax", "LSB/s", offsetof(sprf_config_t, rate_max_lsb_s), 4, 0, 0, 0, RATE_MAX_MIN_LSB_S, RATE_MAX_MAX_LSB_S },
};

const filter_descriptor_t sprf_descriptor FX_FLASH = { "sprf", sizeof parameters / sizeof parameters[0], parameters };

void sprf_defaults(sprf_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->gate_sigma_q8 = GATE_DEFAULT_SIGMA_Q8;
    config->reacquire_samples = REACQUIRE_DEFAULT;
    config->rate_max_lsb_s = RATE_MAX_DEFAULT_LSB_S;
}

static bool gate_legal(const sprf_config_t *config)
{
    bool gate = config->gate_sigma_q8 == 0U ||
                (config->gate_sigma_q8 >= GATE_MIN_SIGMA_Q8 && config->gate_sigma_q8 <= GATE_MAX_SIGMA_Q8);
    bool reacquire = config->reacquire_samples == 0U || config->reacquire_samples == 3U ||
                     config->reacquire_samples == 5U || config->reacquire_samples == 9U;
    return gate && reacquire && config->rate_max_lsb_s >= RATE_MAX_MIN_LSB_S &&
           config->rate_max_lsb_s <= RATE_MAX_MAX_LSB_S;
}

bool sprf_init(sprf_t *f, const sprf_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) || !gate_legal(config)) {
        return false;
    }
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3, config->rate_max_lsb_s);
    f->gate_sigma_q8 = config->gate_sigma_q8;
    f->slope_shift = 0;
    for (uint16_t steps = config->reacquire_samples; steps > 1U; steps >>= 1) {
        f->slope_shift++;
    }
    f->first_lsb = 0;
    f->previous_lsb = 0;
    f->run = 0;
    f->broken = false;
    sprf_set_noise(f, config->r_lsb2_q8);
    return true;
}

void sprf_set_noise(sprf_t *f, uint32_t r_lsb2_q8)
{
    two_state_set_noise(&f->core, r_lsb2_q8);
    two_state_set_gate(&f->core, f->gate_sigma_q8);
    uint32_t spread_q4 = fx_isqrt32(18U * f->core.r_lsb2_q8); /* 3 sqrt(2 R) */
    uint32_t motion_q4 = f->core.rate_max_lsb_q16 >> 12;
    uint32_t agree_lsb = (spread_q4 + motion_q4) >> 4;
    f->agree_lsb = (uint16_t)agree_lsb; /* < 135 + 4609 */
}

void sprf_reset(sprf_t *f, int16_t z0_lsb)
{
    int16_t z0 = filter_clamp_z(z0_lsb);
    f->core.flags = 0;
    two_state_start(&f->core, (int32_t)z0 * 65536);
    two_state_settle(&f->core);
    f->previous_lsb = z0;
    f->run = 0;
    f->broken = false;
}

/* Position and rate from the ends of a run of L samples: variances R, R / (L-1), 2 R / (L-1)^2. */
FX_NOINLINE void restart(sprf_t *f, int16_t z_lsb)
{
    two_state_t *s = &f->core;
    two_state_start(s, (int32_t)z_lsb * 65536);
    if (!f->broken) {
        int32_t slope = (int32_t)(z_lsb - f->first_lsb) * 65536;
        uint32_t p12 = 0x10000000U;
        uint32_t p22 = 0x20000000U;
        for (uint8_t i = f->slope_shift; i != 0U; i--) {
            slope >>= 1; /* exact: the factor 65536 holds 16 halvings */
            p12 >>= 1;
            p22 >>= 2;
        }
        s->rate_lsb_q16 = fx_clamp(slope, (int32_t)s->rate_max_lsb_q16);
        s->u.p.p12_uq28 = p12;
        s->u.p.p22_uq28 = p22 + s->q22_uq28;
    }
    s->flags = FILTER_REACQUIRED;
    f->run = 0;
}

/* A refused sample: counted when it agrees with the one before, else the first of a new run. */
FX_NOINLINE void refuse(sprf_t *f, int16_t z_lsb)
{
    int16_t step = (int16_t)(z_lsb - f->previous_lsb);
    uint16_t distance = (uint16_t)((step < 0) ? -step : step);
    if (f->run != 0U && distance <= f->agree_lsb) {
        f->run++;
    } else {
        f->run = 1;
        f->first_lsb = z_lsb;
        f->broken = false;
    }
    if (f->slope_shift == 0U) {
        f->run = 1;
    } else if (f->run > (uint8_t)(1U << f->slope_shift)) {
        restart(f, z_lsb);
    }
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; formats, bounds and rounding
 * errors as two_state_step; the restart's slope is exact (power-of-two steps). Cost: docs/benchmarks.md.
 */
int32_t sprf_update(sprf_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
    } else if (two_state_step(&f->core, z, true)) {
        f->run = 0;
    } else {
        refuse(f, z);
    }
    f->previous_lsb = z;
    return f->core.x_lsb_q16;
}

int32_t sprf_coast(sprf_t *f)
{
    f->broken = true;
    return two_state_coast(&f->core);
}

uint8_t sprf_flags(const sprf_t *f)
{
    return f->core.flags;
}

void sprf_probe(const sprf_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
}
