/*
 * shrf: its bounds, and what no descriptor tells (support/law_facts.h). Joint condition: of stay with ratio and clean.
 *
 * It takes a sample surely when b t / 2 <= ln(0.85 / 0.15) + ln(S_N / S) / 2: with t <= V <= 1600 / n (sprf_paper's
 * bound) and b = 399 / (P11 + 400), P11 = n^3 / 900, from n = 100 on; and 43 more, rounded up.
 */
#include "support/law_facts.h"

const char *broken_shrf(const filter_t *f)
{
    return broken_mixture(f);
}

law_facts_t law_facts_shrf(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 1200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_WAITS) USUAL, SETTLES_IN(150),
                          .published_only = true, .joint_condition = true, .loses_motion = true };
}
