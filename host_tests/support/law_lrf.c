/*
 * lrf: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * It is kf with q T^3 / R_L = 1/300/60.85 and R_L = 182.6 LSB^2: back after 114 samples by the same bound.
 */
#include "support/law_facts.h"

/* kf.c: R_L / R = N^2 - q1 (N^2 - 1) of 1..1024, R_L to 65,536 LSB^2. */
const char *broken_lrf(const filter_t *f)
{
    uint32_t factor_uq16 = f->own.kalman.of.factor_uq16;
    if (gate_shows(f)) {
        return "flags of a gate";
    }
    if (factor_uq16 < 0x10000U || factor_uq16 > 1024UL << 16) {
        return "factor";
    }
    return broken_core(f, 0xFFFFFFU);
}

law_facts_t law_facts_lrf(void)
{
    return (law_facts_t){ ENVELOPE(TWO_STATE_SUM, 60.85, LINEAR_FORGETS, 0, ENVELOPE_LINEAR) USUAL, REFUSES,
                          SETTLES_IN(114), .stays_away = true, .loses_motion = true };
}
