/* synth_plus: any int16, any state within its bounds; the same bounds afterwards. */
#include "synth_bounds.h"

#include "synth_plus.h"

#define MEMORY_Q16 1207959552 /* 18432 LSB */

/* All but what synth_plus_set_noise sets, because synth_plus_init calls it. */
#define BUT_NOISE(f)                                                                           \
    (656 <= (f)->b0_uq16 && (f)->k <= 8 && -MEMORY_Q16 <= (f)->memory_lsb_q16 <= MEMORY_Q16 && \
     (f)->spread.motion_lsb <= 320 && CORE_BUT_NOISE(&(f)->core, 31))
#define BOUND(f) (BUT_NOISE(f) && SPREAD(&(f)->spread) && CORE(&(f)->core, 31))

/*@ ensures \result ==> BOUND(f); */
bool synth_plus_init(synth_plus_t *f, const synth_plus_config_t *config);
/*@ requires BUT_NOISE(f); ensures BOUND(f); */
void synth_plus_set_noise(synth_plus_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_plus_reset(synth_plus_t *f, int16_t z0_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_plus_update(synth_plus_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_plus_coast(synth_plus_t *f);

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

static void any_start(synth_plus_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_start(&f->core, from_collected, to_collected);
}

static void any_run(synth_plus_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_run(&f->core, from_collected, to_collected);
}

static void any_later_run(synth_plus_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    any_core_later(&f->core, from_collected, to_collected);
}

static void init_with(synth_plus_config_t config)
{
    synth_plus_t f;
    (void)synth_plus_init(&f, &config);
}

static synth_plus_config_t any_config(void)
{
    synth_plus_config_t config;
    config.rate_dhz = ANY_U16(0, UINT16_MAX);
    config.b0_uq16 = ANY_U16(0, UINT16_MAX);
    config.k = ANY_U16(0, UINT16_MAX);
    config.b1_q16 = ANY_S32(S32_MIN, INT32_MAX);
    config.b2_q16 = ANY_S32(S32_MIN, INT32_MAX);
    config.r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    return config;
}

/* Uses: fx_isqrt32. A box that holds all legal configurations, then all with one parameter below or above it. */
void proof_synth_plus_init(void)
{
    synth_plus_config_t legal;
    legal.rate_dhz = ANY_U16(50, 40000);
    legal.b0_uq16 = ANY_U16(656, UINT16_MAX);
    legal.k = ANY_U16(0, 8);
    legal.b1_q16 = ANY_S32(-65535, 65535);
    legal.b2_q16 = ANY_S32(-65535, 65535);
    legal.r_lsb2_q8 = ANY_U32(3, 256000);
    init_with(legal);
    synth_plus_config_t config = any_config();
    config.rate_dhz = ANY_U16(0, 49);
    init_with(config);
    config.rate_dhz = ANY_U16(40001, UINT16_MAX);
    init_with(config);
    config = any_config();
    config.b0_uq16 = ANY_U16(0, 655);
    init_with(config);
    config = any_config();
    config.k = ANY_U16(9, UINT16_MAX);
    init_with(config);
    config = any_config();
    config.b1_q16 = ANY_S32(S32_MIN, -65536);
    init_with(config);
    config.b1_q16 = ANY_S32(65536, INT32_MAX);
    init_with(config);
    config = any_config();
    config.b2_q16 = ANY_S32(S32_MIN, -65536);
    init_with(config);
    config.b2_q16 = ANY_S32(65536, INT32_MAX);
    init_with(config);
    config = any_config();
    config.r_lsb2_q8 = ANY_U32(0, 2);
    init_with(config);
    config.r_lsb2_q8 = ANY_U32(256001, UINT32_MAX);
    init_with(config);
    synth_plus_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: fx_isqrt32 */
void proof_synth_plus_set_noise(void)
{
    synth_plus_t f;
    any_start(&f, 0, 4);
    synth_plus_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_run(&f, 5, 31);
    synth_plus_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 5, 31);
    synth_plus_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 255, 255);
    synth_plus_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

void proof_synth_plus_reset(void)
{
    synth_plus_t f;
    any_start(&f, 0, 4);
    synth_plus_reset(&f, ANY_Z());
    any_run(&f, 5, 31);
    synth_plus_reset(&f, ANY_Z());
    any_later_run(&f, 5, 31);
    synth_plus_reset(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    synth_plus_reset(&f, ANY_Z());
}

/*
 * Uses: limit_x, fit_line.
 * Options: -eva-split-return-function synth_extrapolate:full,start_step:full,plus_step:full
 */
void proof_synth_plus_update(void)
{
    synth_plus_t f;
    any_start(&f, 0, 3);
    (void)synth_plus_update(&f, ANY_Z());
    any_start(&f, 4, 4);
    (void)synth_plus_update(&f, ANY_Z());
    any_run(&f, 5, 31);
    (void)synth_plus_update(&f, ANY_Z());
    any_later_run(&f, 5, 31);
    (void)synth_plus_update(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    (void)synth_plus_update(&f, ANY_Z());
}

/* Uses: limit_x */
void proof_synth_plus_coast(void)
{
    synth_plus_t f;
    any_start(&f, 0, 4);
    (void)synth_plus_coast(&f);
    any_run(&f, 5, 31);
    (void)synth_plus_coast(&f);
    any_later_run(&f, 5, 31);
    (void)synth_plus_coast(&f);
    any_later_run(&f, 255, 255);
    (void)synth_plus_coast(&f);
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
    synth_plus_t f;
    filter_probe_t probe;
    any_start(&f, 0, 4);
    synth_plus_probe(&f, &probe);
    any_run(&f, 5, 31);
    synth_plus_probe(&f, &probe);
    any_later_run(&f, 5, 31);
    synth_plus_probe(&f, &probe);
    any_later_run(&f, 255, 255);
    synth_plus_probe(&f, &probe);
    (void)synth_plus_flags(&f);
}
