/* The synthesised filter: see synth.h for the equations. */
#include "synth.h"

#include "filter_common.h"
#include "fx.h"

/* A lower gain than 0.01 would need more than 16 bits of it: the lag goes with 1 / b0. */
#define B0_MIN_UQ16 656
#define B0_MAX_UQ16 65535
#define A1_MAX_Q16 65535

/* Twice this is how far two samples' motion may carry a start sample from the median: 800 LSB/s, as sprf's ratemax. */
#define MOTION_LSB_S 800U
/* With this the line through the start samples ends within the bound of the format, see fit_start. */
#define SPREAD_MAX_LSB 365

#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)
#define STEADY 255U

static const filter_parameter_t parameters[] FX_FLASH = {
    { "a1", "", offsetof(synth_config_t, a1_q16), 4, 16, 0, 1, -A1_MAX_Q16, A1_MAX_Q16 },
    { "b0", "", offsetof(synth_config_t, b0_uq16), 2, 16, 0, 0, B0_MIN_UQ16, B0_MAX_UQ16 },
    { "r", "LSB2", offsetof(synth_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
};

const filter_descriptor_t synth_descriptor FX_FLASH = { "synth", sizeof parameters / sizeof parameters[0], parameters };

/*
 * Gains of a least-squares line through n samples, (4 n - 2) / (n (n + 1)), n = 6..63, UQ0.16: what the constant gain
 * is raised to after the start. Behind the last one the estimate's variance is within a few per cent of the steady one.
 */
enum { FIRST_GAIN = FILTER_WARM_UP_SAMPLES, END_GAIN = 63 };
static const uint16_t start_gains_uq16[END_GAIN - FIRST_GAIN] FX_FLASH = {
    34328, 30427, 27307, 24758, 22640, 20852, 19325, 18004, 16852, 15838, 14938, 14135, 13414, 12762, 12171,
    11632, 11139, 10685, 10267, 9881,  9522,  9189,  8878,  8587,  8315,  8060,  7820,  7593,  7380,  7178,
    6987,  6805,  6633,  6470,  6314,  6165,  6024,  5889,  5759,  5635,  5517,  5403,  5294,  5189,  5089,
    4992,  4899,  4809,  4722,  4639,  4558,  4480,  4405,  4332,  4262,  4193,  4127,  4063,
};

void synth_defaults(synth_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->b0_uq16 = 19661; /* 0.3 */
    config->a1_q16 = 0;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
}

void synth_paper(synth_config_t *config, uint16_t rate_dhz)
{
    synth_defaults(config, rate_dhz);
    config->b0_uq16 = 6554;  /* 0.1 */
    config->a1_q16 = -19661; /* -0.3 */
}

/* |a1| (1 - b0), UQ0.32, exact. */
static uint32_t memory_uq32(uint16_t b0_uq16, uint16_t a1_uq16)
{
    return fx_mul_u16(a1_uq16, (uint16_t)(0U - b0_uq16));
}

/* (4 - 3 b0) / 4, UQ0.32, exact. */
static uint32_t margin_uq32(uint16_t b0_uq16)
{
    return (0x40000U - 3U * (uint32_t)b0_uq16) << 14;
}

static uint16_t magnitude(int32_t a1_q16)
{
    return (uint16_t)fx_abs32(a1_q16);
}

/*
 * 1 + 2 a1 (1 - b0) > 0 in exact integers. The region's other border lies outside the ranges of the parameters: with a1
 * < 1 and 0 < b0 < 1, 4 - 3 b0 - 4 a1 (1 - b0) > 4 - 3 b0 - 4 (1 - b0) = b0 > 0.
 */
static bool stable(uint16_t b0_uq16, int32_t a1_q16)
{
    return a1_q16 >= 0 || memory_uq32(b0_uq16, magnitude(a1_q16)) < 0x80000000U;
}

/*
 * (2 - b0 - 2 ac (b0 + ac)) / ((1 + 2 ac) (4 - 3 b0 - 4 ac)), ac = a1 (1 - b0): the stationary variance solved from the
 * closed loop. The factors that vanish on the border of the region are formed exactly.
 */
uint32_t synth_noise_gain_uq16(uint16_t b0_uq16, int32_t a1_q16)
{
    uint32_t memory = memory_uq32(b0_uq16, magnitude(a1_q16)) >> 1; /* |ac|, UQ1.31 */
    uint32_t margin = margin_uq32(b0_uq16) >> 1;
    uint16_t ac_uq16 = (uint16_t)(memory >> 15);
    int32_t ac_q16 = (a1_q16 < 0) ? -(int32_t)ac_uq16 : (int32_t)ac_uq16;
    int32_t sum_q16 = (int32_t)b0_uq16 + ac_q16;
    int32_t product_q16 = (int32_t)fx_mul_uq16(fx_abs32(sum_q16), ac_uq16);
    bool negative = (sum_q16 < 0) != (ac_q16 < 0);
    int32_t above_q16 = 0x20000 - (int32_t)b0_uq16 - (negative ? -2 * product_q16 : 2 * product_q16);
    uint32_t left = (a1_q16 < 0) ? 0x40000000U - memory : 0x40000000U + memory; /* (1 + 2 ac) / 2, UQ1.31 */
    uint32_t right = (a1_q16 < 0) ? margin + memory : margin - memory;          /* (4 - 3 b0 - 4 ac) / 4 */
    fx_scaled_t above = fx_scaled((above_q16 > 0) ? (uint32_t)above_q16 : 1U);
    above.exponent = (int8_t)(above.exponent - 16 - 3);
    fx_scaled_t below = fx_scaled_mul(fx_scaled(left), fx_scaled(right));
    below.exponent = (int8_t)(below.exponent - 62);
    return fx_scaled_fixed(fx_scaled_div(above, below), 16);
}

FX_ONCE bool synth_init(synth_t *f, const synth_config_t *config)
{
    bool legal = filter_common_legal(config->rate_dhz, config->r_lsb2_q8) && config->b0_uq16 >= B0_MIN_UQ16 &&
                 config->a1_q16 >= -A1_MAX_Q16 && config->a1_q16 <= A1_MAX_Q16;
    if (!legal || !stable(config->b0_uq16, config->a1_q16)) {
        return false;
    }
    uint8_t *bytes = (uint8_t *)f;
    for (size_t i = 0; i < sizeof *f; i++) {
        bytes[i] = 0;
    }
    f->a1_uq16 = magnitude(config->a1_q16);
    f->a1_negative = config->a1_q16 < 0;
    f->b0_uq16 = config->b0_uq16;
    f->motion_lsb = (uint16_t)(20U * MOTION_LSB_S / config->rate_dhz); /* two samples; <= 320 */
    f->flags = FILTER_WARMING_UP;
    synth_set_noise(f, config->r_lsb2_q8);
    return true;
}

void synth_set_noise(synth_t *f, uint32_t r_lsb2_q8)
{
    r_lsb2_q8 = filter_limited_r_lsb2_q8(r_lsb2_q8);
    f->r_lsb2_q8 = r_lsb2_q8;
    uint16_t noise_lsb = (uint16_t)((fx_isqrt32(36U * r_lsb2_q8) >> 4) + 1U); /* 6 sigma, rounded up: <= 190 */
    uint16_t spread_lsb = (uint16_t)(noise_lsb + f->motion_lsb);
    f->spread_lsb = (spread_lsb > SPREAD_MAX_LSB) ? SPREAD_MAX_LSB : (int16_t)spread_lsb;
}

/*
 * Within the bound of the format; looked for in the high word, so that 4608 LSB and a fraction count as 4608. True when
 * it was outside.
 */
FX_INLINE bool limit_x(int32_t *x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)*x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        *x_lsb_q16 = (*x_lsb_q16 < 0) ? -X_MAX_LSB_Q16 : X_MAX_LSB_Q16;
        return true;
    }
    return false;
}

