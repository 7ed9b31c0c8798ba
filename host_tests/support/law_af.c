/*
 * af: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * It uses every sample and is faster than shrf, whose bound it has.
 */
#include "support/law_facts.h"

const char *broken_af(const filter_t *f)
{
    return broken_mixture(f);
}

law_facts_t law_facts_af(void)
{
    return (law_facts_t){ ENVELOPE(MIXTURE_SUM, 1.0, 800.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_MIXTURE) USUAL,
                          SETTLES_IN(150), .learns = true, .loses_motion = true };
}
