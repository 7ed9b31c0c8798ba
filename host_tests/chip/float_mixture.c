/* A sample that is normal or an outlier, in float: what shrf, pbf and af of paper 002 share. */
#include "float_mixture.h"

#include <math.h>

void float_mixture_start(float_mixture_t *f, const filter_config_t *config, float x0_lsb)
{
    float ratio = (float)config->value[MIXTURE_RATIO_UQ8] / 256.0f;
    float r = (float)config->value[MIXTURE_R_LSB2_Q8] / 256.0f;
    tracker_start(&f->tracker, config, (float)config->value[MIXTURE_Q_LSB2_S3], r, x0_lsb);
    f->ratio2 = ratio * ratio;
    f->clean = (float)config->value[MIXTURE_CLEAN_UQ16] / 65536.0f;
    f->count = 0.0f;
}

float float_mixture_coast(float_mixture_t *f)
{
    tracker_predict(&f->tracker);
    return f->tracker.x;
}

float float_mixture_weigh(float_mixture_t *f, int16_t z_lsb, float *innovation, float *normal, float *outlier)
{
    const float_tracker_t *t = &f->tracker;
    (void)float_mixture_coast(f);
    float s = t->p00 + t->r;
    float s_outlier = t->p00 + f->ratio2 * t->r;
    *innovation = (float)z_lsb - t->x;
    *normal = 1.0f / s;
    *outlier = 1.0f / s_outlier;
    float square = *innovation * *innovation;
    float odds = (1.0f - f->clean) / f->clean * (float)sqrtf(s / s_outlier);
    return 1.0f / (1.0f + odds * (float)expf(0.5f * square * (*normal - *outlier)));
}

void float_mixture_apply(float_mixture_t *f, float innovation, float m, float m2)
{
    float_tracker_t *t = &f->tracker;
    float p00 = t->p00;
    float p01 = t->p01;
    float p10 = t->p10;
    t->x += m * p00 * innovation;
    t->v += m * p10 * innovation;
    t->p00 -= m2 * p00 * p00;
    t->p01 -= m2 * p00 * p01;
    t->p10 -= m2 * p10 * p00;
    t->p11 -= m2 * p10 * p01;
}

/* The numbers whose normalising takes longest, of a search over the legal ones. */
void float_mixture_lengthen(filter_config_t *config)
{
    config->value[MIXTURE_RATIO_UQ8] = 640;
    config->value[MIXTURE_CLEAN_UQ16] = 45158;
}
