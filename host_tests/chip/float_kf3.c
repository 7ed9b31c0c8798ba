/* Three-state Kalman filter with a full 3x3 covariance, in float. */
#include "float_filters.h"

/* bench: worst 2500 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_kf3 {
    float x, v, a; /* LSB, LSB/s, LSB/s^2 */
    float p[3][3];
    float dt, q, r;
    float q_given, per_q, least, most; /* as configured; T^5; the range of q T^5 / R */
};

float_kf3_t float_kf3;

NOTHING_LONGER(kf3)

void float_kf3_start(float_kf3_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    float dt2 = f->dt * f->dt;
    float least = config->rate_dhz >= 1000U ? 2.3283064e-10f : 5.9604645e-8f; /* 2^-32, 2^-24 */
    float most = config->rate_dhz >= 1000U ? 4.8828125e-4f : 1.0f;            /* 2^-11 */
    f->per_q = dt2 * dt2 * f->dt;
    f->q_given = (float)config->value[KF3_Q_LSB2_S5];
    f->least = least;
    f->most = most;
    float_kf3_set_noise(f, (float)config->value[KF3_R_LSB2_Q8] / 256.0f);
    f->x = x0_lsb;
    f->v = 0.0f;
    f->a = 0.0f;
    for (uint8_t i = 0; i < 3; i++) {
        for (uint8_t j = 0; j < 3; j++) {
            f->p[i][j] = 0.0f;
        }
    }
    f->p[0][0] = f->r;
    f->p[1][1] = FLOAT_START_RATE_VARIANCE_LSB2_S2;
    if (f->p[1][1] * dt2 > 0.5f * f->r) {
        f->p[1][1] = 0.5f * f->r / dt2;
    }
    f->p[2][2] = f->p[1][1] / dt2 / (config->rate_dhz >= 1000U ? 4096.0f : 16.0f);
}

/* q T^5 / R keeps to kf3's range, so that both do the same job. */
void float_kf3_set_noise(float_kf3_t *f, float r_lsb2)
{
    f->r = r_lsb2;
    float q = f->q_given * f->per_q / r_lsb2;
    q = q < f->least ? f->least : q;
    q = q > f->most ? f->most : q;
    f->q = q * r_lsb2 / f->per_q;
}

float float_kf3_coast(float_kf3_t *f)
{
    float dt = f->dt;
    f->v += dt * f->a;
    f->x += dt * f->v;
    f->p[2][2] += f->q * dt;
    for (uint8_t i = 0; i < 3; i++) { /* a into v, v into x: rows, then columns */
        f->p[1][i] += dt * f->p[2][i];
        f->p[0][i] += dt * f->p[1][i];
    }
    for (uint8_t i = 0; i < 3; i++) {
        f->p[i][1] += dt * f->p[i][2];
        f->p[i][0] += dt * f->p[i][1];
    }
    return f->x;
}

float float_kf3_update(float_kf3_t *f, int16_t z_lsb)
{
    (void)float_kf3_coast(f);
    float s = f->p[0][0] + f->r;
    float innovation = (float)z_lsb - f->x;
    float gain[3];
    float row[3];
    for (uint8_t i = 0; i < 3; i++) {
        gain[i] = f->p[i][0] / s;
        row[i] = f->p[0][i];
    }
    f->x += gain[0] * innovation;
    f->v += gain[1] * innovation;
    f->a += gain[2] * innovation;
    for (uint8_t i = 0; i < 3; i++) {
        for (uint8_t j = 0; j < 3; j++) {
            f->p[i][j] -= gain[i] * row[j];
        }
    }
    return f->x;
}
