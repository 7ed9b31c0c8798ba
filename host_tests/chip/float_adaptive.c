/* The guarded adaptive filter as adaptive.c describes it, in float. */
#include "float_filters.h"

#include <math.h>

/* bench: worst 1400 cycles; float / ours 4.0; rms 0.25 LSB */

struct float_adaptive {
    float x, v; /* LSB, LSB per sample */
    float mean; /* of the innovations */
    float k;
    float scatter; /* LSB */
    float guard, slow, fast, share, manoeuvre, rate_max, confirm;
    float run;
    float previous;
    uint8_t terms; /* of the scatter, as far as its opening */
    uint8_t strays;
    bool broken, identify, below, term;
};

float_adaptive_t float_adaptive;

/* Unguarded it spares the verdict, and nothing else costs more. */
void lengthen_adaptive(filter_config_t *config)
{
    config->value[ADAPTIVE_GUARD_SIGMA_Q8] = 0;
}

static float limited(float v, float min, float max)
{
    return (v < min) ? min : (v > max) ? max : v;
}

void float_adaptive_start(float_adaptive_t *f, const filter_config_t *config, float x0_lsb)
{
    float rate_hz = (float)config->rate_dhz / 10.0f;
    f->guard = (float)config->value[ADAPTIVE_GUARD_SIGMA_Q8] / 256.0f;
    f->identify = config->value[ADAPTIVE_IDENTIFY] != 0u;
    f->slow = limited(2000.0f / ((float)config->value[ADAPTIVE_SLOW_MS] * rate_hz), 0.0005f, 0.6f);
    f->fast = limited(2000.0f / ((float)config->value[ADAPTIVE_FAST_MS] * rate_hz), f->slow, 0.6f);
    f->share = 0.4f * f->fast;
    f->manoeuvre = limited(2.9f * (float)sqrtf(f->share / 2.0f), 0.0f, 0.845f);
    f->rate_max = limited((float)config->value[ADAPTIVE_RATE_MAX_LSB_S] / rate_hz, 0.0f, 127.0f);
    f->confirm = limited((float)config->value[ADAPTIVE_CONFIRM_MS] * rate_hz / 1000.0f, 3.0f, 65535.0f);
    f->terms = 0;
    float_adaptive_set_noise(f, (float)config->value[ADAPTIVE_R_LSB2_Q8] / 256.0f);
    f->x = x0_lsb;
    f->v = 0.0f;
    f->mean = 0.0f;
    f->k = 0.5f;
    f->previous = x0_lsb;
    f->broken = false;
    f->run = 0;
    f->strays = 0;
    f->term = false;
    f->below = false;
}

void float_adaptive_set_noise(float_adaptive_t *f, float r_lsb2)
{
    if (f->terms == 0u) {
        f->scatter = (float)sqrtf(r_lsb2);
    }
}

static void disperse(float_adaptive_t *f, float innovation, float spread)
{
    float term = 1.375f * (float)fabsf(innovation - f->mean);
    float limit = 2.5f * spread;
    float window = (f->terms < 7u) ? 8.0f : (f->guard > 0.0f || term > limit) ? 16.0f : 32.0f;
    f->scatter += ((term < limit ? term : limit) - spread) / window;
    f->scatter = limited(f->scatter, 0.1f, 90.0f);
    f->terms = (f->terms < 7u) ? (uint8_t)(f->terms + 1u) : 7u;
}

/* What is taken of an innovation beyond the gate; sets motion and jump. */
static float judge(float_adaptive_t *f, float size, float gate, float before, bool *motion, bool *jump)
{
    f->run += 1.0f;
    float agreed = limited(before, 0.0f, size);
    if (agreed > gate) {
        bool large = size > gate + f->rate_max / 8.0f;
        if (!large || f->run >= f->confirm) {
            *motion = true;
            *jump = large;
            return agreed;
        }
        agreed = gate;
    }
    float left = 2.0f * gate - size;
    if (agreed <= 0.0f && left <= 0.0f) {
        f->strays = (f->strays > 191u) ? 255u : (uint8_t)(f->strays + 64u);
    }
    return (agreed > left) ? agreed : left;
}

static void adapt(float_adaptive_t *f, float spread, bool motion)
{
    float drift = (float)fabsf(f->mean);
    if (motion || drift > f->manoeuvre * spread) {
        f->k = (f->k < f->fast) ? f->fast : f->k;
    } else if (drift <= 0.75f * f->manoeuvre * spread) {
        f->k -= f->k * f->k / 4.0f;
        f->k = (f->k < f->slow) ? f->slow : f->k;
    }
}

static void follow(float_adaptive_t *f, float taken, bool jump)
{
    if (jump) {
        f->x += taken;
        f->v = 0.0f;
    } else {
        float w = f->k * taken;
        f->x += 2.0f * w - f->k * w;
        f->v = limited(f->v + f->k * w, -f->rate_max, f->rate_max);
    }
}

static float gate_of(const float_adaptive_t *f, float spread)
{
    float guard = f->guard > 0.0f ? f->guard : 4.5f;
    if (f->strays > 64u) {
        return ((guard <= 3.0f) ? guard : (f->run < 4.0f) ? 2.25f : 9.0f) * spread;
    }
    return guard * (f->run > 0.0f ? spread : spread + (float)fabsf(f->mean));
}

static void step(float_adaptive_t *f, float z)
{
    float before = f->broken ? 0.0f : f->previous - f->x;
    float spread = f->scatter * (1.0f + f->k);
    f->x += f->v;
    float innovation = z - f->x;
    if ((innovation < 0.0f) != f->below) {
        f->below = !f->below;
        f->run = 0;
    }
    float gate = gate_of(f, spread);
    float sign = (innovation < 0.0f) ? -1.0f : 1.0f;
    float taken = sign * innovation;
    bool motion = false;
    bool jump = false;
    if (f->guard > 0.0f && taken > gate) {
        taken = judge(f, taken, gate, sign * before, &motion, &jump);
    } else {
        f->run = 0;
        f->strays = (uint8_t)(f->strays - (f->strays != 0u));
    }
    float most = (gate > 128.0f) ? 128.0f : gate;
    f->mean += f->share * (sign * (taken > most ? most : taken) - f->mean);
    adapt(f, spread, motion);
    follow(f, sign * taken, jump);
    f->term = f->identify && !f->term;
    if (f->term) {
        disperse(f, innovation, spread);
    }
}

float float_adaptive_coast(float_adaptive_t *f)
{
    f->broken = true;
    f->x += f->v;
    return f->x;
}

float float_adaptive_update(float_adaptive_t *f, int16_t z_lsb)
{
    step(f, (float)z_lsb);
    f->previous = (float)z_lsb;
    f->broken = false;
    return f->x;
}
