/* The bounds of mixture.h in ACSL and the contracts of its functions, proved by proof_mixture.c. */
#ifndef MIXTURE_BOUNDS_H
#define MIXTURE_BOUNDS_H

#include "wide_bounds.h"

#include "mixture.h"

/* N^2 - 1 with its leading bit at 31 - k. */
#define SPAN(f, k, power) ((power) <= (f)->span_uq16 < 2 * (power) && (f)->span % 256 == (k))
#define SPANS(f)                                                                                           \
    ((f)->span >= 0x80000000 &&                                                                            \
     (SPAN(f, 14, 0x20000) || SPAN(f, 13, 0x40000) || SPAN(f, 12, 0x80000) || SPAN(f, 11, 0x100000) ||     \
      SPAN(f, 10, 0x200000) || SPAN(f, 9, 0x400000) || SPAN(f, 8, 0x800000) || SPAN(f, 7, 0x1000000) ||    \
      SPAN(f, 6, 0x2000000) || SPAN(f, 5, 0x4000000) || SPAN(f, 4, 0x8000000) || SPAN(f, 3, 0x10000000) || \
      (SPAN(f, 2, 0x20000000) && (f)->span_uq16 <= 655294464)))
#define LOG_ODDS_MAX 11424
#define LEARNT(f)                                                                              \
    (-LOG_ODDS_MAX <= (f)->log_odds_q9 <= LOG_ODDS_MAX && 32768 <= (f)->clean_uq16 <= 65470 && \
     (f)->learnt_from <= 1024 && 0x4000 <= (f)->learnt_uq24 <= 0xFFC000)
#define RULE(rule) ((rule) == MIXTURE_BAYES || (rule) == MIXTURE_SHORTENED)
#define MIXTURE_BOUND(f) (WIDE_BOUND(&(f)->core) && LEARNT(f) && SPANS(f))

/*@ requires v % 256 <= 31;
    assigns \result \from v;
    ensures \result <= 16480;
*/
static uint16_t log2_uq9(fx_leading_t v);

/*@ requires 0x4000 <= q_uq24 <= 0xFFC000;
    assigns \result \from q_uq24;
    ensures -LOG_ODDS_MAX <= \result <= LOG_ODDS_MAX;
*/
int16_t mixture_log_odds_q9(uint32_t q_uq24);

/*@ requires -32767 <= log_odds_q9;
    assigns \result \from log_odds_q9;
    ensures \result.rest_uq24 <= 0x800000;
    ensures \result.outlier == 0 || \result.outlier == 1;
*/
mixture_posterior_t mixture_posterior(int16_t log_odds_q9);

/*@ requires LEARNT(f) && 1 <= f->learnt_from;
    requires posterior.rest_uq24 <= 0x800000;
    assigns f->learnt_from, f->learnt_uq24, f->log_odds_q9 \from *f, posterior;
    ensures LEARNT(f);
*/
static void learn(mixture_t *f, mixture_posterior_t posterior);

/*@ requires WIDE_BOUND(&f->core) && LEARNT(f) && RULE(rule);
    requires span: SPANS(f);
    assigns f->core.x_lsb_q16, f->core.rate_lsb_q16, f->core.u, f->core.size_lsb_uq8, f->core.variance,
            f->core.inverse_uq16, f->core.gain_uq16, f->core.flags, f->core.negative, f->core.collected, f->learnt_from,
            f->learnt_uq24, f->log_odds_q9, \result \from *f, z_lsb, rule;
    ensures WIDE_PARAMETERS(&f->core) && ESTIMATE(&f->core);
    ensures WIDE_MODE(&f->core);
    ensures LEARNT(f);
    ensures -X_MAX_Q16 <= \result <= X_MAX_Q16;
*/
int32_t mixture_update(mixture_t *f, int16_t z_lsb, mixture_rule_t rule);

