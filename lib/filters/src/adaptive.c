/* One sample of the guarded adaptive filter: see adaptive.h for the equations. */
#include "adaptive_scale.h"
#include "filter_common.h"

/* Estimate within its bound, looked for in the high word: 4608 LSB and a fraction count as 4608. */
FX_NOINLINE void limit_x(adaptive_t *f, int32_t x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        f->flags |= FILTER_SATURATED;
        x_lsb_q16 = (x_lsb_q16 < 0) ? -X_MAX_LSB_Q16 : X_MAX_LSB_Q16;
    }
    f->x_lsb_q16 = x_lsb_q16;
}

/* The mean innovation towards `below`, rounded down. */
FX_INLINE int16_t mean_lsb_q8(const adaptive_t *f)
{
    return (int16_t)(f->mean_lsb_q24 >> 16);
}

/* A size of 8.8 bits, limited to 128 LSB. */
FX_INLINE uint16_t size_lsb_uq8(uint32_t size_lsb_uq16)
{
    return (uint16_t)((size_lsb_uq16 >= 0x800000U) ? 0x7FFFU : size_lsb_uq16 >> 8);
}

FX_INLINE void remember(adaptive_t *f, int16_t z_lsb)
{
    f->history_lsb[2] = f->history_lsb[1];
    f->history_lsb[1] = f->history_lsb[0];
    f->history_lsb[0] = z_lsb;
    if (f->filled < 3U) {
        f->filled++;
    }
}

/* A mean moved towards a new term by a part of what they differ; exact. */
FX_NOINLINE uint32_t averaged(uint32_t mean_uq24, uint16_t term_uq8, uint16_t from_uq8, uint16_t weight_uq16)
{
    if (term_uq8 < from_uq8) {
        return mean_uq24 - fx_product_u16((uint16_t)(from_uq8 - term_uq8), weight_uq16);
    }
    return mean_uq24 + fx_product_u16((uint16_t)(term_uq8 - from_uq8), weight_uq16);
}

/* The weight halved when as many terms have come as it averages over. */
FX_INLINE void count_term(adaptive_t *f)
{
    if (f->weight_uq16 != f->last_uq16) {
        f->terms--;
        if (f->terms == 0U) {
            f->weight_uq16 >>= 1;
            f->stage = (uint16_t)(f->stage + f->stage);
            f->terms = f->stage;
        }
    }
}

/* The mean of the start. A bad read makes it large: then the largest of so many terms below its half replaces it. */
FX_INLINE uint32_t doubted(adaptive_t *f, uint32_t mean_uq24, uint16_t term_uq8, uint16_t before_uq8)
{
    if (term_uq8 >= before_uq8 >> 1) {
        f->small = 0;
        return mean_uq24;
    }
    if (f->small == 0U || term_uq8 > f->largest_lsb_uq8) {
        f->largest_lsb_uq8 = term_uq8;
    }
    f->small++;
    if (f->small < SMALL_TERMS) {
        return mean_uq24;
    }
    f->small = 0;
    return (uint32_t)f->largest_lsb_uq8 << 16;
}

FX_INLINE bool is_first_term(const adaptive_t *f)
{
    return f->terms == 2U && f->weight_uq16 == WEIGHT_START_UQ16;
}

/* Noise of a sample from |z - 3 z1 + 3 z2 - z3|, limited to 2.48 times the sigma that is expected of it. */
FX_NOINLINE void identify(adaptive_t *f, int16_t z_lsb)
{
    int16_t third = (int16_t)(f->history_lsb[1] - f->history_lsb[0]);
    third = (int16_t)(third + third + third + z_lsb - f->history_lsb[2]); /* <= 4 x 8191 */
    uint16_t size = (uint16_t)((third < 0) ? -third : third);
    uint16_t term_uq8 = (uint16_t)(((size > 318U) ? 318U : size) << 7); /* sigma below 90 LSB */
    uint16_t mean_uq8 = (uint16_t)(f->third_lsb_uq24 >> 16);
    uint16_t limit_uq8 = UINT16_MAX;
    if (mean_uq8 < 20971U) { /* 3.125 times as large it fits: 2.48 sigma */
        limit_uq8 = (uint16_t)(3U * mean_uq8 + (mean_uq8 >> 3));
    }
    if (term_uq8 > limit_uq8 && f->weight_uq16 < WEIGHT_LIMITED_UQ16) {
        term_uq8 = limit_uq8;
    }
    uint32_t mean = averaged(f->third_lsb_uq24, term_uq8, mean_uq8, f->weight_uq16);
    if (is_first_term(f)) {
        mean = (uint32_t)term_uq8 << 16; /* nothing is left of the R to start from */
    } else if (f->weight_uq16 >= WEIGHT_DOUBTED_UQ16) {
        mean = doubted(f, mean, term_uq8, mean_uq8);
    }
    if ((uint16_t)(mean >> 16) < (uint16_t)(THIRD_MIN_LSB_UQ24 >> 16)) {
        mean = THIRD_MIN_LSB_UQ24;
    }
    f->third_lsb_uq24 = mean;
    if (!f->guarded) {
        f->scatter_lsb_uq24 = fx_product_u16((uint16_t)(mean >> 16), SIGMA_OF_THIRD_UQ16);
    }
    count_term(f);
}

