/* The step and the start of the synthesised laws: see synth.h. */
#include "synth.h"

LAW_KEEPS_FROM(filter_synth_t, r_lsb2_q8);

/*
 * Gains of a least-squares line through n samples, (4 n - 2) / (n (n + 1)), n = 6..63, UQ0.16: they replace the
 * constant gain after the start while they are higher. After the last one the variance of the estimate is within a few
 * per cent of the steady one.
 */
static const uint16_t start_gains_uq16[SYNTH_END_GAIN - SYNTH_FIRST_GAIN] IN_FLASH = {
    34328, 30427, 27307, 24758, 22640, 20852, 19325, 18004, 16852, 15838, 14938, 14135, 13414, 12762, 12171,
    11632, 11139, 10685, 10267, 9881,  9522,  9189,  8878,  8587,  8315,  8060,  7820,  7593,  7380,  7178,
    6987,  6805,  6633,  6470,  6314,  6165,  6024,  5889,  5759,  5635,  5517,  5403,  5294,  5189,  5089,
    4992,  4899,  4809,  4722,  4639,  4558,  4480,  4405,  4332,  4262,  4193,  4127,  4063,
};

void filter_synth_take_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    f->own.synth.r_lsb2_q8 = r_lsb2_q8;
}

void filter_synth_start(filter_t *f, bool settled)
{
    f->own.synth.rate_before_lsb_q16 = 0;
    f->own.synth.memory_lsb_q16 = 0;
    f->own.synth.count = settled ? (uint8_t)SYNTH_STEADY : (uint8_t)SYNTH_FIRST_GAIN;
}

uint16_t filter_synth_next_gain_uq16(filter_t *f)
{
    filter_synth_t *s = &f->own.synth;
    if (s->count < (uint8_t)SYNTH_END_GAIN) {
        uint16_t gain_uq16 = flash_u16(&start_gains_uq16[s->count - (uint8_t)SYNTH_FIRST_GAIN]);
        s->count++;
        if (gain_uq16 > s->b0_uq16) {
            return gain_uq16;
        }
    }
    s->count = SYNTH_STEADY;
    return s->b0_uq16;
}

void filter_synth_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    int32_t before = f->x_lsb_q16;
    tracker_predict(f);
    if (what != STEP_MISSING) {
        filter_tracker_meet(f, z_lsb);
        filter_tracker_move(f, (int32_t)filter_fx_mul_uq16(f->size_lsb_uq16, f->gain_uq16));
    }
    f->rate_lsb = f->x_lsb_q16 - before;
}

void filter_synth_bent_step(filter_t *f, int16_t z_lsb, uint8_t what, uint16_t a1_uq16)
{
    filter_synth_t *s = &f->own.synth;
    int32_t rate = f->rate_lsb;
    int32_t bend = rate - s->rate_before_lsb_q16; /* x1 - 2 x2 + x3 < 18432 LSB */
    s->rate_before_lsb_q16 = rate;
    int32_t part = (int32_t)filter_fx_mul_uq16(filter_fx_abs32(bend), a1_uq16);
    f->rate_lsb = ((bend < 0) != s->a1_negative) ? rate + part : rate - part;
    filter_synth_step(f, z_lsb, what);
}

void filter_synth_steady_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    uint16_t a1_uq16 = f->own.synth.a1_uq16;
    f->gain_uq16 = f->own.synth.b0_uq16;
    if (a1_uq16 == 0U) {
        filter_synth_step(f, z_lsb, what);
    } else {
        filter_synth_bent_step(f, z_lsb, what, a1_uq16);
    }
}

void filter_synth_damp(filter_t *f)
{
    f->own.synth.rate_before_lsb_q16 >>= 1;
}

/* Whether the rate exceeds three sigmas of a sample: both squares in UQ16.16, 9 R < 2^14. */
static bool rate_counts(const filter_t *f)
{
    uint32_t size_lsb_uq8 = filter_fx_abs32(f->rate_lsb) >> 8;
    uint16_t size = (uint16_t)size_lsb_uq8;
    return (size_lsb_uq8 >> 16) != 0U || fx_product_u16(size, size) > (9U * f->own.synth.r_lsb2_q8) << 8;
}

void filter_synth_fade(filter_t *f, bool first)
{
    if (!first) {
        filter_synth_damp(f);
    } else if (!rate_counts(f)) {
        f->rate_lsb = 0;
        f->own.synth.rate_before_lsb_q16 = 0;
    }
}

uint32_t filter_synth_variance_lsb2_q8(const filter_t *f, uint32_t noise_gain_uq16)
{
    fx_scaled_t p = filter_fx_scaled_mul(filter_fx_scaled(noise_gain_uq16), filter_fx_scaled(f->own.synth.r_lsb2_q8));
    p.exponent = (int8_t)(p.exponent - 16);
    return filter_fx_scaled_fixed(p, 0);
}
