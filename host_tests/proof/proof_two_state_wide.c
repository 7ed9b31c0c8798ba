/* The core with the wide covariance: any state within its bounds, any sample, any loss and back. */
#define X_CELLS
#include "wide_bounds.h"

void proof_limited_state(void)
{
    two_state_wide_t s;
    s.flags = 0;
    for (int8_t cell = -27; cell < 27; cell++) {
        (void)limited_state(&s, ANY_S32(33554432L * cell, 33554432L * cell + 33554431L));
    }
}

/* Each element below and from its end. */
void proof_predict_wide_covariance(void)
{
    for (uint8_t i = 0; i < 8; i++) {
        two_state_wide_t s;
        any_wide(&s, 0);
        s.u.p.p11_uq16 = ((i & 1U) != 0U) ? ANY_U32(0x80000000U, P11_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        s.u.p.p12_uq24 = ((i & 2U) != 0U) ? ANY_U32(0x80000000U, P12_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        s.u.p.p22_uq28 = ((i & 4U) != 0U) ? ANY_U32(0x80000000U, P22_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        (void)predict_wide_covariance(&s);
    }
}

/* Below and from 2^28; what grows beyond 2^31 is limited, by its top bit. */
void proof_give_back(void)
{
    uint32_t p = ANY_U32(0, 0x0FFFFFFF);
    give_back(&p, ANY_U32(0, UINT32_MAX), ANY_U16(0, UINT16_MAX), true);
    p = ANY_U32(0, P22_END - 1);
    give_back(&p, ANY_U32(0, UINT32_MAX), ANY_U16(0, UINT16_MAX), false);
}

/* Uses: fx_normalise. Options: -eva-split-return-function fx_leading:full */
void proof_left_of_p22(void)
{
    two_state_wide_t s;
    any_wide(&s, 0);
    (void)left_of_p22(&s, ANY_U32(0, 0xFFFFFF));
}

/* Uses: give_back, left_of_p22. By which elements are above the end of growth. */
void proof_update_covariance(void)
{
    for (uint8_t i = 0; i < 8; i++) {
        two_state_wide_t s;
        any_wide(&s, 0);
        s.u.p.p11_uq16 = ((i & 1U) != 0U) ? ANY_U32(ONE, P11_END - 1) : ANY_U32(0, ONE - 1);
        s.u.p.p12_uq24 = ((i & 2U) != 0U) ? ANY_U32(ONE, P12_END - 1) : ANY_U32(0, ONE - 1);
        s.u.p.p22_uq28 = ((i & 4U) != 0U) ? ANY_U32(ONE, P22_END - 1) : ANY_U32(0, ONE - 1);
        uint32_t back = ANY_BOOL() ? ANY_U32(0, 0xFFFF) : ANY_U32(0x10000, 0x7FFFF);
        update_covariance(&s, ANY_U16(0, UINT16_MAX), ANY_U32(0, 0xFFFFFF), back);
    }
}

/*
 * Uses: fx_normalise, limited_state, predict_wide_covariance, fx_inverse_m_uq16.
 * Options: -eva-split-return-function fx_leading:full
 */
void proof_two_state_wide_predict(void)
{
    two_state_wide_t s;
    any_wide(&s, 16);
    (void)two_state_wide_predict(&s, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

/* Uses: fx_normalise. Options: -eva-split-return-function fx_leading:full */
void proof_two_state_wide_distance_uq8(void)
{
    for (uint8_t places = 0; places < 16; places++) {
        two_state_wide_t s;
        any_wide(&s, places);
        (void)two_state_wide_distance_uq8(&s);
    }
}

/* Uses: fx_normalise, rounded */
void proof_two_state_wide_set_noise(void)
{
    two_state_wide_t s;
    any_wide(&s, 16);
    two_state_wide_set_noise(&s, ANY_U32(0, UINT32_MAX));
}

/* Uses: fx_normalise, rounded */
void proof_two_state_wide_init(void)
{
    two_state_wide_t s;
    two_state_wide_init(&s, ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000));
    //@ check WIDE_BOUND(&s);
}

void proof_two_state_wide_begin(void)
{
    two_state_wide_t s;
    any_wide_start(&s, 0, 4);
    two_state_wide_begin(&s, ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX), ANY_U32(0, UINT32_MAX),
                         ANY_U32(0, UINT32_MAX), ANY_U32(0, UINT32_MAX));
    //@ check WIDE_BOUND(&s);
}

/* Uses: fx_normalise, rounded. By places of S. */
void proof_two_state_wide_probe(void)
{
    filter_probe_t probe;
    for (uint8_t places = 0; places <= 16; places++) {
        two_state_wide_t s;
        any_wide(&s, places);
        two_state_wide_probe(&s, ANY_U16(0, UINT16_MAX), &probe);
    }
    two_state_wide_t s;
    any_wide_start(&s, 0, 4);
    two_state_wide_probe(&s, ANY_U16(0, UINT16_MAX), &probe);
}
