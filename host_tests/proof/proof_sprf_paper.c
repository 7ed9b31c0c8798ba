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
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_paper_update(sprf_paper_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t sprf_paper_coast(sprf_paper_t *f);

#include "sprf_paper.c"

static void init_with(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3, uint16_t gate_sigma_q8)
{
    sprf_paper_t f;
    sprf_paper_config_t config = { rate_dhz, r_lsb2_q8, q_lsb2_s3, gate_sigma_q8 };
    (void)sprf_paper_init(&f, &config);
}

/* Uses: fx_normalise, rounded, two_state_wide_set_noise. All legal configurations, then all with one outside. */
void proof_sprf_paper_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    uint32_t q_lsb2_s3 = ANY_U32(0, UINT32_MAX);
    uint16_t gate = ANY_U16(0, UINT16_MAX);
    init_with(ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000), ANY_U16(256, 4096));
    init_with(ANY_U16(0, 49), r_lsb2_q8, q_lsb2_s3, gate);
    init_with(ANY_U16(40001, UINT16_MAX), r_lsb2_q8, q_lsb2_s3, gate);
    init_with(rate_dhz, ANY_U32(0, 2), q_lsb2_s3, gate);
    init_with(rate_dhz, ANY_U32(256001, UINT32_MAX), q_lsb2_s3, gate);
    init_with(rate_dhz, r_lsb2_q8, 0, gate);
    init_with(rate_dhz, r_lsb2_q8, ANY_U32(1000000001, UINT32_MAX), gate);
    init_with(rate_dhz, r_lsb2_q8, q_lsb2_s3, ANY_U16(0, 255));
    init_with(rate_dhz, r_lsb2_q8, q_lsb2_s3, ANY_U16(4097, UINT16_MAX));
    sprf_paper_config_t config;
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
