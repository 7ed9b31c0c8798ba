/* The step and the start of the synthesised filters: see synth_common.h. */
#include "synth_common.h"

#include "filter_common.h"
#include "fx.h"

/* Twice this is how far two samples' motion may carry a start sample from the median: 800 LSB/s, as sprf's ratemax. */
#define MOTION_LSB_S 800U
/* With this the line through the start samples ends within the bound of the format, see fit_line. */
#define SPREAD_MAX_LSB 365

#define SYNTH_X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

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

void synth_begin(synth_core_t *c, size_t size)
{
    filter_zero(c, size);
    c->flags = FILTER_WARMING_UP;
}

void synth_take_noise(synth_core_t *c, uint32_t r_lsb2_q8)
{
    c->r_lsb2_q8 = filter_limited_r_lsb2_q8(r_lsb2_q8);
}

void synth_spread_of_rate(synth_spread_t *spread, uint16_t rate_dhz)
{
    spread->motion_lsb = (uint16_t)(20U * MOTION_LSB_S / rate_dhz); /* two samples; <= 320 */
}

void synth_take_noise_and_spread(synth_core_t *c, synth_spread_t *spread, uint32_t r_lsb2_q8)
{
    synth_take_noise(c, r_lsb2_q8);
    uint16_t noise_lsb = (uint16_t)((fx_isqrt32(36U * c->r_lsb2_q8) >> 4) + 1U); /* 6 sigma, rounded up: <= 190 */
    uint16_t spread_lsb = (uint16_t)(noise_lsb + spread->motion_lsb);
    spread->spread_lsb = (spread_lsb > SPREAD_MAX_LSB) ? SPREAD_MAX_LSB : (int16_t)spread_lsb;
}

/*
 * Within the bound of the format; looked for in the high word, so that 4608 LSB and a fraction count as 4608. True when
 * it was outside.
 */
FX_INLINE bool limit_x(int32_t *x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)*x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        *x_lsb_q16 = (*x_lsb_q16 < 0) ? -SYNTH_X_MAX_LSB_Q16 : SYNTH_X_MAX_LSB_Q16;
        return true;
    }
    return false;
}

FX_NOINLINE void all_at(synth_core_t *c, int32_t x_lsb_q16)
{
    c->u.run.x_lsb_q16[0] = x_lsb_q16;
    c->u.run.x_lsb_q16[1] = x_lsb_q16;
    c->u.run.x_lsb_q16[2] = x_lsb_q16;
}

FX_ONCE void synth_at_rest(synth_core_t *c, int16_t z0_lsb)
{
    all_at(c, (int32_t)filter_clamp_z(z0_lsb) * 65536);
    c->innovation_lsb_q16 = 0;
    c->gain_uq16 = 0;
    c->collected = SYNTH_STEADY;
    c->flags = 0;
}

/* Deviation of a start sample from the median, limited. */
FX_INLINE int16_t deviation_lsb(const synth_core_t *c, uint8_t i, int16_t median_lsb, int16_t spread_lsb)
{
    int16_t off_lsb = (int16_t)(c->u.start.seen_lsb[i] - median_lsb);
    if (off_lsb > spread_lsb) {
        return spread_lsb;
    }
    return (off_lsb < -spread_lsb) ? (int16_t)-spread_lsb : off_lsb;
}

/*
 * The line of least squares through the start samples, each limited to the median -+ spread, so that an outlier among
 * them costs no more than a large error of measurement. With d the deviations from the median: mean in the middle of
 * the line, slope (-2, -1, 0, 1, 2) d / 10. The line ends within 7/5 x 365 < 512 LSB of the median, hence within the
 * bound. 65536 / 5 is rounded: 2 in 10^5 of the deviation. Returns the median.
 */
