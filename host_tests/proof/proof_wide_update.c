/* The update of the core with the wide covariance: any state within its bounds, any loss and back. */
#include "wide_bounds.h"

/* Uses: update_covariance, limited_state. By places of S and cells of the estimate. */
void proof_two_state_wide_update(void)
{
    for (uint8_t places = 0; places < 16; places++) {
        two_state_wide_t s;
        any_wide(&s, places);
        //@ admit REACH(&s);
        two_state_wide_update(&s, ANY_U16(0, UINT16_MAX), ANY_U32(0, 0x7FFFF));
    }
}

/* Uses: two_state_wide_predict, two_state_wide_update */
void proof_two_state_wide_reset(void)
{
    two_state_wide_t s;
    any_wide(&s, 16);
    two_state_wide_reset(&s, ANY_Z());
}

/* Uses: two_state_wide_predict, two_state_wide_update */
void proof_two_state_wide_reset_step(void)
{
    two_state_wide_t s;
    any_wide(&s, 16);
    (void)two_state_wide_reset_step(&s, ANY_Z(), ANY_U8(0, UINT8_MAX));
}
