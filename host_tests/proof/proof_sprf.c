/* sprf: any int16, any state within its bounds; the same bounds afterwards. */
#include "reacquire_bounds.h"

#include "sprf.h"

#define GATE(f) ((f)->gate_sigma_q8 <= 4096 && (f)->refused <= SPRF_RATE_HELD_SAMPLES && RUN(&(f)->again))
#define BOUND(f) \
    (PARAMETERS(&(f)->core) && (f)->core.r_lsb2_q8 <= R_END && ESTIMATE(&(f)->core) && MODE(&(f)->core) && GATE(f))

/*@ ensures \result ==> BOUND(f); */
bool sprf_init(sprf_t *f, const sprf_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_set_noise(sprf_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_reset(sprf_t *f, int16_t z0_lsb);
bool sprf_reset_step(sprf_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_update(sprf_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_coast(sprf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_damp(sprf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_hold(sprf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_restart(sprf_t *f);

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "reacquire.c"

#include "sprf.c"

static void any_gate(sprf_t *f)
{
    f->gate_sigma_q8 = ANY_U16(0, 4096);
    f->refused = ANY_U8(0, SPRF_RATE_HELD_SAMPLES);
    any_run(&f->again);
}

/*
 * Uses: fx_normalise, rounded, two_state_set_noise, two_state_set_gate, fx_isqrt32. A box that holds all legal
 * configurations, then all with one parameter below or above it.
 */
void proof_sprf_init(void)
{
    sprf_t f;
    sprf_config_t config;
    for (uint8_t number = 0; number < CASES(6); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.r_lsb2_q8 = any_u32(part_of(number, 1), 3, 256000, UINT32_MAX);
        config.q_lsb2_s3 = any_u32(part_of(number, 2), 1, 1000000000, UINT32_MAX);
        config.gate_sigma_q8 = any_u16(part_of(number, 3), 0, 4096);
        config.reacquire_samples = any_u16(part_of(number, 4), 0, 9);
        config.rate_max_lsb_s = any_u32(part_of(number, 5), 10, 1000000, UINT32_MAX);
        (void)sprf_init(&f, &config);
    }
    sprf_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: two_state_set_noise, two_state_set_gate, fx_isqrt32 */
void proof_sprf_set_noise(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_start(&f.core);
    sprf_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

/* Uses: two_state_reset */
void proof_sprf_reset(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_reset(&f, ANY_Z());
    any_start(&f.core);
    sprf_reset(&f, ANY_Z());
}

/* Uses: two_state_step */
void proof_sprf_reset_step(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)sprf_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_start(&f.core);
    (void)sprf_reset_step(&f, ANY_Z(), 0);
}

/* Uses: two_state_step, reacquire_refused */
void proof_sprf_update(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)sprf_update(&f, ANY_Z());
    any_gate(&f);
    any_start(&f.core);
    f.core.collected = ANY_U8(0, FILTER_WARM_UP_SAMPLES - 2);
    (void)sprf_update(&f, ANY_Z());
    any_start(&f.core);
    f.core.collected = FILTER_WARM_UP_SAMPLES - 1;
    (void)sprf_update(&f, ANY_Z());
}

/* Uses: two_state_step. Options: -eva-split-return-function two_state_coast:full */
void proof_sprf_coast(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)sprf_coast(&f);
    any_start(&f.core);
    (void)sprf_coast(&f);
    filter_probe_t probe;
    sprf_probe(&f, &probe);
    (void)sprf_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_sprf_gap(void)
{
    sprf_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_damp(&f);
    any_start(&f.core);
    sprf_damp(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_gap(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_hold(&f);
    any_start(&f.core);
    sprf_gap(&f);
    any_start(&f.core);
    sprf_hold(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    sprf_restart(&f);
    any_start(&f.core);
    sprf_restart(&f);
}
