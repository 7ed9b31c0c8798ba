/*
 * synth: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * At (0, 0.3) the error obeys e = 0.7 (2 e1 - e2) from 2 n and 2 n - 2 LSB: |e| <= 400.1 x 0.83666^k, and below 1/4 LSB
 * from k = 40 on for every gap n <= 200. Poles at 0.83666: e^-10 after 56 samples. Joint condition: the stability
 * region of a1 and b0.
 */
#include "support/law_facts.h"
#include "synth.h"

#ifndef __AVR__
static double noise_gain(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    int32_t a1_uq16 = s->a1_uq16;
    return filter_synth_noise_gain_uq16(s->b0_uq16, s->a1_negative ? -a1_uq16 : a1_uq16) / 65536.0;
}
#endif

/* synth.h: v and v' are within the limit of the rate. */
static const char *broken_running_estimates(const filter_t *f)
{
    const filter_synth_t *s = &f->own.synth;
    if (filter_fx_abs32(s->rate_before_lsb_q16) > f->rate_max_lsb) {
        return "rate before";
    }
    bool steady = s->count == (uint8_t)SYNTH_STEADY;
    return (!steady && (s->count < (uint8_t)SYNTH_FIRST_GAIN || s->count > (uint8_t)SYNTH_END_GAIN)) ? "count" : NULL;
}

const char *broken_estimates(const filter_t *f)
{
    if (r_broken(f->own.synth.r_lsb2_q8, FILTER_R_MAX_LSB2_Q8)) {
        return "r";
    }
    return running(f) ? broken_running_estimates(f) : NULL;
}

/* synth.c: gains as configured. */
const char *broken_synth(const filter_t *f)
{
    return (f->own.synth.b0_uq16 < SYNTH_B0_MIN_UQ16) ? "configuration" : broken_estimates(f);
}

law_facts_t law_facts_synth(void)
{
    return (law_facts_t){ ENVELOPE(2.277, 1.0, 0.0, 56, ENVELOPE_FIXED_GAIN, .noise_gain = noise_gain) USUAL,
                          REFUSES,
                          SETTLES_IN(40),
                          .published_only = true,
                          .joint_condition = true,
                          .rate_is_a_difference = true,
                          .synthesised = true };
}
