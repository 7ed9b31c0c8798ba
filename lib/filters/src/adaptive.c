/*
 * adaptive: fading memory driven by the innovations, guarded against outliers; the future work of paper 000.
 *
 *   x_e = x + v                              straight-line prediction, u = z - x_e
 *   x = x_e + (2 k - k^2) t, v = v + k^2 t   t: the part of u that is used
 *
 * A sample n steps old has weight (1 - k)^n (first-order fading memory): a memory of about 2 / k samples. For noise of
 * sigma s the sigma of the innovation is (1 + k) s, within 6 % up to k = 0.6. When the mean innovation exceeds 2.9 of
 * its sigmas (noise alone: about twice a minute at 100 Hz), k jumps to that of the shortest memory. Below three
 * quarters of that it falls by k^2 / 4 per sample, which lengthens the memory by half a sample, to that of the slowest.
 *
 * Guard: the gate is `guard` sigmas of the innovation. For a sample after one within the gate the magnitude of the mean
 * is added to the sigma, because motion that was followed continues. A sample beyond the gate counts as motion only if
 * the one before it, extrapolated with the estimated rate, is off to the same side too. The part that both agree on is
 * then used, and the memory is shortened. An isolated one is used up to the gate, less the further off it is, and from
 * twice the gate on not at all (a stray). An innovation that exceeds the gate by more than motion explains (an eighth
 * of `ratemax`) is accepted as a jump after `confirm` of samples on the same side. While strays are frequent
 * (adaptive.h) the gate is tighter, so that two bad samples in a row do not pass for motion.
 *
 * Noise, with `identify` on (1): the scatter of the innovations about their mean, from every second sample, each
 * limited to 2.5 times its expected value. Motion that the line does not follow widens it, and with it the gate. It
 * starts from the R configured, or set last before the first sample after the start; later filter_set_noise has no
 * effect, and filter_own_noise_lsb2_q8 returns the R identified. Off (0): always the square root of that R.
 *
 * FILTER_GATED means that the sample is beyond the gate and used in part or not at all, so its gain need not be 0.
 * Noise above 90 LSB counts as 90, a mean innovation above 128 LSB as 128. Reset keeps the identified noise and clears
 * rate, mean innovation and strays; the memory is then the slowest.
 *
 * Scaling:
 *   rate     Q7.24, <= 127 LSB per sample
 *   k        UQ0.32, its upper 16 bits are the gain
 *   sizes    of the innovation, of the part used and of the gate: magnitudes in UQ16, so there is no sign to handle
 *   means    of innovations (Q7.24, positive towards the last one) and of their scatter (UQ8.24): a term is rounded to
 *            2^-8 LSB, the mean moves by the exact product of the difference and the weight
 */
#include "adaptive.h"

LAW_KEEPS_FROM(filter_adaptive_t, scatter_lsb_uq24);

LAW_PARAMETER(guard, "guard\0sigma", 8, 1, 256, 4096, 1152);
LAW_PARAMETER(identify, "identify\0", 0, 0, 0, 1, 1);
LAW_PARAMETER(slow, "slow\0ms", 0, 0, 10, 60000, 500);
LAW_PARAMETER(fast, "fast\0ms", 0, 0, 1, 60000, 0);
LAW_PARAMETER(confirm, "confirm\0ms", 0, 0, 0, 10000, 120);
static const filter_parameter_t *const parameters[] IN_FLASH = {
    &guard, &filter_parameter_r, &identify, &slow, &fast, &confirm, &filter_parameter_ratemax
};

/*
 * One rule for all rates. Shortest memory: 80 ms, a quick turn of the hand, plus two samples, the least that define a
 * line. Slowest: half a second and at least 20 samples. Gate: 3 sigma below 20 Hz, where a motion lasts a few samples
 * and outliers in it cost most; 4.5 from there on, more than a hand moves between samples.
 */
static void standard(filter_config_t *config)
{
    uint16_t rate_dhz = config->rate_dhz;
    if (rate_dhz < 200U) {
        config->value[ADAPTIVE_GUARD_SIGMA_Q8] = 768;
    }
    if (rate_dhz < 400U) {
        config->value[ADAPTIVE_SLOW_MS] = (int32_t)(200000U / rate_dhz);
    }
    config->value[ADAPTIVE_FAST_MS] = (int32_t)80 + (int32_t)(20000U / rate_dhz);
}

