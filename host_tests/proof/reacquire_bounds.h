/* The bounds of reacquire.h in ACSL and the contract of its step, proved by proof_reacquire.c. */
#ifndef REACQUIRE_BOUNDS_H
#define REACQUIRE_BOUNDS_H

#include "two_state_bounds.h"

#include "reacquire.h"

/* run never passes 8: a run of `steps` samples restarts with the next, or with steps 0 stays at 1. */
#define RUN(a) (SAMPLE((a)->first_lsb) && SAMPLE((a)->previous_lsb) && (a)->run <= 8 && (a)->steps <= 8)

/* Of P: soft, of which more is not known here, says WIDTH. */
#ifndef REACQUIRE_BEFORE
#define REACQUIRE_BEFORE(p) HELD(p)
#define REACQUIRE_AFTER(p) (SMALL(p) || HELD(p))
#endif

/*@ requires PARAMETERS(s) && ESTIMATE(s) && s->collected == 5 && RUN(a) && SAMPLE(z_lsb);
    requires REACQUIRE_BEFORE(s->u.p);
    assigns a->run, a->first_lsb, a->broken, s->x_lsb_q16, s->rate_lsb_q16, s->u, s->size_lsb_uq8, s->limit_lsb2,
            s->gain_uq16, s->flags, s->collected, \result \from *a, *s, z_lsb;
    ensures PARAMETERS(s) && ESTIMATE(s) && s->collected == 5 && RUN(a);
    ensures REACQUIRE_AFTER(s->u.p);
    ensures \result == 0 || \result == 1;
*/
bool reacquire_refused(reacquire_t *a, two_state_t *s, int16_t z_lsb);

static void any_run(reacquire_t *a)
{
    a->agree_lsb = ANY_U16(0, UINT16_MAX);
    a->first_lsb = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    a->previous_lsb = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    a->run = ANY_U8(0, 8);
    a->steps = ANY_U8(0, 8);
    a->broken = ANY_BOOL();
}

#endif
