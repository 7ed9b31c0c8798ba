/* Two-state Kalman filter with a full 2x2 covariance, in float. */
#include "float_filters.h"

/* bench: worst 1080 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_kf {
    float x, v; /* LSB, LSB/s */
    float p00, p01, p10, p11;
    float dt, q, r; /* s, LSB^2/s^3, LSB^2 */
};

float_kf_t float_kf;

NOTHING_LONGER(kf)

void float_kf_start(float_kf_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[KF_Q_LSB2_S3];
    f->r = (float)config->value[KF_R_LSB2_Q8] / 256.0f;
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p10 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
}

void float_kf_set_noise(float_kf_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

float float_kf_coast(float_kf_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (f->p01 + f->p10 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p10 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
    return f->x;
}

float float_kf_update(float_kf_t *f, int16_t z_lsb)
{
    (void)float_kf_coast(f);
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
