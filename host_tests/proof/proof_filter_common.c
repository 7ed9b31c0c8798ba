/* What the filters share: any argument, any samples of the start. */
#include "eva.h"
#include "filter_common.h"

#define MEDIAN_Q16(x) (-4096 * 65536 <= (x) <= 4095 * 65536)
/*@ requires 1 <= count <= FILTER_WARM_UP_SAMPLES;
    ensures MEDIAN_Q16(\result);
*/
int32_t filter_warm_up_median_q16(const int16_t *ascending_lsb, uint8_t count);

/*@ requires count < FILTER_WARM_UP_SAMPLES;
    ensures \forall integer i; 0 <= i < FILTER_WARM_UP_SAMPLES ==> -4096 <= ascending_lsb[i] <= 4095;
*/
void filter_warm_up_insert(int16_t *ascending_lsb, uint8_t count, int16_t z_lsb);

/*@ ensures FILTER_R_MIN_LSB2_Q8 <= \result <= FILTER_R_MAX_LSB2_Q8; */
uint32_t filter_limited_r_lsb2_q8(uint32_t r_lsb2_q8);

#include "filter_common.c"

static void any_samples(int16_t *lsb)
{
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
}

void proof_filter_warm_up_insert(void)
{
    for (uint8_t count = 0; count < FILTER_WARM_UP_SAMPLES; count++) {
        int16_t lsb[FILTER_WARM_UP_SAMPLES];
        any_samples(lsb);
        filter_warm_up_insert(lsb, count, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

void proof_filter_warm_up_median_q16(void)
{
    int16_t lsb[FILTER_WARM_UP_SAMPLES];
    any_samples(lsb);
    for (uint8_t count = 1; count <= FILTER_WARM_UP_SAMPLES; count++) {
        (void)filter_warm_up_median_q16(lsb, count);
    }
}

void proof_filter_limited_r_lsb2_q8(void)
{
    (void)filter_limited_r_lsb2_q8(ANY_U32(0, UINT32_MAX));
}

void proof_filter_default_r_lsb2_q8(void)
{
    uint32_t r_lsb2_q8 = filter_default_r_lsb2_q8(ANY_U16(0, 40000));
    //@ check 3 <= r_lsb2_q8 <= 30720;
}

/* True at the ends of the legal ranges, false for every rate and every R outside them. */
void proof_filter_common_legal(void)
{
    bool least = filter_common_legal(50, 3);
    bool most = filter_common_legal(40000, 256000);
    //@ check ends: least == 1 && most == 1;
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    bool slow = filter_common_legal(ANY_U16(0, 49), r_lsb2_q8);
    bool fast = filter_common_legal(ANY_U16(40001, UINT16_MAX), r_lsb2_q8);
    bool small = filter_common_legal(rate_dhz, ANY_U32(0, 2));
    bool large = filter_common_legal(rate_dhz, ANY_U32(256001, UINT32_MAX));
    //@ check none: slow == 0 && fast == 0 && small == 0 && large == 0;
}
