/*
 * auto: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * Its three members with gates, restarts and scores in double, for each gap: back after 10 at most (a gap of 5).
 */
#include "support/law_facts.h"

/* auto.c: every member within its formats, memories between 3.3 and 512 samples, scores of squares within 8 sigmas. */
static const char *broken_member(const filter_t *f, const filter_member_t *m)
{
    if (filter_fx_abs32(m->x_lsb_q16) > X_MAX_Q16) {
        return "x of a member";
    }
    if (filter_fx_abs32(m->rate_lsb_q16) > f->rate_max_lsb) {
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

const char *broken_auto(const filter_t *f)
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

law_facts_t law_facts_auto(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) USUAL, REFUSES,
                          SETTLES_IN(10), .restarts = true, .switches = true };
}
