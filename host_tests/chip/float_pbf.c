/* The pseudo-Bayesian filter of paper 002, in float. */
#include "float_mixture.h"

/*
 * bench: worst 5000 cycles; float / ours 3.5; rms 0.25 LSB
 * its products are calls: it keeps to its cycles and saves flash before more
 */

struct float_pbf {
    float_mixture_t mixture;
};

float_pbf_t float_pbf;

void lengthen_pbf(filter_config_t *config)
{
    float_mixture_lengthen(config);
}

void float_pbf_start(float_pbf_t *f, const filter_config_t *config, float x0_lsb)
{
    float_mixture_start(&f->mixture, config, x0_lsb);
}

void float_pbf_set_noise(float_pbf_t *f, float r_lsb2)
{
    f->mixture.tracker.r = r_lsb2;
}

float float_pbf_coast(float_pbf_t *f)
{
    return float_mixture_coast(&f->mixture);
}

float float_pbf_update(float_pbf_t *f, int16_t z_lsb)
{
    float innovation;
    float normal;
    float outlier;
    float p = float_mixture_weigh(&f->mixture, z_lsb, &innovation, &normal, &outlier);
    float m = outlier + p * (normal - outlier);
    float spread = innovation * (normal - outlier);
    float_mixture_apply(&f->mixture, innovation, m, m - p * (1.0f - p) * spread * spread);
    return f->mixture.tracker.x;
}
