/*
 * The synthesised filter as equation 7 of paper 000 prints it: four products, in float. With FLOAT_KEPT the two
 * coefficients made from a1 are computed once, at the start.
 */
#include "float_filters.h"

/* bench: worst 745 cycles; float / ours 2.6; rms 0.25 LSB */

struct float_synth {
    float x1, x2, x3;
    float most; /* LSB a sample */
    float a1, b0;
#ifdef FLOAT_KEPT
    float c1; /* 2 - a1 */
    float c2; /* 1 - 2 a1 */
#endif
};

float_synth_t float_synth;

/* Paper 001's; with a1 = 0 there is no second product. */
void lengthen_synth(filter_config_t *config)
{
    config->value[SYNTH_A1_Q16] = -19661; /* -0.3 */
    config->value[SYNTH_B0_UQ16] = 6554;  /* 0.1 */
}

void float_synth_start(float_synth_t *f, const filter_config_t *config, float x0_lsb)
{
    f->a1 = (float)config->value[SYNTH_A1_Q16] / 65536.0f;
    f->b0 = (float)config->value[SYNTH_B0_UQ16] / 65536.0f;
#ifdef FLOAT_KEPT
    f->c1 = 2.0f - f->a1;
    f->c2 = 1.0f - 2.0f * f->a1;
#endif
    f->most = 10.0f * (float)config->value[SYNTH_RATE_MAX_LSB_S] / (float)config->rate_dhz;
    f->x1 = x0_lsb;
    f->x2 = x0_lsb;
    f->x3 = x0_lsb;
}

/* Its gains do not depend on R. */
void float_synth_set_noise(float_synth_t *f, float r_lsb2)
{
    (void)f;
    (void)r_lsb2;
}

static float extrapolate(const float_synth_t *f)
{
#ifdef FLOAT_KEPT
    return f->c1 * f->x1 - f->c2 * f->x2 - f->a1 * f->x3;
#else
    return (2.0f - f->a1) * f->x1 - (1.0f - 2.0f * f->a1) * f->x2 - f->a1 * f->x3;
#endif
}

static float shift(float_synth_t *f, float x)
{
    f->x3 = f->x2;
    f->x2 = f->x1;
    f->x1 = x;
    float step = f->x1 - f->x2;
    float over = (step > f->most) ? step - f->most : (step < -f->most) ? step + f->most : 0.0f;
    f->x2 += over; /* the steps after it go on from there */
    f->x3 += over;
    return x;
}

float float_synth_coast(float_synth_t *f)
{
    return shift(f, extrapolate(f));
}

float float_synth_update(float_synth_t *f, int16_t z_lsb)
{
    float x_e = extrapolate(f);
    return shift(f, x_e + f->b0 * ((float)z_lsb - x_e));
}
