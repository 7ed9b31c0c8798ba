/* synth_opt: see law.h and synth_bounds.h. */
#define LAST_COUNT 16
#define KEPT(f) (SYNTH_KEPT(f) && (f)->own.synth.of.scheduled.ratio_class <= 5 && 3 <= (f)->own.synth.of.scheduled.p0_lsb2_q8 <= 25600000)
#include "synth_bounds.h"

#include "synth_opt.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_synth(f, kind);
    f->own.synth.of.scheduled.p0_lsb2_q8 = ANY_U32(3, 25600000);
    f->own.synth.of.scheduled.ratio_class = ANY_U8(0, 5);
    f->own.synth.of.scheduled.variant_u = ANY_BOOL();
}

PROVE(set_up, synth_opt)
/* Options: -no-warn-signed-downcast */
PROVE(defaults, synth_opt)
PROVE(set_noise, synth_opt)
/* Uses: fit_line */
PROVE(start, synth_opt)
/* Uses: tracker_bounded */
PROVE(step, synth_opt)
PROVE(fade, synth_opt)
/* Uses: fx_normalise, rounded */
PROVE(report, synth_opt)
