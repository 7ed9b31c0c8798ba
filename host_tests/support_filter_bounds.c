/* What each filter of the list promises of its state: the bounds. */
#include "support_filters.h"

/* two_state.h, "Scaling"; the largest R is a filter's own. */
static const char *broken_core(const two_state_t *s, int32_t x_lsb_q16, uint32_t r_max_lsb2_q8)
{
    if (x_lsb_q16 != s->x_lsb_q16) {
        return "x returned";
    }
    if (s->rate_max_lsb_q16 > (uint32_t)FILTER_X_MAX_LSB << 16 || fx_abs32(s->rate_lsb_q16) > s->rate_max_lsb_q16) {
        return "rate";
    }
    if (s->size_lsb_uq8 > (uint32_t)8704 << 8) {
        return "innovation";
    }
    if (s->q22_uq28 < 16U || s->q22_uq28 > 0x10000000U || s->p22_start_uq28 > 0x10000000U) {
        return "q22";
    }
    if (s->r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 || s->r_lsb2_q8 > r_max_lsb2_q8) {
        return "r";
    }
    if (s->collected > FILTER_WARM_UP_SAMPLES) {
        return "collected";
    }
    if (!two_state_warming_up(s) && (s->u.p.p11_uq28 >= TWO_STATE_P11_END_UQ28 || s->u.p.p12_uq28 >= 0x40000000U ||
                                     s->u.p.p22_uq28 >= 0x30000000U)) {
        return "P";
    }
    return NULL;
}

static const char *broken_two_state(const two_state_t *s, int32_t x_lsb_q16)
{
    return broken_core(s, x_lsb_q16, FILTER_R_MAX_LSB2_Q8);
}

/* reacquire.h: a run ends with sample number steps + 1; agreement 3 sqrt(2 R) + rate_max < 135 + 4609. */
static const char *broken_reacquire(const reacquire_t *a)
{
    if (a->steps > 8U || a->run > ((a->steps == 0U) ? 1U : a->steps) || a->agree_lsb >= 135U + 4609U) {
        return "run";
    }
    if (a->previous_lsb < FILTER_Z_MIN_LSB || a->previous_lsb > FILTER_Z_MAX_LSB) {
        return "previous";
    }
    if (a->first_lsb < FILTER_Z_MIN_LSB || a->first_lsb > FILTER_Z_MAX_LSB) {
        return "first";
    }
    return NULL;
}

static const char *broken_sprf(const sprf_t *f, int32_t x_lsb_q16)
{
    const char *broken = broken_reacquire(&f->again);
    if (f->refused > SPRF_RATE_HELD_SAMPLES) {
        return "refused";
    }
    return (broken != NULL) ? broken : broken_two_state(&f->core, x_lsb_q16);
}

/* synth_common.h: estimates within the format's bound; the output is the newest, or the start's median. */
static const char *broken_synth_estimates(const synth_core_t *c, int32_t x_lsb_q16)
{
    for (uint8_t i = 0; i < 3U; i++) {
        if (fx_abs32(c->u.run.x_lsb_q16[i]) > (uint32_t)FILTER_X_MAX_LSB << 16) {
            return "older x";
        }
    }
    int32_t output = ((c->flags & FILTER_WARMING_UP) != 0U) ? c->u.run.median_lsb_q16 : c->u.run.x_lsb_q16[0];
    return (x_lsb_q16 == output) ? NULL : "x returned";
}

static const char *broken_synth_core(const synth_core_t *c, int32_t x_lsb_q16)
{
    if (fx_abs32(c->innovation_lsb_q16) > (uint32_t)8704 << 16) {
        return "innovation";
    }
    if (c->r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 || c->r_lsb2_q8 > FILTER_R_MAX_LSB2_Q8) {
        return "r";
    }
    if (c->collected >= 64U && c->collected != 255U) {
        return "collected";
    }
    return (c->collected < FILTER_WARM_UP_SAMPLES) ? NULL : broken_synth_estimates(c, x_lsb_q16);
}

/* synth.h: gains as configured, the start's line within its spread. */
static const char *broken_synth(const synth_t *f, int32_t x_lsb_q16)
{
    if (f->spread.spread_lsb <= 0 || f->spread.spread_lsb > 365) {
        return "spread";
    }
    return (f->b0_uq16 < 656U) ? "configuration" : broken_synth_core(&f->core, x_lsb_q16);
}

