/* What each law of the list promises of its own state, and the tracker of what all share: the bounds. */
#include "adaptive.h"
#include "kalman.h"
#include "mixture.h"
#include "support_filters.h"
#include "synth.h"
#include "wide.h"

#define X_MAX_Q16 ((uint32_t)FILTER_X_MAX_LSB << 16)
#define RATE_MAX_FINE_Q24 ((uint32_t)127 << 24)

static bool r_broken(uint32_t r_lsb2_q8, uint32_t max_lsb2_q8)
{
    return r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 || r_lsb2_q8 > max_lsb2_q8;
}

static bool running(const filter_t *f)
{
    return f->collected == FILTER_RUNNING;
}

/* kalman.h, "Scaling"; the largest R is a law's own. */
static const char *broken_core(const filter_t *f, uint32_t r_max_lsb2_q8)
{
    const filter_kalman_t *k = &f->own.kalman;
    if (k->q22_uq28 < KALMAN_Q22_MIN_UQ28 || k->q22_uq28 > KALMAN_Q22_MAX_UQ28 ||
        k->p22_start_uq28 > KALMAN_Q22_MAX_UQ28) {
        return "q22";
    }
    if (r_broken(k->r_lsb2_q8, r_max_lsb2_q8)) {
        return "r";
    }
    if (running(f) && (k->p.p11 >= 0x80000000U || k->p.p12 >= 0x40000000U || k->p.p22 >= 0x30000000U)) {
        return "P";
    }
    return NULL;
}

/* No gate, so nothing is refused and nothing re-acquired. */
static bool gate_shows(const filter_t *f)
{
    return (f->flags & (FILTER_GATED | FILTER_REACQUIRED)) != 0U;
}

