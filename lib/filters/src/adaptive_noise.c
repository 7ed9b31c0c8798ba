/* What adaptive learns of the noise: see adaptive.c. */
#include "adaptive.h"

/* A mean moved towards a new term by a part of what they differ; exact. */
FX_NOINLINE uint32_t averaged(uint32_t mean_uq24, uint16_t term_uq8, uint16_t from_uq8, uint16_t weight_uq16)
{
    if (term_uq8 < from_uq8) {
        return mean_uq24 - fx_product_u16((uint16_t)(from_uq8 - term_uq8), weight_uq16);
    }
    return mean_uq24 + fx_product_u16((uint16_t)(term_uq8 - from_uq8), weight_uq16);
}

/* The weight halved when as many terms have come as it averages over. */
FX_INLINE void count_term(filter_adaptive_t *a)
{
    if (a->weight_uq16 != a->last_uq16) {
        a->terms--;
        if (a->terms == 0U) {
            a->weight_uq16 >>= 1;
            a->stage = (uint16_t)(a->stage + a->stage);
            a->terms = a->stage;
        }
    }
}

/* The mean of the start. A bad read makes it large: then the largest of so many terms below its half replaces it. */
FX_INLINE uint32_t doubted(filter_adaptive_t *a, uint32_t mean_uq24, uint16_t term_uq8, uint16_t before_uq8)
{
    if (term_uq8 >= before_uq8 >> 1) {
        a->small = 0;
        return mean_uq24;
    }
    if (a->small == 0U || term_uq8 > a->largest_lsb_uq8) {
        a->largest_lsb_uq8 = term_uq8;
    }
    a->small++;
    if (a->small < SMALL_TERMS) {
        return mean_uq24;
    }
    a->small = 0;
    return (uint32_t)a->largest_lsb_uq8 << 16;
}

FX_INLINE bool is_first_term(const filter_adaptive_t *a)
{
    return a->terms == 2U && a->weight_uq16 == WEIGHT_START_UQ16;
}

/* Noise of a sample from |z - 3 z1 + 3 z2 - z3|, limited to 2.48 times the sigma that is expected of it. */
FX_NOINLINE void identify(filter_adaptive_t *a, int16_t newest_lsb, int16_t z_lsb)
{
    int16_t third = (int16_t)(a->history_lsb[0] - newest_lsb);
    third = (int16_t)(third + third + third + z_lsb - a->history_lsb[1]); /* <= 4 x 8191 */
    uint16_t size = (uint16_t)((third < 0) ? -third : third);
    uint16_t term_uq8 = (uint16_t)(((size > 318U) ? 318U : size) << 7); /* sigma below 90 LSB */
    uint16_t mean_uq8 = (uint16_t)(a->third_lsb_uq24 >> 16);
    uint16_t limit_uq8 = UINT16_MAX;
    if (mean_uq8 < 20971U) { /* 3.125 times as large it fits: 2.48 sigma */
        limit_uq8 = (uint16_t)(3U * mean_uq8 + (mean_uq8 >> 3));
    }
    if (term_uq8 > limit_uq8 && a->weight_uq16 < WEIGHT_LIMITED_UQ16) {
        term_uq8 = limit_uq8;
    }
    uint32_t mean = averaged(a->third_lsb_uq24, term_uq8, mean_uq8, a->weight_uq16);
    if (is_first_term(a)) {
        mean = (uint32_t)term_uq8 << 16; /* nothing is left of the R to start from */
    } else if (a->weight_uq16 >= WEIGHT_DOUBTED_UQ16) {
        mean = doubted(a, mean, term_uq8, mean_uq8);
    }
    if ((uint16_t)(mean >> 16) < (uint16_t)(THIRD_MIN_LSB_UQ24 >> 16)) {
        mean = THIRD_MIN_LSB_UQ24;
    }
    a->third_lsb_uq24 = mean;
    if (!a->guarded) {
        a->scatter_lsb_uq24 = fx_product_u16((uint16_t)(mean >> 16), SIGMA_OF_THIRD_UQ16);
    }
    count_term(a);
}

/*
 * Scatter of the innovations from 1.375 |u - mean|, limited to 2.5 times what is expected of it: sqrt(pi / 2) = 1.253
 * makes a mean size a sigma, and a tenth more keeps false alarms rarer than known noise would.
 */
void adaptive_disperse(filter_adaptive_t *a, uint32_t size_lsb_uq16, uint16_t spread_uq8)
{
    int16_t mean = (int16_t)(a->mean_lsb_q24 >> 16);
    int16_t size = (int16_t)adaptive_size_lsb_uq8(size_lsb_uq16);
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
    uint16_t weight = a->weight_uq16;
    if (weight < WEIGHT_SCATTER_UQ16) {
        weight = WEIGHT_SCATTER_UQ16;
    } else if (weight > WEIGHT_SCATTER_START_UQ16) {
        weight = WEIGHT_SCATTER_START_UQ16;
    }
    uint32_t scatter = averaged(a->scatter_lsb_uq24, term_uq8, spread_uq8, weight);
    if ((uint16_t)(scatter >> 16) < (uint16_t)(SCATTER_MIN_LSB_UQ24 >> 16)) {
        scatter = SCATTER_MIN_LSB_UQ24;
    }
    if ((uint16_t)(scatter >> 16) >= (uint16_t)(SCATTER_MAX_LSB_UQ24 >> 16)) {
        scatter = SCATTER_MAX_LSB_UQ24;
    }
    a->scatter_lsb_uq24 = scatter;
}

void adaptive_learn(filter_t *f, int16_t z_lsb)
{
    filter_adaptive_t *a = &f->own.adaptive;
    int16_t newest_lsb = f->previous_lsb;
    if (a->third != 0U && a->filled == 3U) {
        identify(a, newest_lsb, z_lsb);
    }
    a->third ^= a->by_turns;
    a->history_lsb[1] = a->history_lsb[0];
    a->history_lsb[0] = newest_lsb;
    if (a->filled < 3U) {
        a->filled++;
    }
}

void adaptive_set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_adaptive_t *a = &f->own.adaptive;
    if (a->identify && (a->terms != 2U || a->weight_uq16 != WEIGHT_START_UQ16)) {
        return;
    }
    uint16_t sigma_q10 = fx_isqrt32(r_lsb2_q8 << 12);
    sigma_q10 = (sigma_q10 < 110U) ? 110U : sigma_q10; /* as the least R has: the proof knows no roots */
    a->third_lsb_uq24 = fx_product_u16(sigma_q10, THIRD_OF_SIGMA_Q8) << 6; /* within what identify keeps */
    a->scatter_lsb_uq24 = (uint32_t)sigma_q10 << 14;
}

uint32_t adaptive_r_lsb2_q8(const filter_t *f)
{
    uint16_t sigma_uq8 = fx_high_u16((uint16_t)(f->own.adaptive.third_lsb_uq24 >> 16), SIGMA_OF_THIRD_UQ16);
    return tracker_limited_r(fx_product_u16(sigma_uq8, sigma_uq8) >> 8);
}