/* synth_opt.h: the schedule ends with its 12th step; a class of P0 / R; no gain below 1/2 but for a coast. */
static const char *broken_synth_opt(const synth_opt_t *f, int32_t x_lsb_q16)
{
    if (f->ratio_class > 5U || (f->core.collected > 16U && f->core.collected != 255U)) {
        return "schedule";
    }
    bool updated = f->core.collected > FILTER_WARM_UP_SAMPLES && (f->core.flags & FILTER_COASTED) == 0U;
    if (updated && f->core.collected != 255U && f->core.gain_uq16 < 0x8000U) {
        return "gain";
    }
    return broken_synth_core(&f->core, x_lsb_q16);
}

/* synth_plus.h: gains as configured, the memory as limited. */
static const char *broken_synth_plus(const synth_plus_t *f, int32_t x_lsb_q16)
{
    if (f->spread.spread_lsb <= 0 || f->spread.spread_lsb > 365) {
        return "spread";
    }
    if (f->b0_uq16 < 656U || f->k > 8U) {
        return "configuration";
    }
    if (fx_abs32(f->memory_lsb_q16) > (uint32_t)18432 << 16) {
        return "memory";
    }
    return broken_synth_core(&f->core, x_lsb_q16);
}

/* kf.h: no gate, so nothing is refused and nothing re-acquired. */
static const char *broken_kf(const kf_t *f, int32_t x_lsb_q16)
{
    if ((f->core.flags & (FILTER_GATED | FILTER_REACQUIRED)) != 0U) {
        return "flags of a gate";
    }
    return broken_two_state(&f->core, x_lsb_q16);
}

/* lrf.h: R_L / R = N^2 - q1 (N^2 - 1) of 1..1024. */
static const char *broken_lrf(const lrf_t *f, int32_t x_lsb_q16)
{
    if (f->factor_uq16 < 0x10000U || f->factor_uq16 > 1024UL << 16) {
        return "factor";
    }
    return broken_core(&f->core, x_lsb_q16, LRF_R_MAX_LSB2_Q8);
}

/* soft.h: nothing is refused, only a missing sample leaves no gain; re-acquisition as sprf. */
static const char *broken_soft(const soft_t *f, int32_t x_lsb_q16)
{
    const char *broken = broken_reacquire(&f->again);
    bool gated = (f->core.flags & FILTER_GATED) != 0U;
    if (gated && (f->share_uq16 == 0U || f->again.run == 0U)) {
        return "gated";
    }
    return (broken != NULL) ? broken : broken_two_state(&f->core, x_lsb_q16);
}

/*
 * two_state_wide.h, "Scaling": after an update no element of P exceeds P_END; a prediction adds to P11 less than 2 x
 * 128 + 9 (UQ16.16), to P12 less than 9 (UQ8.24), to P22 at most 1 (UQ4.28).
 */
static bool wide_covariance_broken(const two_state_wide_t *s)
{
    return s->u.p.p11_uq16 > TWO_STATE_WIDE_P_END + 0x1090000U || s->u.p.p12_uq24 > TWO_STATE_WIDE_P_END + 0x9000000U ||
           s->u.p.p22_uq28 > TWO_STATE_WIDE_P_END + 0x10000000U;
}

static const char *broken_wide(const two_state_wide_t *s, int32_t x_lsb_q16)
{
    if (x_lsb_q16 != s->x_lsb_q16) {
        return "x returned";
    }
    if (fx_abs32(s->rate_lsb_q16) > (uint32_t)FILTER_X_MAX_LSB << 16) {
        return "rate";
    }
    if (s->size_lsb_uq8 > (uint32_t)8704 << 8) {
        return "innovation";
    }
    if (s->q22_uq28 < TWO_STATE_Q22_MIN_UQ28 || s->q22_uq28 > TWO_STATE_Q22_MAX_UQ28 ||
        s->p22_start_uq28 > TWO_STATE_Q22_MAX_UQ28) {
        return "q22";
    }
    if (s->r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 || s->r_lsb2_q8 > FILTER_R_MAX_LSB2_Q8) {
        return "r";
    }
    if (s->collected > FILTER_WARM_UP_SAMPLES) {
        return "collected";
    }
    if (s->variance != 0U && (fx_places(s->variance) > 15U || s->inverse_uq16 < 0x8000U)) {
        return "S";
    }
    return (!two_state_wide_warming_up(s) && wide_covariance_broken(s)) ? "P" : NULL;
}

