/* pbf, shrf, af: one law with three presets; see law.h. Their report is filter_wide_report. */
#define LOG_ODDS_MAX 11424
#define SPAN_END 655294464
#define MIXED(f) (f)->own.mixture
#define LEARNT(m)                                                                            \
    (-LOG_ODDS_MAX <= (m).log_odds_q9 <= LOG_ODDS_MAX && 32768 <= (m).clean_uq16 <= 65470 && \
     (m).learnt_from <= 1024 && 0x4000 <= (m).normal_uq24 <= 0xFFC000 && (m).leave_uq16 <= 65470)
#define KEPT(f) (WIDE_PARAMETERS(f) && LEARNT(MIXED(f)) && 0x20000 <= MIXED(f).span_uq16 <= SPAN_END)
#define CONFIGURATIONS(law) 13
#include "wide_bounds.h"

#include "mixture.h"

/*@ requires v % 256 <= 31;
    assigns \result \from v;
    ensures \result <= 16480;
*/
static uint16_t log2_uq9(fx_leading_t v);

/*@ requires 0x4000 <= q_uq24 <= 0xFFC000;
    assigns \result \from q_uq24;
    ensures -LOG_ODDS_MAX <= \result <= LOG_ODDS_MAX;
*/
int16_t filter_mixture_log_odds_q9(uint32_t q_uq24);

/*@ requires -32767 <= log_odds_q9;
    assigns \result \from log_odds_q9;
    ensures \result.rest_uq24 <= 0x800000;
    ensures \result.outlier == 0 || \result.outlier == 1;
*/
mixture_posterior_t filter_mixture_posterior(int16_t log_odds_q9);

/*@ requires LEARNT(*m) && 1 <= m->learnt_from;
    requires p <= 0x1000000;
    assigns m->learnt_from, m->normal_uq24, m->log_odds_q9 \from *m, p;
    ensures LEARNT(*m);
*/
static void learn(filter_mixture_t *m, uint32_t p);

#include "mixture.c"

/*@ requires KEPT(f) && WIDE_P(f) && TRACKED(f);
    requires f->own.wide.inverse_uq16 >= 0x8000;
    requires places: S_PLACES(f);
    assigns \result \from f->size_lsb_uq16, f->own;
    ensures \result.p.rest_uq24 <= 0x800000;
    ensures FLAG(\result.p.outlier);
*/
static evidence_t weigh(const filter_t *f);

static void any_own(filter_t *f, uint8_t kind)
{
    filter_mixture_t *m = &f->own.mixture;
    (void)kind;
    any_wide(f);
    m->span_uq16 = ANY_U32(0x20000, SPAN_END);
    m->log_odds_q9 = ANY_S16(-LOG_ODDS_MAX, LOG_ODDS_MAX);
    m->clean_uq16 = ANY_U16(32768, 65470);
    m->learnt_from = ANY_BOOL() ? 0 : ANY_U16(2, 1024);
    m->normal_uq24 = ANY_U32(0x4000, 0xFFC000);
    m->leave_uq16 = ANY_BOOL() ? 0 : ANY_U16(656, 65470);
    m->turn_uq16 = ANY_U16(0, UINT16_MAX);
}

/* The first ratio N of each leading bit of N^2 - 1, and the first beyond the legal ones. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    static const uint16_t ratio_from_q8[] = { 512,  573,  768,  1056,  1471,  2064,  2908,
                                              4104, 5799, 8196, 11589, 16386, 23172, 25601 };
    config->value[MIXTURE_RATIO_UQ8] = ANY_S32(ratio_from_q8[number], ratio_from_q8[number + 1U] - 1);
}

/* By places. */
void proof_log2_uq9(void)
{
    for (uint8_t places = 0; places < 32; places++) {
        (void)log2_uq9((ANY_U32(0x800000, 0xFFFFFF) * 256U) + places);
    }
}

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_filter_mixture_log_odds_q9(void)
{
    (void)filter_mixture_log_odds_q9(ANY_U32(0x4000, 0xFFC000));
}

/* By intervals of the table. */
void proof_filter_mixture_posterior(void)
{
    for (int16_t from = 0; from <= 32512; from += 256) {
        int16_t to = (int16_t)(from + 255);
        (void)filter_mixture_posterior(ANY_S16(from, to));
        (void)filter_mixture_posterior(ANY_S16((int16_t)-to, (int16_t)((from == 0) ? -1 : -from)));
        if (from == 32512) {
            return;
        }
    }
}

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_learn(void)
{
    filter_t f;
    any_own(&f, 0);
    f.own.mixture.learnt_from = ANY_U16(2, 1024);
    learn(&f.own.mixture, ANY_U32(0, 0x1000000));
}

/* By places of S and of N^2 - 1. Options: -eva-split-return-function filter_fx_leading:full */
void proof_weigh(void)
{
    for (uint32_t power = 0x20000; power <= 0x20000000U; power *= 2U) {
        for (uint8_t places = 0; places < 16; places++) {
            filter_t f;
            any_running(&f, &filter_law_pbf, 0);
            any_update(&f, places);
            f.own.mixture.span_uq16 = ANY_U32(power, (power == 0x20000000U) ? SPAN_END : 2U * power - 1U);
            (void)weigh(&f);
        }
    }
}

PROVE_LAW(pbf)
PROVE_LAW(shrf)
PROVE_LAW(af)
