/*
 * What the yardsticks of the Kalman family share: level and rate with a full 2x2 covariance, from the textbook. In a
 * header, so that the compiler sees it in each file as if it had been written there.
 */
#ifndef FLOAT_TRACKER_H
#define FLOAT_TRACKER_H

#include "float_filters.h"

typedef struct {
    float x, v; /* LSB, LSB/s */
    float p00, p01, p10, p11;
    float dt, q, r; /* s, LSB^2/s^3, LSB^2 */
} float_tracker_t;

/* At rest at x0, as uncertain as one sample. */
static inline void tracker_start(float_tracker_t *t, const filter_config_t *config, float q, float r, float x0_lsb)
{
    *t = (float_tracker_t){ .x = x0_lsb, .p00 = r, .p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2, .q = q, .r = r };
    t->dt = 10.0f / (float)config->rate_dhz;
}

static inline void tracker_predict(float_tracker_t *t)
{
    t->x += t->dt * t->v;
    t->p00 += t->dt * (t->p01 + t->p10 + t->dt * t->p11);
    t->p01 += t->dt * t->p11;
    t->p10 += t->dt * t->p11;
    t->p11 += t->q * t->dt;
}

/* s: variance of the innovation that the gains follow. */
static inline void tracker_correct(float_tracker_t *t, float innovation, float s)
{
    float k0 = t->p00 / s;
    float k1 = t->p10 / s;
    t->x += k0 * innovation;
    t->v += k1 * innovation;
    float p00 = t->p00;
    float p01 = t->p01;
    t->p00 -= k0 * p00;
    t->p01 -= k0 * p01;
    t->p10 -= k1 * p00;
    t->p11 -= k1 * p01;
}

#endif
