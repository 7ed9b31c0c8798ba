/* The structurally shortened robust filter of paper 002, in float. */
#include "float_mixture.h"

/*
 * bench: worst 3650 cycles; float / ours 3.5; rms 0.25 LSB
 * its products are calls: it keeps to its cycles and saves flash before more
 */

struct float_shrf {
    float_mixture_t mixture;
};

float_shrf_t float_shrf;

void lengthen_shrf(filter_config_t *config)
{
    float_mixture_lengthen(config);
}

void float_shrf_start(float_shrf_t *f, const filter_config_t *config, float x0_lsb)
{
    float_mixture_start(&f->mixture, config, x0_lsb);
}

void float_shrf_set_noise(float_shrf_t *f, float r_lsb2)
{
    f->mixture.tracker.r = r_lsb2;
}

float float_shrf_coast(float_shrf_t *f)
{
    return float_mixture_coast(&f->mixture);
}

float float_shrf_update(float_shrf_t *f, int16_t z_lsb)
{
    float innovation;
    float normal;
    float outlier;
    float p = float_mixture_weigh(&f->mixture, z_lsb, &innovation, &normal, &outlier);
    float m = p * normal;
    float spread = innovation * normal;
    float_mixture_apply(&f->mixture, innovation, m, m - p * (1.0f - p) * spread * spread);
    return f->mixture.tracker.x;
}
