/* synth_plus: see law.h and synth_bounds.h. */
#define LAST_COUNT 31
#define CONFIGURATIONS 9
#define KEPT(f) (SYNTH_KEPT(f) && 656 <= (f)->own.synth.b0_uq16 && (f)->own.synth.of.plus.k <= 8 && (f)->own.synth.of.plus.rest_uq8 <= 128)
#include "synth_bounds.h"

#include "synth_plus.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_synth(f, kind);
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

/* Uses: fx_isqrt32 */
PROVE(set_up, synth_plus)
/* Options: -no-warn-signed-downcast */
PROVE(defaults, synth_plus)
/* Uses: fx_isqrt32 */
PROVE(set_noise, synth_plus)
/* Uses: fit_line */
PROVE(start, synth_plus)
/* Uses: tracker_bounded, fx_without_part, fx_clamp_high. Options: -eva-split-return-function start_step:full */
PROVE(step, synth_plus)
PROVE(fade, synth_plus)
/* Uses: fx_normalise, rounded */
PROVE(report, synth_plus)

/* Uses: fx_normalise, rounded. Any coefficients within their ranges, stable or not. */
void proof_filter_synth_plus_noise_gain_uq16(void)
{
    filter_config_t config = { 0 };
    any_config(&config, &filter_law_synth_plus, false);
    (void)filter_synth_plus_noise_gain_uq16(&config);
}
