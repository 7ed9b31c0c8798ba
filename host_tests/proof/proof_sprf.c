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

/* Uses: kalman_set_up */
PROVE(set_up, sprf)
/* Options: -no-warn-signed-downcast */
PROVE(defaults, sprf)
/* Uses: kalman_set_variance, kalman_set_gate */
PROVE(set_noise, sprf)
PROVE(start, sprf)
/* Uses: kalman_step, kalman_refused */
PROVE(step, sprf)
PROVE(fade, sprf)
PROVE(report, sprf)
