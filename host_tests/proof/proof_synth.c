/* synth: any int16, any state within its bounds; the same bounds afterwards. Its parts, which the others share, too. */
#include "synth_bounds.h"

#include "synth.h"

/* All but what synth_set_noise sets, because synth_init calls it. */
#define BUT_NOISE(f) (656 <= (f)->b0_uq16 && (f)->spread.motion_lsb <= 320 && CORE_BUT_NOISE(&(f)->core, 63))
#define BOUND(f) (BUT_NOISE(f) && SPREAD(&(f)->spread) && CORE(&(f)->core, 63))

/*@ ensures \result ==> BOUND(f); */
bool synth_init(synth_t *f, const synth_config_t *config);
/*@ requires BUT_NOISE(f); ensures BOUND(f); */
void synth_set_noise(synth_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_reset(synth_t *f, int16_t z0_lsb);
bool synth_reset_step(synth_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_update(synth_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_coast(synth_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_damp(synth_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_hold(synth_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_restart(synth_t *f);

#include "filter_common.c"
#include "fx.c"

#include "synth_common.c"

#include "synth.c"

static void any_common(synth_t *f)
{
    any_spread(&f->spread);
    f->a1_uq16 = ANY_U16(0, UINT16_MAX);
    f->b0_uq16 = ANY_U16(656, UINT16_MAX);
    f->a1_negative = ANY_BOOL();
}

static void any_state(synth_t *f, uint8_t kind)
{
    any_common(f);
    any_core_of_kind(&f->core, kind, 63);
}

void proof_limit_x(void)
{
    for (int16_t cell = -128; cell < 128; cell++) {
        int32_t from_q16 = (int32_t)cell * CELL_Q16;
        int32_t x_q16 = ANY_S32(from_q16, from_q16 + (CELL_Q16 - 1));
        (void)limit_x(&x_q16);
    }
}

/*
 * By intervals of the median: near an end of the range the other samples can be far from it to one side only, which
 * keeps the line within the bound even though intervals take mean and slope for independent.
 */
void proof_fit_line(void)
{
    for (int16_t from_lsb = FILTER_Z_MIN_LSB; from_lsb <= FILTER_Z_MAX_LSB; from_lsb += 32) {
        synth_core_t c;
        any_core_start(&c, FILTER_WARM_UP_SAMPLES, FILTER_WARM_UP_SAMPLES);
        c.u.start.ascending_lsb[2] = ANY_S16(from_lsb, from_lsb + 31);
        (void)fit_line(&c, ANY_S16(1, 365));
    }
}

/* Uses: fx_isqrt32. A box that holds all legal configurations, then all with one parameter below or above it. */
void proof_synth_init(void)
{
    synth_t f;
    synth_config_t config;
    for (uint8_t number = 0; number < CASES(4); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.b0_uq16 = any_u16(part_of(number, 1), 656, UINT16_MAX);
        config.a1_q16 = any_s32(part_of(number, 2), -65535, 65535);
        config.r_lsb2_q8 = any_u32(part_of(number, 3), 3, 256000, UINT32_MAX);
        (void)synth_init(&f, &config);
    }
    synth_defaults(&config, ANY_U16(50, 40000));
    synth_paper(&config, ANY_U16(50, 40000));
}

/* Uses: fx_isqrt32 */
void proof_synth_set_noise(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        synth_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

void proof_synth_reset(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        synth_reset(&f, ANY_Z());
    }
}

void proof_synth_reset_step(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        (void)synth_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    }
}

/*
 * Uses: limit_x, fit_line.
 * Options: -eva-split-return-function synth_extrapolate:full,synth_next_gain_uq16:full,step:full
 */
void proof_synth_update(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        (void)synth_update(&f, ANY_Z());
    }
}

/* Uses: limit_x */
void proof_synth_coast(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        (void)synth_coast(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_synth_gap(void)
{
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        synth_damp(&f);
        any_state(&f, kind);
        synth_gap(&f);
        any_state(&f, kind);
        synth_hold(&f);
        any_state(&f, kind);
        synth_restart(&f);
    }
}

/* Uses: fx_normalise, rounded. Any gain and extrapolation within its range, stable or not. */
void proof_synth_noise_gain_uq16(void)
{
    (void)synth_noise_gain_uq16(ANY_U16(656, UINT16_MAX), ANY_S32(-65535, 65535));
}

/* Uses: fx_normalise, rounded */
void proof_synth_probe(void)
{
    filter_probe_t probe;
    for (uint8_t kind = 0; kind < CORE_KINDS; kind++) {
        synth_t f;
        any_state(&f, kind);
        synth_probe(&f, &probe);
        (void)synth_flags(&f);
    }
}
