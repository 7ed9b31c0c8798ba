/* synth: see law.h and synth_bounds.h. */
#define LAST_COUNT 63
#define KEPT(f) (SYNTH_KEPT(f) && 656 <= (f)->own.synth.b0_uq16)
#include "synth_bounds.h"

#include "synth.c"

static void any_own(filter_t *f, uint8_t kind)
{
    (void)kind;
    any_synth(f);
}

/* Any gain and extrapolation within its range, stable or not. */
void proof_filter_synth_noise_gain_uq16(void)
{
    (void)filter_synth_noise_gain_uq16(ANY_U16(656, UINT16_MAX), ANY_S32(-65535, 65535));
}

/* With a sample and without. */
void proof_filter_synth_step(void)
{
    filter_t f;
    any_tracked(&f, NULL);
    f.rate_lsb = ANY_S32(-BENT_END, BENT_END);
    filter_synth_step(&f, 0, STEP_MISSING);
    any_tracked(&f, NULL);
    f.rate_lsb = ANY_S32(-BENT_END, BENT_END);
    filter_synth_step(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), STEP_SAMPLE);
}

/* So many counts are kept apart. Options: -eva-ilevel 64 */
PROVE_LAW(synth)
