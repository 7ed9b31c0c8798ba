/* A matrix row times a vector; complements fx.h and is built like it. */
#ifndef FX_DOT_H
#define FX_DOT_H

#include "fx.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * sum + a[0] x b[0] + a[1] x b[1] + a[2] x b[2], each product / 2^8 and rounded down. |a| < 2^23: the top byte is
 * ignored. Wraps beyond 32 bits.
 */
static inline int32_t fx_dot24_c(int32_t sum, const int32_t a[3], const int16_t b[3])
{
    uint32_t wrapping = (uint32_t)sum;
    for (uint8_t i = 0; i < 3U; i++) {
        int16_t high = (int16_t)(a[i] >> 8);
        int16_t low = (int16_t)(a[i] & 0xFF);
        wrapping += (uint32_t)((int32_t)high * b[i]) + (uint32_t)(((int32_t)low * b[i]) >> 8);
    }
    return (int32_t)wrapping;
}

#ifdef FX_ASSEMBLER
/* The lowest of the product's five bytes is left out; the bytes of a are loaded one by one, which saves registers. */
MACHINE_INLINE int32_t fx_dot24(int32_t sum, const int32_t a[3], const int16_t b[3])
{
    uint8_t byte, low, high, zero, left;
    __asm__("clr %[z]\n\tldi %[n],3\n"
            "1:\tld %[l],%a[b]+\n\tld %[h],%a[b]+\n\tld %[v],%a[a]+\n\t"
            "mul %[v],%[l]\n\tadd %A[s],r1\n\tadc %B[s],%[z]\n\tadc %C[s],%[z]\n\tadc %D[s],%[z]\n\t"
            "mulsu %[h],%[v]\n\tsbc %C[s],%[z]\n\tsbc %D[s],%[z]\n\t"
            "add %A[s],r0\n\tadc %B[s],r1\n\tadc %C[s],%[z]\n\tadc %D[s],%[z]\n\t"
            "ld %[v],%a[a]+\n\t"
            "mul %[v],%[l]\n\tadd %A[s],r0\n\tadc %B[s],r1\n\tadc %C[s],%[z]\n\tadc %D[s],%[z]\n\t"
            "mulsu %[h],%[v]\n\tsbc %D[s],%[z]\n\tadd %B[s],r0\n\tadc %C[s],r1\n\tadc %D[s],%[z]\n\t"
            "ld %[v],%a[a]+\n\tadiw %A[a],1\n\t"
            "mulsu %[v],%[l]\n\tsbc %D[s],%[z]\n\tadd %B[s],r0\n\tadc %C[s],r1\n\tadc %D[s],%[z]\n\t"
            "muls %[v],%[h]\n\tadd %C[s],r0\n\tadc %D[s],r1\n\t"
            "dec %[n]\n\tbrne 1b\n\t"
            "clr r1"
            : [s] "+r"(sum), [a] "+x"(a), [b] "+z"(b), [z] "=&r"(zero), [n] "=&d"(left), [v] "=&a"(byte),
              [l] "=&a"(low), [h] "=&a"(high)
            :
            : "memory");
    return sum;
}
#else
static inline int32_t fx_dot24(int32_t sum, const int32_t a[3], const int16_t b[3])
{
    return fx_dot24_c(sum, a, b);
}
#endif

#ifdef __cplusplus
}
#endif
#endif
