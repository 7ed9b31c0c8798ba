/*
 * Parametric synthesis as one writes it who computes the gains on line, in float: the covariance of the last three
 * errors and its optimal a1, or variant U with equation 21 of paper 000; the clamps as in synth_opt.c.
 */
#include "float_filters.h"

/* bench: worst 745 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_synth_opt {
    float x1, x2, x3;
    float most;                         /* LSB a sample */
    float s11, s12, s13, s22, s23, s33; /* covariance of the last three errors */
    float r;
    float p1, p2, p3, p4, p5; /* of variant U: past variances */
    bool u;
};

float_synth_opt_t float_synth_opt;

/* Variant U has a second product. */
void lengthen_synth_opt(filter_config_t *config)
{
    config->value[SYNTH_OPT_VARIANT_U] = 1;
}

void float_synth_opt_start(float_synth_opt_t *f, const filter_config_t *config, float x0_lsb)
{
    float p0 = (float)config->value[SYNTH_OPT_P0_LSB2_Q8] / 256.0f;
    f->u = config->value[SYNTH_OPT_VARIANT_U] != 0U;
    f->r = (float)config->value[SYNTH_OPT_R_LSB2_Q8] / 256.0f;
    f->s11 = f->s12 = f->s13 = f->s22 = f->s23 = f->s33 = p0;
    f->p1 = f->p2 = f->p3 = f->p4 = f->p5 = p0;
    f->most = 10.0f * (float)config->value[SYNTH_OPT_RATE_MAX_LSB_S] / (float)config->rate_dhz;
    f->x1 = f->x2 = f->x3 = x0_lsb;
}

void float_synth_opt_set_noise(float_synth_opt_t *f, float r_lsb2)
{
    f->r = r_lsb2;
}

static float limited(float v, float low, float high)
{
    if (v < low) {
        return low;
    }
    return (v > high) ? high : v;
}

/* Denominators that are nothing but rounding give the straight line. */
static float quotient(float above, float below, float size)
{
    return (below > 1e-5f * size || below < -1e-5f * size) ? above / below : 0.0f;
}

static float optimal_a1(const float_synth_opt_t *f)
{
    float below = f->s11 - 4.0f * f->s12 + 2.0f * f->s13 + 4.0f * f->s22 - 4.0f * f->s23 + f->s33;
    float above = 2.0f * f->s11 - 5.0f * f->s12 + 2.0f * f->s13 + 2.0f * f->s22 - f->s23;
    return limited(quotient(above, below, f->s11 + f->s33), -1.0f / 3.0f, 0.0f);
}

static float paper_a1(const float_synth_opt_t *f)
{
    float below = 8.0f * f->p2 + 4.0f * f->p3 - 8.0f * f->p4 + 2.0f * f->p5;
    float above = f->p1 + 6.0f * f->p2 - 8.0f * f->p3 + 2.0f * f->p4;
    return limited(quotient(-above, below, f->p2), -1.0f / 3.0f, 0.0f);
}

static float shift(float_synth_opt_t *f, float x)
{
    f->x3 = f->x2;
    f->x2 = f->x1;
    f->x1 = x;
    float step = f->x1 - f->x2;
    float over = step - limited(step, -f->most, f->most);
    f->x2 += over; /* the steps after it go on from there */
    f->x3 += over;
    return x;
}

static float gain_of(float pe, float r)
{
    return limited(pe / (pe + r), 0.5f, 1.0f);
}

float float_synth_opt_coast(float_synth_opt_t *f)
{
    float a1 = f->u ? paper_a1(f) : optimal_a1(f);
    return shift(f, (2.0f - a1) * f->x1 - (1.0f - 2.0f * a1) * f->x2 - a1 * f->x3);
}

float float_synth_opt_update(float_synth_opt_t *f, int16_t z_lsb)
{
    float a1 = f->u ? paper_a1(f) : optimal_a1(f);
    float h1 = 2.0f - a1;
    float h2 = 2.0f * a1 - 1.0f;
    float b0;
    if (f->u) {
        float pe = h1 * h1 * f->p1 + h2 * h2 * f->p2 + a1 * a1 * f->p3;
        b0 = gain_of(pe, f->r);
        f->p5 = f->p4;
        f->p4 = f->p3;
        f->p3 = f->p2;
        f->p2 = f->p1;
        f->p1 = (1.0f - b0) * (1.0f - b0) * pe + b0 * b0 * f->r;
    } else {
        float e1 = h1 * f->s11 + h2 * f->s12 - a1 * f->s13;
        float e2 = h1 * f->s12 + h2 * f->s22 - a1 * f->s23;
        float e3 = h1 * f->s13 + h2 * f->s23 - a1 * f->s33;
        float pe = h1 * e1 + h2 * e2 - a1 * e3;
        b0 = gain_of(pe, f->r);
        f->s33 = f->s22;
        f->s23 = f->s12;
        f->s22 = f->s11;
        f->s12 = (1.0f - b0) * e1;
        f->s13 = (1.0f - b0) * e2;
        f->s11 = (1.0f - b0) * (1.0f - b0) * pe + b0 * b0 * f->r;
    }
    float x_e = h1 * f->x1 + h2 * f->x2 - a1 * f->x3;
    return shift(f, x_e + b0 * ((float)z_lsb - x_e));
}
