/*
 * soft: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * It takes kf's path within its soft gate and is restarted beyond its gate, as sprf; in between it updates with a
 * larger R, by which V falls as well (the recursion in double is back after 16). Joint condition: reacquire as sprf.
 */
#include "support/law_facts.h"

/* soft.c: nothing is refused, only a missing sample leaves no gain; re-acquisition as sprf. */
const char *broken_soft(const filter_t *f)
{
    const char *broken = broken_run(f);
    bool gated = (f->flags & FILTER_GATED) != 0U;
    if (gated && (f->own.kalman.of.gated.share_uq16 == 0U || f->own.kalman.run == 0U)) {
        return "gated";
    }
    return (broken != NULL) ? broken : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

law_facts_t law_facts_soft(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_REACQUIRES) USUAL, SETTLES_IN(43),
                          .joint_condition = true, .restarts = true };
}
