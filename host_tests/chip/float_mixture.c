/* A sample that is normal or an outlier, in float: what shrf, pbf and af of paper 002 share. */
#include "float_mixture.h"

#include <math.h>

void float_mixture_start(float_mixture_t *f, const filter_config_t *config, float x0_lsb)
{
    float ratio = (float)config->value[MIXTURE_RATIO_UQ8] / 256.0f;
    f->dt = 10.0f / (float)config->rate_dhz;
    f->q = (float)config->value[MIXTURE_Q_LSB2_S3];
    f->r = (float)config->value[MIXTURE_R_LSB2_Q8] / 256.0f;
    f->ratio2 = ratio * ratio;
    f->clean = (float)config->value[MIXTURE_CLEAN_UQ16] / 65536.0f;
    f->count = 0.0f;
    f->x = x0_lsb;
    f->v = 0.0f;
    f->p00 = f->r;
    f->p01 = 0.0f;
    f->p10 = 0.0f;
    f->p11 = FLOAT_START_RATE_VARIANCE_LSB2_S2;
}

float float_mixture_coast(float_mixture_t *f)
{
    f->x += f->dt * f->v;
    f->p00 += f->dt * (f->p01 + f->p10 + f->dt * f->p11);
    f->p01 += f->dt * f->p11;
    f->p10 += f->dt * f->p11;
    f->p11 += f->q * f->dt;
    return f->x;
}

float float_mixture_weigh(float_mixture_t *f, int16_t z_lsb, float *innovation, float *normal, float *outlier)
{
    (void)float_mixture_coast(f);
    float s = f->p00 + f->r;
    float s_outlier = f->p00 + f->ratio2 * f->r;
    *innovation = (float)z_lsb - f->x;
    *normal = 1.0f / s;
    *outlier = 1.0f / s_outlier;
    float square = *innovation * *innovation;
    float odds = (1.0f - f->clean) / f->clean * (float)sqrtf(s / s_outlier);
    return 1.0f / (1.0f + odds * (float)expf(0.5f * square * (*normal - *outlier)));
}

void float_mixture_apply(float_mixture_t *f, float innovation, float m, float m2)
{
    float p00 = f->p00;
    float p01 = f->p01;
    float p10 = f->p10;
    f->x += m * p00 * innovation;
    f->v += m * p10 * innovation;
    f->p00 -= m2 * p00 * p00;
    f->p01 -= m2 * p00 * p01;
    f->p10 -= m2 * p10 * p00;
    f->p11 -= m2 * p10 * p01;
}

/* The numbers whose normalising takes longest, of a search over the legal ones. */
void float_mixture_lengthen(filter_config_t *config)
{
    config->value[MIXTURE_RATIO_UQ8] = 640;
    config->value[MIXTURE_CLEAN_UQ16] = 45158;
}
