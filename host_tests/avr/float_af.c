/* The adaptive filter of paper 002, with the mean of the learnt probability in place of its grid, in float. */
#include "float_filters.h"

void float_af_start(float_af_t *f, const filter_config_t *config, float x0_lsb)
{
    float_mixture_start(f, config, x0_lsb);
    f->count = 2.0f;
}

void float_af_set_noise(float_af_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

float float_af_coast(float_af_t *f)
{
    return float_mixture_coast(f);
}

float float_af_update(float_af_t *f, int16_t z_lsb)
{
    float innovation;
    float normal;
    float outlier;
    float p = float_mixture_weigh(f, z_lsb, &innovation, &normal, &outlier);
    f->count += f->count < 1024.0f ? 1.0f : 0.0f;
    f->clean += (p - f->clean) / f->count;
    float m = outlier + p * (normal - outlier);
    float spread = innovation * (normal - outlier);
    float_mixture_apply(f, innovation, m, m - p * (1.0f - p) * spread * spread);
    return f->x;
}
