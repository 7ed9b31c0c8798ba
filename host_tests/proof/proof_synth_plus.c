/* synth_plus: see law.h and synth_bounds.h. */
#define LAST_COUNT 31
#define CONFIGURATIONS(law) 9
#define KEPT(f)                                                                         \
    (SYNTH_KEPT(f) && 656 <= (f)->own.synth.b0_uq16 && (f)->own.synth.of.plus.k <= 8 && \
     (f)->own.synth.of.plus.rest_uq8 <= 128)
#include "synth_bounds.h"

#include "synth_plus.c"

static void any_own(filter_t *f, uint8_t kind)
{
    (void)kind;
    any_synth(f);
    f->own.synth.of.plus.b1_uq16 = ANY_U16(0, UINT16_MAX);
    f->own.synth.of.plus.b2_uq16 = ANY_U16(0, UINT16_MAX);
    f->own.synth.of.plus.b1_negative = ANY_BOOL();
    f->own.synth.of.plus.b2_negative = ANY_BOOL();
    f->own.synth.of.plus.k = ANY_U8(0, 8);
    f->own.synth.of.plus.rest_uq8 = ANY_U8(0, 128);
}

/* k by k, because the shift comes of it. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    config->value[SYNTH_PLUS_K] = (int32_t)number;
}

/* Any coefficients within their ranges, stable or not. */
void proof_filter_synth_taps_noise_gain_uq16(void)
{
    filter_config_t config = { 0 };
    any_config(&config, &filter_law_synth_plus, false);
    (void)filter_synth_taps_noise_gain_uq16(&config);
}

/* So many counts are kept apart. Options: -eva-ilevel 64 */
PROVE_LAW(synth_plus)
