/* The missing component and its effect on the angles: see tilt_partial.h. */
#include "tilt_partial.h"

#include "fx.h"

#define G2_Q12 0x10000000UL /* (256 in Q6)^2 */

/* In Q6, rounded down, limited to 1 g. */
static uint16_t size_q6(int32_t a_q8)
{
    uint32_t a_q6 = filter_fx_abs32(a_q8) >> 2;
    return (a_q6 > 16384U) ? 16384U : (uint16_t)a_q6;
}

uint16_t tilt_missing_q6(int32_t x_q8, int32_t y_q8, int32_t z_q8)
{
    uint16_t x = size_q6(x_q8);
    uint16_t y = size_q6(y_q8);
    uint16_t z = size_q6(z_q8);
    uint32_t known_q12 = fx_product_u16(x, x) + fx_product_u16(y, y); /* <= 3 x 2^28 */
    known_q12 += fx_product_u16(z, z);
    return (known_q12 < G2_Q12) ? filter_fx_isqrt32(G2_Q12 - known_q12) : 0U;
}

uint16_t tilt_partial_sigma_cdeg(uint16_t sigma_q8, uint16_t missing_q6)
{
    if (missing_q6 == 0U) {
        return TILT_PARTIAL_SIGMA_MAX_CDEG;
    }
    uint32_t sigma_cdeg = fx_product_u16(sigma_q8, 1432U) / missing_q6; /* 18000 / pi / 4: Q8 over Q6 */
    return (sigma_cdeg < TILT_PARTIAL_SIGMA_MAX_CDEG) ? (uint16_t)sigma_cdeg : TILT_PARTIAL_SIGMA_MAX_CDEG;
}
