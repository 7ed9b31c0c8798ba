/* Three fading memories and the choice among them: see auto.h. */
#include "auto_inside.h"

/* A member with a shorter memory than eight samples takes every sample until it has grown to its own. */
#define K_OPEN_UQ16 16384U

/* One sample of the warm-up. */
static int32_t warm_up(auto_t *f, int16_t z_lsb)
{
    filter_warm_up_insert(f->u.start_lsb, f->collected, z_lsb);
    f->collected++;
    int32_t median_q16 = filter_warm_up_median_q16(f->u.start_lsb, f->collected);
    if (!auto_warming_up(f)) {
        auto_all_at(f, median_q16, false);
    }
    f->flags = FILTER_WARMING_UP;
    return median_q16;
}

/* x within its bound by the high word: 4608 LSB and a fraction count as 4608. */
FX_INLINE int32_t within_x(auto_t *f, int32_t x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        x_lsb_q16 = (x_lsb_q16 < 0) ? -AUTO_X_MAX_LSB_Q16 : AUTO_X_MAX_LSB_Q16;
        f->flags |= FILTER_SATURATED;
    }
    return x_lsb_q16;
}

FX_INLINE int32_t within_rate(auto_t *f, int32_t rate_lsb_q16)
{
    if (fx_abs32(rate_lsb_q16) > f->rate_max_lsb_q16) {
        rate_lsb_q16 = (rate_lsb_q16 < 0) ? -(int32_t)f->rate_max_lsb_q16 : (int32_t)f->rate_max_lsb_q16;
        f->flags |= FILTER_SATURATED;
    }
    return rate_lsb_q16;
}

/* One sample on. */
FX_INLINE void predict(auto_t *f, auto_member_t *m)
{
    m->x_lsb_q16 = within_x(f, m->x_lsb_q16 + m->rate_lsb_q16);
}

/* What the update of one member told. */
typedef struct {
    int32_t innovation_lsb_q16;
    uint16_t gain_uq16;
    uint8_t flags;
} answer_t;

/* A sample beyond the gate: one more on its side; the last of a run restarts the member at it. Returns the flag. */
FX_NOINLINE uint8_t refused(auto_member_t *m, bool below, int16_t z_lsb)
{
    int8_t run = m->refused;
    if (below) {
        run = (int8_t)((run < 0) ? run - 1 : -1);
    } else {
        run = (int8_t)((run > 0) ? run + 1 : 1);
    }
    m->refused = run;
    if (run < AUTO_RESTART_SAMPLES && run > -AUTO_RESTART_SAMPLES) {
        return FILTER_GATED;
    }
    m->x_lsb_q16 = (int32_t)z_lsb * 65536;
    m->rate_lsb_q16 = 0;
    m->k_uq16 = AUTO_K_MAX_UQ16;
    m->refused = 0;
    return FILTER_REACQUIRED;
}

/* The member's gains, its memory half a sample longer, its state moved by the innovation. Returns the gain. */
FX_INLINE uint16_t correct(auto_t *f, auto_member_t *m, uint16_t final_k, uint32_t size_lsb_uq8, bool below)
{
    uint16_t k = m->k_uq16;
    uint32_t square_uq32 = fx_mul_u16(k, k);
    uint16_t square_uq16 = (uint16_t)(square_uq32 >> 16);
    uint16_t gain_uq16 = (uint16_t)(k + (uint16_t)(k - square_uq16)); /* <= 0.84 */
    if (k > final_k) {
        k = (uint16_t)(k - (square_uq16 >> 2) - 1U);
        m->k_uq16 = (k > final_k) ? k : final_k;
    }
    FX_FENCE();
    int32_t x_step = (int32_t)fx_mul24_uq16(size_lsb_uq8, gain_uq16);
    m->x_lsb_q16 += below ? -x_step : x_step;
    FX_FENCE();
    int32_t rate_step = (int32_t)fx_mul24_uq24(size_lsb_uq8, square_uq32 >> 8);
    m->rate_lsb_q16 = within_rate(f, m->rate_lsb_q16 + (below ? -rate_step : rate_step));
    return gain_uq16;
}

/* One member one sample on: its score by the innovation, then its state. */
FX_NOINLINE void step(auto_t *f, uint8_t i, int16_t z_lsb, answer_t *a)
{
    auto_member_t *m = &f->u.members[i];
    FX_FENCE_OF(m); /* else computed from i at each use */
    uint16_t final_k = f->final_k_uq16[i];
    predict(f, m);
    int32_t innovation = (int32_t)z_lsb * 65536 - m->x_lsb_q16;
    a->innovation_lsb_q16 = innovation;
    bool below = innovation < 0;
    uint32_t size_lsb_uq8 = fx_abs32(innovation) >> 8;
    FX_FENCE();
    uint16_t bounded = f->eight_sigmas_lsb_uq8;
    if (size_lsb_uq8 < bounded) {
        bounded = (uint16_t)size_lsb_uq8;
    }
    uint32_t square_lsb2_uq8 = fx_mul_u16(bounded, bounded) >> 8;
    m->score_lsb2_uq8 = m->score_lsb2_uq8 - (m->score_lsb2_uq8 >> 3) + square_lsb2_uq8;
    FX_FENCE();
    uint32_t gate_lsb_uq8 = f->gate_lsb_uq8;
    if (i == (uint8_t)AUTO_SLOW) {
        gate_lsb_uq8 += gate_lsb_uq8;
    }
    bool open = m->k_uq16 > K_OPEN_UQ16 && m->k_uq16 > final_k;
    if (size_lsb_uq8 > gate_lsb_uq8 && !open) {
        a->flags = refused(m, below, z_lsb);
        a->gain_uq16 = 0;
        return;
    }
    m->refused = 0;
    a->flags = 0;
    a->gain_uq16 = correct(f, m, final_k, size_lsb_uq8, below);
}

