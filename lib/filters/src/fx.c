/* Fixed-point primitives that are too large to inline; see fx.h. */
#include "fx.h"

/*
 * Node i: 65536 / (1 + i/128) - h^2/16 x second derivative, h = 1/128, so that the error of the chord is centred on
 * zero (a chord of the convex 1/m lies up to h^2/8 x f'' above it); rounded to nearest, the first limited to 65535.
 */
const uint16_t filter_fx_reciprocal_nodes_uq16[129] IN_FLASH = {
    65535, 65027, 64527, 64035, 63550, 63072, 62601, 62137, 61681, 61230, 60787, 60349, 59918, 59493, 59074,
    58661, 58254, 57852, 57456, 57065, 56679, 56299, 55924, 55553, 55188, 54827, 54471, 54120, 53773, 53430,
    53092, 52758, 52429, 52103, 51781, 51464, 51150, 50840, 50534, 50231, 49932, 49637, 49345, 49056, 48771,
    48489, 48210, 47935, 47662, 47393, 47127, 46864, 46603, 46346, 46091, 45839, 45590, 45344, 45100, 44859,
    44620, 44384, 44150, 43919, 43691, 43464, 43240, 43018, 42799, 42582, 42367, 42154, 41943, 41734, 41528,
    41323, 41121, 40920, 40721, 40525, 40330, 40137, 39946, 39756, 39569, 39383, 39199, 39017, 38836, 38657,
    38480, 38304, 38130, 37957, 37786, 37617, 37449, 37283, 37118, 36954, 36792, 36631, 36472, 36314, 36158,
    36003, 35849, 35696, 35545, 35395, 35246, 35099, 34952, 34807, 34664, 34521, 34379, 34239, 34100, 33962,
    33825, 33689, 33554, 33421, 33288, 33156, 33026, 32896, 32768,
};

MACHINE_APART uint32_t filter_fx_abs32(int32_t v)
{
    return (v < 0) ? 0U - (uint32_t)v : (uint32_t)v;
}

uint16_t filter_fx_isqrt32(uint32_t v)
{
    uint32_t rest = v;
    uint32_t root = 0;
    for (uint32_t bit = 0x40000000U; bit != 0U; bit >>= 2) {
        uint32_t trial = root + bit;
        root >>= 1;
        if (rest >= trial) {
            rest -= trial;
            root += bit;
        }
    }
    return (uint16_t)root;
}

#ifndef FX_ASSEMBLER /* else in fx_avr.c */
uint32_t filter_fx_mul_uq16(uint32_t a, uint16_t b_uq16)
{
    return fx_mul_uq16_c(a, b_uq16);
}

uint16_t filter_fx_mul16_uq16(uint16_t a, uint16_t b_uq16)
{
    return fx_mul16_uq16_c(a, b_uq16);
}

uint32_t filter_fx_mul24_uq16(uint32_t a_q8, uint16_t b_uq16)
{
    return fx_mul24_uq16_c(a_q8, b_uq16);
}

uint32_t filter_fx_mul24_uq24(uint32_t a_q8, uint32_t b_uq24)
{
    return fx_mul24_uq24_c(a_q8, b_uq24);
}

uint32_t filter_fx_mul_uq24(uint32_t a, uint32_t b_uq24)
{
    return fx_mul_uq24_c(a, b_uq24);
}

uint32_t filter_fx_shift_right(uint32_t v, uint8_t places)
{
    return fx_shift_right_c(v, places);
}
#endif

uint16_t filter_fx_high_u16(uint16_t a, uint16_t b)
{
    return (uint16_t)(fx_product_u16(a, b) >> 16);
}

uint16_t filter_fx_inverse_uq16(uint32_t m_uq31)
{
    return fx_inverse_m_uq16((uint8_t)(m_uq31 >> 24) & 0x7FU, (uint16_t)(m_uq31 >> 8));
}

fx_leading_t filter_fx_leading(uint32_t v)
{
    if (v == 0U) {
        v = 1;
    }
    uint8_t places = fx_normalise(&v);
    return (v & 0xFFFFFF00U) | places;
}

/* A 32-bit value with its top bit set, times 2^exponent (weight of the lowest bit), rounded to a 16-bit mantissa. */
static fx_scaled_t rounded(uint32_t v, int8_t exponent)
{
    fx_scaled_t result = { (uint16_t)(v >> 16), (int8_t)(exponent + 16) };
    if ((v & 0x8000U) != 0U) {
        result.mantissa++;
        if (result.mantissa == 0U) {
            result.mantissa = 0x8000U;
            result.exponent++;
        }
    }
    return result;
}

/* Any v > 0 times 2^exponent. */
static fx_scaled_t normalised(uint32_t v, int8_t exponent)
{
    uint8_t places = fx_normalise(&v);
    return rounded(v, (int8_t)(exponent - (int8_t)places));
}

fx_scaled_t filter_fx_scaled(uint32_t v)
{
    return normalised((v == 0U) ? 1U : v, 0);
}

fx_scaled_t filter_fx_scaled_mul(fx_scaled_t a, fx_scaled_t b)
{
    return normalised(fx_product_u16(a.mantissa, b.mantissa), (int8_t)(a.exponent + b.exponent));
}

MACHINE_APART fx_scaled_t filter_fx_scaled_div(fx_scaled_t a, fx_scaled_t b)
{
    uint32_t quotient = ((uint32_t)a.mantissa << 16) / b.mantissa; /* 2^15 < quotient < 2^17 */
    return normalised(quotient, (int8_t)(a.exponent - b.exponent - 16));
}

uint32_t filter_fx_scaled_fixed(fx_scaled_t a, uint8_t fraction_bits)
{
    int16_t shift = (int16_t)(a.exponent + (int16_t)fraction_bits);
    if (shift > 16) {
        return UINT32_MAX;
    }
    if (shift < -16) {
        return 0; /* below one half */
    }
    uint32_t v = (uint32_t)a.mantissa << 16;
    uint8_t last = 0; /* the last bit shifted out, for rounding */
    for (uint8_t places = (uint8_t)(16 - shift); places != 0U; places--) {
        last = (uint8_t)v & 1U;
        v >>= 1;
    }
    return v + last;
}
