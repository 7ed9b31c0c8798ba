/*
 * Roll and pitch in fixed point.
 *
 * An angle is the arc tangent of the ratio of the smaller to the larger leg (octant reduction), an odd minimax
 * polynomial. The length of (y, z) comes from the same ratio, larger leg times sqrt(1 + ratio^2), which saves a square
 * root for pitch. No table, no library division, no RAM. The polynomials are minimax fits on 0..1.
 *
 * Scaling of tilt_angles: in LSB Q8; legs truncated to 15 bits (error 2^-14); ratio, its square and polynomials in
 * UQ0.16, each product rounded down (error 2^-16); angles in 1/800 degree, rounded half up to 0.01. No state, so
 * nothing can drift or saturate. Sum of the bounds: roll 0.021, pitch 0.029 degree (derived in
 * host_tests/tilt/test_tilt.c). Cost: make bench; no RAM.
 *
 * Square root: P. Zimmermann, "Karatsuba Square Root", INRIA RR-3805, one step on 8-bit digits.
 */
#include "tilt.h"

#include "fx.h"

/* Product of two fractions in UQ0.16, rounded down. A macro: a function would not be inlined, 90 cycles more in all. */
#define PRODUCT_UQ16(a_uq16, b_uq16) ((uint16_t)(fx_product_u16(a_uq16, b_uq16) >> 16))

#define RIGHT_ANGLE_CDEG 9000U
#define HALF_TURN_CDEG 18000U

/* Slope of a right triangle in the first quadrant. */
typedef struct {
    uint16_t ratio_uq16;  /* smaller / larger leg */
    uint16_t ratio2_uq16; /* its square */
    uint16_t larger;      /* larger leg less its last bits: below 2^15 */
    uint8_t dropped;      /* number of these bits */
    bool steep;           /* the opposite leg is the larger one */
} slope_t;

/*
 * Drops bits of both numbers until they have 15; returns how many: an error below 2^-14 of the larger. Shorter ones
 * stay as they are: ratio and length, rounded down, are the same in a larger scale.
 */
static uint8_t shorten_to_15_bits(uint32_t opposite, uint32_t adjacent, uint16_t *o, uint16_t *a)
{
    uint8_t dropped = 0;
    while (((uint16_t)((opposite | adjacent) >> 16) & 0xFF80U) != 0U) {
        opposite >>= 8;
        adjacent >>= 8;
        dropped = (uint8_t)(dropped + 8U);
    }
    for (uint8_t excess = (uint8_t)(((opposite | adjacent) << 1) >> 16); excess != 0U; excess >>= 1) {
        opposite >>= 1;
        adjacent >>= 1;
        dropped++;
    }
    *o = (uint16_t)opposite;
    *a = (uint16_t)adjacent;
    return dropped;
}

/* One bit of a quotient: the remainder is below the divisor before and after. */
#define DIVIDE_ONE_BIT(quotient, remainder, divisor)           \
    do {                                                       \
        (remainder) = (uint16_t)((remainder) << 1);            \
        (quotient) = (uint16_t)((quotient) << 1);              \
        if ((remainder) >= (divisor)) {                        \
            (remainder) = (uint16_t)((remainder) - (divisor)); \
            (quotient) |= 1U;                                  \
        }                                                      \
    } while (0)

/*
 * small / large rounded down to UQ0.16, for small <= large < 2^15; equal numbers give the largest fraction. Four bits
 * per iteration, because the loop costs a quarter of a bit: saves 72 cycles in tilt_angles.
 */
static uint16_t fraction_uq16(uint16_t small, uint16_t large)
{
    if (small == large) {
        return UINT16_MAX;
    }
    uint16_t quotient = 0;
    for (uint8_t turns = 4; turns != 0U; turns--) {
        DIVIDE_ONE_BIT(quotient, small, large);
        DIVIDE_ONE_BIT(quotient, small, large);
        DIVIDE_ONE_BIT(quotient, small, large);
        DIVIDE_ONE_BIT(quotient, small, large);
    }
    return quotient;
}

static void slope_of(slope_t *slope, uint32_t opposite, uint32_t adjacent)
{
    uint16_t o;
    uint16_t a;
    slope->dropped = shorten_to_15_bits(opposite, adjacent, &o, &a);
    slope->steep = o > a;
    slope->larger = slope->steep ? o : a;
    slope->ratio_uq16 = 0;
    if (slope->larger != 0U) {
        slope->ratio_uq16 = fraction_uq16(slope->steep ? a : o, slope->larger);
    }
    slope->ratio2_uq16 = PRODUCT_UQ16(slope->ratio_uq16, slope->ratio_uq16);
}