/* sprf_paper.h: gate of 1..16 sigma. */
static const char *broken_sprf_paper(const sprf_paper_t *f, int32_t x_lsb_q16)
{
    if (f->gate2_uq8 < 256U || f->gate2_uq8 == UINT16_MAX) {
        return "gate";
    }
    return broken_wide(&f->core, x_lsb_q16);
}

/* mixture.h: N^2 - 1 of 3..9999; q in 0.5..0.999, or learnt within its margin. */
static const char *broken_mixture(const mixture_t *f, bool learning, int32_t x_lsb_q16)
{
    if (f->span_uq16 < (3UL << 16) || f->span_uq16 > (9999UL << 16)) {
        return "span";
    }
    if ((f->learnt_from != 0U) != learning || f->learnt_from > 1024U) {
        return "learnt_from";
    }
    uint32_t margin = learning ? MIXTURE_LEARNT_MARGIN_UQ24 : (uint32_t)(65536UL - MIXTURE_CLEAN_MAX_UQ16) << 8;
    if (f->learnt_uq24 < margin || f->learnt_uq24 > 0x1000000U - margin ||
        fx_abs32(f->log_odds_q9) > (uint32_t)7 * 512U) {
        return "q";
    }
    return broken_wide(&f->core, x_lsb_q16);
}

#define KF3_ONE_UQ28 0x10000000U

/* kf3.h: P11 below 1 after an update; a prediction from P11 < 4 and the rest < 1 ends below 13, 7, 5, 4, 3 and 2. */
static bool kf3_covariance_broken(const kf3_t *f)
{
    uint32_t p11_end = (f->core.gain_uq16 != 0U) ? 1U : 13U;
    const uint32_t elements[] = { f->core.u.p.p11_uq28, f->core.u.p.p12_uq28, f->core.u.p.p22_uq28,
                                  f->p13_uq28,          f->p23_uq28,          f->p33_uq28 };
    const uint32_t ends[] = { p11_end, 7U, 5U, 4U, 3U, 2U };
    for (uint8_t i = 0; i < 6U; i++) {
        if (elements[i] >= ends[i] * KF3_ONE_UQ28) {
            return true;
        }
    }
    return false;
}

/* Drive and R within their ranges. */
static bool kf3_parameters_broken(const kf3_t *f)
{
    uint32_t drive_end = f->fine ? KF3_ONE_UQ28 / 8U : KF3_ONE_UQ28;
    return f->core.q22_uq28 < 16U || f->core.q22_uq28 > drive_end || f->core.r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8 ||
           f->core.r_lsb2_q8 > FILTER_R_MAX_LSB2_Q8;
}

/* kf3.h: no gate; rate and acceleration within the bound of the format. */
static const char *broken_kf3(const kf3_t *f, int32_t x_lsb_q16)
{
    if ((f->core.flags & (FILTER_GATED | FILTER_REACQUIRED)) != 0U) {
        return "flags of a gate";
    }
    if (x_lsb_q16 != f->core.x_lsb_q16) {
        return "x returned";
    }
    if (fx_abs32(f->core.rate_lsb_q16) > (uint32_t)FILTER_X_MAX_LSB << 16 ||
        fx_abs32(f->acceleration_q16) > (uint32_t)FILTER_X_MAX_LSB << 16) {
        return "rate or acceleration";
    }
    if (f->core.size_lsb_uq8 > (uint32_t)8704 << 8) {
        return "innovation";
    }
    if (kf3_parameters_broken(f)) {
        return "q33 or r";
    }
    return (!two_state_warming_up(&f->core) && kf3_covariance_broken(f)) ? "P" : NULL;
}

/* A gate of 16 sigma of 90 LSB times 1.6; before the first step these hold the start. */
static bool broken_adaptive_step(const adaptive_t *f)
{
    return f->collected == FILTER_WARM_UP_SAMPLES &&
           (f->u.run.size_lsb_uq16 > (uint32_t)8704 << 16 || f->u.run.gate_lsb_uq16 > (uint32_t)2305 << 16);
}

static const char *broken_adaptive_memory(const adaptive_t *f)
{
    if (f->slow_uq16 < 32U || f->fast_uq16 < f->slow_uq16 || f->fast_uq16 > 39322U || f->k_uq32 >> 16 > 39322U) {
        return "memory";
    }
    if (f->collected > FILTER_WARM_UP_SAMPLES || f->filled > 3U || f->weight_uq16 < f->last_uq16 || f->confirm < 3U) {
        return "counts";
    }
    return NULL;
}

