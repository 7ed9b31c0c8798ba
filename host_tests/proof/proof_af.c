/* af: any int16, any state within its bounds; the same bounds afterwards. */
#include "mixture_bounds.h"

#include "af.h"

/*@ ensures \result ==> MIXTURE_BOUND(f); */
bool af_init(af_t *f, const af_config_t *config);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void af_set_noise(af_t *f, uint32_t r_lsb2_q8);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void af_reset(af_t *f, int16_t z0_lsb);
bool af_reset_step(af_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t af_update(af_t *f, int16_t z_lsb);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t af_coast(af_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void af_damp(af_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void af_hold(af_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void af_restart(af_t *f);

#include "af.c"

/*
 * Uses: fx_normalise, rounded, two_state_wide_set_noise, mixture_log_odds_q9.
 * Options: -eva-split-return-function fx_leading:full,mixture_init:full
 */
void proof_af_init(void)
{
    for (uint8_t number = 0; number < CONFIGURATIONS; number++) {
        mixture_t f;
        (void)init_one(&f, af_init, number);
    }
    af_config_t config;
    af_defaults(&config, ANY_U16(50, 40000));
    af_t f;
    af_configure(&f, &config);
}

/* Uses: two_state_wide_set_noise */
void proof_af_set_noise(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        af_set_noise(&f, ANY_U32(0, UINT32_MAX));
        any_mixture(&f, range, true);
        af_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

/* Uses: mixture_reset */
void proof_af_reset(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        af_reset(&f, ANY_Z());
        any_mixture(&f, range, true);
        af_reset(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_reset_step, mixture_log_odds_q9 */
void proof_af_reset_step(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        (void)af_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
        any_mixture(&f, range, true);
        (void)af_reset_step(&f, ANY_Z(), 0);
    }
}

/* Uses: mixture_update */
void proof_af_update(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        (void)af_update(&f, ANY_Z());
        any_mixture(&f, range, true);
        (void)af_update(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_predict, two_state_wide_probe. Options: -eva-split-return-function two_state_wide_coast:full */
void proof_af_coast(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        (void)af_coast(&f);
        any_mixture(&f, range, true);
        (void)af_coast(&f);
        filter_probe_t probe;
        af_probe(&f, &probe);
        (void)af_flags(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_af_gap(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        af_t f;
        any_mixture(&f, range, false);
        af_damp(&f);
        any_mixture(&f, range, true);
        af_damp(&f);
        any_mixture(&f, range, false);
        af_gap(&f);
        any_mixture(&f, range, false);
        af_hold(&f);
        any_mixture(&f, range, true);
        af_gap(&f);
        any_mixture(&f, range, true);
        af_hold(&f);
        any_mixture(&f, range, false);
        af_restart(&f);
        any_mixture(&f, range, true);
        af_restart(&f);
    }
}
