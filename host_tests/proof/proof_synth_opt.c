/* synth_opt: see law.h and synth_bounds.h. */
#define LAST_COUNT 16
#define KINDS 13 /* count by count: the schedule's place is made of it */
#define KEPT(f)                                                       \
    (SYNTH_KEPT(f) && (f)->own.synth.of.scheduled.ratio_class <= 5 && \
     3 <= (f)->own.synth.of.scheduled.p0_lsb2_q8 <= 25600000)
#include "synth_bounds.h"

#include "synth_opt.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_synth(f);
    f->own.synth.count = (kind == 0U) ? SYNTH_STEADY : (uint8_t)(SYNTH_FIRST_GAIN - 1 + kind);
    f->own.synth.of.scheduled.p0_lsb2_q8 = ANY_U32(3, 25600000);
    f->own.synth.of.scheduled.ratio_class = ANY_U8(0, 5);
    f->own.synth.of.scheduled.variant_u = ANY_BOOL();
}

/* The least default of P0 is made of that of R. Whole: filter_tracker_limited_r */
PROVE_LAW(synth_opt)