static const char *broken_kf(const filter_t *f)
{
    return gate_shows(f) ? "flags of a gate" : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

/* kf.c: R_L / R = N^2 - q1 (N^2 - 1) of 1..1024, R_L to 65,536 LSB^2. */
static const char *broken_lrf(const filter_t *f)
{
    uint32_t factor_uq16 = f->own.kalman.of.factor_uq16;
    if (gate_shows(f)) {
        return "flags of a gate";
    }
    if (factor_uq16 < 0x10000U || factor_uq16 > 1024UL << 16) {
        return "factor";
    }
    return broken_core(f, 0xFFFFFFU);
}

/* kalman.h: a run ends with sample number steps + 1; agreement 3 sqrt(2 R) + rate_max < 135 + 4609. */
static const char *broken_run(const filter_t *f)
{
    const filter_kalman_t *k = &f->own.kalman;
    if (k->steps > 8U || k->agree_lsb >= 135U + 4609U) {
        return "run's length";
    }
    if (!running(f)) {
        return NULL;
    }
    if (k->run > ((k->steps == 0U) ? 1U : k->steps)) {
        return "run";
    }
    return (k->first_lsb < FILTER_Z_MIN_LSB || k->first_lsb > FILTER_Z_MAX_LSB) ? "first" : NULL;
}

/* sprf.c: counted to five. */
static const char *broken_sprf(const filter_t *f)
{
    const char *broken = broken_run(f);
    if (running(f) && f->own.kalman.refused > 5U) {
        return "refused";
    }
    return (broken != NULL) ? broken : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

/* soft.c: nothing is refused, only a missing sample leaves no gain; re-acquisition as sprf. */
static const char *broken_soft(const filter_t *f)
{
    const char *broken = broken_run(f);
    bool gated = (f->flags & FILTER_GATED) != 0U;
    if (gated && (f->own.kalman.of.gated.share_uq16 == 0U || f->own.kalman.run == 0U)) {
        return "gated";
    }
    return (broken != NULL) ? broken : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

/*
 * wide.h: after an update no element of P exceeds P_END; a prediction adds to P11 less than 2 x 128 + 9 (UQ16.16), to
 * P12 less than 9 (UQ8.24), to P22 at most 1 (UQ4.28).
 */
static bool wide_covariance_broken(const filter_wide_t *w)
{
    return w->p.p11 > WIDE_P_END + 0x1090000U || w->p.p12 > WIDE_P_END + 0x9000000U ||
           w->p.p22 > WIDE_P_END + 0x10000000U;
}

static const char *broken_wide(const filter_t *f)
{
    const filter_wide_t *w = &f->own.wide;
    if (w->q22_uq28 < KALMAN_Q22_MIN_UQ28 || w->q22_uq28 > KALMAN_Q22_MAX_UQ28) {
        return "q22";
    }
    if (r_broken(w->r_lsb2_q8, FILTER_R_MAX_LSB2_Q8)) {
        return "r";
    }
    if (!running(f)) {
        return NULL;
    }
    if (w->variance != 0U && (fx_places(w->variance) > 15U || w->inverse_uq16 < 0x8000U)) {
        return "S";
    }
    return wide_covariance_broken(w) ? "P" : NULL;
}

/* sprf_paper.c: gate of 1..16 sigma. */
static const char *broken_sprf_paper(const filter_t *f)
{
    uint16_t gate2_uq8 = f->own.wide.gate2_uq8;
    return (gate2_uq8 < 256U || gate2_uq8 == UINT16_MAX) ? "gate" : broken_wide(f);
}

/* mixture.c: N^2 - 1 of 3..9999; q in 0.5..0.999, or learnt within its margin. */
static const char *broken_mixture(const filter_t *f)
{
    const filter_mixture_t *m = &f->own.mixture;
    bool learning = law_facts(kind_of(f)).learns;
    if (m->span_uq16 < (3UL << 16) || m->span_uq16 > (9999UL << 16)) {
        return "span";
    }
    if ((m->learnt_from != 0U) != learning || m->learnt_from > 1024U) {
        return "learnt_from";
    }
    /* 1 - q at least 66 of 65536 where it is given */
    uint32_t margin = learning ? MIXTURE_LEARNT_MARGIN_UQ24 : 66UL << 8;
    uint32_t q_uq24 = learning ? m->learnt_uq24 : (uint32_t)m->clean_uq16 << 8;
    if (q_uq24 < margin || q_uq24 > 0x1000000U - margin || fx_abs32(m->log_odds_q9) > (uint32_t)7 * 512U) {
        return "q";
    }
    return broken_wide(f);
}

#define broken_shrf broken_mixture
#define broken_pbf broken_mixture
#define broken_af broken_mixture

/*
 * synth.h: v and v' are x1 - x2 and x2 - x3 of estimates within the bound, and behind damping between them; the line of
 * the start lies ahead of the median until the first step.
 */
static const char *broken_synth_estimates(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    int32_t newest = f->x_lsb_q16 + s->ahead_lsb_q16;
    if (fx_abs32(newest) > X_MAX_Q16 || fx_abs32(newest - f->rate_lsb) > X_MAX_Q16 + 1U) {
        return "older x";
    }
    if (fx_abs32(s->rate_before_lsb_q16) > 2U * X_MAX_Q16) {
        return "oldest x";
    }
    bool steady = s->count == (uint8_t)SYNTH_STEADY;
    return (!steady && (s->count < (uint8_t)SYNTH_FIRST_GAIN || s->count > (uint8_t)SYNTH_END_GAIN)) ? "count" : NULL;
}

static const char *broken_synth_core(const filter_t *f)
{
    if (r_broken(f->own.synth.r_lsb2_q8, FILTER_R_MAX_LSB2_Q8)) {
        return "r";
    }
    return running(f) ? broken_synth_estimates(f) : NULL;
}

/* The start's line within its spread. */
static bool spread_broken(const filter_t *f)
{
    return f->own.synth.spread_lsb <= 0 || f->own.synth.spread_lsb > 365;
}

/* synth.c: gains as configured. */
static const char *broken_synth(const filter_t *f)
{
    if (spread_broken(f)) {
        return "spread";
    }
    return (f->own.synth.b0_uq16 < SYNTH_B0_MIN_UQ16) ? "configuration" : broken_synth_core(f);
}

/* synth_opt.c: the schedule ends with its 12th step; a class of P0 / R; no gain below 1/2 but where none was used. */
static const char *broken_synth_opt(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    bool scheduled = running(f) && s->count != (uint8_t)SYNTH_STEADY;
    if (s->of.scheduled.ratio_class > 5U || (scheduled && s->count > 16U)) {
        return "schedule";
    }
    bool updated = scheduled && s->count > (uint8_t)SYNTH_FIRST_GAIN && (f->flags & FILTER_COASTED) == 0U;
    if (updated && f->gain_uq16 < 0x8000U) {
        return "gain";
    }
    return broken_synth_core(f);
}

/* synth_plus.c: gains as configured, the memory as limited. */
static const char *broken_synth_plus(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    if (spread_broken(f)) {
        return "spread";
    }
    if (s->b0_uq16 < SYNTH_B0_MIN_UQ16 || s->of.plus.k > 8U) {
        return "configuration";
    }
    if (running(f) && fx_abs32(s->memory_lsb_q16) > (uint32_t)18432 << 16) {
        return "memory";
    }
    return broken_synth_core(f);
}

/* kf3.c: P11 below 1 after an update; a prediction from P11 < 4 and the rest < 1 ends below 13, 7, 5, 4, 3 and 2. */
static bool kf3_covariance_broken(const filter_t *f)
{
    const filter_kf3_t *k = &f->own.kf3;
    uint32_t p11_end = (f->gain_uq16 != 0U) ? 1U : 13U;
    const uint32_t elements[] = { k->p.p11, k->p.p12, k->p.p22, k->p13_uq28, k->p23_uq28, k->p33_uq28 };
    const uint32_t ends[] = { p11_end, 7U, 5U, 4U, 3U, 2U };
    for (uint8_t i = 0; i < 6U; i++) {
        if (elements[i] >= ends[i] * KALMAN_ONE_UQ28) {
            return true;
        }
    }
    return false;
}

/* kf3.c: no gate; acceleration within the bound of the format, drive and R within their ranges. */
static const char *broken_kf3(const filter_t *f)
{
    const filter_kf3_t *k = &f->own.kf3;
    if (gate_shows(f)) {
        return "flags of a gate";
    }
    uint32_t drive_end = k->fine ? KALMAN_ONE_UQ28 / 8U : KALMAN_ONE_UQ28;
    if (k->q33_uq28 < 16U || k->q33_uq28 > drive_end || r_broken(k->r_lsb2_q8, FILTER_R_MAX_LSB2_Q8)) {
        return "q33 or r";
    }
    if (!running(f)) {
        return NULL;
    }
    if (fx_abs32(k->acceleration_q16) > X_MAX_Q16) {
        return "acceleration";
    }
    return kf3_covariance_broken(f) ? "P" : NULL;
}

static const char *broken_adaptive_memory(const filter_t *f)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    if (a->slow_uq16 < ADAPTIVE_K_MIN_UQ16 || a->fast_uq16 < a->slow_uq16 || a->fast_uq16 > TRACKER_K_MAX_UQ16) {
        return "memory";
    }
    if (running(f) && a->k_uq32 >> 16 > TRACKER_K_MAX_UQ16) {
        return "memory in force";
    }
    return (a->confirm < ADAPTIVE_CONFIRM_LEAST || a->learnt > ADAPTIVE_OPENING_TERMS) ? "counts" : NULL;
}

/*
 * adaptive.c: a sigma of 0.1 to 90 LSB, memory between 3.3 and 4096 samples, a gate of 16 sigma of 90 LSB times 1.6;
 * mean and gate lie where the samples of the start were.
 */
static const char *broken_adaptive(const filter_t *f)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    if (a->scatter_lsb_uq24 < ADAPTIVE_SCATTER_MIN_UQ24 || a->scatter_lsb_uq24 > ADAPTIVE_SCATTER_MAX_UQ24) {
        return "noise";
    }
    if (running(f) && a->gate_lsb_uq16 > (uint32_t)2305 << 16) {
        return "gate";
    }
    if (running(f) && fx_abs32(a->mean_lsb_q24) > (uint32_t)128 << 24) {
        return "mean";
    }
    return broken_adaptive_memory(f);
}

/* auto.c: every member within its formats, memories between 3.3 and 512 samples, scores of squares within 8 sigmas. */
static const char *broken_member(const filter_t *f, const filter_member_t *m)
{
    if (fx_abs32(m->x_lsb_q16) > X_MAX_Q16) {
        return "x of a member";
    }
    if (fx_abs32(m->rate_lsb_q16) > f->rate_max_lsb) {
        return "rate of a member";
    }
    if (m->score_lsb2_uq8 > 8U * 64U * FILTER_R_MAX_LSB2_Q8 + 8U) {
        return "score";
    }
    if (m->k_uq16 < 256U || m->k_uq16 > TRACKER_K_MAX_UQ16) {
        return "memory";
    }
    return (m->refused < 5 && m->refused > -5) ? NULL : "run";
}

static const char *broken_auto(const filter_t *f)
{
    const filter_auto_t *b = &f->own.bank;
    if (!running(f)) {
        return NULL;
    }
    if (b->chosen >= (uint8_t)AUTO_MEMBERS || b->shown >= (uint8_t)AUTO_MEMBERS) {
        return "member";
    }
    const char *broken = NULL;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS && broken == NULL; i++) {
        broken = broken_member(f, &b->members[i]);
    }
    bool warming_up = (f->flags & FILTER_WARMING_UP) != 0U;
    return (!warming_up && f->x_lsb_q16 != b->members[b->shown].x_lsb_q16) ? "x returned" : broken;
}