FX_NOINLINE int32_t fit_line(synth_core_t *c, int16_t spread_lsb)
{
    int16_t median_lsb = c->u.start.ascending_lsb[FILTER_WARM_UP_SAMPLES / 2];
    int16_t sum = deviation_lsb(c, 0, median_lsb, spread_lsb);
    int16_t rise = (int16_t)-sum;
    int16_t second = deviation_lsb(c, 1, median_lsb, spread_lsb);
    sum = (int16_t)(sum + second);
    rise = (int16_t)(rise + rise - second);
    sum = (int16_t)(sum + deviation_lsb(c, 2, median_lsb, spread_lsb));
    int16_t fourth = deviation_lsb(c, 3, median_lsb, spread_lsb);
    sum = (int16_t)(sum + fourth);
    int16_t fifth = deviation_lsb(c, 4, median_lsb, spread_lsb);
    sum = (int16_t)(sum + fifth);
    rise = (int16_t)(rise + fourth + fifth + fifth);
    int32_t median_q16 = (int32_t)median_lsb * 65536;
    int32_t x = median_q16 + (int32_t)sum * 13107;
    c->u.run.x_lsb_q16[2] = x;
    int32_t slope = (int32_t)rise * 6554;
    x += slope;
    c->u.run.x_lsb_q16[1] = x;
    x += slope;
    c->u.run.x_lsb_q16[0] = x;
    c->u.run.median_lsb_q16 = median_q16;
    return median_q16;
}

/* All at the median of the start samples. Returns it. */
FX_NOINLINE int32_t fit_median(synth_core_t *c)
{
    int32_t median_q16 = (int32_t)c->u.start.ascending_lsb[FILTER_WARM_UP_SAMPLES / 2] * 65536;
    all_at(c, median_q16);
    c->u.run.median_lsb_q16 = median_q16;
    return median_q16;
}

FX_ONCE int32_t synth_warm_up(synth_core_t *c, int16_t z_lsb, const synth_spread_t *spread)
{
    c->flags = FILTER_WARMING_UP;
    uint8_t count = c->collected;
    c->u.start.seen_lsb[count] = z_lsb;
    filter_warm_up_insert(c->u.start.ascending_lsb, count, z_lsb);
    count++;
    c->collected = count;
    if (count != FILTER_WARM_UP_SAMPLES) {
        return filter_warm_up_median_q16(c->u.start.ascending_lsb, count);
    }
    if (spread != NULL) {
        return fit_line(c, spread->spread_lsb);
    }
    return fit_median(c);
}

FX_ONCE int32_t synth_estimate(const synth_core_t *c)
{
    if (c->collected >= FILTER_WARM_UP_SAMPLES) {
        return ((c->flags & FILTER_WARMING_UP) != 0U) ? c->u.run.median_lsb_q16 : c->u.run.x_lsb_q16[0];
    }
    return (c->collected == 0U) ? 0 : filter_warm_up_median_q16(c->u.start.ascending_lsb, c->collected);
}

FX_ONCE uint16_t synth_next_gain_uq16(synth_core_t *c, uint16_t b0_uq16)
{
    if (c->collected != SYNTH_STEADY) {
        uint16_t gain_uq16 = 0;
        if (c->collected < (uint8_t)SYNTH_END_GAIN) {
            gain_uq16 = fx_flash_u16(&start_gains_uq16[c->collected - (uint8_t)SYNTH_FIRST_GAIN]);
            c->collected++;
        }
        if (gain_uq16 > b0_uq16) {
            return gain_uq16;
        }
        c->collected = SYNTH_STEADY;
    }
    return b0_uq16;
}

FX_ONCE int32_t synth_scaled(int32_t v, uint16_t factor_uq16)
{
    return fx_scale_uq16(v, factor_uq16);
}

FX_ONCE int32_t synth_bend(const synth_core_t *c, bool negative)
{
    int32_t bend;
    if (negative) {
        bend = c->u.run.x_lsb_q16[1];
        bend += bend;
        bend = fx_minus(bend, c->u.run.x_lsb_q16, 0);
        return fx_minus(bend, c->u.run.x_lsb_q16, 2);
    }
    bend = fx_plus(c->u.run.x_lsb_q16[0], c->u.run.x_lsb_q16, 2);
    bend = fx_minus(bend, c->u.run.x_lsb_q16, 1);
    return fx_minus(bend, c->u.run.x_lsb_q16, 1);
}

