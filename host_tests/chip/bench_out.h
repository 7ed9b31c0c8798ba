/* Numbers out of the UART and random ones, for bench.c only. */
#ifndef BENCH_OUT_H
#define BENCH_OUT_H

#include <stdint.h>

#include "base/format.h"
#include "bench_call.h"

static void put_number(uint16_t value)
{
    char digits[FORMAT_U16_MAX];
    char *end = format_u16(digits, value);
    put(' ');
    for (const char *at = digits; at != end; at++) {
        put(*at);
    }
}

static uint32_t random_state = 2463534242ul;

/* xorshift32 (Marsaglia). */
static uint32_t random_bits(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

/* -2^(bits-1) .. 2^(bits-1)-1 */
static int16_t uniform(uint8_t bits)
{
    return (int16_t)((int16_t)(random_bits() >> (32u - bits)) - (int16_t)(1u << (bits - 1u)));
}

#endif