/* tracker.h, filter.h: what all laws have. */
static const char *broken_tracker(const filter_t *f, bool fine, bool difference)
{
    uint32_t most = fine ? RATE_MAX_FINE_Q24 : X_MAX_Q16;
    if (f->rate_max_lsb > most || fx_abs32(f->rate_lsb) > (difference ? 2U * X_MAX_Q16 : f->rate_max_lsb)) {
        return "rate";
    }
    if (f->size_lsb_uq16 > (uint32_t)8704 << 16) {
        return "innovation";
    }
    if (f->collected > FILTER_RUNNING || f->quarters > 4U) {
        return "collected";
    }
    if (f->previous_lsb < FILTER_Z_MIN_LSB || f->previous_lsb > FILTER_Z_MAX_LSB) {
        return "previous";
    }
    return NULL;
}

/* A law without a function does not compile. */
static const char *broken_state(const filter_t *f, filter_kind_t kind)
{
    switch (kind) {
#define BROKEN(F)         \
    case FILTER_KIND_##F: \
        return broken_##F(f);
        FILTER_LIST(BROKEN)
#undef BROKEN
    case FILTER_KIND_COUNT:
        break;
    }
    return "kind";
}

const char *broken_bound(const filter_t *f, const filter_probe_t *probe, int32_t x_lsb_q16)
{
    filter_kind_t kind = kind_of(f);
    law_facts_t facts = law_facts(kind);
    if (fx_abs32(x_lsb_q16) > X_MAX_Q16) {
        return "x";
    }
    if (x_lsb_q16 != f->x_lsb_q16) {
        return "x returned";
    }
    bool warming_up = (probe->flags & FILTER_WARMING_UP) != 0U;
    if (probe->x_lsb_q16 != x_lsb_q16 || probe->flags != f->flags) {
        return "probe";
    }
    if (warming_up && probe->rate_lsb_q16 != 0) {
        return "rate while warming up";
    }
    uint8_t unused = facts.gated_means_unused ? FILTER_GATED | FILTER_COASTED : FILTER_COASTED;
    if ((probe->flags & unused) != 0U && probe->gain_uq16 != 0U) {
        return "gain";
    }
    bool fine = (fx_flash_u8(&f->law->traits) & LAW_FINE_RATE) != 0U;
    const char *broken = broken_tracker(f, fine, facts.synthesised);
    return (broken != NULL) ? broken : broken_state(f, kind);
}
