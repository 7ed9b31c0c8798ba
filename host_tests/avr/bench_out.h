/* Text out of the UART and random numbers, for bench.c only. */
#ifndef BENCH_OUT_H
#define BENCH_OUT_H

#include <avr/io.h>
#include <avr/pgmspace.h>
#include <stdint.h>

#include "format.h"

static void put(char c)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    UDR0 = (uint8_t)c;
}

static void put_text(const char *flash_text)
{
    for (char c = (char)pgm_read_byte(flash_text); c != '\0'; c = (char)pgm_read_byte(++flash_text)) {
        put(c);
    }
}

static void put_number(uint16_t value)
{
    char digits[FORMAT_U16_MAX];
    char *end = format_u16(digits, value);
    put(' ');
    for (const char *at = digits; at != end; at++) {
        put(*at);
    }
}

static void put_hex(uint16_t value)
{
    for (uint8_t i = 0; i < 4; i++, value = (uint16_t)(value << 4)) {
        uint8_t digit = (uint8_t)(value >> 12);
        put((char)(digit < 10 ? '0' + digit : 'a' + digit - 10));
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