/*
 * Scatter of the innovations from 1.375 |u - mean|, limited to 2.5 times what is expected of it: sqrt(pi / 2) = 1.253
 * makes a mean size a sigma, and a tenth more keeps false alarms rarer than known noise would.
 */
FX_NOINLINE void disperse(adaptive_t *f, uint16_t spread_uq8)
{
    int16_t mean = mean_lsb_q8(f);
    int16_t size = (int16_t)size_lsb_uq8(f->u.run.size_lsb_uq16);
    uint16_t term_uq8 = (mean > size) ? (uint16_t)(mean - size) : (uint16_t)((uint16_t)size - (uint16_t)mean);
    if (term_uq8 > 47662U) {
        term_uq8 = 47662U; /* 1.375 times this fits */
    }
    term_uq8 = (uint16_t)(term_uq8 + (term_uq8 >> 2) + (term_uq8 >> 3));
    uint16_t limit_uq8 = UINT16_MAX;
    if (spread_uq8 < 26214U) {
        limit_uq8 = (uint16_t)(2U * spread_uq8 + (spread_uq8 >> 1));
    }
    if (term_uq8 > limit_uq8) {
        term_uq8 = limit_uq8;
    }
    uint16_t weight = f->weight_uq16;
    if (weight < WEIGHT_SCATTER_UQ16) {
        weight = WEIGHT_SCATTER_UQ16;
    } else if (weight > WEIGHT_SCATTER_START_UQ16) {
        weight = WEIGHT_SCATTER_START_UQ16;
    }
    uint32_t scatter = averaged(f->scatter_lsb_uq24, term_uq8, spread_uq8, weight);
    if ((uint16_t)(scatter >> 16) < (uint16_t)(SCATTER_MIN_LSB_UQ24 >> 16)) {
        scatter = SCATTER_MIN_LSB_UQ24;
    }
    if ((uint16_t)(scatter >> 16) >= (uint16_t)(SCATTER_MAX_LSB_UQ24 >> 16)) {
        scatter = SCATTER_MAX_LSB_UQ24;
    }
    f->scatter_lsb_uq24 = scatter;
}

/* One sample of the start. */
FX_NOINLINE void collect(adaptive_t *f, int16_t z_lsb)
{
    filter_warm_up_insert(f->u.start_lsb, f->collected, z_lsb);
    f->collected++;
    f->x_lsb_q16 = filter_warm_up_median_q16(f->u.start_lsb, f->collected);
    f->flags = FILTER_WARMING_UP;
    if (f->collected == FILTER_WARM_UP_SAMPLES) {
        f->k_uq32 = K_START_UQ32;
        f->u.run.size_lsb_uq16 = 0;
        f->u.run.gate_lsb_uq16 = 0;
    }
}

/* Counts a sample beyond the gate. What the sample before was off in the same direction, carried on with the rate. */
FX_NOINLINE uint32_t agreed_lsb_uq16(adaptive_t *f)
{
    uint16_t run = f->run;
    if (f->verdict == (uint8_t)WITHIN_GATE) {
        run = 0;
    }
    run++;
    if (run != 0U) {
        f->run = run;
    }
    FX_FENCE();
    int32_t before = f->u.run.before_lsb_q16;
    if (f->below) {
        before = -before;
    }
    return (before < 0) ? 0U : (uint32_t)before;
}

