/* sprf_paper: any int16, any state within its bounds; the same bounds afterwards. */
#include "wide_bounds.h"

#include "sprf_paper.h"

#define BOUND(f) WIDE_BOUND(&(f)->core)

/*@ ensures \result ==> BOUND(f); */
bool sprf_paper_init(sprf_paper_t *f, const sprf_paper_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_paper_set_noise(sprf_paper_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_paper_reset(sprf_paper_t *f, int16_t z0_lsb);
bool sprf_paper_reset_step(sprf_paper_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_paper_update(sprf_paper_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_paper_coast(sprf_paper_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_paper_damp(sprf_paper_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_paper_hold(sprf_paper_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void sprf_paper_restart(sprf_paper_t *f);

#include "sprf_paper.c"

/* Uses: fx_normalise, rounded, two_state_wide_set_noise. All legal configurations, then all with one outside. */
void proof_sprf_paper_init(void)
{
    sprf_paper_t f;
    sprf_paper_config_t config;
    for (uint8_t number = 0; number < CASES(4); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.r_lsb2_q8 = any_u32(part_of(number, 1), 3, 256000, UINT32_MAX);
        config.q_lsb2_s3 = any_u32(part_of(number, 2), 1, 1000000000, UINT32_MAX);
        config.gate_sigma_q8 = any_u16(part_of(number, 3), 256, 4096);
        (void)sprf_paper_init(&f, &config);
    }
    sprf_paper_defaults(&config, ANY_U16(50, 40000));
}

static void any_sprf_paper(sprf_paper_t *f, bool starting)
{
    f->gate2_uq8 = ANY_U16(0, UINT16_MAX);
    any_wide(&f->core, 0);
    f->core.variance = ANY_U32(0, UINT32_MAX);
    if (starting) {
        any_wide_start(&f->core, 0, 4);
    }
}

/* Uses: two_state_wide_set_noise */
void proof_sprf_paper_set_noise(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    sprf_paper_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_sprf_paper(&f, true);
    sprf_paper_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

/* Uses: two_state_wide_reset */
void proof_sprf_paper_reset(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    sprf_paper_reset(&f, ANY_Z());
    any_sprf_paper(&f, true);
    sprf_paper_reset(&f, ANY_Z());
}

/* Uses: two_state_wide_reset_step */
void proof_sprf_paper_reset_step(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    (void)sprf_paper_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_sprf_paper(&f, true);
    (void)sprf_paper_reset_step(&f, ANY_Z(), 0);
}

/* Uses: two_state_wide_predict, two_state_wide_distance_uq8, two_state_wide_update */
void proof_sprf_paper_update(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    (void)sprf_paper_update(&f, ANY_Z());
    any_sprf_paper(&f, true);
    (void)sprf_paper_update(&f, ANY_Z());
}

/* Uses: two_state_wide_predict, two_state_wide_probe. Options: -eva-split-return-function two_state_wide_coast:full */
void proof_sprf_paper_coast(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    (void)sprf_paper_coast(&f);
    any_sprf_paper(&f, true);
    (void)sprf_paper_coast(&f);
    filter_probe_t probe;
    sprf_paper_probe(&f, &probe);
    (void)sprf_paper_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_sprf_paper_gap(void)
{
    sprf_paper_t f;
    any_sprf_paper(&f, false);
    sprf_paper_damp(&f);
    any_sprf_paper(&f, true);
    sprf_paper_damp(&f);
    any_sprf_paper(&f, false);
    sprf_paper_gap(&f);
    any_sprf_paper(&f, false);
    sprf_paper_hold(&f);
    any_sprf_paper(&f, true);
    sprf_paper_gap(&f);
    any_sprf_paper(&f, true);
    sprf_paper_hold(&f);
    any_sprf_paper(&f, false);
    sprf_paper_restart(&f);
    any_sprf_paper(&f, true);
    sprf_paper_restart(&f);
}
