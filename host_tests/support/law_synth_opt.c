/*
 * synth_opt: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * In the limit the error obeys e = (2 e1 - e2) / 3 (poles at 0.57735): below 1/4 LSB after 14, the recursion run in
 * double over every gap.
 */
#include "support/law_facts.h"
#include "synth.h"

#ifndef __AVR__
/* Of (a1, b0) = (0, 2/3), where its schedule ends. */
static double noise_gain(const filter_t *f)
{
    (void)f;
    return 2.0 / 3.0;
}
#endif

/* synth_opt.c: the schedule ends with its 12th step; a class of P0 / R; no gain below 1/2 but where none was used. */
const char *broken_synth_opt(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    bool scheduled = running(f) && s->count != (uint8_t)SYNTH_STEADY;
    if (s->of.scheduled.ratio_class > 5U || (scheduled && s->count > 16U)) {
        return "schedule";
    }
    bool updated = scheduled && s->count > (uint8_t)SYNTH_FIRST_GAIN && (f->flags & FILTER_COASTED) == 0U;
    if (updated && f->gain_uq16 < 0x8000U) {
        return "gain";
    }
    return broken_estimates(f);
}

law_facts_t law_facts_synth_opt(void)
{
    return (law_facts_t){ ENVELOPE(1.446, 1.0, 0.0, 19, ENVELOPE_FIXED_GAIN, .noise_gain = noise_gain) USUAL,
                          REFUSES,
                          SETTLES_IN(14),
                          .published_only = true,
                          .rate_is_a_difference = true,
                          .synthesised = true };
}