/* Largest threshold, in sigmas of one: below 34 Hz, with few samples in the mean, 2.9 of its sigmas is too late. */
#define MANOEUVRE_MAX_UQ16 55378U /* 0.845 */

/* Weights and thresholds derived from the shortest memory. */
static void set_memory(filter_adaptive_t *a, const filter_config_t *config)
{
    a->slow_uq16 = filter_tracker_memory_k_uq16((uint16_t)config->value[ADAPTIVE_SLOW_MS], config->rate_dhz,
                                                ADAPTIVE_K_MIN_UQ16);
    a->fast_uq16 = filter_tracker_memory_k_uq16((uint16_t)config->value[ADAPTIVE_FAST_MS], config->rate_dhz,
                                                a->slow_uq16);
    a->share_uq16 = filter_fx_high_u16(a->fast_uq16, 26214); /* 0.4 */
    /* 2.9 sigma of the mean, whose variance is about share / 2 */
    uint32_t manoeuvre_uq16 = fx_product_u16(filter_fx_isqrt32((uint32_t)a->share_uq16 << 16), 525) >> 8;
    a->manoeuvre_uq16 = (manoeuvre_uq16 > MANOEUVRE_MAX_UQ16) ? MANOEUVRE_MAX_UQ16 : (uint16_t)manoeuvre_uq16;
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_adaptive_t *a = &f->own.adaptive;
    uint16_t guard_sigma_q8 = (uint16_t)config->value[ADAPTIVE_GUARD_SIGMA_Q8];
    a->guarded = guard_sigma_q8 != 0U;
    a->gate_sigma_q8 = a->guarded ? guard_sigma_q8 : ADAPTIVE_UNGUARDED_SIGMA_Q8;
    f->identifies = (uint8_t)config->value[ADAPTIVE_IDENTIFY] != 0U;
    set_memory(a, config);
    uint32_t confirm_samples = (uint32_t)config->value[ADAPTIVE_CONFIRM_MS] * config->rate_dhz / 10000U; /* <= 40000 */
    a->confirm = (confirm_samples < ADAPTIVE_CONFIRM_LEAST) ? ADAPTIVE_CONFIRM_LEAST : (uint16_t)confirm_samples;
    filter_tracker_limit_rate(f, (uint32_t)config->value[ADAPTIVE_RATE_MAX_LSB_S], 24);
    filter_set_noise(f, (uint32_t)config->value[ADAPTIVE_R_LSB2_Q8]);
}

static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_adaptive_t *a = &f->own.adaptive;
    if (a->learnt == 0U) {
        uint32_t sigma_q10 = filter_fx_isqrt32(r_lsb2_q8 << 12); /* 110..32382 */
        a->scatter_lsb_uq24 = sigma_q10 << 14;
    }
}

/* 1.5 variances, as in noise.h: the scatter is 1.375 / sqrt(pi / 2) = 1.097 sigmas, so 1.25 times its square. */
static uint32_t own_noise(const filter_t *f)
{
    uint16_t scatter_uq8 = fx_upper(&f->own.adaptive.scatter_lsb_uq24);
    return f->identifies ? fx_product_u16(scatter_uq8, (uint16_t)(scatter_uq8 + (scatter_uq8 >> 2))) >> 8 : 0U;
}

static void start(filter_t *f, bool settled)
{
    filter_adaptive_t *a = &f->own.adaptive;
    filter_tracker_clear(a, offsetof(filter_adaptive_t, scatter_lsb_uq24));
    f->negative = false;
    f->broken = false;
    a->k_uq32 = settled ? (uint32_t)a->slow_uq16 << 16 : ADAPTIVE_K_START_UQ32;
}

/* The rate per sample in Q16, rounded down as seen from the side of the last innovation. */
static int32_t rate_lsb_q16(const filter_t *f)
{
    int32_t rate = f->rate_lsb >> 8;
    return (f->negative && (uint8_t)(uint32_t)f->rate_lsb != 0U) ? rate + 1 : rate;
}

/* Magnitude of the mean innovation, UQ8.8. */
static uint16_t mean_size_uq8(const filter_adaptive_t *a)
{
    int16_t mean = fx_upper_signed(&a->mean_lsb_q24);
    return (mean < 0) ? (uint16_t)(0U - (uint16_t)mean) : (uint16_t)mean;
}

