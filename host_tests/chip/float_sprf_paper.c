/* The Kalman filter behind a binary gate of so many sigmas as paper 002 prints it, in float. */
#include "float_filters.h"

#include <math.h>

/*
 * bench: worst 2250 cycles; float / ours 2.5; rms 0.25 LSB
 * its products are calls: it keeps to its cycles and saves flash before more
 */

struct float_sprf_paper {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float gate; /* sigmas */
};

float_sprf_paper_t float_sprf_paper;

NOTHING_LONGER(sprf_paper)

void float_sprf_paper_start(float_sprf_paper_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[SPRF_PAPER_Q_LSB2_S3];
    f->r = (float)config->value[SPRF_PAPER_R_LSB2_Q8] / 256.0f;
    f->gate = (float)config->value[SPRF_PAPER_GATE_SIGMA_Q8] / 256.0f;
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p10 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
}

void float_sprf_paper_set_noise(float_sprf_paper_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

float float_sprf_paper_coast(float_sprf_paper_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (f->p01 + f->p10 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p10 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
    return f->x;
}

float float_sprf_paper_update(float_sprf_paper_t *f, int16_t z_lsb)
{
    (void)float_sprf_paper_coast(f);
    float s = f->p00 + f->r;
    float innovation = (float)z_lsb - f->x;
    if ((float)fabsf(innovation) <= f->gate * (float)sqrtf(s)) {
        float k0 = f->p00 / s;
        float k1 = f->p10 / s;
        f->x += k0 * innovation;
        f->v += k1 * innovation;
        float p00 = f->p00;
        float p01 = f->p01;
        f->p00 -= k0 * p00;
        f->p01 -= k0 * p01;
        f->p10 -= k1 * p00;
        f->p11 -= k1 * p01;
    }
    return f->x;
}
