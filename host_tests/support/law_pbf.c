/*
 * pbf: its bounds, and what no descriptor tells (support/law_facts.h). Joint condition: of stay with ratio and clean.
 *
 * It uses every sample and is faster than shrf, whose bound it has.
 */
#include "support/law_facts.h"

const char *broken_pbf(const filter_t *f)
{
    return broken_mixture(f);
}

law_facts_t law_facts_pbf(void)
{
    return (law_facts_t){ ENVELOPE(MIXTURE_SUM, 1.0, 800.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_MIXTURE) USUAL,
                          SETTLES_IN(150), .joint_condition = true, .loses_motion = true };
}
