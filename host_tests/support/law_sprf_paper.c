/*
 * sprf_paper: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * Where samples are refused V falls too, because P grows meanwhile: n samples after the motion's end, refused or
 * coasted, it is at most 16 / (q T^3 n) LSB^-2 (4 LSB^2 e and P of n steps of the model), 1600 / n here. It takes all
 * from V = 4 on, n = 400, and 43 more.
 */
#include "support/law_facts.h"

/* sprf_paper.c: gate of 1..16 sigma. */
const char *broken_sprf_paper(const filter_t *f)
{
    uint16_t gate2_uq8 = f->own.wide.gate2_uq8;
    return (gate2_uq8 < 256U || gate2_uq8 == UINT16_MAX) ? "gate" : broken_wide(f);
}

law_facts_t law_facts_sprf_paper(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) REFUSES,
                          SETTLES_IN(443),
                          .published_only = true,
                          .locks_out = true,
                          .stays_away = true,
                          .restarts = true,
                          .loses_motion = true };
}
