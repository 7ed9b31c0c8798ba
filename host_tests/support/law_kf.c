/*
 * kf: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * With q T^3 / R = 1/300 (defaults at 100 Hz) and P grown over the gap, sqrt(P11 V) is below 1/4 LSB after 43 samples
 * for the worst gap.
 */
#include "support/law_facts.h"

const char *broken_kf(const filter_t *f)
{
    return gate_shows(f) ? "flags of a gate" : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

law_facts_t law_facts_kf(void)
{
    return (law_facts_t){ ENVELOPE(TWO_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_LINEAR) USUAL, REFUSES,
                          SETTLES_IN(43) };
}
