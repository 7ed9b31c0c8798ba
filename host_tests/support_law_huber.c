/*
 * huber: its bounds, and what no descriptor tells (support_law_facts.h).
 *
 * Back after a gap it moves by c sigmas a sample at first: the recursion in double over every gap is below 1/4 LSB after
 * 120.
 * Envelope: a jump is followed at the pace of c sigmas a sample, which no rule there describes.
 */
#include "support_law_facts.h"

const char *broken_huber(const filter_t *f)
{
    return gate_shows(f) ? "flags of a gate" : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

law_facts_t law_facts_huber(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, LINEAR_FORGETS, 0, ENVELOPE_NONE) USUAL, REFUSES, SETTLES_IN(125),
                          .stays_away = true };
}