/* What is taken of the size of an innovation beyond the gate. */
FX_NOINLINE uint32_t judge(adaptive_t *f, uint32_t size)
{
    uint32_t agreed = agreed_lsb_uq16(f);
    FX_FENCE();
    if (agreed > size) {
        agreed = size;
    }
    uint32_t gate = f->u.run.gate_lsb_uq16;
    if (agreed > gate) {
        bool large = size - gate > (uint32_t)f->jump_lsb_uq8 << 8;
        if (!large || f->run >= f->confirm) {
            f->verdict = large ? JUMP : MOTION;
            return agreed;
        }
        agreed = gate;
    }
    f->flags |= FILTER_GATED;
    f->verdict = OUTLIER;
    uint32_t twice = gate + gate;
    if (size < twice) {
        twice -= size;
        if (twice > agreed) {
            return twice;
        }
    }
    if (agreed == 0U) {
        f->verdict = UNUSED;
    }
    return agreed;
}

/* Innovations in their mean, each limited to the gate. */
FX_INLINE void average_innovation(adaptive_t *f, uint32_t taken)
{
    uint32_t gate = f->u.run.gate_lsb_uq16;
    int16_t limited = (int16_t)size_lsb_uq8((taken > gate) ? gate : taken);
    int16_t mean = mean_lsb_q8(f);
    if (limited < mean) {
        f->mean_lsb_q24 -= (int32_t)fx_product_u16((uint16_t)(mean - limited), f->share_uq16);
    } else {
        f->mean_lsb_q24 += (int32_t)fx_product_u16((uint16_t)((uint16_t)limited - (uint16_t)mean), f->share_uq16);
    }
}

/* Memory after this sample. */
FX_INLINE void adapt(adaptive_t *f, uint16_t spread_uq8)
{
    int16_t mean = mean_lsb_q8(f);
    uint16_t mean_uq8 = (mean < 0) ? (uint16_t)(0U - (uint16_t)mean) : (uint16_t)mean;
    uint16_t threshold_uq8 = (uint16_t)(fx_mul_u16(spread_uq8, f->manoeuvre_uq16) >> 16);
    uint16_t k = (uint16_t)(f->k_uq32 >> 16);
    if (f->verdict >= (uint8_t)MOTION || mean_uq8 > threshold_uq8) {
        if (k < f->fast_uq16) {
            f->k_uq32 = (uint32_t)f->fast_uq16 << 16;
        }
    } else if (mean_uq8 <= (uint16_t)(threshold_uq8 - (threshold_uq8 >> 2))) {
        k >>= 1;
        uint32_t less = f->k_uq32 - fx_mul_u16(k, k); /* k^2 / 4 */
        if ((uint16_t)(less >> 16) < f->slow_uq16) {
            less = (uint32_t)f->slow_uq16 << 16;
        }
        f->k_uq32 = less;
    }
}

/* Rate changed by so much, at most 127 LSB, in the direction of the innovation and within its limit. */
FX_INLINE void turn(adaptive_t *f, int32_t by_lsb_q24)
{
    int32_t limit = f->rate_max_lsb_q24;
    if (f->rate_lsb_q24 > limit - by_lsb_q24) {
        f->rate_lsb_q24 = limit;
    } else {
        f->rate_lsb_q24 += by_lsb_q24;
    }
}

/* k w of a w of 128 LSB and more. */
FX_NOINLINE uint32_t coarse_turn_lsb_uq24(uint32_t w_lsb_uq16, uint16_t k_uq16)
{
    uint32_t kw = fx_times_uq16(w_lsb_uq16, k_uq16);
    return (kw >= (uint32_t)127 << 16) ? (uint32_t)RATE_LIMIT_LSB_Q24 : kw << 8;
}

/* What of the magnitude that is taken x moves by: 2 w - k w with w = k taken; the rate turns by k w. */
FX_INLINE uint32_t gained(adaptive_t *f, uint32_t taken)
{
    uint16_t k = (uint16_t)(f->k_uq32 >> 16);
    uint32_t w = fx_mul24_uq16(taken >> 8, k);
    uint32_t kw = (w >= 0x800000U) ? coarse_turn_lsb_uq24(w, k) : fx_mul24_uq16(w, k);
    FX_FENCE();
    turn(f, (int32_t)kw);
    return w + w - (kw >> 8);
}

/* x moved by so much in the direction of the innovation. */
FX_INLINE void move(adaptive_t *f, uint32_t by_lsb_uq16)
{
    int32_t x = f->x_lsb_q16;
    limit_x(f, f->below ? x - (int32_t)by_lsb_uq16 : x + (int32_t)by_lsb_uq16);
}

