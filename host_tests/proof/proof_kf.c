/* kf: any int16, any state within its bounds; the same bounds afterwards. */
#include "two_state_bounds.h"

#include "kf.h"

#define BOUND(f) (PARAMETERS(&(f)->core) && (f)->core.r_lsb2_q8 <= R_END && ESTIMATE(&(f)->core) && MODE(&(f)->core))

/*@ ensures \result ==> BOUND(f); */
bool kf_init(kf_t *f, const kf_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf_set_noise(kf_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf_reset(kf_t *f, int16_t z0_lsb);
bool kf_reset_step(kf_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t kf_update(kf_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t kf_coast(kf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf_damp(kf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf_hold(kf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf_restart(kf_t *f);

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "kf.c"

static void init_with(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    kf_t f;
    kf_config_t config = { rate_dhz, r_lsb2_q8, q_lsb2_s3 };
    (void)kf_init(&f, &config);
}

/*
 * Uses: fx_normalise, rounded, two_state_set_noise.
 * All legal configurations, then all with one parameter below or above.
 */
void proof_kf_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    uint32_t q_lsb2_s3 = ANY_U32(0, UINT32_MAX);
    init_with(ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000));
    init_with(ANY_U16(0, 49), r_lsb2_q8, q_lsb2_s3);
    init_with(ANY_U16(40001, UINT16_MAX), r_lsb2_q8, q_lsb2_s3);
    init_with(rate_dhz, ANY_U32(0, 2), q_lsb2_s3);
    init_with(rate_dhz, ANY_U32(256001, UINT32_MAX), q_lsb2_s3);
    init_with(rate_dhz, r_lsb2_q8, 0);
    init_with(rate_dhz, r_lsb2_q8, ANY_U32(1000000001, UINT32_MAX));
    kf_config_t config;
    kf_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: two_state_set_noise */
void proof_kf_set_noise(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_start(&f.core);
    kf_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

/* Uses: two_state_reset */
void proof_kf_reset(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_reset(&f, ANY_Z());
    any_start(&f.core);
    kf_reset(&f, ANY_Z());
}

/* Uses: two_state_step */
void proof_kf_reset_step(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)kf_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_start(&f.core);
    (void)kf_reset_step(&f, ANY_Z(), 0);
}

/* Uses: two_state_step */
void proof_kf_update(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)kf_update(&f, ANY_Z());
    any_start(&f.core);
    f.core.collected = ANY_U8(0, FILTER_WARM_UP_SAMPLES - 2);
    (void)kf_update(&f, ANY_Z());
    any_start(&f.core);
    f.core.collected = FILTER_WARM_UP_SAMPLES - 1;
    (void)kf_update(&f, ANY_Z());
}

/* Uses: two_state_step. Options: -eva-split-return-function two_state_coast:full */
void proof_kf_coast(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)kf_coast(&f);
    any_start(&f.core);
    (void)kf_coast(&f);
    filter_probe_t probe;
    kf_probe(&f, &probe);
    (void)kf_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_kf_gap(void)
{
    kf_t f;
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_damp(&f);
    any_start(&f.core);
    kf_damp(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_gap(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_hold(&f);
    any_start(&f.core);
    kf_gap(&f);
    any_start(&f.core);
    kf_hold(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    kf_restart(&f);
    any_start(&f.core);
    kf_restart(&f);
}
