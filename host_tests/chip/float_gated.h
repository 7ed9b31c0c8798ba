/*
 * What the yardsticks of sprf and soft share: a tracker that refused samples restart when enough in a row agree, and
 * whose rate is limited.
 */
#ifndef FLOAT_GATED_H
#define FLOAT_GATED_H

#include <math.h>

#include "float_tracker.h"

typedef struct {
    float_tracker_t tracker;
    float gate, rate_max, agree; /* sigmas (0: none), LSB/s, LSB */
    float previous, first;
    uint8_t run, reacquire;
    bool broken;
} float_gated_t;

static inline void gated_set_noise(float_gated_t *g, float r_lsb2)
{
    g->tracker.r = r_lsb2;
    g->agree = 3.0f * (float)sqrtf(2.0f * r_lsb2) + g->rate_max * g->tracker.dt;
}

/* gate, rate_max and reacquire are set. */
static inline void gated_start(float_gated_t *g, const filter_config_t *config, float q, float r, float x0_lsb)
{
    tracker_start(&g->tracker, config, q, r, x0_lsb);
    gated_set_noise(g, r);
    g->previous = x0_lsb;
    g->first = x0_lsb;
    g->run = 0;
    g->broken = false;
}

static inline float gated_coast(float_gated_t *g)
{
    g->broken = true;
    tracker_predict(&g->tracker);
    return g->tracker.x;
}

static inline void gated_limit_rate(float_gated_t *g)
{
    if (g->tracker.v > g->rate_max) {
        g->tracker.v = g->rate_max;
    } else if (g->tracker.v < -g->rate_max) {
        g->tracker.v = -g->rate_max;
    }
}

/* From the last of the samples that agree; the rate over all of them, if none is missing. */
static inline void gated_restart(float_gated_t *g, float z)
{
    float_tracker_t *t = &g->tracker;
    float span = (float)(g->reacquire - 1u) * t->dt;
    t->x = z;
    t->v = 0.0f;
    t->p00 = t->r;
    t->p01 = 0.0f;
    t->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
    if (!g->broken) {
        t->v = (z - g->first) / span;
        t->p01 = t->r / span;
        t->p11 = 2.0f * t->r / (span * span) + t->q * t->dt;
    }
    t->p10 = t->p01;
    gated_limit_rate(g);
    g->run = 0;
}

static inline void gated_refuse(float_gated_t *g, float z)
{
    if (g->reacquire != 0 && g->tracker.p00 >= g->tracker.r) {
        g->tracker.v *= 0.5f;
    }
    if (g->run != 0 && (float)fabsf(z - g->previous) <= g->agree) {
        g->run++;
    } else {
        g->run = 1;
        g->first = z;
        g->broken = false;
    }
    if (g->reacquire != 0 && g->run >= g->reacquire) {
        gated_restart(g, z);
    }
}

static inline bool gated_outside(const float_gated_t *g, float innovation, float s)
{
    return g->gate > 0.0f && (float)fabsf(innovation) > g->gate * (float)sqrtf(s);
}

static inline void gated_correct(float_gated_t *g, float innovation, float s)
{
    tracker_correct(&g->tracker, innovation, s);
    gated_limit_rate(g);
}

#endif
