/* What each law of the list promises of its own state, and the tracker of what all share: the bounds. */
#include "kalman.h"
#include "mixture.h"
#include "support/law_facts.h"
#include "wide.h"

#define RATE_MAX_FINE_Q24 ((uint32_t)127 << 24)

bool r_broken(uint32_t r_lsb2_q8, uint32_t max_lsb2_q8)
{
    return r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 || r_lsb2_q8 > max_lsb2_q8;
}

bool running(const filter_t *f)
{
    return f->collected == FILTER_RUNNING;
}

/* kalman.h, "Scaling"; the largest R is a law's own. */
const char *broken_core(const filter_t *f, uint32_t r_max_lsb2_q8)
{
    const filter_kalman_t *k = &f->own.kalman;
    if (k->q22_uq26 < KALMAN_Q22_MIN_UQ26 || k->q22_uq26 > KALMAN_Q22_MAX_UQ26 ||
        k->p22_start_uq26 > KALMAN_Q22_MAX_UQ26) {
        return "q22";
    }
    if (r_broken(k->r_lsb2_q8, r_max_lsb2_q8)) {
        return "r";
    }
    if (running(f) && (k->p.p11 >= 0x34000000U || k->p.p12 >= 0x80000000U || k->p.p22 >= 0x78000000U)) {
        return "P";
    }
    return NULL;
}

/* No gate, so nothing is refused and nothing re-acquired. */
bool gate_shows(const filter_t *f)
{
    return (f->flags & (FILTER_GATED | FILTER_REACQUIRED)) != 0U;
}

/* kalman.h: a run ends with sample number steps + 1; agreement 3 sqrt(2 R) + rate_max < 135 + 4609. */
const char *broken_run(const filter_t *f)
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

/*
 * wide.h: after an update no element of P exceeds P_END; a prediction adds to P11 less than 2 x 128 + 9 (UQ16.16), to
 * P12 less than 9 (UQ8.24), to P22 at most 1 (UQ4.28).
 */
static bool wide_covariance_broken(const filter_wide_t *w)
{
    return w->p.p11 > WIDE_P_END + 0x1090000U || w->p.p12 > WIDE_P_END + 0x9000000U ||
           w->p.p22 > WIDE_P_END + 0x10000000U;
}

const char *broken_wide(const filter_t *f)
{
    const filter_wide_t *w = &f->own.wide;
    if (w->q22_uq28 < WIDE_Q22_MIN_UQ28 || w->q22_uq28 > WIDE_Q22_MAX_UQ28) {
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

/* mixture.c: N^2 - 1 of 3..9999; q within its margin. */
const char *broken_mixture(const filter_t *f)
{
    const filter_mixture_t *m = &f->own.mixture;
    bool learning = law_facts(kind_of(f)).learns;
    if (m->span_uq16 < (3UL << 16) || m->span_uq16 > (9999UL << 16)) {
        return "span";
    }
    if ((m->learnt_from != 0U) != learning || m->learnt_from > 1024U) {
        return "learnt_from";
    }
    if (m->normal_uq24 < MIXTURE_MARGIN_UQ24 || m->normal_uq24 > 0x1000000U - MIXTURE_MARGIN_UQ24 ||
        filter_fx_abs32(m->log_odds_q9) > (uint32_t)7 * 512U) {
        return "q";
    }
    return broken_wide(f);
}

/* tracker.h, filter.h: what all laws have. */
static const char *broken_tracker(const filter_t *f, bool fine, bool difference)
{
    uint32_t most = fine ? RATE_MAX_FINE_Q24 : difference ? 2U * X_MAX_Q16 : X_MAX_Q16;
    if (f->rate_max_lsb > most || filter_fx_abs32(f->rate_lsb) > f->rate_max_lsb) {
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

/* What the probe tells of the state. */
static const char *broken_probe(const filter_t *f, const filter_probe_t *probe, bool gated_means_unused)
{
    if (probe->x_lsb_q16 != f->x_lsb_q16 || probe->flags != f->flags) {
        return "probe";
    }
    if ((probe->flags & FILTER_WARMING_UP) != 0U && probe->rate_lsb_q16 != 0) {
        return "rate while warming up";
    }
    uint8_t unused = gated_means_unused ? FILTER_GATED | FILTER_COASTED : FILTER_COASTED;
    return ((probe->flags & unused) != 0U && probe->gain_uq16 != 0U) ? "gain" : NULL;
}

const char *broken_bound(const filter_t *f, const filter_probe_t *probe, int32_t x_lsb_q16)
{
    filter_kind_t kind = kind_of(f);
    law_facts_t facts = law_facts(kind);
    if (filter_fx_abs32(x_lsb_q16) > X_MAX_Q16) {
        return "x";
    }
    if (x_lsb_q16 != f->x_lsb_q16) {
        return "x returned";
    }
    bool fine = (flash_u8(&f->law->traits) & LAW_FINE_RATE) != 0U;
    const char *broken = broken_probe(f, probe, facts.gated_means_unused);
    broken = (broken != NULL) ? broken : broken_tracker(f, fine, facts.synthesised);
    return (broken != NULL) ? broken : broken_state(f, kind);
}