/* A magnitude in 8.8 bits, limited to 128 LSB. */
static MACHINE_APART int16_t size_lsb_q8(uint32_t size_lsb_uq16)
{
    return (int16_t)((size_lsb_uq16 >= 0x800000U) ? 0x7FFF : (int16_t)(uint16_t)(size_lsb_uq16 >> 8));
}

/* Moves a mean by the weighted difference between a new term and its expected value; exact. */
static uint32_t averaged(uint32_t mean_uq24, uint16_t expected_uq8, uint16_t term_uq8, uint16_t weight_uq16)
{
    if (term_uq8 < expected_uq8) {
        return mean_uq24 - fx_product_u16((uint16_t)(expected_uq8 - term_uq8), weight_uq16);
    }
    return mean_uq24 + fx_product_u16((uint16_t)(term_uq8 - expected_uq8), weight_uq16);
}

/*
 * Adds the used part of an innovation, limited to the gate, to their mean. The mean is signed: flipping the top bit
 * keeps the order of the numbers.
 */
static void average_innovation(filter_adaptive_t *a, uint32_t taken)
{
    uint16_t term = (uint16_t)size_lsb_q8((taken > a->gate_lsb_uq16) ? a->gate_lsb_uq16 : taken);
    uint32_t mean = (uint32_t)a->mean_lsb_q24 ^ 0x80000000U;
    mean = averaged(mean, (uint16_t)(mean >> 16), term ^ 0x8000U, a->share_uq16);
    a->mean_lsb_q24 = (int32_t)(mean ^ 0x80000000U);
}

/*
 * How far the sample before, extrapolated with the rate, was off to the same side; at most the current innovation. 0 if
 * a sample was missing in between.
 */
static uint32_t agreed_lsb_uq16(const filter_t *f, int32_t x1_lsb_q16)
{
    if (f->broken) {
        return 0;
    }
    int32_t before = (int32_t)f->previous_lsb * 65536 - x1_lsb_q16;
    if (f->negative) {
        before = -before;
    }
    if (before < 0) {
        return 0;
    }
    return ((uint32_t)before > f->size_lsb_uq16) ? f->size_lsb_uq16 : (uint32_t)before;
}

/* Counts a sample beyond the gate and decides how much of its innovation is used. */
static uint32_t judge(filter_t *f, int32_t x1_lsb_q16)
{
    filter_adaptive_t *a = &f->own.adaptive;
    if (a->run != UINT16_MAX) {
        a->run++;
    }
    uint32_t agreed = agreed_lsb_uq16(f, x1_lsb_q16);
    uint32_t size = f->size_lsb_uq16;
    uint32_t gate = a->gate_lsb_uq16;
    if (agreed > gate) {
        /* the excess over the gate that motion does not explain */
        uint16_t jump_lsb_uq8 = (uint16_t)(fx_upper(&f->rate_max_lsb) >> 3);
        bool large = size - gate > (uint32_t)jump_lsb_uq8 << 8;
        if (!large || a->run >= a->confirm) {
            a->verdict = large ? ADAPTIVE_JUMP : ADAPTIVE_MOTION;
            return agreed;
        }
        agreed = gate;
    }
    f->flags |= FILTER_GATED;
    uint32_t twice = gate + gate;
    uint32_t left = (size < twice) ? twice - size : 0U;
    agreed = (left > agreed) ? left : agreed;
    a->verdict = ADAPTIVE_OUTLIER;
    if (agreed == 0U) {
        a->verdict = ADAPTIVE_UNUSED;
        a->strays = (a->strays > UINT8_MAX - ADAPTIVE_STRAY) ? UINT8_MAX : (uint8_t)(a->strays + ADAPTIVE_STRAY);
    }
    return agreed;
}

/* Memory after this sample. */
static void adapt(filter_adaptive_t *a, uint16_t spread_uq8)
{
    uint16_t mean_uq8 = mean_size_uq8(a);
    uint16_t threshold_uq8 = filter_fx_high_u16(spread_uq8, a->manoeuvre_uq16);
    uint16_t k = fx_upper(&a->k_uq32);
    if (a->verdict >= (uint8_t)ADAPTIVE_MOTION || mean_uq8 > threshold_uq8) {
        if (k < a->fast_uq16) {
            a->k_uq32 = (uint32_t)a->fast_uq16 << 16;
        }
    } else if (mean_uq8 <= (uint16_t)(threshold_uq8 - (threshold_uq8 >> 2))) {
        k >>= 1;
        uint32_t less = a->k_uq32 - fx_product_u16(k, k); /* k^2 / 4 */
        if ((uint16_t)(less >> 16) < a->slow_uq16) {
            less = (uint32_t)a->slow_uq16 << 16;
        }
        a->k_uq32 = less;
    }
}

