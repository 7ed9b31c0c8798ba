/* shrf: any int16, any state within its bounds; the same bounds afterwards. */
#include "mixture_bounds.h"

#include "shrf.h"

/*@ ensures \result ==> MIXTURE_BOUND(f); */
bool shrf_init(shrf_t *f, const shrf_config_t *config);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void shrf_set_noise(shrf_t *f, uint32_t r_lsb2_q8);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void shrf_reset(shrf_t *f, int16_t z0_lsb);
bool shrf_reset_step(shrf_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t shrf_update(shrf_t *f, int16_t z_lsb);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t shrf_coast(shrf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void shrf_damp(shrf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void shrf_hold(shrf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void shrf_restart(shrf_t *f);

#include "shrf.c"

/*
 * Uses: fx_normalise, rounded, two_state_wide_set_noise, mixture_log_odds_q9.
 * Options: -eva-split-return-function fx_leading:full,mixture_init:full
 */
void proof_shrf_init(void)
{
    for (uint8_t number = 0; number < CONFIGURATIONS; number++) {
        mixture_t f;
        (void)init_one(&f, shrf_init, number);
    }
    shrf_config_t config;
    shrf_defaults(&config, ANY_U16(50, 40000));
    shrf_t f;
    shrf_configure(&f, &config);
}

/* Uses: two_state_wide_set_noise */
void proof_shrf_set_noise(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        shrf_set_noise(&f, ANY_U32(0, UINT32_MAX));
        any_mixture(&f, range, true);
        shrf_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

/* Uses: mixture_reset */
void proof_shrf_reset(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        shrf_reset(&f, ANY_Z());
        any_mixture(&f, range, true);
        shrf_reset(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_reset_step, mixture_log_odds_q9 */
void proof_shrf_reset_step(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        (void)shrf_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
        any_mixture(&f, range, true);
        (void)shrf_reset_step(&f, ANY_Z(), 0);
    }
}

/* Uses: mixture_update */
void proof_shrf_update(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        (void)shrf_update(&f, ANY_Z());
        any_mixture(&f, range, true);
        (void)shrf_update(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_predict, two_state_wide_probe. Options: -eva-split-return-function two_state_wide_coast:full */
void proof_shrf_coast(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        (void)shrf_coast(&f);
        any_mixture(&f, range, true);
        (void)shrf_coast(&f);
        filter_probe_t probe;
        shrf_probe(&f, &probe);
        (void)shrf_flags(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_shrf_gap(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        shrf_t f;
        any_mixture(&f, range, false);
        shrf_damp(&f);
        any_mixture(&f, range, true);
        shrf_damp(&f);
        any_mixture(&f, range, false);
        shrf_gap(&f);
        any_mixture(&f, range, false);
        shrf_hold(&f);
        any_mixture(&f, range, true);
        shrf_gap(&f);
        any_mixture(&f, range, true);
        shrf_hold(&f);
        any_mixture(&f, range, false);
        shrf_restart(&f);
        any_mixture(&f, range, true);
        shrf_restart(&f);
    }
}
