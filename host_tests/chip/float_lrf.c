/* The Kalman filter with the mean variance of normal and outlying samples, in float. */
#include "float_filters.h"

/* bench: worst 1080 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_lrf {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r, factor; /* r: R_L, factor times that of a normal sample */
};

float_lrf_t float_lrf;

NOTHING_LONGER(lrf)

void float_lrf_start(float_lrf_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[LRF_Q_LSB2_S3];
    float ratio = (float)config->value[LRF_RATIO_UQ8] / 256.0f;
    float square = ratio * ratio;
    f->factor = (float)config->value[LRF_CLEAN_UQ16] / 65536.0f * (1.0f - square) + square;
    f->r = f->factor * (float)config->value[LRF_R_LSB2_Q8] / 256.0f;
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p10 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
}

void float_lrf_set_noise(float_lrf_t *f, float r_lsb2)
{
    f->r = f->factor * r_lsb2;
}

float float_lrf_coast(float_lrf_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (f->p01 + f->p10 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p10 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
    return f->x;
}

float float_lrf_update(float_lrf_t *f, int16_t z_lsb)
{
    (void)float_lrf_coast(f);
    float s = f->p00 + f->r;
    float k0 = f->p00 / s;
    float k1 = f->p10 / s;
    float innovation = (float)z_lsb - f->x;
    f->x += k0 * innovation;
    f->v += k1 * innovation;
    float p00 = f->p00;
    float p01 = f->p01;
    f->p00 -= k0 * p00;
    f->p01 -= k0 * p01;
    f->p10 -= k1 * p00;
    f->p11 -= k1 * p01;
    return f->x;
}
