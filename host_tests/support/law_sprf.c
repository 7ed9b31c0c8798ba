/*
 * sprf: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * Back as kf when the first innovation is within its gate, else its five agreeing samples restart it without error.
 * Joint condition: of reacquire 3..9 only 3, 5 and 9, whose slope is a shift.
 */
#include "support/law_facts.h"

/* sprf.c: counted to five. */
const char *broken_sprf(const filter_t *f)
{
    const char *broken = broken_run(f);
    if (running(f) && f->own.kalman.refused > 5U) {
        return "refused";
    }
    return (broken != NULL) ? broken : broken_core(f, FILTER_R_MAX_LSB2_Q8);
}

law_facts_t law_facts_sprf(void)
{
    return (law_facts_t){ ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_STANDS) USUAL, REFUSES,
                          SETTLES_IN(43), .joint_condition = true, .restarts = true };
}