FX_ONCE void synth_reset(synth_t *f, int16_t z0_lsb)
{
    int32_t x = (int32_t)filter_clamp_z(z0_lsb) * 65536;
    f->u.run.x_lsb_q16[0] = x;
    f->u.run.x_lsb_q16[1] = x;
    f->u.run.x_lsb_q16[2] = x;
    f->innovation_lsb_q16 = 0;
    f->gain_uq16 = 0;
    f->collected = STEADY;
    f->flags = 0;
}

/* Deviation of a start sample from the median, limited. */
FX_INLINE int16_t deviation_lsb(const synth_t *f, uint8_t i, int16_t median_lsb)
{
    int16_t off_lsb = (int16_t)(f->u.start.seen_lsb[i] - median_lsb);
    if (off_lsb > f->spread_lsb) {
        return f->spread_lsb;
    }
    return (off_lsb < -f->spread_lsb) ? (int16_t)-f->spread_lsb : off_lsb;
}

/*
 * The line of least squares through the start samples, each limited to the median -+ spread, so that an outlier among
 * them costs no more than a large error of measurement. With d the deviations from the median: mean in the middle of
 * the line, slope (-2, -1, 0, 1, 2) d / 10. The line ends within 7/5 x 365 < 512 LSB of the median, hence within the
 * bound. 65536 / 5 is rounded: 2 in 10^5 of the deviation. Returns the median.
 */
