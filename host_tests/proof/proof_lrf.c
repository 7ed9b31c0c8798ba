/* lrf: any int16, any state within its bounds; the same bounds afterwards. */
#include "two_state_bounds.h"

#include "lrf.h"

#define FACTOR_MIN 65536
#define FACTOR_MAX 67108864 /* 1024 */
#define BOUND(f) \
    (PARAMETERS(&(f)->core) && ESTIMATE(&(f)->core) && MODE(&(f)->core) && FACTOR_MIN <= (f)->factor_uq16 <= FACTOR_MAX)

/*@ requires 256 <= ratio_uq8 <= 8192;
    assigns \result \from clean_uq16, ratio_uq8;
    ensures FACTOR_MIN <= \result <= FACTOR_MAX;
*/
static uint32_t factor_uq16(uint16_t clean_uq16, uint16_t ratio_uq8);

/*@ ensures \result ==> BOUND(f); */
bool lrf_init(lrf_t *f, const lrf_config_t *config);
/*@ requires BOUND(f);
    assigns f->core.r_lsb2_q8, f->core.q22_uq28, f->core.p22_start_uq28 \from *f, r_lsb2_q8;
    ensures BOUND(f);
*/
void lrf_set_noise(lrf_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void lrf_reset(lrf_t *f, int16_t z0_lsb);
bool lrf_reset_step(lrf_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t lrf_update(lrf_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t lrf_coast(lrf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void lrf_damp(lrf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void lrf_hold(lrf_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void lrf_restart(lrf_t *f);

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "lrf.c"

static void any_run(lrf_t *f)
{
    any_state_of(&f->core, R_ANY);
    f->factor_uq16 = ANY_U32(FACTOR_MIN, FACTOR_MAX);
}

static void any_warm_up(lrf_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_start_of(&f->core, R_ANY);
    f->factor_uq16 = ANY_U32(FACTOR_MIN, FACTOR_MAX);
    f->core.collected = ANY_U8(from_collected, to_collected);
}

/* Ratio by ratio, because intervals do not know that N^2 - 1 and N^2 are of the same N. */
void proof_factor_uq16(void)
{
    for (uint16_t ratio_uq8 = RATIO_MIN_UQ8; ratio_uq8 <= RATIO_MAX_UQ8; ratio_uq8++) {
        (void)factor_uq16(ANY_U16(0, UINT16_MAX), ratio_uq8);
    }
}

static void init_with(const lrf_config_t *core, uint16_t clean_uq16, uint16_t ratio_uq8)
{
    lrf_t f;
    lrf_config_t config = *core;
    config.clean_uq16 = clean_uq16;
    config.ratio_uq8 = ratio_uq8;
    (void)lrf_init(&f, &config);
}

static void init_core(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    lrf_config_t core = { rate_dhz, r_lsb2_q8, q_lsb2_s3, 0, 0 };
    uint16_t clean = ANY_U16(0, UINT16_MAX);
    init_with(&core, ANY_U16(656, UINT16_MAX), ANY_U16(256, 8192));
    init_with(&core, ANY_U16(0, 655), ANY_U16(0, UINT16_MAX));
    init_with(&core, clean, ANY_U16(0, 255));
    init_with(&core, clean, ANY_U16(8193, UINT16_MAX));
}

/*
 * Uses: fx_normalise, rounded, two_state_set_noise, factor_uq16, lrf_set_noise. A box that holds all legal
 * configurations, then
 * all with one parameter below or above it.
 */
void proof_lrf_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    uint32_t q_lsb2_s3 = ANY_U32(0, UINT32_MAX);
    init_core(ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000));
    init_core(ANY_U16(0, 49), r_lsb2_q8, q_lsb2_s3);
    init_core(ANY_U16(40001, UINT16_MAX), r_lsb2_q8, q_lsb2_s3);
    init_core(rate_dhz, ANY_U32(0, 2), q_lsb2_s3);
    init_core(rate_dhz, ANY_U32(256001, UINT32_MAX), q_lsb2_s3);
    init_core(rate_dhz, r_lsb2_q8, 0);
    init_core(rate_dhz, r_lsb2_q8, ANY_U32(1000000001, UINT32_MAX));
    lrf_config_t config;
    lrf_defaults(&config, ANY_U16(50, 40000));
}

static void set_noise_in(uint32_t from_lsb2_q8, uint32_t to_lsb2_q8)
{
    lrf_t f;
    any_warm_up(&f, 0, 4);
    lrf_set_noise(&f, ANY_U32(from_lsb2_q8, to_lsb2_q8));
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_set_noise(&f, ANY_U32(from_lsb2_q8, to_lsb2_q8));
}

/* Uses: fx_normalise, rounded, two_state_set_variance. The smallest R apart. */
void proof_lrf_set_noise(void)
{
    set_noise_in(0, 7);
    set_noise_in(8, UINT32_MAX);
}

/* Uses: two_state_reset */
void proof_lrf_reset(void)
{
    lrf_t f;
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_reset(&f, ANY_Z());
    any_warm_up(&f, 0, 4);
    lrf_reset(&f, ANY_Z());
}

/* Uses: two_state_step */
void proof_lrf_reset_step(void)
{
    lrf_t f;
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    (void)lrf_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_warm_up(&f, 0, 4);
    (void)lrf_reset_step(&f, ANY_Z(), 0);
}

/* Uses: two_state_step */
void proof_lrf_update(void)
{
    lrf_t f;
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    (void)lrf_update(&f, ANY_Z());
    any_warm_up(&f, 0, 3);
    (void)lrf_update(&f, ANY_Z());
    any_warm_up(&f, 4, 4);
    (void)lrf_update(&f, ANY_Z());
}

/* Uses: two_state_step. Options: -eva-split-return-function two_state_coast:full */
void proof_lrf_coast(void)
{
    lrf_t f;
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    (void)lrf_coast(&f);
    any_warm_up(&f, 0, 4);
    (void)lrf_coast(&f);
    filter_probe_t probe;
    lrf_probe(&f, &probe);
    (void)lrf_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_lrf_gap(void)
{
    lrf_t f;
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_damp(&f);
    any_warm_up(&f, 0, 4);
    lrf_damp(&f);
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_gap(&f);
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_hold(&f);
    any_warm_up(&f, 0, 4);
    lrf_gap(&f);
    any_warm_up(&f, 0, 4);
    lrf_hold(&f);
    any_run(&f);
    //@ admit COVARIANCE(&f.core);
    lrf_restart(&f);
    any_warm_up(&f, 0, 4);
    lrf_restart(&f);
}