/* adaptive.h, adaptive.c: state within its formats, noise within the legal R, memory between 3.3 and 4096 samples. */
static const char *broken_adaptive(const adaptive_t *f, int32_t x_lsb_q16)
{
    if (x_lsb_q16 != f->x_lsb_q16) {
        return "x returned";
    }
    if (f->rate_max_lsb_q24 > (int32_t)127 << 24 || fx_abs32(f->rate_lsb_q24) > (uint32_t)f->rate_max_lsb_q24) {
        return "rate";
    }
    if (f->third_lsb_uq24 < 2990500U || f->scatter_lsb_uq24 > 1509949440U) {
        return "noise";
    }
    if (broken_adaptive_step(f)) {
        return "innovation or gate";
    }
    if (fx_abs32(f->mean_lsb_q24) > (uint32_t)128 << 24) {
        return "mean";
    }
    return broken_adaptive_memory(f);
}

/* auto.h: every member within its formats, memories between 3.3 and 512 samples, scores of squares within 8 sigmas. */
static const char *broken_auto_member(const auto_t *f, const auto_member_t *m)
{
    if (fx_abs32(m->x_lsb_q16) > (uint32_t)FILTER_X_MAX_LSB << 16) {
        return "x of a member";
    }
    if (fx_abs32(m->rate_lsb_q16) > f->rate_max_lsb_q16) {
        return "rate";
    }
    if (m->score_lsb2_uq8 > 8U * 64U * FILTER_R_MAX_LSB2_Q8 + 8U) {
        return "score";
    }
    if (m->k_uq16 < 256U || m->k_uq16 > 39322U) {
        return "memory";
    }
    return (m->refused < AUTO_RESTART_SAMPLES && m->refused > -AUTO_RESTART_SAMPLES) ? NULL : "run";
}

static const char *broken_auto(const auto_t *f, int32_t x_lsb_q16)
{
    if (f->chosen >= (uint8_t)AUTO_MEMBERS || f->shown >= (uint8_t)AUTO_MEMBERS) {
        return "member";
    }
    if (f->rate_max_lsb_q16 > (uint32_t)FILTER_X_MAX_LSB << 16 || fx_abs32(f->innovation_lsb_q16) > (uint32_t)8704
                                                                                                        << 16) {
        return "innovation or rate's limit";
    }
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        return NULL;
    }
    const char *broken = NULL;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS && broken == NULL; i++) {
        broken = broken_auto_member(f, &f->u.members[i]);
    }
    bool warming_up = (f->flags & FILTER_WARMING_UP) != 0U;
    return (!warming_up && x_lsb_q16 != f->u.members[f->shown].x_lsb_q16) ? "x returned" : broken;
}

static const char *broken_shrf(const shrf_t *f, int32_t x_lsb_q16)
{
    return broken_mixture(f, false, x_lsb_q16);
}

static const char *broken_pbf(const pbf_t *f, int32_t x_lsb_q16)
{
    return broken_mixture(f, false, x_lsb_q16);
}

static const char *broken_af(const af_t *f, int32_t x_lsb_q16)
{
    return broken_mixture(f, true, x_lsb_q16);
}

/* A filter without a function does not compile. */
static const char *broken_state(const filter_any_t *f, int32_t x_lsb_q16)
{
    switch ((filter_kind_t)f->kind) {
#define BROKEN(F)         \
    case FILTER_KIND_##F: \
        return broken_##F(&f->state.of_##F, x_lsb_q16);
        FILTER_LIST(BROKEN)
#undef BROKEN
    case FILTER_KIND_COUNT:
        break;
    }
    return "kind";
}

const char *broken_bound(const filter_any_t *f, const filter_probe_t *probe, int32_t x_lsb_q16)
{
    if (fx_abs32(x_lsb_q16) > (uint32_t)FILTER_X_MAX_LSB << 16) {
        return "x";
    }
    /* after the last sample of the warm-up the state may be ahead of the median put out */
    bool warming_up = (probe->flags & FILTER_WARMING_UP) != 0U;
    if ((!warming_up && probe->x_lsb_q16 != x_lsb_q16) || probe->flags != filter_any_flags(f)) {
        return "probe";
    }
    if (warming_up && probe->rate_lsb_q16 != 0) {
        return "rate while warming up";
    }
    uint8_t unused = gated_means_unused((filter_kind_t)f->kind) ? FILTER_GATED | FILTER_COASTED : FILTER_COASTED;
    if ((probe->flags & unused) != 0U && probe->gain_uq16 != 0U) {
        return "gain";
    }
    return broken_state(f, x_lsb_q16);
}
