/*
 * The Kalman filter whose innovation variance is raised to r^2 / softgate^2, with the re-acquisition rule of sprf, in
 * float.
 */
#include "float_gated.h"

/* bench: worst 1715 cycles; float / ours 4.0; rms 0.3 LSB */

struct float_soft {
    float_gated_t gated;
    float soft; /* sigmas (0: none) */
};

float_soft_t float_soft;

/* From R = 16 LSB^2 on such a soft gate takes the coarse format. */
void lengthen_soft(filter_config_t *config)
{
    config->value[SOFT_SOFT_SIGMA_Q8] = 4096;
}

void float_soft_start(float_soft_t *f, const filter_config_t *config, float x0_lsb)
{
    float_gated_t *g = &f->gated;
    g->gate = (float)config->value[SOFT_GATE_SIGMA_Q8] / 256.0f;
    g->rate_max = (float)config->value[SOFT_RATE_MAX_LSB_S];
    g->reacquire = (uint8_t)config->value[SOFT_REACQUIRE_SAMPLES];
    f->soft = (float)config->value[SOFT_SOFT_SIGMA_Q8] / 256.0f;
    float r = (float)config->value[SOFT_R_LSB2_Q8] / 256.0f;
    gated_start(g, config, (float)config->value[SOFT_Q_LSB2_S3], r, x0_lsb);
}

void float_soft_set_noise(float_soft_t *f, float r_lsb2)
{
    gated_set_noise(&f->gated, r_lsb2);
}

float float_soft_coast(float_soft_t *f)
{
    return gated_coast(&f->gated);
}

float float_soft_update(float_soft_t *f, int16_t z_lsb)
{
    float_gated_t *g = &f->gated;
    float z = (float)z_lsb;
    tracker_predict(&g->tracker);
    float s = g->tracker.p00 + g->tracker.r;
    float innovation = z - g->tracker.x;
    float s_eff = s;
    if (f->soft > 0.0f && innovation * innovation > f->soft * f->soft * s) {
        s_eff = innovation * innovation / (f->soft * f->soft);
    }
    gated_correct(g, innovation, s_eff);
    if (s_eff > s && gated_outside(g, innovation, s)) {
        gated_refuse(g, z);
    } else {
        g->run = 0;
    }
    g->previous = z;
    return g->tracker.x;
}
