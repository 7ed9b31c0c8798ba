/* Ranges, default of R, running median; see filter_common.h. */
#include "filter_common.h"

#include "fx.h"

bool filter_common_legal(uint16_t rate_dhz, uint32_t r_lsb2_q8)
{
    return rate_dhz >= FILTER_RATE_MIN_DHZ && rate_dhz <= FILTER_RATE_MAX_DHZ &&
           filter_limited_r_lsb2_q8(r_lsb2_q8) == r_lsb2_q8;
}

FX_ONCE int16_t filter_limited_z(int16_t z_lsb)
{
    return filter_clamp_z(z_lsb);
}

FX_ONCE void filter_zero(void *state, size_t size)
{
    uint8_t *at = (uint8_t *)state;
    while (size != 0U) {
        *at++ = 0;
        size--;
    }
}

FX_ONCE uint32_t filter_default_r_lsb2_q8(uint16_t rate_dhz)
{
    uint32_t r = ((uint32_t)rate_dhz * 768U + 500U) / 1000U;      /* 0.003 per 0.1 Hz, Q8 */
    return (r < FILTER_R_MIN_LSB2_Q8) ? FILTER_R_MIN_LSB2_Q8 : r; /* <= 30720 */
}

FX_ONCE uint16_t filter_memory_k_uq16(uint16_t memory_ms, uint16_t rate_dhz, uint16_t k_min_uq16)
{
    uint32_t k_uq16 = 1310720000U / ((uint32_t)memory_ms * rate_dhz);
    if (k_uq16 > FILTER_K_MAX_UQ16) {
        return FILTER_K_MAX_UQ16;
    }
    return (k_uq16 < k_min_uq16) ? k_min_uq16 : (uint16_t)k_uq16;
}

FX_ONCE uint32_t filter_limited_r_lsb2_q8(uint32_t r_lsb2_q8)
{
    if (r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8) {
        return FILTER_R_MIN_LSB2_Q8;
    }
    return (r_lsb2_q8 > FILTER_R_MAX_LSB2_Q8) ? FILTER_R_MAX_LSB2_Q8 : r_lsb2_q8;
}

int32_t filter_warm_up_median_q16(const int16_t *ascending_lsb, uint8_t count)
{
    int16_t high = ascending_lsb[count >> 1];
    int16_t low = ((count & 1U) != 0U) ? high : ascending_lsb[(count >> 1) - 1];
    return ((int32_t)(int16_t)(low + high) * 65536) >> 1; /* even before the halving: exact */
}

FX_ONCE void filter_halve(uint32_t *p)
{
    *p >>= 1;
}

FX_ONCE void filter_warm_up_insert(int16_t *ascending_lsb, uint8_t count, int16_t z_lsb)
{
    int16_t *at = &ascending_lsb[count];
    for (; at != ascending_lsb && at[-1] > z_lsb; at--) {
        at[0] = at[-1];
    }
    *at = z_lsb;
}
