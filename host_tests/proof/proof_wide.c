/* The wide covariance: any state within its bounds, any sample, any loss and back. */
#define KEPT WIDE_PARAMETERS
#include "wide_bounds.h"

static void any_own(filter_t *f, uint8_t kind)
{
    (void)kind;
    any_wide(f);
}

/* Each element below and from its end. */
void proof_grow_wide(void)
{
    for (uint8_t i = 0; i < 8; i++) {
        filter_t f;
        any_running(&f, NULL, 0);
        f.own.wide.p.p11 = ((i & 1U) != 0U) ? ANY_U32(0x80000000U, P11_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        f.own.wide.p.p12 = ((i & 2U) != 0U) ? ANY_U32(0x80000000U, P12_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        f.own.wide.p.p22 = ((i & 4U) != 0U) ? ANY_U32(0x80000000U, P22_END - 1) : ANY_U32(0, 0x7FFFFFFF);
        (void)grow_wide(&f.own.wide);
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

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_left_of_p22(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    (void)left_of_p22(&f.own.wide, ANY_U32(0, 0xFFFFFF));
}

/* By which elements are above the end of growth. */
void proof_correct_covariance(void)
{
    for (uint8_t i = 0; i < 8; i++) {
        filter_t f;
        any_running(&f, NULL, 0);
        f.own.wide.p.p11 = ((i & 1U) != 0U) ? ANY_U32(ONE, P11_END - 1) : ANY_U32(0, ONE - 1);
        f.own.wide.p.p12 = ((i & 2U) != 0U) ? ANY_U32(ONE, P12_END - 1) : ANY_U32(0, ONE - 1);
        f.own.wide.p.p22 = ((i & 4U) != 0U) ? ANY_U32(ONE, P22_END - 1) : ANY_U32(0, ONE - 1);
        uint32_t back = ANY_BOOL() ? ANY_U32(0, 0xFFFF) : ANY_U32(0x10000, 0x7FFFF);
        correct_covariance(&f.own.wide, ANY_U16(0, UINT16_MAX), ANY_U32(0, 0xFFFFFF), back);
    }
}

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_filter_wide_predict(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    (void)filter_wide_predict(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_filter_wide_distance_uq8(void)
{
    for (uint8_t places = 0; places < 16; places++) {
        filter_t f;
        any_update(&f, places);
        (void)filter_wide_distance_uq8(&f);
    }
}

/* By places of S and cells of the estimate. */
void proof_filter_wide_correct(void)
{
    for (uint8_t places = 0; places < 16; places++) {
        filter_t f;
        any_update(&f, places);
        //@ admit REACH(&f);
        filter_wide_correct(&f, ANY_U16(0, UINT16_MAX), ANY_U32(0, 0x7FFFF));
    }
}

void proof_filter_wide_set_noise(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    filter_wide_set_noise(&f, ANY_U32(3, R_END));
}

/* By places of S. */
void proof_filter_wide_report(void)
{
    filter_probe_t probe;
    for (uint8_t places = 0; places < 16; places++) {
        filter_t f;
        any_update(&f, places);
        filter_wide_report(&f, &probe);
    }
    filter_t f;
    any_update(&f, 0);
    f.own.wide.variance = 0;
    filter_wide_report(&f, &probe);
    any_starting(&f, NULL, 0, 4);
    filter_wide_report(&f, &probe);
}
