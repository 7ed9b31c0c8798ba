/* The step and the start of the synthesised laws: see synth.h. */
#include "synth.h"

/* Two samples' motion at this rate may carry a start sample from the median: as sprf's ratemax. */
#define MOTION_LSB_S 800U
/* With this the line through the start samples ends within the bound of the format, see fit_line. */
#define SPREAD_MAX_LSB 365

/*
 * Gains of a least-squares line through n samples, (4 n - 2) / (n (n + 1)), n = 6..63, UQ0.16: what the constant gain
 * is raised to after the start. Behind the last one the estimate's variance is within a few per cent of the steady one.
 */
static const uint16_t start_gains_uq16[SYNTH_END_GAIN - SYNTH_FIRST_GAIN] FX_FLASH = {
    34328, 30427, 27307, 24758, 22640, 20852, 19325, 18004, 16852, 15838, 14938, 14135, 13414, 12762, 12171,
    11632, 11139, 10685, 10267, 9881,  9522,  9189,  8878,  8587,  8315,  8060,  7820,  7593,  7380,  7178,
    6987,  6805,  6633,  6470,  6314,  6165,  6024,  5889,  5759,  5635,  5517,  5403,  5294,  5189,  5089,
    4992,  4899,  4809,  4722,  4639,  4558,  4480,  4405,  4332,  4262,  4193,  4127,  4063,
};

void synth_take_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    f->own.synth.r_lsb2_q8 = r_lsb2_q8;
}

void synth_take_noise_and_spread(filter_t *f, uint32_t r_lsb2_q8)
{
    uint16_t noise_lsb = (uint16_t)((fx_isqrt32(36U * r_lsb2_q8) >> 4) + 1U); /* 6 sigma, rounded up: <= 190 */
    uint16_t motion_lsb = (uint16_t)(20U * MOTION_LSB_S / f->rate_dhz);       /* two samples; <= 320 */
    uint16_t spread_lsb = (uint16_t)(noise_lsb + motion_lsb);
    f->own.synth.spread_lsb = (spread_lsb > SPREAD_MAX_LSB) ? SPREAD_MAX_LSB : (int16_t)spread_lsb;
    synth_take_noise(f, r_lsb2_q8);
}

/*
 * The line of least squares through the start samples, each limited to the median -+ spread, so that an outlier among
 * them costs no more than a large error of measurement. With d the deviations from the median: mean in the middle of the
 * line, slope (-2, -1, 0, 1, 2) d / 10. The line ends within 7/5 x 365 < 512 LSB of the median, hence within the bound.
 * 65536 / 5 is rounded: 2 in 10^5 of the deviation. Returns its end less the median.
 */
static int32_t fit_line(filter_t *f)
{
    const int16_t *seen_lsb = f->own.start.seen_lsb;
    int16_t median_lsb = f->own.start.ascending_lsb[FILTER_WARM_UP_SAMPLES / 2];
    int16_t spread_lsb = f->own.synth.spread_lsb;
    int16_t sum = 0;
    int16_t above = 0; /* sums of what has come so far: the slope is their sum less twice what all have */
    for (uint8_t left = FILTER_WARM_UP_SAMPLES; left != 0U; left--) {
        int16_t off_lsb = (int16_t)(*seen_lsb++ - median_lsb);
        if (off_lsb > spread_lsb) {
            off_lsb = spread_lsb;
        } else if (off_lsb < -spread_lsb) {
            off_lsb = (int16_t)-spread_lsb;
        }
        above = (int16_t)(above + sum);
        sum = (int16_t)(sum + off_lsb);
    }
    f->rate_lsb = (int32_t)(int16_t)(2 * sum - above) * 6554;
    return (int32_t)sum * 13107 + 2 * f->rate_lsb;
}

void synth_start(filter_t *f, bool settled)
{
    filter_synth_t *s = &f->own.synth;
    int32_t ahead_lsb_q16 = 0;
    if (!settled && s->spread_lsb != 0) {
        ahead_lsb_q16 = fit_line(f);
    }
    s->ahead_lsb_q16 = ahead_lsb_q16; /* the estimate of the last start sample is still the median */
    s->rate_before_lsb_q16 = f->rate_lsb;
    s->memory_lsb_q16 = 0;
    s->count = settled ? (uint8_t)SYNTH_STEADY : (uint8_t)SYNTH_FIRST_GAIN;
}

void synth_take_line(filter_t *f)
{
    f->x_lsb_q16 += f->own.synth.ahead_lsb_q16;
    f->own.synth.ahead_lsb_q16 = 0;
}

uint16_t synth_next_gain_uq16(filter_t *f)
{
    filter_synth_t *s = &f->own.synth;
    if (s->count < (uint8_t)SYNTH_END_GAIN) {
        uint16_t gain_uq16 = fx_flash_u16(&start_gains_uq16[s->count - (uint8_t)SYNTH_FIRST_GAIN]);
        s->count++;
        if (gain_uq16 > s->b0_uq16) {
            return gain_uq16;
        }
    }
    s->count = SYNTH_STEADY;
    return s->b0_uq16;
}

void synth_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    int32_t x1 = f->x_lsb_q16;
    int32_t x = tracker_bounded(f, x1 + f->rate_lsb);
    if (what != STEP_MISSING) {
        int32_t innovation = (int32_t)z_lsb * 65536 - x;
        f->negative = innovation < 0;
        f->size_lsb_uq16 = fx_abs32(innovation);
        x += fx_scale_uq16(innovation, f->gain_uq16);
    }
    f->x_lsb_q16 = x;
    f->rate_lsb = x - x1;
}

void synth_bend_by(filter_t *f, uint16_t a1_uq16)
{
    filter_synth_t *s = &f->own.synth;
    int32_t bend = f->rate_lsb - s->rate_before_lsb_q16; /* x1 - 2 x2 + x3 < 18432 LSB */
    FX_FENCE();
    s->rate_before_lsb_q16 = f->rate_lsb;
    FX_FENCE();
    bend = fx_scale_uq16(bend, a1_uq16);
    FX_FENCE();
    if (s->a1_negative) {
        f->rate_lsb += bend;
    } else {
        f->rate_lsb -= bend;
    }
}

void synth_damp(filter_t *f)
{
    f->own.synth.rate_before_lsb_q16 >>= 1;
}

/* More than three sigmas of a sample: both squares in UQ16.16, 9 R < 2^14. */
static bool rate_counts(const filter_t *f)
{
    uint32_t size_lsb_uq8 = fx_abs32(f->rate_lsb) >> 8;
    uint16_t size = (uint16_t)size_lsb_uq8;
    return (size_lsb_uq8 >> 16) != 0U || fx_product_u16(size, size) > (9U * f->own.synth.r_lsb2_q8) << 8;
}

void synth_fade(filter_t *f, bool first)
{
    if (!first) {
        synth_damp(f);
    } else if (!rate_counts(f)) {
        f->rate_lsb = 0;
        f->own.synth.rate_before_lsb_q16 = 0;
    }
}

uint32_t synth_variance_lsb2_q8(const filter_t *f, uint32_t noise_gain_uq16)
{
    fx_scaled_t p = fx_scaled_mul(fx_scaled(noise_gain_uq16), fx_scaled(f->own.synth.r_lsb2_q8));
    p.exponent = (int8_t)(p.exponent - 16);
    return fx_scaled_fixed(p, 0);
}
