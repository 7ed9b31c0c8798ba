/* synth_opt: any int16, any state within its bounds; the same bounds afterwards. */
#include "synth_bounds.h"

#include "synth_opt.h"

/* All but what synth_opt_set_noise sets, because synth_opt_init calls it. */
#define BUT_NOISE(f) (3 <= (f)->p0_lsb2_q8 <= 25600000 && (f)->ratio_class <= 5 && CORE_BUT_NOISE(&(f)->core, 16))
#define BOUND(f) (BUT_NOISE(f) && CORE(&(f)->core, 16))

/*@ ensures \result ==> BOUND(f); */
bool synth_opt_init(synth_opt_t *f, const synth_opt_config_t *config);
/*@ requires BUT_NOISE(f); ensures BOUND(f); */
void synth_opt_set_noise(synth_opt_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_opt_reset(synth_opt_t *f, int16_t z0_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_opt_update(synth_opt_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_opt_coast(synth_opt_t *f);

#include "filter_common.c"
#include "fx.c"

#include "synth_common.c"

#include "synth_opt.c"

static void any_common(synth_opt_t *f)
{
    f->p0_lsb2_q8 = ANY_U32(3, 25600000);
    f->ratio_class = ANY_U8(0, 5);
    f->variant_u = ANY_BOOL();
}

static void any_start(synth_opt_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_start(&f->core, from_collected, to_collected);
}

static void any_run(synth_opt_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_run(&f->core, from_collected, to_collected);
}

static void any_later_run(synth_opt_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_later(&f->core, from_collected, to_collected);
}

static void init_with(uint16_t rate_dhz, uint16_t variant_u, uint32_t p0_lsb2_q8, uint32_t r_lsb2_q8)
{
    synth_opt_t f;
    synth_opt_config_t config = { rate_dhz, variant_u, p0_lsb2_q8, r_lsb2_q8 };
    (void)synth_opt_init(&f, &config);
}

/* A box that holds all legal configurations, then all with one parameter below or above it. */
void proof_synth_opt_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint16_t variant_u = ANY_U16(0, UINT16_MAX);
    uint32_t p0_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    init_with(ANY_U16(50, 40000), ANY_U16(0, 1), ANY_U32(3, 25600000), ANY_U32(3, 256000));
    init_with(ANY_U16(0, 49), variant_u, p0_lsb2_q8, r_lsb2_q8);
    init_with(ANY_U16(40001, UINT16_MAX), variant_u, p0_lsb2_q8, r_lsb2_q8);
    init_with(rate_dhz, ANY_U16(2, UINT16_MAX), p0_lsb2_q8, r_lsb2_q8);
    init_with(rate_dhz, variant_u, ANY_U32(0, 2), r_lsb2_q8);
    init_with(rate_dhz, variant_u, ANY_U32(25600001, UINT32_MAX), r_lsb2_q8);
    init_with(rate_dhz, variant_u, p0_lsb2_q8, ANY_U32(0, 2));
    init_with(rate_dhz, variant_u, p0_lsb2_q8, ANY_U32(256001, UINT32_MAX));
    synth_opt_config_t config;
    synth_opt_defaults(&config, ANY_U16(50, 40000));
}

void proof_synth_opt_set_noise(void)
{
    synth_opt_t f;
    any_start(&f, 0, 4);
    synth_opt_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_run(&f, 5, 16);
    synth_opt_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 5, 16);
    synth_opt_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 255, 255);
    synth_opt_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

void proof_synth_opt_reset(void)
{
    synth_opt_t f;
    any_start(&f, 0, 4);
    synth_opt_reset(&f, ANY_Z());
    any_run(&f, 5, 16);
    synth_opt_reset(&f, ANY_Z());
    any_later_run(&f, 5, 16);
    synth_opt_reset(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    synth_opt_reset(&f, ANY_Z());
}

/* Uses: limit_x. Options: -eva-split-return-function synth_extrapolate:full,move_on:full,synth_opt_step:full */
void proof_synth_opt_update(void)
{
    synth_opt_t f;
    any_start(&f, 0, 3);
    (void)synth_opt_update(&f, ANY_Z());
    any_start(&f, 4, 4);
    (void)synth_opt_update(&f, ANY_Z());
    any_run(&f, 5, 16);
    (void)synth_opt_update(&f, ANY_Z());
    any_later_run(&f, 5, 16);
    (void)synth_opt_update(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    (void)synth_opt_update(&f, ANY_Z());
}

/* Uses: limit_x */
void proof_synth_opt_coast(void)
{
    synth_opt_t f;
    any_start(&f, 0, 4);
    (void)synth_opt_coast(&f);
    any_run(&f, 5, 16);
    (void)synth_opt_coast(&f);
    any_later_run(&f, 5, 16);
    (void)synth_opt_coast(&f);
    any_later_run(&f, 255, 255);
    (void)synth_opt_coast(&f);
}

/* Uses: fx_normalise, rounded */
void proof_synth_opt_probe(void)
{
    synth_opt_t f;
    filter_probe_t probe;
    any_start(&f, 0, 4);
    synth_opt_probe(&f, &probe);
    any_run(&f, 5, 16);
    synth_opt_probe(&f, &probe);
    any_later_run(&f, 5, 16);
    synth_opt_probe(&f, &probe);
    any_later_run(&f, 255, 255);
    synth_opt_probe(&f, &probe);
    (void)synth_opt_flags(&f);
}
