/* The Kalman filter with Huber's weight on its innovation, in float. */
#include "float_filters.h"

#include <math.h>

/* bench: worst 2000 cycles; float / ours 2.0; rms 0.25 LSB */

struct float_huber {
    float x, v;
    float p00, p01, p11;
    float dt, q, r, huber, rate_max;
};

float_huber_t float_huber;

NOTHING_LONGER(huber)

void float_huber_start(float_huber_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[HUBER_Q_LSB2_S3];
    f->huber = (float)config->value[HUBER_SIGMA_Q8] / 256.0f;
    f->rate_max = (float)config->value[HUBER_RATE_MAX_LSB_S];
    float_huber_set_noise(f, (float)config->value[HUBER_R_LSB2_Q8] / 256.0f);
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
}

void float_huber_set_noise(float_huber_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

float float_huber_coast(float_huber_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (2.0f * f->p01 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
    return f->x;
}

float float_huber_update(float_huber_t *f, int16_t z_lsb)
{
    (void)float_huber_coast(f);
    float s = f->p00 + f->r;
    float u = (float)z_lsb - f->x;
    float limit = f->huber * (float)sqrtf(s);
    float size = (float)fabsf(u);
    float w = (f->huber > 0.0f && size > limit) ? limit / size : 1.0f;
    float k0 = w * f->p00 / s;
    float k1 = w * f->p01 / s;
    f->x += k0 * u;
    f->v += k1 * u;
    f->v = (f->v > f->rate_max) ? f->rate_max : (f->v < -f->rate_max) ? -f->rate_max : f->v;
    f->p11 -= k1 * f->p01;
    f->p01 -= k0 * f->p01;
    f->p00 -= k0 * f->p00;
    return f->x;
}