/*
 * Angle of a slope in 0.01 degree, 0..9000. atan(r) = r (c0 - c1 r^2 + c2 r^4 - c3 r^6) in 1/800 degree: |error of the
 * polynomial| < 0.0047 degree, plus 0.005 for the last digit.
 */
static uint16_t slope_cdeg(const slope_t *slope)
{
    uint16_t ratio2 = slope->ratio2_uq16;
    uint16_t sum = (uint16_t)(6704U - PRODUCT_UQ16(1787U, ratio2));
    sum = (uint16_t)(14722U - PRODUCT_UQ16(sum, ratio2));
    sum = (uint16_t)(45801U - PRODUCT_UQ16(sum, ratio2));
    uint16_t angle = (uint16_t)((uint16_t)(PRODUCT_UQ16(sum, slope->ratio_uq16) + 4U) >> 3);
    return slope->steep ? (uint16_t)(RIGHT_ANGLE_CDEG - angle) : angle;
}

/* Hypotenuse in the scale of slope->larger: 2 larger (sqrt(1 + r^2) / 2); relative error < 2e-4. */
static uint16_t slope_length(const slope_t *slope)
{
    uint16_t ratio2 = slope->ratio2_uq16;
    uint16_t sum = (uint16_t)(3585U - PRODUCT_UQ16(846U, ratio2));
    sum = (uint16_t)(16315U - PRODUCT_UQ16(sum, ratio2));
    uint16_t half_secant_uq16 = (uint16_t)(32768U + PRODUCT_UQ16(sum, ratio2));
    return PRODUCT_UQ16((uint16_t)(slope->larger << 1), half_secant_uq16);
}

static int16_t signed_cdeg(uint16_t first_quadrant_cdeg, bool y_negative, bool x_negative)
{
    int16_t angle = (int16_t)(x_negative ? HALF_TURN_CDEG - first_quadrant_cdeg : first_quadrant_cdeg);
    return (y_negative && angle != (int16_t)HALF_TURN_CDEG) ? (int16_t)(0 - angle) : angle;
}

int16_t tilt_atan2_cdeg(int32_t y, int32_t x)
{
    slope_t slope;
    slope_of(&slope, filter_fx_abs32(y), filter_fx_abs32(x));
    return signed_cdeg(slope_cdeg(&slope), y < 0, x < 0);
}

void tilt_angles(tilt_t *out, const int32_t a_q8[3])
{
    int32_t x_q8 = a_q8[0];
    int32_t y_q8 = a_q8[1];
    int32_t z_q8 = a_q8[2];
    slope_t slope;
    slope_of(&slope, filter_fx_abs32(y_q8), filter_fx_abs32(z_q8));
    uint32_t x = filter_fx_abs32(x_q8);
    uint16_t yz = slope_length(&slope);
    x >>= slope.dropped; /* to the unit of yz: cheaper than the other way round */
    out->roll_undefined = yz < TILT_ROLL_MIN_Q8;
    if (!out->roll_undefined) {
        out->roll_cdeg = signed_cdeg(slope_cdeg(&slope), y_q8 < 0, z_q8 < 0);
    }
    slope_of(&slope, x, yz);
    int16_t pitch_cdeg = (int16_t)slope_cdeg(&slope);
    out->pitch_cdeg = (int16_t)(x_q8 < 0 ? pitch_cdeg : -pitch_cdeg);
}

uint16_t tilt_isqrt32(uint32_t v)
{
    return filter_fx_isqrt32(v);
}

/* An acceleration in 1/64 LSB, rounded down; larger ones give 2^15, beyond any plausible one. */
static uint16_t magnitude_q6(int32_t a_q8)
{
    uint32_t a_q6 = filter_fx_abs32(a_q8) >> 2;
    return (a_q6 > 0x8000UL) ? 0x8000U : (uint16_t)a_q6;
}

bool tilt_gravity_plausible(const int32_t a_q8[3])
{
    const uint32_t lowest_q12 = 193944617UL;  /* (0.85 g * 256 LSB/g * 64)^2 = 13926.4^2 */
    const uint32_t highest_q12 = 355005890UL; /* (1.15 g * 256 LSB/g * 64)^2 = 18841.6^2 */
    uint32_t sum_q12 = 0;
    for (uint8_t axis = 0; axis < 3U; axis++) {
        uint16_t magnitude = magnitude_q6(a_q8[axis]);
        sum_q12 += (uint32_t)magnitude * magnitude; /* <= 3 x 2^30 */
    }
    return sum_q12 >= lowest_q12 && sum_q12 <= highest_q12;
}
