/*
 * adaptive: a fading-memory filter whose memory the innovations drive, guarded against outliers. The future work that
 * paper 000 names: noise identified on line, the filter's parameters driven by it.
 *
 *   x_e = x + v                              straight line through the past, u = z - x_e
 *   x = x_e + (2 k - k^2) t, v = v + k^2 t   t: the part of u that is taken
 *
 * weights a sample n steps old by (1 - k)^n (fading memory of the first order): its memory is about 2 / k samples
 * and the innovation's sigma, within 6 % up to k = 0.6, (1 + k) sigma for noise of that sigma. k grows at once to that
 * of the shortest memory when the mean innovation is not explained by noise, and falls by k^2 / 4 a sample, which
 * lengthens the memory by half a sample, to that of the slowest.
 *
 * Guard: a sample further off than `guard` sigmas counts as motion only when the one before it, carried on with the
 * estimated rate, lies off to the same side too; what both agree on is taken and the memory is shortened. An isolated
 * one is taken up to the gate, and the less the further off it is, not at all from twice the gate on. An innovation
 * further beyond the gate than motion explains (an eighth of `ratemax`) is believed after `confirm` of samples on the
 * same side.
 *
 * Noise, with `identify` on (1): sigma of a sample from third differences, which see neither position, rate nor
 * acceleration (it feeds the unguarded filter and the probe), and the scatter of the innovations about their mean (it
 * feeds the guard, because motion that the line does not follow widens it); by turns, a sample each, and each limited
 * to 2.5 times what it is expected to be (3.1 for the differences' mean). R as configured or told by set_noise before
 * the first difference is what both start from, later calls change nothing: a pipeline that estimates an R of its own
 * may go on telling it, and need not. The differences' mean is their first one, unlimited for four; until the
 * sixteenth, six in a row below its half put the largest of them in its place: what one bad read at the start leaves.
 * Below a sigma of 0.5 LSB most differences are 0 and R comes out too small. Off (0): both are the square root of that
 * R, always.
 *
 * FILTER_GATED tells that the sample lies beyond the gate and is taken in part or not at all, so its gain need not be
 * 0. Noise above 90 LSB counts as 90, a mean innovation above 128 LSB as 128. Reset keeps the
 * identified noise and forgets rate, mean innovation and history; the memory is the slowest.
 *
 * Parameters guard, r, identify, slow, fast, confirm, ratemax (at most 127 LSB per sample of it).
 *
 * Scaling:
 *   rate     Q7.24, <= 127 LSB per sample
 *   k        UQ0.32, its upper 16 bits as the gain
 *   sizes    of the innovation, what is taken of it and its gate in UQ16, towards its side: no sign is to be watched
 */
#include "adaptive.h"

/* The mean innovation towards the last one, rounded down. */
FX_INLINE int16_t mean_lsb_q8(const filter_adaptive_t *a)
{
    return (int16_t)(a->mean_lsb_q24 >> 16);
}

/* The rate of one sample, rounded down towards the side of the last innovation. */
FX_INLINE int32_t rate_lsb_q16(const filter_t *f)
{
    return f->negative ? -(-f->rate_lsb >> 8) : f->rate_lsb >> 8;
}

/* What the sample before was off, towards the side of this one, carried on with the rate; 0: there is none. */
static int32_t before_lsb_q16(const filter_t *f)
{
    if (f->own.adaptive.filled == 0U) {
        return 0;
    }
    int32_t before = (int32_t)f->previous_lsb * 65536 - (f->x_lsb_q16 - rate_lsb_q16(f));
    return f->negative ? -before : before;
}

/* Counts a sample beyond the gate, and judges what is taken of its innovation. */
FX_NOINLINE uint32_t judge(filter_t *f)
{
    filter_adaptive_t *a = &f->own.adaptive;
    uint16_t run = (a->verdict == (uint8_t)WITHIN_GATE) ? 0U : a->run;
    run++;
    if (run != 0U) {
        a->run = run;
    }
    uint32_t size = f->size_lsb_uq16;
    int32_t before = before_lsb_q16(f);
    uint32_t agreed = (before < 0) ? 0U : (uint32_t)before;
    if (agreed > size) {
        agreed = size;
    }
    FX_FENCE();
    uint32_t gate = a->gate_lsb_uq16;
    if (agreed > gate) {
        uint16_t jump_lsb_uq8 = (uint16_t)(f->rate_max_lsb >> 19); /* beyond the gate, what motion does not explain */
        bool large = size - gate > (uint32_t)jump_lsb_uq8 << 8;
        if (!large || a->run >= a->confirm) {
            a->verdict = large ? JUMP : MOTION;
            return agreed;
        }
        agreed = gate;
    }
    f->flags |= FILTER_GATED;
    a->verdict = OUTLIER;
    uint32_t twice = gate + gate;
    if (size < twice) {
        twice -= size;
        if (twice > agreed) {
            return twice;
        }
    }
    if (agreed == 0U) {
        a->verdict = UNUSED;
    }
    return agreed;
}

/* Innovations in their mean, each limited to the gate. */
FX_INLINE void average_innovation(filter_adaptive_t *a, uint32_t taken)
{
    uint32_t gate = a->gate_lsb_uq16;
    int16_t limited = (int16_t)adaptive_size_lsb_uq8((taken > gate) ? gate : taken);
    int16_t mean = mean_lsb_q8(a);
    if (limited < mean) {
        a->mean_lsb_q24 -= (int32_t)fx_product_u16((uint16_t)(mean - limited), a->share_uq16);
    } else {
        a->mean_lsb_q24 += (int32_t)fx_product_u16((uint16_t)((uint16_t)limited - (uint16_t)mean), a->share_uq16);
    }
}