/* Changes the rate by at most 127 LSB in the direction of the innovation, within its limit. */
static void turn(filter_t *f, int32_t by_lsb_q24)
{
    int32_t limit = (int32_t)f->rate_max_lsb;
    int32_t rate = f->negative ? -f->rate_lsb : f->rate_lsb;
    rate = (rate > limit - by_lsb_q24) ? limit : rate + by_lsb_q24;
    f->rate_lsb = f->negative ? -rate : rate;
}

/* k w, at most 127 LSB; from w = 128 LSB on to 2^-16. */
static uint32_t turn_lsb_uq24(uint32_t w_lsb_uq16, uint16_t k_uq16)
{
    if (w_lsb_uq16 < 0x800000U) {
        return filter_fx_mul_uq16(w_lsb_uq16 << 8, k_uq16);
    }
    uint32_t kw = filter_fx_mul_uq16(w_lsb_uq16, k_uq16);
    return (kw >= (uint32_t)127 << 16) ? (uint32_t)127 << 24 : kw << 8;
}

/* Of the used magnitude x moves by 2 w - k w, with w = k taken, and the rate changes by k w. */
static void follow(filter_t *f, uint32_t taken)
{
    if (f->own.adaptive.verdict == (uint8_t)ADAPTIVE_JUMP) {
        f->flags |= FILTER_REACQUIRED;
        f->rate_lsb = 0;
    } else {
        uint16_t k = fx_upper(&f->own.adaptive.k_uq32);
        uint32_t w = filter_fx_mul_uq16(taken, k);
        uint32_t kw = turn_lsb_uq24(w, k);
        turn(f, (int32_t)kw);
        taken = w + w - (kw >> 8);
    }
    filter_tracker_move(f, (int32_t)taken);
    f->x_lsb_q16 = tracker_bounded(f, f->x_lsb_q16); /* the limit of the rate may put x a step beyond the sample */
}

/* Gate of this sample. The sigma of its innovation, mean included, is below 256 LSB, so 16 of them are below 4096. */
static uint32_t gate_lsb_uq16(const filter_adaptive_t *a, uint16_t expected_uq8)
{
    uint16_t sigma_q8 = a->gate_sigma_q8;
    if (a->strays > ADAPTIVE_STRAY) {
        if (sigma_q8 > ADAPTIVE_CLOSE_SIGMA_Q8) {
            sigma_q8 = (a->run < ADAPTIVE_TIGHT_RUN) ? ADAPTIVE_TIGHT_SIGMA_Q8 : ADAPTIVE_WIDE_SIGMA_Q8;
        }
    } else if (a->run == 0U) {
        uint16_t mean_uq8 = mean_size_uq8(a);
        uint16_t most_uq8 = (uint16_t)~expected_uq8;
        expected_uq8 = (uint16_t)(expected_uq8 + ((mean_uq8 < most_uq8) ? mean_uq8 : most_uq8));
    }
    return fx_product_u16(expected_uq8, sigma_q8);
}

/* Innovation and gate; returns the sigma of the innovation, LSB. An innovation of 0 keeps its side. */
static uint16_t meet(filter_t *f, int16_t z_lsb)
{
    filter_adaptive_t *a = &f->own.adaptive;
    bool before = f->negative;
    filter_tracker_meet(f, z_lsb);
    if (f->size_lsb_uq16 == 0U) {
        f->negative = before;
    } else if (f->negative != before) {
        a->run = 0;
        a->mean_lsb_q24 = -a->mean_lsb_q24;
    }
    uint16_t spread_uq8 = fx_upper(&a->scatter_lsb_uq24);
    spread_uq8 = (uint16_t)(spread_uq8 + filter_fx_high_u16(spread_uq8, fx_upper(&a->k_uq32)));
    a->gate_lsb_uq16 = gate_lsb_uq16(a, spread_uq8);
    return spread_uq8;
}

/*
 * Scatter of the innovations from 1.375 |u - mean|, limited to 2.5 times its expected value: sqrt(pi / 2) = 1.253 turns
 * a mean magnitude into a sigma, and the extra tenth makes false alarms rarer than with known noise.
 */
