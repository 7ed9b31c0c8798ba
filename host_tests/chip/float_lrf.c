/* The Kalman filter with the mean variance of normal and outlying samples, in float. */
#include "float_tracker.h"

/* bench: worst 1080 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_lrf {
    float_tracker_t tracker; /* r: R_L, factor times that of a normal sample */
    float factor;
};

float_lrf_t float_lrf;

NOTHING_LONGER(lrf)

void float_lrf_start(float_lrf_t *f, const filter_config_t *config, float x0_lsb)
{
    float ratio = (float)config->value[LRF_RATIO_UQ8] / 256.0f;
    float square = ratio * ratio;
    f->factor = (float)config->value[LRF_CLEAN_UQ16] / 65536.0f * (1.0f - square) + square;
    float r = f->factor * (float)config->value[LRF_R_LSB2_Q8] / 256.0f;
    tracker_start(&f->tracker, config, (float)config->value[LRF_Q_LSB2_S3], r, x0_lsb);
}

void float_lrf_set_noise(float_lrf_t *f, float r_lsb2)
{
    f->tracker.r = f->factor * r_lsb2;
}

float float_lrf_coast(float_lrf_t *f)
{
    tracker_predict(&f->tracker);
    return f->tracker.x;
}

float float_lrf_update(float_lrf_t *f, int16_t z_lsb)
{
    float_tracker_t *t = &f->tracker;
    tracker_predict(t);
    tracker_correct(t, (float)z_lsb - t->x, t->p00 + t->r);
    return t->x;
}
