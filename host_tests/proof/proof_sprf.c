/* sprf: see law.h. */
#define KEPT(f) (PARAMETERS(f) && (f)->own.kalman.of.gated.gate_sigma_q8 <= 4096)
#include "kalman_bounds.h"

#include "sprf.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
    f->own.kalman.of.gated.gate_sigma_q8 = ANY_U16(0, 4096);
    f->own.kalman.of.gated.share_uq16 = ANY_U16(0, UINT16_MAX);
}

PROVE_LAW(sprf)
