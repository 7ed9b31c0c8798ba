/* Three fading memories and the choice among them as auto.c describes it, in float. */
#include "float_filters.h"

#include <math.h>

/*
 * bench: worst 2690 cycles; float / ours 3.8; rms 0.6 LSB
 * where two scores are near, rounding decides which estimate is shown, and for how long: an eighth of the noise
 */

typedef struct {
    float x, v, k, score; /* LSB, LSB per sample, 2 / memory, LSB^2 */
    int8_t refused;
} float_auto_member_t;

struct float_auto {
    float_auto_member_t members[AUTO_MEMBERS];
    float final_k[AUTO_MEMBERS];
    float gate[AUTO_MEMBERS];
    float sigma, rate_max; /* LSB, LSB per sample */
    uint8_t chosen;
};

float_auto_t float_auto;

NOTHING_LONGER(auto)

static float limited(float v, float min, float max)
{
    return (v < min) ? min : (v > max) ? max : v;
}

void float_auto_start(float_auto_t *f, const filter_config_t *config, float x0_lsb)
{
    float rate_hz = (float)config->rate_dhz / 10.0f;
    f->final_k[AUTO_SLOW] = limited(2000.0f / ((float)config->value[AUTO_SLOW_MS] * rate_hz), 2.0f / 512.0f, 0.6f);
    f->final_k[AUTO_MIDDLE] = limited(2000.0f / ((float)config->value[AUTO_MIDDLE_MS] * rate_hz), 2.0f / 512.0f, 0.6f);
    f->final_k[AUTO_FAST] = limited(2000.0f / ((float)config->value[AUTO_FAST_MS] * rate_hz), 2.0f / 512.0f, 0.6f);
    float gate = (config->value[AUTO_GATE_SIGMA_Q8] != 0u) ? (float)config->value[AUTO_GATE_SIGMA_Q8] / 256.0f : 1e6f;
    f->rate_max = limited((float)config->value[AUTO_RATE_MAX_LSB_S] / rate_hz, 0.0f, 4608.0f);
    f->chosen = AUTO_MIDDLE;
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        f->members[i] = (float_auto_member_t){ x0_lsb, 0.0f, 0.5f, 0.0f, 0 };
        f->gate[i] = (i == AUTO_SLOW) ? 2.0f * gate : gate;
    }
    float_auto_set_noise(f, (float)config->value[AUTO_R_LSB2_Q8] / 256.0f);
}

void float_auto_set_noise(float_auto_t *f, float r_lsb2)
{
    f->sigma = (float)sqrtf(r_lsb2);
}

/* True: the sample is beyond the gate and not to be used. */
static bool refuses(float_auto_t *f, uint8_t i, float u, float z)
{
    float_auto_member_t *m = &f->members[i];
    if ((float)fabsf(u) <= f->gate[i] * f->sigma || (m->k > 0.25f && m->k > f->final_k[i])) {
        m->refused = 0;
        return false;
    }
    int8_t side = (u < 0.0f) ? -1 : 1;
    m->refused = (int8_t)((m->refused * side > 0) ? m->refused + side : side);
    if (m->refused >= 5 || m->refused <= -5) {
        m->x = z;
        m->v = 0.0f;
        m->k = 0.6f;
        m->refused = 0;
    }
    return true;
}

static void step(float_auto_t *f, uint8_t i, float z)
{
    float_auto_member_t *m = &f->members[i];
    m->x = limited(m->x + m->v, -4608.0f, 4608.0f);
    float u = z - m->x;
    float bounded = limited(u, -8.0f * f->sigma, 8.0f * f->sigma);
    m->score += (bounded * bounded - m->score) / 8.0f;
    if (refuses(f, i, u, z)) {
        return;
    }
    float square = m->k * m->k;
    m->x += (2.0f * m->k - square) * u;
    m->v = limited(m->v + square * u, -f->rate_max, f->rate_max);
    if (m->k > f->final_k[i]) {
        m->k = limited(m->k - square / 4.0f, f->final_k[i], 0.6f);
    }
}

float float_auto_update(float_auto_t *f, int16_t z_lsb)
{
    uint8_t best = 0;
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        step(f, i, limited((float)z_lsb, -4096.0f, 4095.0f));
        if (f->members[i].score < f->members[best].score) {
            best = i;
        }
    }
    if (f->members[best].score < f->members[f->chosen].score * (31.0f / 32.0f)) {
        f->chosen = best;
    }
    return f->members[f->chosen].x;
}

float float_auto_coast(float_auto_t *f)
{
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        f->members[i].x = limited(f->members[i].x + f->members[i].v, -4608.0f, 4608.0f);
    }
    return f->members[AUTO_MIDDLE].x;
}