FX_NOINLINE int32_t fit_start(synth_t *f)
{
    int16_t median_lsb = f->u.start.ascending_lsb[FILTER_WARM_UP_SAMPLES / 2];
    int16_t sum = deviation_lsb(f, 0, median_lsb);
    int16_t rise = (int16_t)-sum;
    int16_t second = deviation_lsb(f, 1, median_lsb);
    sum = (int16_t)(sum + second);
    rise = (int16_t)(rise + rise - second);
    sum = (int16_t)(sum + deviation_lsb(f, 2, median_lsb));
    int16_t fourth = deviation_lsb(f, 3, median_lsb);
    sum = (int16_t)(sum + fourth);
    int16_t fifth = deviation_lsb(f, 4, median_lsb);
    sum = (int16_t)(sum + fifth);
    rise = (int16_t)(rise + fourth + fifth + fifth);
    int32_t median_q16 = (int32_t)median_lsb * 65536;
    int32_t x = median_q16 + (int32_t)sum * 13107;
    f->u.run.x_lsb_q16[2] = x;
    int32_t slope = (int32_t)rise * 6554;
    x += slope;
    f->u.run.x_lsb_q16[1] = x;
    x += slope;
    f->u.run.x_lsb_q16[0] = x;
    f->u.run.median_lsb_q16 = median_q16;
    return median_q16;
}

/* One sample of the start. Returns the running median. */
FX_NOINLINE int32_t collect(synth_t *f, int16_t z_lsb)
{
    f->flags = FILTER_WARMING_UP;
    uint8_t count = f->collected;
    f->u.start.seen_lsb[count] = z_lsb;
    filter_warm_up_insert(f->u.start.ascending_lsb, count, z_lsb);
    count++;
    f->collected = count;
    if (count == FILTER_WARM_UP_SAMPLES) {
        return fit_start(f);
    }
    return filter_warm_up_median_q16(f->u.start.ascending_lsb, count);
}

/* Estimate in force: the running median while warming up. */
static int32_t estimate(const synth_t *f)
{
    if (f->collected >= FILTER_WARM_UP_SAMPLES) {
        return ((f->flags & FILTER_WARMING_UP) != 0U) ? f->u.run.median_lsb_q16 : f->u.run.x_lsb_q16[0];
    }
    return (f->collected == 0U) ? 0 : filter_warm_up_median_q16(f->u.start.ascending_lsb, f->collected);
}

/* A call of its own for the two products. */
FX_NOINLINE int32_t scaled(int32_t v, uint16_t factor_uq16)
{
    return fx_scale_uq16(v, factor_uq16);
}

/* - a1 (x1 - 2 x2 + x3); 0 while the start's gains are in force: the straight line alone. */
FX_NOINLINE int32_t curvature(const synth_t *f)
{
    if (f->collected != STEADY || f->a1_uq16 == 0U) {
        return 0;
    }
    int32_t bend;
    if (f->a1_negative) {
        bend = fx_plus(f->u.run.x_lsb_q16[0], f->u.run.x_lsb_q16, 2);
        bend = fx_minus(bend, f->u.run.x_lsb_q16, 1);
        bend = fx_minus(bend, f->u.run.x_lsb_q16, 1);
    } else {
        bend = f->u.run.x_lsb_q16[1];
        bend += bend;
        bend = fx_minus(bend, f->u.run.x_lsb_q16, 0);
        bend = fx_minus(bend, f->u.run.x_lsb_q16, 2);
    }
    return scaled(bend, f->a1_uq16);
}

/*
 * The estimates moved on and x_e, limited, in the place of the newest. With every |x| <= 4608 LSB: |2 x1 - x2| <= 13824
 * and |a1 (x1 - 2 x2 + x3)| < 18432, together below 2^31 in Q16.
 */