static void disperse(filter_adaptive_t *a, uint32_t size_lsb_uq16, uint16_t spread_uq8)
{
    int16_t mean = fx_upper_signed(&a->mean_lsb_q24);
    int16_t size = size_lsb_q8(size_lsb_uq16);
    uint16_t term = (mean > size) ? (uint16_t)(mean - size) : (uint16_t)((uint16_t)size - (uint16_t)mean);
    if (term > 47662U) {
        term = 47662U; /* 1.375 times this fits */
    }
    term = (uint16_t)(term + (term >> 2) + (term >> 3));
    uint16_t weight = a->guarded ? ADAPTIVE_WEIGHT_UQ16 : ADAPTIVE_UNGUARDED_WEIGHT_UQ16;
    if (spread_uq8 < 26214U) { /* else the limit exceeds every term */
        uint16_t limit = (uint16_t)(2U * spread_uq8 + (spread_uq8 >> 1));
        if (term > limit) {
            term = limit;
            weight = ADAPTIVE_WEIGHT_UQ16;
        }
    }
    if (a->learnt < ADAPTIVE_OPENING_TERMS) {
        a->learnt++;
        weight = ADAPTIVE_OPENING_UQ16;
    }
    uint32_t scatter = averaged(a->scatter_lsb_uq24, spread_uq8, term, weight);
    scatter = (scatter < ADAPTIVE_SCATTER_MIN_UQ24) ? ADAPTIVE_SCATTER_MIN_UQ24 : scatter;
    a->scatter_lsb_uq24 = (scatter > ADAPTIVE_SCATTER_MAX_UQ24) ? ADAPTIVE_SCATTER_MAX_UQ24 : scatter;
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_adaptive_t *a = &f->own.adaptive;
    int32_t x1_lsb_q16 = f->x_lsb_q16;
    f->x_lsb_q16 = tracker_bounded(f, x1_lsb_q16 + rate_lsb_q16(f));
    if (what == STEP_MISSING) {
        return;
    }
    uint16_t spread_uq8 = meet(f, z_lsb);
    uint32_t taken = f->size_lsb_uq16;
    if (taken > a->gate_lsb_uq16 && a->guarded) {
        taken = judge(f, x1_lsb_q16);
    } else {
        a->verdict = ADAPTIVE_WITHIN;
        a->run = 0;
        if (a->strays != 0U) {
            a->strays--;
        }
    }
    f->broken = false;
    average_innovation(a, taken);
    adapt(a, spread_uq8);
    follow(f, taken);
    a->turn ^= f->identifies;
    if (a->turn) {
        disperse(a, f->size_lsb_uq16, spread_uq8);
    }
}

/* Gain of the last update; 0 when nothing was used. */
static uint16_t gain_uq16(const filter_t *f)
{
    if ((f->flags & FILTER_COASTED) != 0U || f->own.adaptive.verdict == (uint8_t)ADAPTIVE_UNUSED) {
        return 0;
    }
    uint16_t k = fx_upper(&f->own.adaptive.k_uq32);
    return (uint16_t)(2U * k - filter_fx_high_u16(k, k));
}

/* Variance of the fading memory for samples that scatter as the innovations do. */
static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    uint16_t sigma_uq8 = fx_upper(&a->scatter_lsb_uq24);
    out->p_lsb2_q8 = fx_product_u16(sigma_uq8, sigma_uq8) >> 8;
    if (f->collected != FILTER_RUNNING) {
        return;
    }
    out->p_lsb2_q8 = filter_tracker_fading_variance(out->p_lsb2_q8, fx_upper(&a->k_uq32));
    out->gain_uq16 = gain_uq16(f);
    if (a->guarded && a->gate_lsb_uq16 != 0U) {
        uint16_t gate_uq4 = (uint16_t)(a->gate_lsb_uq16 >> 12); /* < 4096 LSB */
        out->gate_lsb2_q8 = fx_product_u16(gate_uq4, gate_uq4);
    }
}

const filter_law_t filter_law_adaptive IN_FLASH = { .parameter_count = 7,
                                                    .traits = LAW_FINE_RATE | LAW_GATED,
                                                    .worst_cycles = 1300,
                                                    .parameters = parameters,
                                                    .standard = standard,
                                                    .set_up = set_up,
                                                    .set_noise = set_noise,
                                                    .own_noise = own_noise,
                                                    .start = start,
                                                    .step = step,
                                                    .report = LAW_REPORT(report),
                                                    .name = "adaptive" };