/* The member with the least score, if it lies a thirty-second below that of the one in force. */
static void choose(auto_t *f)
{
    uint8_t best = 0;
    for (uint8_t i = 1; i < (uint8_t)AUTO_MEMBERS; i++) {
        if (f->u.members[i].score_lsb2_uq8 < f->u.members[best].score_lsb2_uq8) {
            best = i;
        }
    }
    uint32_t in_force = f->u.members[f->chosen].score_lsb2_uq8;
    if (f->u.members[best].score_lsb2_uq8 < in_force - (in_force >> 5)) {
        f->chosen = best;
        f->flags |= FILTER_SWITCHED;
    }
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x, rate  Q15.16; |x| <= 4608 LSB by a clamp after the prediction (the update moves x towards a sample within 4096),
 *            |rate| <= rate_max <= 4608 LSB per sample by a clamp after the update; so |u| <= 8704 LSB < 2^30 / 2^16,
 *            and rate + k^2 u <= 4608 + 0.36 x 8704 < 2^15 LSB
 *   k        UQ0.16, 1/256..0.6; gains 2 k - k^2 <= 0.84 in UQ0.16 and k^2 in UQ0.24, each rounded down
 *   u        rounded down to 2^-8 LSB in magnitude, products half away from zero to 2^-16: a member settles where
 *            k^2 u is below 2^-17 LSB, within 0.005 LSB with a memory of 50 samples, 0.3 with 400, 0.5 with 512
 *   score    UQ24.8, eight times the mean: s + l - s / 8 with l <= (8 x 31.63)^2 = 64 R <= 64,000 LSB^2, so
 *            s <= 8 l + 7 counts < 2^27; rounded down by less than a count a sample
 *   gate     UQ24.8 within 2^-8 LSB and 2^-11 of itself: 16 x 2 sigmas of 31.63 LSB are 1,012 LSB
 *   cost     docs/benchmarks.md
 */
int32_t auto_update(auto_t *f, int16_t z_lsb)
{
    int16_t z = filter_limited_z(z_lsb);
    if (auto_warming_up(f)) {
        return warm_up(f, z);
    }
    answer_t answers[AUTO_MEMBERS];
    f->flags = 0;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        step(f, i, z, &answers[i]);
    }
    choose(f);
    f->shown = f->chosen;
    const answer_t *a = &answers[f->shown];
    f->innovation_lsb_q16 = a->innovation_lsb_q16;
    f->gain_uq16 = a->gain_uq16;
    f->flags |= a->flags;
    return f->u.members[f->shown].x_lsb_q16;
}

int32_t auto_coast(auto_t *f)
{
    if (auto_warming_up(f)) {
        f->flags = FILTER_WARMING_UP | FILTER_COASTED;
        return auto_estimate(f);
    }
    f->flags = FILTER_COASTED;
    f->innovation_lsb_q16 = 0;
    f->gain_uq16 = 0;
    f->shown = AUTO_MIDDLE;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        predict(f, &f->u.members[i]);
    }
    return f->u.members[AUTO_MIDDLE].x_lsb_q16;
}

/* Two sigmas of its rate, four times that while its memory grows. */
void auto_gap(auto_t *f)
{
    auto_member_t *m = &f->u.members[AUTO_MIDDLE];
    if (auto_warming_up(f)) {
        return;
    }
    uint32_t still_lsb_q16 = fx_product_u16(f->eight_sigmas_lsb_uq8, f->still_uq16) >> 8;
    if (m->k_uq16 > f->final_k_uq16[AUTO_MIDDLE]) {
        still_lsb_q16 <<= 2;
    }
    if (fx_abs32(m->rate_lsb_q16) <= still_lsb_q16) {
        m->rate_lsb_q16 = 0;
    }
}

void auto_damp(auto_t *f)
{
    if (auto_warming_up(f)) {
        return;
    }
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        f->u.members[i].rate_lsb_q16 >>= 1;
    }
}

void auto_hold(auto_t *f)
{
    if (auto_warming_up(f)) {
        return;
    }
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        auto_member_t *m = &f->u.members[i];
        if (m->refused > 1) {
            m->refused = 1;
        } else if (m->refused < -1) {
            m->refused = -1;
        }
    }
}
