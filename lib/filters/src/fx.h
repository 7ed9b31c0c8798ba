/*
 * Fixed-point primitives. Apart from machine.h, only this header, fx_avr.h and fx_avr.c depend on the machine.
 *
 * Every primitive has a portable C version and, where the compiler's code is slow, one in assembler (fx_avr.h, and
 * fx_avr.c for functions). Both give the same bits for every argument (host_tests/chip/fx_twins.c compares them on the
 * chip). No primitive divides, uses float or 64-bit arithmetic on AVR. All are pure and may be called from main or from
 * an interrupt.
 */
#ifndef FX_H
#define FX_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

#ifdef __cplusplus
extern "C" {
#endif

/* |v|; INT32_MIN gives 2^31. */
uint32_t filter_fx_abs32(int32_t v);

/* v limited to -limit..limit; limit >= 0. */
static inline int32_t fx_clamp(int32_t v, int32_t limit)
{
    if (v > limit) {
        return limit;
    }
    return (v < -limit) ? -limit : v;
}

/*
 * a x b, exact. Written as a plain product because the compiler knows that its library routine for it uses few
 * registers. Anything it knew about a and b would make it choose a longer one.
 */
MACHINE_INLINE uint32_t fx_product_u16(uint16_t a, uint16_t b)
{
    MACHINE_FENCE(a);
    MACHINE_FENCE(b);
    return (uint32_t)a * b;
}

/*
 * a x b_uq16 rounded half up, any a: the format of a is kept. Wide products are built from halves, so that no 64-bit
 * helper is linked.
 */
static inline uint32_t fx_mul_uq16_c(uint32_t a, uint16_t b_uq16)
{
    uint32_t low = fx_product_u16((uint16_t)a, b_uq16);
    return fx_product_u16((uint16_t)(a >> 16), b_uq16) + (low >> 16) + ((low >> 15) & 1U);
}

/* a x b_uq16 rounded half up, any 16-bit a. */
static inline uint16_t fx_mul16_uq16_c(uint16_t a, uint16_t b_uq16)
{
    uint32_t product = fx_product_u16(a, b_uq16);
    return (uint16_t)((product >> 16) + ((product >> 15) & 1U));
}

/* a x b_uq16 / 2^8 rounded half up, a < 2^24: a in Q8 gives the product in Q16. */
static inline uint32_t fx_mul24_uq16_c(uint32_t a_q8, uint16_t b_uq16)
{
    uint32_t low = fx_product_u16((uint16_t)a_q8, b_uq16);
    uint32_t high = (uint32_t)(a_q8 >> 16) * b_uq16;
    return (high << 8) + (low >> 8) + ((low >> 7) & 1U);
}

/* a x b_uq24 / 2^16 rounded half up, a and b_uq24 < 2^24: a in Q8 gives the product in Q16. */
static inline uint32_t fx_mul24_uq24_c(uint32_t a_q8, uint32_t b_uq24)
{
    uint16_t a_low = (uint16_t)a_q8;
    uint16_t b_low = (uint16_t)b_uq24;
    uint16_t a_high = (uint16_t)(a_q8 >> 16);
    uint16_t b_high = (uint16_t)(b_uq24 >> 16);
    uint32_t low = fx_product_u16(a_low, b_low);
    return (fx_product_u16(a_high, b_high) << 16) + fx_product_u16(a_low, b_high) + fx_product_u16(a_high, b_low) +
           (low >> 16) + ((low >> 15) & 1U);
}

/* v x 2^12, exact. */
static inline uint32_t fx_shift12_c(uint16_t v)
{
    return (uint32_t)v << 12;
}

/* v x 8, wrapping. */
static inline uint32_t fx_eightfold_c(uint32_t v)
{
    return v << 3;
}

/* v / 16 rounded half up, any v. */
static inline uint32_t fx_sixteenth_c(uint32_t v)
{
    return (v >> 4) + ((v >> 3) & 1U);
}

/* Shifts *v > 0 left until its top bit is set; returns the number of places. */
static inline uint8_t fx_normalise_c(uint32_t *v)
{
    uint8_t places = 0;
    while ((uint8_t)(*v >> 24) == 0U) {
        *v <<= 8;
        places = (uint8_t)(places + 8U);
    }
    while ((*v & 0x80000000U) == 0U) {
        *v <<= 1;
        places++;
    }
    return places;
}

/* v / 2^places rounded down; places < 32. */
static inline uint32_t fx_shift_right_c(uint32_t v, uint8_t places)
{
    return v >> places;
}

/* a x b_uq24 rounded half up, any a, b_uq24 < 2^24: the format of a is kept. */
static inline uint32_t fx_mul_uq24_c(uint32_t a, uint32_t b_uq24)
{
    uint16_t b_high = (uint16_t)(b_uq24 >> 8);
    uint16_t b_low = (uint16_t)(b_uq24 & 0xFFU);
    uint16_t a_high = (uint16_t)(a >> 16);
    uint16_t a_low = (uint16_t)a;
    uint32_t cross = fx_product_u16(a_low, b_high);
    uint32_t rest = ((cross & 0xFFU) << 8) + fx_product_u16(a_low, b_low);
    /* a x b = a_high x b_high x 2^24 + middle x 2^16 + (rest mod 2^16) */
    uint32_t middle = (cross >> 8) + fx_product_u16(a_high, b_low) + (rest >> 16);
    return fx_product_u16(a_high, b_high) + (middle >> 8) + ((middle >> 7) & 1U);
}

/*
 * v - v x part_uq8 / 2^8, the part subtracted rounded half up; part_uq8 0 or a power of 2: the 8-bit chip multiplies.
 */
static inline int32_t fx_without_part_c(int32_t v, uint8_t part_uq8)
{
    uint32_t size = filter_fx_abs32(v);
    uint32_t half = (v < 0) ? 127U : 128U;
    int32_t part = (int32_t)((size >> 8) * part_uq8 + (((size & 0xFFU) * part_uq8 + half) >> 8));
    return (v < 0) ? v + part : v - part;
}

/* v limited to -limit..limit x 2^24; limit a constant 1..127. */
static inline int32_t fx_clamp_high_c(int32_t v, uint8_t limit)
{
    return fx_clamp(v, (int32_t)limit * 16777216);
}

/* Upper half of a number in memory: for v >> 16 the compiler for the 8-bit chip loads all four bytes. */
static inline uint16_t fx_upper_c(const uint32_t *v)
{
    return (uint16_t)(*v >> 16);
}
static inline int16_t fx_upper_signed_c(const int32_t *v)
{
    return (int16_t)(*v >> 16);
}

#if defined(__AVR__) && defined(__OPTIMIZE__)
#include "fx_avr.h"
#else
static inline uint32_t fx_shift12(uint16_t v)
{
    return fx_shift12_c(v);
}
static inline uint32_t fx_eightfold(uint32_t v)
{
    return fx_eightfold_c(v);
}
static inline uint32_t fx_sixteenth(uint32_t v)
{
    return fx_sixteenth_c(v);
}
static inline uint8_t fx_normalise(uint32_t *v)
{
    return fx_normalise_c(v);
}
static inline int32_t fx_without_part(int32_t v, uint8_t part_uq8)
{
    return fx_without_part_c(v, part_uq8);
}
static inline int32_t fx_clamp_high(int32_t v, uint8_t limit)
{
    return fx_clamp_high_c(v, limit);
}
static inline uint16_t fx_upper(const uint32_t *v)
{
    return fx_upper_c(v);
}
static inline int16_t fx_upper_signed(const int32_t *v)
{
    return fx_upper_signed_c(v);
}

#endif

/*
 * Too long to inline: a call takes 10 to 30 cycles, the inlined code up to 150 bytes. In this order: the products of
 * the C versions of these names; fx_shift_right_c; the upper half of fx_product_u16, rounded down.
 */
uint32_t filter_fx_mul_uq16(uint32_t a, uint16_t b_uq16);
uint16_t filter_fx_mul16_uq16(uint16_t a, uint16_t b_uq16);
uint32_t filter_fx_mul24_uq16(uint32_t a_q8, uint16_t b_uq16);
uint32_t filter_fx_mul24_uq24(uint32_t a_q8, uint32_t b_uq24);
uint32_t filter_fx_mul_uq24(uint32_t a, uint32_t b_uq24);
uint32_t filter_fx_shift_right(uint32_t v, uint8_t places);
uint16_t filter_fx_high_u16(uint16_t a, uint16_t b);

/* a + b, at most UINT32_MAX. */
static inline uint32_t fx_add_sat(uint32_t a, uint32_t b)
{
    uint32_t sum = a + b;
    return (sum < a) ? UINT32_MAX : sum;
}

/* Nodes of the reciprocal table, see fx.c; in program memory. */
extern const uint16_t filter_fx_reciprocal_nodes_uq16[129];

/*
 * 1 / m in UQ0.16, at most 65535, for m = 1 + (interval + fraction / 2^16) / 128, interval < 128. Table of 129 nodes in
 * program memory, linear interpolation. |result - 1/m| <= 1.5 x 2^-16 (chord 0.25, nodes 0.5, product 0.5, limit of the
 * first node 0.25), tested.
 */
static inline uint16_t fx_inverse_m_uq16(uint8_t interval, uint16_t fraction)
{
    const uint16_t *node = &filter_fx_reciprocal_nodes_uq16[interval];
    uint16_t left = flash_u16(node);
    uint16_t drop = (uint16_t)(left - flash_u16(node + 1));
    return (uint16_t)(left - filter_fx_mul16_uq16(drop, fraction));
}

/* 1 / s for 1 <= s < 256 (UQ8.24) in UQ0.16, at most 65535. |result - 1/s| <= 1.5 x 2^-16, tested. */
static inline uint16_t fx_reciprocal_uq16(uint32_t s_uq24)
{
    uint8_t halvings = 0;
    while ((uint8_t)(s_uq24 >> 24) >= 2U) {
        s_uq24 >>= 1;
        halvings++;
    }
    uint32_t half = s_uq24 >> 1; /* s = m x 2^halvings, 1 <= m < 2: the leading bit of m is bit 23 of half */
    uint16_t inverse = fx_inverse_m_uq16((uint8_t)(half >> 16) & 0x7FU, (uint16_t)half);
    for (; halvings > 1U; halvings--) {
        inverse >>= 1;
    }
    return (halvings == 0U) ? inverse : (uint16_t)((inverse >> 1) + (inverse & 1U));
}

/*
 * 1 / m in UQ0.16, at most 65535, for 1 <= m < 2 (UQ1.31: the leading bit is set, the low byte does not matter). Same
 * bits as fx_inverse_m_uq16.
 */
uint16_t filter_fx_inverse_uq16(uint32_t m_uq31);

/* floor(sqrt(v)), exact. About 700 cycles: configuration only. */
uint16_t filter_fx_isqrt32(uint32_t v);

/*
 * The 24 leading bits of a number, shifted left until the top bit of 32 is set, with the number of places in the low
 * byte: one word, because a structure would be passed through memory. 0 is taken as 1.
 */
typedef uint32_t fx_leading_t;
fx_leading_t filter_fx_leading(uint32_t v);

static inline uint8_t fx_places(fx_leading_t leading)
{
    return (uint8_t)leading;
}

/* The 16 leading bits. */
static inline uint16_t fx_mantissa(fx_leading_t leading)
{
    return (uint16_t)(leading >> 16);
}

/* mantissa x 2^exponent with 0x8000 <= mantissa, for configuration values that span many decades. */
typedef struct {
    uint16_t mantissa;
    int8_t exponent;
} fx_scaled_t;

/* v > 0 to 16 significant bits (relative error <= 2^-16); 0 is taken as 1. */
fx_scaled_t filter_fx_scaled(uint32_t v);

/*
 * a x b and a / b, each with a relative error <= 2^-14. Exponents must stay within -100..100. filter_fx_scaled_div
 * divides.
 */
fx_scaled_t filter_fx_scaled_mul(fx_scaled_t a, fx_scaled_t b);
fx_scaled_t filter_fx_scaled_div(fx_scaled_t a, fx_scaled_t b);

/* a in fixed point with the given fraction bits, rounded half up, saturated to UINT32_MAX. */
uint32_t filter_fx_scaled_fixed(fx_scaled_t a, uint8_t fraction_bits);

#ifdef __cplusplus
}
#endif
#endif
