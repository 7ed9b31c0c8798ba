/* The posterior of a normal sample and the update by it: any state within its bounds, any sample. */
#include "mixture_bounds.h"

/* By places. */
void proof_log2_uq9(void)
{
    for (uint8_t places = 0; places < 32; places++) {
        (void)log2_uq9((ANY_U32(0x800000, 0xFFFFFF) * 256U) + places);
    }
}

/* Uses: fx_normalise, log2_uq9. Options: -eva-split-return-function fx_leading:full */
void proof_mixture_log_odds_q9(void)
{
    (void)mixture_log_odds_q9(ANY_U32(0x4000, 0xFFC000));
}

/* By intervals of the table. */
void proof_mixture_posterior(void)
{
    for (int16_t from = 0; from <= 32512; from += 256) {
        int16_t to = (int16_t)(from + 255);
        (void)mixture_posterior(ANY_S16(from, to));
        (void)mixture_posterior(ANY_S16((int16_t)-to, (int16_t)((from == 0) ? -1 : -from)));
        if (from == 32512) {
            return;
        }
    }
}

/* Uses: fx_normalise, fx_inverse_m_uq16, mixture_log_odds_q9. Options: -eva-split-return-function fx_leading:full */
void proof_learn(void)
{
    mixture_t f;
    any_mixture(&f, 0, false);
    f.learnt_from = ANY_U16(2, 1024);
    mixture_posterior_t posterior = { ANY_U32(0, 0x800000), ANY_BOOL() };
    learn(&f, posterior);
}

/*
 * Uses: two_state_wide_distance_uq8, log2_uq9, mixture_posterior, fx_normalise, fx_inverse_m_uq16. By places of
 * N^2 - 1. Options: -eva-split-return-function fx_leading:full
 */
void proof_weigh(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        mixture_t f;
        any_mixture(&f, range, false);
        for (uint8_t places = 0; places < 16; places++) {
            f.core.variance = (ANY_U32(0x800000, 0xFFFFFF) * 256U) + places;
            (void)weigh(&f);
        }
    }
}

static void any_ratio(mixture_t *f, bool starting)
{
    any_mixture(f, 0, starting);
    f->span_uq16 = ANY_U32(0x20000, 655294464);
    f->span = ANY_U32(0x80000000, UINT32_MAX);
}

/* Uses: two_state_wide_predict, two_state_wide_update, weigh, learn */
void proof_mixture_update(void)
{
    mixture_t f;
    any_ratio(&f, false);
    (void)mixture_update(&f, ANY_Z(), MIXTURE_BAYES);
    any_ratio(&f, false);
    (void)mixture_update(&f, ANY_Z(), MIXTURE_SHORTENED);
    any_ratio(&f, true);
    f.core.collected = ANY_U8(0, 3);
    (void)mixture_update(&f, ANY_Z(), MIXTURE_BAYES);
    any_ratio(&f, true);
    f.core.collected = 4;
    (void)mixture_update(&f, ANY_Z(), MIXTURE_BAYES);
}

/* Uses: two_state_wide_reset, mixture_log_odds_q9 */
void proof_mixture_reset(void)
{
    mixture_t f;
    any_mixture(&f, 0, false);
    mixture_reset(&f, ANY_Z());
    any_mixture(&f, 0, true);
    mixture_reset(&f, ANY_Z());
}

/* Uses: two_state_wide_reset_step, mixture_log_odds_q9 */
void proof_mixture_reset_step(void)
{
    mixture_t f;
    any_mixture(&f, 0, false);
    (void)mixture_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_mixture(&f, 0, true);
    (void)mixture_reset_step(&f, ANY_Z(), 0);
}
