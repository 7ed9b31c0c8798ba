/* The missing component and its sigma: any int32 in, no overflow, both within their ranges. */
#include "eva.h"
#include "fx_contracts.h"

#include "tilt_partial.h"

/*@ ensures \result <= 16384; */
static uint16_t size_q6(int32_t a_q8);
/*@ ensures \result <= 16384; */
uint16_t tilt_missing_q6(int32_t x_q8, int32_t y_q8, int32_t z_q8);
/*@ ensures \result <= 9000;
    ensures missing_q6 == 0 ==> \result == 9000;
*/
uint16_t tilt_partial_sigma_cdeg(uint16_t sigma_q8, uint16_t missing_q6);

#include "fx.c"

#include "tilt_partial.c"

static int32_t any_s32_all(void)
{
    return ANY_S32(S32_MIN, INT32_MAX);
}

void proof_size_q6(void)
{
    (void)size_q6(any_s32_all());
}

void proof_tilt_missing_q6(void)
{
    (void)tilt_missing_q6(any_s32_all(), any_s32_all(), any_s32_all());
    uint16_t none = tilt_missing_q6(65536, any_s32_all(), any_s32_all());
    uint16_t none_too = tilt_missing_q6(any_s32_all(), any_s32_all(), S32_MIN);
    //@ check one_g: none == 0 && none_too == 0;
}

void proof_tilt_partial_sigma_cdeg(void)
{
    (void)tilt_partial_sigma_cdeg(ANY_U16(0, UINT16_MAX), 0);
    (void)tilt_partial_sigma_cdeg(ANY_U16(0, UINT16_MAX), ANY_U16(1, UINT16_MAX));
}
