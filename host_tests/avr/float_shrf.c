/* The structurally shortened robust filter of paper 002, in float. */
#include "float_filters.h"

void float_shrf_start(float_shrf_t *f, const filter_config_t *config, float x0_lsb)
{
    float_mixture_start(f, config, x0_lsb);
}

void float_shrf_set_noise(float_shrf_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

float float_shrf_coast(float_shrf_t *f)
{
    return float_mixture_coast(f);
}

float float_shrf_update(float_shrf_t *f, int16_t z_lsb)
{
    float innovation;
    float normal;
    float outlier;
    float p = float_mixture_weigh(f, z_lsb, &innovation, &normal, &outlier);
    float m = p * normal;
    float spread = innovation * normal;
    float_mixture_apply(f, innovation, m, m - p * (1.0f - p) * spread * spread);
    return f->x;
}