/*@ requires WIDE_PARAMETERS(&f->core) && LEARNT(f);
    assigns f->core.x_lsb_q16, f->core.rate_lsb_q16, f->core.u, f->core.size_lsb_uq8, f->core.variance,
            f->core.inverse_uq16, f->core.gain_uq16, f->core.flags, f->core.negative, f->core.collected, f->learnt_from,
            f->learnt_uq24, f->log_odds_q9 \from *f, z0_lsb;
    ensures ESTIMATE(&f->core) && f->core.collected == 5 && WIDE_P(f->core.u.p);
    ensures LEARNT(f);
*/
void mixture_reset(mixture_t *f, int16_t z0_lsb);

#include "mixture.c"

/*@ requires LEARNT(f) && WIDE_P(f->core.u.p) && WIDE_PARAMETERS(&f->core) && ESTIMATE(&f->core);
    requires f->core.inverse_uq16 >= 0x8000;
    requires span: SPANS(f);
    requires places: S_PLACES(&f->core);
    assigns \result \from *f;
    ensures \result.p.rest_uq24 <= 0x800000;
    ensures \result.p.outlier == 0 || \result.p.outlier == 1;
*/
static evidence_t weigh(const mixture_t *f);

/* The first ratio N of each leading bit of N^2 - 1, and the first beyond the legal ones. */
static const uint16_t ratio_from_q8[] = { 512,  573,  768,  1056,  1471,  2064,  2908,
                                          4104, 5799, 8196, 11589, 16386, 23172, 25601 };
#define RATIO_RANGES 13

/* Any state with a ratio from one of these ranges. */
static void any_mixture(mixture_t *f, uint8_t range, bool starting)
{
    uint8_t places = (uint8_t)(14U - range);
    uint32_t power = (uint32_t)0x20000U << range;
    any_wide(&f->core, 0);
    f->core.variance = ANY_U32(0, UINT32_MAX);
    if (starting) {
        any_wide_start(&f->core, 0, 4);
    }
    f->span_uq16 = ANY_U32(power, (range == RATIO_RANGES - 1U) ? 655294464U : 2 * power - 1);
    f->span = (ANY_U32(0x800000, 0xFFFFFF) * 256U) + places;
    f->log_odds_q9 = ANY_S16(-LOG_ODDS_MAX, LOG_ODDS_MAX);
    f->clean_uq16 = ANY_U16(32768, 65470);
    f->learnt_from = ANY_BOOL() ? 0 : ANY_U16(2, 1024);
    f->learnt_uq24 = ANY_U32(0x4000, 0xFFC000);
}

/* One parameter of a legal configuration outside its range, then all legal ones by ranges of the ratio. */
static bool init_one(mixture_t *f, bool (*init)(mixture_t *, const mixture_config_t *), uint8_t number)
{
    mixture_config_t config = { ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000), ANY_U16(512, 25600),
                                ANY_U16(32768, 65470) };
    if (number < RATIO_RANGES) {
        config.ratio_uq8 = ANY_U16(ratio_from_q8[number], ratio_from_q8[number + 1] - 1);
        return init(f, &config);
    }
    config.clean_uq16 = ANY_U16(0, UINT16_MAX);
    config.ratio_uq8 = ANY_U16(0, UINT16_MAX);
    switch (number) {
    case 13:
        config.rate_dhz = ANY_U16(0, 49);
        break;
    case 14:
        config.rate_dhz = ANY_U16(40001, UINT16_MAX);
        break;
    case 15:
        config.r_lsb2_q8 = ANY_U32(0, 2);
        break;
    case 16:
        config.r_lsb2_q8 = ANY_U32(256001, UINT32_MAX);
        break;
    case 17:
        config.q_lsb2_s3 = 0;
        break;
    case 18:
        config.q_lsb2_s3 = ANY_U32(1000000001, UINT32_MAX);
        break;
    case 19:
        config.ratio_uq8 = ANY_U16(0, 511);
        break;
    case 20:
        config.ratio_uq8 = ANY_U16(25601, UINT16_MAX);
        break;
    case 21:
        config.ratio_uq8 = ANY_U16(512, 25600);
        config.clean_uq16 = ANY_U16(0, 32767);
        break;
    default:
        config.ratio_uq8 = ANY_U16(512, 25600);
        config.clean_uq16 = ANY_U16(65471, UINT16_MAX);
        break;
    }
    return init(f, &config);
}
#define CONFIGURATIONS 23

#endif