FX_ONCE void synth_extrapolate(synth_core_t *c, int32_t addend_q16)
{
    int32_t expected = addend_q16;
    int32_t x2 = c->u.run.x_lsb_q16[1];
    c->u.run.x_lsb_q16[2] = x2;
    expected -= x2;
    int32_t x1 = c->u.run.x_lsb_q16[0];
    c->u.run.x_lsb_q16[1] = x1;
    expected += x1;
    expected += x1;
    if (limit_x(&expected)) {
        c->flags |= FILTER_SATURATED;
    }
    c->u.run.x_lsb_q16[0] = expected;
}

FX_ONCE int32_t synth_correct(synth_core_t *c, int16_t z_lsb)
{
    int32_t innovation = (int32_t)z_lsb * 65536;
    innovation = fx_minus(innovation, c->u.run.x_lsb_q16, 0);
    c->innovation_lsb_q16 = innovation;
    int32_t x = synth_scaled(innovation, c->gain_uq16);
    FX_FENCE();
    x = fx_plus(x, c->u.run.x_lsb_q16, 0);
    c->u.run.x_lsb_q16[0] = x;
    return x;
}

FX_ONCE bool synth_coasts(synth_core_t *c)
{
    if (c->collected < FILTER_WARM_UP_SAMPLES) {
        c->flags = FILTER_WARMING_UP | FILTER_COASTED;
        return false;
    }
    c->flags = FILTER_COASTED;
    c->innovation_lsb_q16 = 0;
    c->gain_uq16 = 0;
    return true;
}

/* Half way to another, rounded down: within the bound that both have. */
FX_NOINLINE void approach(int32_t *x_lsb_q16, int32_t to_lsb_q16)
{
    *x_lsb_q16 = (*x_lsb_q16 + to_lsb_q16) >> 1;
}

FX_ONCE void synth_core_damp(synth_core_t *c)
{
    if (c->collected >= FILTER_WARM_UP_SAMPLES) {
        approach(&c->u.run.x_lsb_q16[1], c->u.run.x_lsb_q16[0]);
        approach(&c->u.run.x_lsb_q16[2], c->u.run.x_lsb_q16[0]);
    }
}

/* More than three sigmas of a sample: both squares in UQ16.16, 9 R < 2^14. */
FX_INLINE bool rate_counts(const synth_core_t *c)
{
    uint32_t size_lsb_uq8 = fx_abs32(c->u.run.x_lsb_q16[0] - c->u.run.x_lsb_q16[1]) >> 8;
    uint16_t size = (uint16_t)size_lsb_uq8;
    return (size_lsb_uq8 >> 16) != 0U || fx_mul_u16(size, size) > (9U * c->r_lsb2_q8) << 8;
}

FX_ONCE void synth_core_gap(synth_core_t *c)
{
    if (c->collected >= FILTER_WARM_UP_SAMPLES && !rate_counts(c)) {
        all_at(c, c->u.run.x_lsb_q16[0]);
    }
}

FX_ONCE void synth_core_restart(synth_core_t *c)
{
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        c->u.start.seen_lsb[i] = 0;
        c->u.start.ascending_lsb[i] = 0;
    }
    c->innovation_lsb_q16 = 0;
    c->gain_uq16 = 0;
    c->collected = 0;
    c->flags = FILTER_WARMING_UP;
}

FX_ONCE void synth_probe_core(const synth_core_t *c, filter_probe_t *out)
{
    bool running = (c->flags & FILTER_WARMING_UP) == 0U;
    out->x_lsb_q16 = synth_estimate(c);
    out->rate_lsb_q16 = running ? c->u.run.x_lsb_q16[0] - c->u.run.x_lsb_q16[1] : 0;
    out->innovation_lsb_q16 = c->innovation_lsb_q16;
    out->p_lsb2_q8 = c->r_lsb2_q8;
    out->gate_lsb2_q8 = UINT32_MAX;
    out->gain_uq16 = c->gain_uq16;
    out->flags = c->flags;
}

uint32_t synth_variance_lsb2_q8(const synth_core_t *c, uint32_t noise_gain_uq16)
{
    fx_scaled_t p = fx_scaled_mul(fx_scaled(noise_gain_uq16), fx_scaled(c->r_lsb2_q8));
    p.exponent = (int8_t)(p.exponent - 16);
    return fx_scaled_fixed(p, 0);
}