/* The innovation's size and direction: rate and mean are kept towards it, so that what follows knows no sign. */
FX_INLINE void face(adaptive_t *f, int16_t z_lsb)
{
    int32_t innovation = (int32_t)z_lsb * 65536 - f->x_lsb_q16;
    bool below = f->below;
    if (innovation < 0) {
        innovation = -innovation;
        below = true;
    } else if (innovation != 0) {
        below = false;
    }
    f->u.run.size_lsb_uq16 = (uint32_t)innovation;
    if (below != f->below) {
        f->below = below;
        f->run = 0;
        f->rate_lsb_q24 = -f->rate_lsb_q24;
        FX_FENCE();
        f->mean_lsb_q24 = -f->mean_lsb_q24;
    }
}

/* Innovation and gate; returns the sigma of the innovation, LSB. */
FX_NOINLINE uint16_t meet(adaptive_t *f, int16_t z_lsb)
{
    f->flags = 0;
    f->u.run.before_lsb_q16 = 0;
    if (f->filled != 0U) {
        f->u.run.before_lsb_q16 = (int32_t)f->history_lsb[0] * 65536 - f->x_lsb_q16;
    }
    FX_FENCE();
    limit_x(f, f->x_lsb_q16 + adaptive_rate_lsb_q16(f));
    FX_FENCE();
    face(f, z_lsb);
    FX_FENCE();
    uint16_t spread_uq8 = (uint16_t)(f->scatter_lsb_uq24 >> 16);
    uint16_t k = (uint16_t)(f->k_uq32 >> 16);
    spread_uq8 = (uint16_t)(spread_uq8 + (uint16_t)(fx_mul_u16(spread_uq8, k) >> 16));
    f->u.run.gate_lsb_uq16 = fx_mul_u16(spread_uq8, f->gate_sigma_q8);
    return spread_uq8;
}

/* Estimate and memory moved by a part of the innovation. */
FX_NOINLINE void follow(adaptive_t *f, uint32_t taken, uint16_t spread_uq8)
{
    average_innovation(f, taken);
    FX_FENCE();
    adapt(f, spread_uq8);
    FX_FENCE();
    if (f->verdict == (uint8_t)JUMP) {
        f->flags |= FILTER_REACQUIRED;
        f->rate_lsb_q24 = 0;
    } else {
        taken = gained(f, taken);
    }
    move(f, taken);
}

/* One sample on. */
FX_INLINE void step(adaptive_t *f, int16_t z_lsb)
{
    uint16_t spread_uq8 = meet(f, z_lsb);
    uint32_t taken = f->u.run.size_lsb_uq16;
    if (f->guarded && taken > f->u.run.gate_lsb_uq16) {
        taken = judge(f, taken);
    } else {
        f->verdict = WITHIN_GATE;
    }
    follow(f, taken, spread_uq8);
    if (f->third == 0U && f->identify) {
        disperse(f, spread_uq8);
    }
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x        Q15.16; |x_e| <= 4608 LSB by a clamp; the update moves it towards a sample within 4096
 *   rate     Q7.24, <= 127 LSB per sample; |u| <= 8704 LSB
 *   k        UQ0.32, its upper 16 bits as the gain
 *   cost     docs/benchmarks.md
 */
int32_t adaptive_update(adaptive_t *f, int16_t z_lsb)
{
    int16_t z = filter_limited_z(z_lsb);
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        collect(f, z);
    } else {
        step(f, z);
    }
    if (f->third != 0U && f->filled == 3U) {
        identify(f, z);
    }
    f->third ^= f->by_turns;
    remember(f, z);
    return f->x_lsb_q16;
}

/* The sample before is missing then: nothing agrees with the next, and no difference is taken across the gap. */
int32_t adaptive_coast(adaptive_t *f)
{
    f->filled = 0;
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        f->flags = FILTER_WARMING_UP | FILTER_COASTED;
        return f->x_lsb_q16;
    }
    f->u.run.size_lsb_uq16 = 0;
    f->flags = FILTER_COASTED;
    limit_x(f, f->x_lsb_q16 + adaptive_rate_lsb_q16(f));
    return f->x_lsb_q16;
}

uint8_t adaptive_flags(const adaptive_t *f)
{
    return f->flags;
}