/* Memory after this sample. */
FX_INLINE void adapt(filter_adaptive_t *a, uint16_t spread_uq8)
{
    int16_t mean = mean_lsb_q8(a);
    uint16_t mean_uq8 = (mean < 0) ? (uint16_t)(0U - (uint16_t)mean) : (uint16_t)mean;
    uint16_t threshold_uq8 = (uint16_t)(fx_mul_u16(spread_uq8, a->manoeuvre_uq16) >> 16);
    uint16_t k = (uint16_t)(a->k_uq32 >> 16);
    if (a->verdict >= (uint8_t)MOTION || mean_uq8 > threshold_uq8) {
        if (k < a->fast_uq16) {
            a->k_uq32 = (uint32_t)a->fast_uq16 << 16;
        }
    } else if (mean_uq8 <= (uint16_t)(threshold_uq8 - (threshold_uq8 >> 2))) {
        k >>= 1;
        uint32_t less = a->k_uq32 - fx_mul_u16(k, k); /* k^2 / 4 */
        if ((uint16_t)(less >> 16) < a->slow_uq16) {
            less = (uint32_t)a->slow_uq16 << 16;
        }
        a->k_uq32 = less;
    }
}

/* Rate changed by so much, at most 127 LSB, towards the innovation and within its limit. */
FX_INLINE void turn(filter_t *f, int32_t by_lsb_q24)
{
    int32_t limit = (int32_t)f->rate_max_lsb;
    int32_t rate = f->negative ? -f->rate_lsb : f->rate_lsb;
    rate = (rate > limit - by_lsb_q24) ? limit : rate + by_lsb_q24;
    f->rate_lsb = f->negative ? -rate : rate;
}

/* k w of a w of 128 LSB and more. */
FX_NOINLINE uint32_t coarse_turn_lsb_uq24(uint32_t w_lsb_uq16, uint16_t k_uq16)
{
    uint32_t kw = fx_times_uq16(w_lsb_uq16, k_uq16);
    return (kw >= (uint32_t)127 << 16) ? (uint32_t)127 << 24 : kw << 8;
}

/* What of the magnitude that is taken x moves by: 2 w - k w with w = k taken; the rate turns by k w. */
FX_INLINE uint32_t gained(filter_t *f, uint32_t taken)
{
    uint16_t k = (uint16_t)(f->own.adaptive.k_uq32 >> 16);
    uint32_t w = fx_mul24_uq16(taken >> 8, k);
    uint32_t kw = (w >= 0x800000U) ? coarse_turn_lsb_uq24(w, k) : fx_mul24_uq16(w, k);
    FX_FENCE();
    turn(f, (int32_t)kw);
    return w + w - (kw >> 8);
}

/* Innovation and gate; returns the sigma of the innovation, LSB. An innovation of 0 keeps to its side. */
FX_NOINLINE uint16_t meet(filter_t *f, int16_t z_lsb)
{
    filter_adaptive_t *a = &f->own.adaptive;
    bool before = f->negative;
    tracker_meet(f, z_lsb);
    if (f->size_lsb_uq16 == 0U) {
        f->negative = before;
    } else if (f->negative != before) {
        a->run = 0;
        a->mean_lsb_q24 = -a->mean_lsb_q24;
    }
    FX_FENCE();
    uint16_t spread_uq8 = (uint16_t)(a->scatter_lsb_uq24 >> 16);
    spread_uq8 = (uint16_t)(spread_uq8 + (uint16_t)(fx_mul_u16(spread_uq8, (uint16_t)(a->k_uq32 >> 16)) >> 16));
    a->gate_lsb_uq16 = fx_mul_u16(spread_uq8, a->gate_sigma_q8);
    return spread_uq8;
}

/* Estimate and memory moved by a part of the innovation. */
FX_NOINLINE void follow(filter_t *f, uint32_t taken, uint16_t spread_uq8)
{
    filter_adaptive_t *a = &f->own.adaptive;
    average_innovation(a, taken);
    FX_FENCE();
    adapt(a, spread_uq8);
    FX_FENCE();
    if (a->verdict == (uint8_t)JUMP) {
        f->flags |= FILTER_REACQUIRED;
        f->rate_lsb = 0;
    } else {
        taken = gained(f, taken);
    }
    tracker_move(f, (int32_t)taken);
    f->x_lsb_q16 = tracker_bounded(f, f->x_lsb_q16); /* the rate's limit may leave x a step beyond the sample */
}

void adaptive_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_adaptive_t *a = &f->own.adaptive;
    if (f->broken) { /* nothing agrees with the next sample, and no difference is taken across the gap */
        f->broken = false;
        a->filled = 0;
    }
    f->x_lsb_q16 = tracker_bounded(f, f->x_lsb_q16 + rate_lsb_q16(f));
    if (what == STEP_MISSING) {
        return;
    }
    uint16_t spread_uq8 = meet(f, z_lsb);
    uint32_t taken = f->size_lsb_uq16;
    if (a->guarded && taken > a->gate_lsb_uq16) {
        taken = judge(f);
    } else {
        a->verdict = WITHIN_GATE;
    }
    follow(f, taken, spread_uq8);
    if (a->third == 0U && a->identify) {
        adaptive_disperse(a, f->size_lsb_uq16, spread_uq8);
    }
    adaptive_learn(f, z_lsb);
}
