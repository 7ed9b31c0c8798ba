/*
 * What callers may assume of the primitives (ACSL); each is proved on the body by an entry of proof_fx.c.
 */
#ifndef FX_CONTRACTS_H
#define FX_CONTRACTS_H

#include "fx.h"

/* 2^44 / s is 1 / s in UQ0.16; 600 counts: one interval of the table, as coarse as the proof looks. */
/*@ requires s_uq28 >= 0x10000000;
    assigns \result \from s_uq28;
    ensures \result <= 17592186044416 / s_uq28 + 600;
*/
static inline uint16_t fx_reciprocal_uq16(uint32_t s_uq28);

/* A leading bit k brings the exponent to k - 15, one more when the mantissa is rounded up. */
#define AT_LEAST(k, power) (v < (power) || \result.exponent >= exponent + (k)-15)
#define AT_MOST(k, power) (v >= 2 * (power) || \result.exponent <= exponent + (k)-14)
/*@ requires v > 0;
    requires -75 <= exponent <= 60;
    assigns \result \from v, exponent;
    ensures \result.mantissa >= 0x8000;
    ensures exponent - 15 <= \result.exponent <= exponent + 17;
    ensures AT_LEAST(3, 8) && AT_LEAST(5, 32) && AT_LEAST(15, 32768) && AT_LEAST(30, 0x40000000);
    ensures AT_MOST(3, 8) && AT_MOST(12, 4096) && AT_MOST(15, 32768) && AT_MOST(16, 65536) && AT_MOST(17, 131072) &&
            AT_MOST(19, 524288) && AT_MOST(29, 0x20000000);
*/
static fx_scaled_t normalised(uint32_t v, int8_t exponent);

/*@ assigns \result \from v; */
uint16_t fx_isqrt32(uint32_t v);

#endif
