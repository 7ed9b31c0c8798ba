/*
 * Numbers as decimal text, by subtraction of powers of ten: on the ATmega a 32-bit division costs 600 cycles per digit.
 * Each function writes to `at`, without a terminator, and returns a pointer past the last character.
 * Pure; any context.
 */
#ifndef FORMAT_H
#define FORMAT_H

#include <stdbool.h>
#include <stdint.h>

/* Longest text of each. */
#define FORMAT_U16_MAX 5
#define FORMAT_I16_MAX 6
#define FORMAT_U32_MAX 10
#define FORMAT_HUNDREDTHS_MAX 7

char *format_u16(char *at, uint16_t value);
char *format_i16(char *at, int16_t value);
char *format_u32(char *at, uint32_t value);

/* value / 100 with two decimals, such as degrees from 0.01 degree; -32767..32767. */
char *format_hundredths(char *at, int16_t value);

#endif
