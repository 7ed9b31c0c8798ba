/*
 * synth_plus: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * With its alpha-beta of 0.289 and 0.0487 (0.843) the error is below 1/4 LSB after 40, the recursion run in double over
 * every gap. It rounds what rho takes off half up, so that a mirrored step may differ by 2^-16 LSB, and later estimates
 * by the sum of the response to that: 2^-4 LSB allows a sum of 4096. Envelope: kf's gains at the least R, fixed. Joint
 * condition: the stability region of its four coefficients.
 */
#include "support/law_facts.h"
#include "synth.h"

/* synth_plus.c: gains as configured, the memory as limited. */
const char *broken_synth_plus(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    if (s->b0_uq16 < SYNTH_B0_MIN_UQ16 || s->of.plus.k > 8U) {
        return "configuration";
    }
    if (running(f) && filter_fx_abs32(s->memory_lsb_q16) > (uint32_t)18432 << 16) {
        return "memory";
    }
    return broken_estimates(f);
}

law_facts_t law_facts_synth_plus(void)
{
    return (law_facts_t){ ENVELOPE(TWO_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_FIXED_GAIN) USUAL,
                          REFUSES,
                          SETTLES_IN(40),
                          .joint_condition = true,
                          .mirror_lsb_q16 = 4096,
                          .synthesised = true };
}
