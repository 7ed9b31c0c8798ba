/* pbf: any int16, any state within its bounds; the same bounds afterwards. */
#include "mixture_bounds.h"

#include "pbf.h"

/*@ ensures \result ==> MIXTURE_BOUND(f); */
bool pbf_init(pbf_t *f, const pbf_config_t *config);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void pbf_set_noise(pbf_t *f, uint32_t r_lsb2_q8);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void pbf_reset(pbf_t *f, int16_t z0_lsb);
bool pbf_reset_step(pbf_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t pbf_update(pbf_t *f, int16_t z_lsb);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t pbf_coast(pbf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void pbf_damp(pbf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void pbf_hold(pbf_t *f);
/*@ requires MIXTURE_BOUND(f); ensures MIXTURE_BOUND(f); */
void pbf_restart(pbf_t *f);

#include "pbf.c"

/*
 * Uses: fx_normalise, rounded, two_state_wide_set_noise, mixture_log_odds_q9.
 * Options: -eva-split-return-function fx_leading:full,mixture_init:full
 */
void proof_pbf_init(void)
{
    for (uint8_t number = 0; number < CONFIGURATIONS; number++) {
        mixture_t f;
        (void)init_one(&f, pbf_init, number);
    }
    pbf_config_t config;
    pbf_defaults(&config, ANY_U16(50, 40000));
    pbf_t f;
    pbf_configure(&f, &config);
}

/* Uses: two_state_wide_set_noise */
void proof_pbf_set_noise(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        pbf_set_noise(&f, ANY_U32(0, UINT32_MAX));
        any_mixture(&f, range, true);
        pbf_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

/* Uses: mixture_reset */
void proof_pbf_reset(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        pbf_reset(&f, ANY_Z());
        any_mixture(&f, range, true);
        pbf_reset(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_reset_step, mixture_log_odds_q9 */
void proof_pbf_reset_step(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        (void)pbf_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
        any_mixture(&f, range, true);
        (void)pbf_reset_step(&f, ANY_Z(), 0);
    }
}

/* Uses: mixture_update */
void proof_pbf_update(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        (void)pbf_update(&f, ANY_Z());
        any_mixture(&f, range, true);
        (void)pbf_update(&f, ANY_Z());
    }
}

/* Uses: two_state_wide_predict, two_state_wide_probe. Options: -eva-split-return-function two_state_wide_coast:full */
void proof_pbf_coast(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        (void)pbf_coast(&f);
        any_mixture(&f, range, true);
        (void)pbf_coast(&f);
        filter_probe_t probe;
        pbf_probe(&f, &probe);
        (void)pbf_flags(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_pbf_gap(void)
{
    for (uint8_t range = 0; range < RATIO_RANGES; range++) {
        pbf_t f;
        any_mixture(&f, range, false);
        pbf_damp(&f);
        any_mixture(&f, range, true);
        pbf_damp(&f);
        any_mixture(&f, range, false);
        pbf_gap(&f);
        any_mixture(&f, range, false);
        pbf_hold(&f);
        any_mixture(&f, range, true);
        pbf_gap(&f);
        any_mixture(&f, range, true);
        pbf_hold(&f);
        any_mixture(&f, range, false);
        pbf_restart(&f);
        any_mixture(&f, range, true);
        pbf_restart(&f);
    }
}
