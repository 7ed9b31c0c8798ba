/*
 * What callers may assume of the primitives (ACSL); each is proved on the body by an entry of proof_fx.c.
 */
#ifndef FX_CONTRACTS_H
#define FX_CONTRACTS_H

#include "fx.h"

/* 2^40 / s is 1 / s in UQ0.16; 600 counts: one interval of the table, as coarse as the proof looks. */
/*@ requires s_uq24 >= 0x1000000;
    assigns \result \from s_uq24;
    ensures \result <= 1099511627776 / s_uq24 + 600;
*/
static inline uint16_t fx_reciprocal_uq16(uint32_t s_uq24);

/*@ requires interval < 128;
    assigns \result \from interval, fraction;
    ensures 0x8000 <= \result;
*/
static inline uint16_t fx_inverse_m_uq16(uint8_t interval, uint16_t fraction);

/* A number with the leading bit of `power` is shifted by so many places. */
#define PLACES(k, power) (\result == (k) && (power) <= \old(*v) <= (power)-1 + (power))
/*@ requires \valid(v) && *v > 0;
    assigns *v, \result \from *v;
    ensures *v >= 0x80000000;
    ensures PLACES(0, 0x80000000) || PLACES(1, 0x40000000) || PLACES(2, 0x20000000) ||
            PLACES(3, 0x10000000) || PLACES(4, 0x8000000) || PLACES(5, 0x4000000) ||
            PLACES(6, 0x2000000) || PLACES(7, 0x1000000) || PLACES(8, 0x800000) ||
            PLACES(9, 0x400000) || PLACES(10, 0x200000) || PLACES(11, 0x100000) ||
            PLACES(12, 0x80000) || PLACES(13, 0x40000) || PLACES(14, 0x20000) ||
            PLACES(15, 0x10000) || PLACES(16, 0x8000) || PLACES(17, 0x4000) ||
            PLACES(18, 0x2000) || PLACES(19, 0x1000) || PLACES(20, 0x800) ||
            PLACES(21, 0x400) || PLACES(22, 0x200) || PLACES(23, 0x100) ||
            PLACES(24, 0x80) || PLACES(25, 0x40) || PLACES(26, 0x20) ||
            PLACES(27, 0x10) || PLACES(28, 0x8) || PLACES(29, 0x4) ||
            PLACES(30, 0x2) || PLACES(31, 0x1);
*/
static inline uint8_t fx_normalise(uint32_t *v);

/*@ requires v >= 0x80000000;
    requires -110 <= exponent <= 60;
    assigns \result \from v, exponent;
    ensures \result.mantissa >= 0x8000;
    ensures exponent + 16 <= \result.exponent <= exponent + 17;
*/
static fx_scaled_t rounded(uint32_t v, int8_t exponent);

/*
 * The ends that its callers ask for, of Q28: 1 g, and what is left of it across 30 degrees, 27/32 rounded down; and of
 * the least noise, and the largest drive of kf (Q26) and of kf3.
 */
#define SQUARE(k) ((k) * (k)*0x40000)
/*@ assigns \result \from v;
    ensures v <= 0x10000000 ==> \result <= 0x4000;
    ensures v <= 0x40000000 ==> \result <= 0x8000;
    ensures v >= SQUARE(27) ==> \result >= 512 * 27;
    ensures v <= 0x2000000 ==> \result <= 8191;
    ensures v >= 12288 ==> \result >= 104;
*/
uint16_t filter_fx_isqrt32(uint32_t v);

/*
 * What is left lies between 0 and v: told by powers of 2, because intervals keep no relation to v, and by 18432 LSB,
 * the bound of what synth_plus brings.
 */
#define BELOW(power) ((power) <= v || v <= -(power) || ((power) > \result && \result > -(power)))
/*@ requires part_uq8 <= 128;
    assigns \result \from v, part_uq8;
    ensures v >= 0 ==> \result >= 0;
    ensures v <= 0 ==> \result <= 0;
    ensures BELOW(0x10) && BELOW(0x100) && BELOW(0x1000) && BELOW(0x10000) && BELOW(0x100000) && BELOW(0x1000000) &&
            BELOW(0x10000000);
    ensures -18432 * 65536 <= v <= 18432 * 65536 ==> -18432 * 65536 <= \result <= 18432 * 65536;
*/
static inline int32_t fx_without_part(int32_t v, uint8_t part_uq8);

/*@ requires 1 <= limit <= 127;
    assigns \result \from v, limit;
    ensures -16777216 * limit <= \result <= 16777216 * limit;
    ensures v >= 0 ==> \result >= 0;
    ensures v <= 0 ==> \result <= 0;
    ensures v > 16777216 * limit ==> \result == 16777216 * limit;
    ensures v < -16777216 * limit ==> \result == -16777216 * limit;
*/
static inline int32_t fx_clamp_high(int32_t v, uint8_t limit);

#endif
