/* The Kalman filter behind a binary gate of so many sigmas, with the re-acquisition rule of sprf, in float. */
#include "float_filters.h"

#include <math.h>

/* bench: worst 1230 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_sprf {
    float x, v;
    float p00, p01, p10, p11;
    float dt, q, r;
    float gate, rate_max, agree; /* sigmas (0: none), LSB/s, LSB */
    float previous, first;
    uint8_t run, refused, reacquire;
    bool broken;
};

float_sprf_t float_sprf;

NOTHING_LONGER(sprf)

void float_sprf_start(float_sprf_t *f, const filter_config_t *config, float x0_lsb)
{
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[SPRF_Q_LSB2_S3];
    f->gate = (float)config->value[SPRF_GATE_SIGMA_Q8] / 256.0f;
    f->rate_max = (float)config->value[SPRF_RATE_MAX_LSB_S];
    f->reacquire = (uint8_t)config->value[SPRF_REACQUIRE_SAMPLES];
    float_sprf_set_noise(f, (float)config->value[SPRF_R_LSB2_Q8] / 256.0f);
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p10 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
    f->previous = x0_lsb;
    f->first = x0_lsb;
    f->run = 0;
    f->broken = false;
}

void float_sprf_set_noise(float_sprf_t *f, float r_lsb2)
{
    f->r = r_lsb2;
    f->agree = 3.0f * (float)sqrtf(2.0f * r_lsb2) + f->rate_max * f->dt;
}

static void predict(float_sprf_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (f->p01 + f->p10 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p10 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
}

float float_sprf_coast(float_sprf_t *f)
{
    f->broken = true;
    predict(f);
    return f->x;
}

static void limit_rate(float_sprf_t *f)
{
    if (f->v > f->rate_max) {
        f->v = f->rate_max;
    } else if (f->v < -f->rate_max) {
        f->v = -f->rate_max;
    }
}

static void restart(float_sprf_t *f, float z)
{
    float span = (float)(f->reacquire - 1u) * f->dt;
    f->x = z;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
    if (!f->broken) {
        f->v = (z - f->first) / span;
        f->p01 = f->r / span;
        f->p11 = 2.0f * f->r / (span * span) + f->q * f->dt;
    }
    f->p10 = f->p01;
    limit_rate(f);
    f->run = 0;
}

static void forget_rate(float_sprf_t *f)
{
    if (f->run == 0) {
        f->refused = 0;
    }
    if (f->refused < 5u) {
        f->refused++;
    } else if (f->reacquire != 0) {
        f->v = 0.0f;
    }
}

static void refuse(float_sprf_t *f, float z)
{
    forget_rate(f);
    if (f->reacquire != 0 && f->p00 >= f->r) {
        f->v *= 0.5f;
    }
    if (f->run != 0 && (float)fabsf(z - f->previous) <= f->agree) {
        f->run++;
    } else {
        f->run = 1;
        f->first = z;
        f->broken = false;
    }
    if (f->reacquire != 0 && f->run >= f->reacquire) {
        restart(f, z);
    }
}

float float_sprf_update(float_sprf_t *f, int16_t z_lsb)
{
    float z = (float)z_lsb;
    predict(f);
    float s = f->p00 + f->r;
    float innovation = z - f->x;
    if (f->gate > 0.0f && (float)fabsf(innovation) > f->gate * (float)sqrtf(s)) {
        refuse(f, z);
    } else {
        float k0 = f->p00 / s;
        float k1 = f->p10 / s;
        f->x += k0 * innovation;
        f->v += k1 * innovation;
        limit_rate(f);
        float p00 = f->p00;
        float p01 = f->p01;
        f->p00 -= k0 * p00;
        f->p01 -= k0 * p01;
        f->p10 -= k1 * p00;
        f->p11 -= k1 * p01;
        f->run = 0;
    }
    f->previous = z;
    return f->x;
}
