/*
 * synth: its bounds, and what no descriptor tells (support_law_facts.h).
 *
 * At (0, 0.3) the error obeys e = 0.7 (2 e1 - e2) from 2 n and 2 n - 2 LSB: |e| <= 400.1 x 0.83666^k, and below 1/4 LSB
 * from k = 40 on for every gap n <= 200. Poles at 0.83666: e^-10 after 56 samples. Joint condition: the stability
 * region of a1 and b0.
 */
#include "support_law_facts.h"
#include "synth.h"

/* synth.c: gains as configured. */
const char *broken_synth(const filter_t *f)
{
    return (f->own.synth.b0_uq16 < SYNTH_B0_MIN_UQ16) ? "configuration" : broken_estimates(f);
}

law_facts_t law_facts_synth(void)
{
    return (law_facts_t){ ENVELOPE(2.277, 1.0, 0.0, 56, ENVELOPE_FIXED_GAIN) USUAL,
                          REFUSES,
                          SETTLES_IN(40),
                          .joint_condition = true,
                          .rate_is_a_difference = true,
                          .synthesised = true };
}