FX_NOINLINE void extrapolate(synth_t *f, int32_t curvature_q16)
{
    int32_t expected = curvature_q16;
    int32_t x2 = f->u.run.x_lsb_q16[1];
    f->u.run.x_lsb_q16[2] = x2;
    expected -= x2;
    int32_t x1 = f->u.run.x_lsb_q16[0];
    f->u.run.x_lsb_q16[1] = x1;
    expected += x1;
    expected += x1;
    if (limit_x(&expected)) {
        f->flags |= FILTER_SATURATED;
    }
    f->u.run.x_lsb_q16[0] = expected;
}

/* The gain for this sample; the start ends with the first gain of the line's that is not above the steady one. */
FX_INLINE uint16_t next_gain_uq16(synth_t *f)
{
    if (f->collected != STEADY) {
        uint16_t gain_uq16 = 0;
        if (f->collected < (uint8_t)END_GAIN) {
            gain_uq16 = fx_flash_u16(&start_gains_uq16[f->collected - (uint8_t)FIRST_GAIN]);
            f->collected++;
        }
        if (gain_uq16 > f->b0_uq16) {
            return gain_uq16;
        }
        f->collected = STEADY;
    }
    return f->b0_uq16;
}

/* One sample on. */
FX_NOINLINE int32_t step(synth_t *f, int16_t z_lsb)
{
    f->flags = 0;
    f->gain_uq16 = next_gain_uq16(f);
    FX_FENCE();
    extrapolate(f, curvature(f));
    int32_t innovation = (int32_t)z_lsb * 65536;
    innovation = fx_minus(innovation, f->u.run.x_lsb_q16, 0);
    f->innovation_lsb_q16 = innovation;
    int32_t x = scaled(innovation, f->gain_uq16);
    FX_FENCE();
    x = fx_plus(x, f->u.run.x_lsb_q16, 0);
    f->u.run.x_lsb_q16[0] = x;
    return x;
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x        Q15.16; |x_e| <= 4608 LSB by a clamp; the update moves x_e towards a sample within 4096, so |x| <= 4608
 *            and the bound is inductive; |z - x_e| <= 8704 LSB < 2^30 / 2^16
 *   a1, b0   UQ0.16 magnitudes, within 2^-17 of the wanted ones
 *   rounding each product half away from zero to 2^-16 LSB; both together reach the output with the noise gain over
 *            b0^2 of the filter: 0.0002 LSB rms at (-0.3, 0.1). The bound that the tests hold against the double
 *            reference is (1 + |1 - b0|) 2^-17 times the sum of the error's impulse response
 *   cost     docs/benchmarks.md
 */
int32_t synth_update(synth_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        return collect(f, z);
    }
    return step(f, z);
}

int32_t synth_coast(synth_t *f)
{
    int32_t x_lsb_q16;
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        f->flags = FILTER_WARMING_UP;
        x_lsb_q16 = estimate(f);
    } else {
        f->flags = 0;
        f->innovation_lsb_q16 = 0;
        f->gain_uq16 = 0;
        extrapolate(f, curvature(f));
        x_lsb_q16 = f->u.run.x_lsb_q16[0];
    }
    f->flags |= FILTER_COASTED;
    return x_lsb_q16;
}

uint8_t synth_flags(const synth_t *f)
{
    return f->flags;
}

/* The variance is that of one sample until the gain is steady, then R times the noise gain, limited to 32 bits. */
void synth_probe(const synth_t *f, filter_probe_t *out)
{
    bool running = (f->flags & FILTER_WARMING_UP) == 0U;
    out->x_lsb_q16 = estimate(f);
    out->rate_lsb_q16 = running ? f->u.run.x_lsb_q16[0] - f->u.run.x_lsb_q16[1] : 0;
    out->innovation_lsb_q16 = f->innovation_lsb_q16;
    out->p_lsb2_q8 = f->r_lsb2_q8;
    if (f->collected == STEADY) {
        uint32_t noise_gain_uq16 = synth_noise_gain_uq16(f->b0_uq16,
                                                         f->a1_negative ? -(int32_t)f->a1_uq16 : f->a1_uq16);
        fx_scaled_t p = fx_scaled_mul(fx_scaled(noise_gain_uq16), fx_scaled(f->r_lsb2_q8));
        p.exponent = (int8_t)(p.exponent - 16);
        out->p_lsb2_q8 = fx_scaled_fixed(p, 0);
    }
    out->gate_lsb2_q8 = UINT32_MAX;
    out->gain_uq16 = f->gain_uq16;
    out->flags = f->flags;
}
