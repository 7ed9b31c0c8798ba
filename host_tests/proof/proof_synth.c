/* synth: see law.h and synth_bounds.h. */
#define LAST_COUNT 63
#define KEPT(f) (SYNTH_KEPT(f) && 656 <= (f)->own.synth.b0_uq16)
#include "synth_bounds.h"

#include "synth.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_synth(f, kind, 1, 365);
}


/* Any gain and extrapolation within its range, stable or not. */
void proof_filter_synth_noise_gain_uq16(void)
{
    (void)filter_synth_noise_gain_uq16(ANY_U16(656, UINT16_MAX), ANY_S32(-65535, 65535));
}

void proof_fit_line(void)
{
    filter_t f;
    any_starting(&f, &filter_law_synth, 0, 5);
    f.own.synth.spread_lsb = ANY_S16(1, 365);
    (void)fit_line(&f);
}

PROVE_LAW(synth)
