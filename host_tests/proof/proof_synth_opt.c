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
bool synth_opt_reset_step(synth_opt_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_opt_update(synth_opt_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_opt_coast(synth_opt_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_opt_damp(synth_opt_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_opt_hold(synth_opt_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_opt_restart(synth_opt_t *f);

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

static void any_state(synth_opt_t *f, uint8_t kind)
{
    any_common(f);
    any_core_of_kind(&f->core, kind, 16);
}

/* A box that holds all legal configurations, then all with one parameter below or above it. */
void proof_synth_opt_init(void)
{
    synth_opt_t f;
    synth_opt_config_t config;
    for (uint8_t number = 0; number < CASES(4); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.variant_u = any_u16(part_of(number, 1), 0, 1);
        config.p0_lsb2_q8 = any_u32(part_of(number, 2), 3, 25600000, UINT32_MAX);
        config.r_lsb2_q8 = any_u32(part_of(number, 3), 3, 256000, UINT32_MAX);
        (void)synth_opt_init(&f, &config);
    }
    synth_opt_defaults(&config, ANY_U16(50, 40000));
}

void proof_synth_opt_set_noise(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        synth_opt_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

void proof_synth_opt_reset(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        synth_opt_reset(&f, ANY_Z());
    }
}

void proof_synth_opt_reset_step(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        (void)synth_opt_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    }
}

/* Uses: limit_x. Options: -eva-split-return-function synth_extrapolate:full,move_on:full,synth_opt_step:full */
void proof_synth_opt_update(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        (void)synth_opt_update(&f, ANY_Z());
    }
}

/* Uses: limit_x */
void proof_synth_opt_coast(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        (void)synth_opt_coast(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_synth_opt_gap(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        synth_opt_damp(&f);
        any_state(&f, kind);
        synth_opt_gap(&f);
        any_state(&f, kind);
        synth_opt_hold(&f);
        any_state(&f, kind);
        synth_opt_restart(&f);
    }
}

/* Uses: fx_normalise, rounded */
void proof_synth_opt_probe(void)
{
    filter_probe_t probe;
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_opt_t f;
        any_state(&f, kind);
        synth_opt_probe(&f, &probe);
        (void)synth_opt_flags(&f);
    }
}
