/* synth_plus: any int16, any state within its bounds; the same bounds afterwards. */
#include "synth_bounds.h"

#include "synth_plus.h"

#define MEMORY_Q16 1207959552 /* 18432 LSB */

/* All but what synth_plus_set_noise sets, because synth_plus_init calls it. */
#define BUT_NOISE(f)                                                                                                   \
    (656 <= (f)->b0_uq16 && (f)->k <= 8 && (f)->rest_uq8 <= 128 && -MEMORY_Q16 <= (f)->memory_lsb_q16 <= MEMORY_Q16 && \
     (f)->spread.motion_lsb <= 320 && CORE_BUT_NOISE(&(f)->core, 31))
#define BOUND(f) (BUT_NOISE(f) && SPREAD(&(f)->spread) && CORE(&(f)->core, 31))

/*@ ensures \result ==> BOUND(f); */
bool synth_plus_init(synth_plus_t *f, const synth_plus_config_t *config);
/*@ requires BUT_NOISE(f); ensures BOUND(f); */
void synth_plus_set_noise(synth_plus_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_plus_reset(synth_plus_t *f, int16_t z0_lsb);
bool synth_plus_reset_step(synth_plus_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_plus_update(synth_plus_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_plus_coast(synth_plus_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_plus_damp(synth_plus_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_plus_hold(synth_plus_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_plus_restart(synth_plus_t *f);

#include "filter_common.c"
#include "fx.c"

#include "synth_common.c"

#include "synth_plus.c"

static void any_common(synth_plus_t *f)
{
    any_spread(&f->spread);
    f->memory_lsb_q16 = ANY_S32(-MEMORY_Q16, MEMORY_Q16);
    f->b0_uq16 = ANY_U16(656, UINT16_MAX);
    f->b1_uq16 = ANY_U16(0, UINT16_MAX);
    f->b2_uq16 = ANY_U16(0, UINT16_MAX);
    f->b1_negative = ANY_BOOL();
    f->b2_negative = ANY_BOOL();
    f->k = ANY_U8(0, 8);
    f->rest_uq8 = ANY_U8(0, 128);
}

static void any_state(synth_plus_t *f, uint8_t kind)
{
    any_common(f);
    any_core_of_kind(&f->core, kind, 31);
}

/*
 * Uses: fx_isqrt32. A box that holds all legal configurations, k by k because the shift comes of it, then all with one
 * parameter below or above it.
 */
void proof_synth_plus_init(void)
{
    synth_plus_t f;
    synth_plus_config_t config;
    for (uint8_t number = 0; number < CASES(6); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.b0_uq16 = any_u16(part_of(number, 1), 656, UINT16_MAX);
        config.k = any_u16(part_of(number, 2), 0, 8);
        config.b1_q16 = any_s32(part_of(number, 3), -65535, 65535);
        config.b2_q16 = any_s32(part_of(number, 4), -65535, 65535);
        config.r_lsb2_q8 = any_u32(part_of(number, 5), 3, 256000, UINT32_MAX);
        for (uint16_t k = 0; k < 9 && number == 0U; k++) {
            config.k = k;
            (void)synth_plus_init(&f, &config);
        }
        if (number != 0U) {
            (void)synth_plus_init(&f, &config);
        }
    }
    synth_plus_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: fx_isqrt32 */
void proof_synth_plus_set_noise(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        synth_plus_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

void proof_synth_plus_reset(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        synth_plus_reset(&f, ANY_Z());
    }
}

void proof_synth_plus_reset_step(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        (void)synth_plus_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    }
}

/*
 * Uses: limit_x, fit_line, fx_without_part, fx_clamp_high.
 * Options: -eva-split-return-function synth_extrapolate:full,start_step:full,plus_step:full
 */
void proof_synth_plus_update(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        (void)synth_plus_update(&f, ANY_Z());
    }
}

/* Uses: limit_x, fx_without_part, fx_clamp_high */
void proof_synth_plus_coast(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        (void)synth_plus_coast(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_synth_plus_gap(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        synth_plus_damp(&f);
        any_state(&f, kind);
        synth_plus_gap(&f);
        any_state(&f, kind);
        synth_plus_hold(&f);
        any_state(&f, kind);
        synth_plus_restart(&f);
    }
}

/* Uses: fx_normalise, rounded. Any coefficients within their ranges, stable or not. */
void proof_synth_plus_noise_gain_uq16(void)
{
    synth_plus_config_t config;
    config.b0_uq16 = ANY_U16(656, UINT16_MAX);
    config.k = ANY_U16(0, 8);
    config.b1_q16 = ANY_S32(-65535, 65535);
    config.b2_q16 = ANY_S32(-65535, 65535);
    (void)synth_plus_noise_gain_uq16(&config);
}

/* Uses: fx_normalise, rounded */
void proof_synth_plus_probe(void)
{
    filter_probe_t probe;
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_plus_t f;
        any_state(&f, kind);
        synth_plus_probe(&f, &probe);
        (void)synth_plus_flags(&f);
    }
}
