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
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_update(sprf_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_coast(sprf_t *f);

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

static void init_with(const sprf_config_t *core, uint16_t gate_sigma_q8, uint16_t reacquire_samples, uint32_t rate_max)
{
    sprf_t f;
    sprf_config_t config = *core;
    config.gate_sigma_q8 = gate_sigma_q8;
    config.reacquire_samples = reacquire_samples;
    config.rate_max_lsb_s = rate_max;
    (void)sprf_init(&f, &config);
}

static void init_gates(const sprf_config_t *core)
{
    uint16_t gate = ANY_U16(0, UINT16_MAX);
    uint16_t reacquire = ANY_U16(0, UINT16_MAX);
    uint32_t rate_max = ANY_U32(0, UINT32_MAX);
    init_with(core, ANY_U16(0, 4096), ANY_U16(0, 9), ANY_U32(10, 1000000));
    init_with(core, ANY_U16(4097, UINT16_MAX), reacquire, rate_max);
    init_with(core, gate, ANY_U16(10, UINT16_MAX), rate_max);
    init_with(core, gate, reacquire, ANY_U32(0, 9));
    init_with(core, gate, reacquire, ANY_U32(1000001, UINT32_MAX));
}

static void init_core(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    sprf_config_t core = { rate_dhz, r_lsb2_q8, q_lsb2_s3, 0, 0, 0 };
    init_gates(&core);
}

/*
 * Uses: fx_normalise, rounded, two_state_set_noise, two_state_set_gate, fx_isqrt32. A box that holds all legal
 * configurations,
 * then all with one parameter below or above it.
 */
void proof_sprf_init(void)
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
    sprf_config_t config;
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
