/* Re-acquisition: any refused sample, any run and state within their bounds; the same bounds afterwards. */
#include "reacquire_bounds.h"

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "reacquire.c"

void proof_reacquire_refused(void)
{
    two_state_t s;
    reacquire_t a;
    any_run(&a);
    any_state(&s);
    //@ admit HELD(s.u.p);
    (void)reacquire_refused(&a, &s, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

/* Uses: fx_isqrt32 */
void proof_reacquire_set_noise(void)
{
    two_state_t s;
    reacquire_t a;
    any_state(&s);
    reacquire_set_noise(&a, &s);
}
