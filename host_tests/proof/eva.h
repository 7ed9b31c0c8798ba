/* Any value of an interval, for the drivers of make proof. */
#ifndef EVA_H
#define EVA_H

#include <__fc_builtin.h>
#include <stdbool.h>
#include <stdint.h>

#define ANY_U8(low, high) ((uint8_t)Frama_C_unsigned_char_interval(low, high))
#define ANY_U16(low, high) ((uint16_t)Frama_C_unsigned_int_interval(low, high))
#define ANY_S16(low, high) ((int16_t)Frama_C_int_interval(low, high))
#define ANY_U32(low, high) ((uint32_t)Frama_C_unsigned_long_interval(low, high))
#define ANY_S32(low, high) ((int32_t)Frama_C_long_interval(low, high))
#define ANY_BOOL() ((bool)Frama_C_unsigned_char_interval(0, 1))
#define ANY_S8(low, high) ((int8_t)Frama_C_int_interval(low, high))

#define S16_MIN (-32767 - 1)
#define S32_MIN (-2147483647L - 1)
#define ANY_Z() ANY_S16(S16_MIN, 32767)

/*
 * Configurations for an init, case by case: in case 0 each parameter lies within its range; in the next two the first
 * lies below and above it, the others anywhere; then the second, and so on. `count` parameters have CASES(count).
 */
enum { WITHIN, BELOW_RANGE, ABOVE_RANGE, ANYWHERE };
#define CASES(count) (1U + 2U * (count))

static uint8_t part_of(uint8_t number, uint8_t parameter)
{
    if (number == 0U) {
        return WITHIN;
    }
    if ((uint8_t)(number - 1U) / 2U != parameter) {
        return ANYWHERE;
    }
    return (number % 2U != 0U) ? BELOW_RANGE : ABOVE_RANGE;
}

/* A range that begins at 0 has nothing below it, one that ends with the type nothing above: the other side instead. */
static uint32_t any_u32(uint8_t part, uint32_t low, uint32_t high, uint32_t end)
{
    if (part == WITHIN) {
        return ANY_U32(low, high);
    }
    if (part == ANYWHERE) {
        return ANY_U32(0, end);
    }
    if (low != 0U && (part == BELOW_RANGE || high == end)) {
        return ANY_U32(0, low - 1U);
    }
    return ANY_U32(high + 1U, end);
}

static uint16_t any_u16(uint8_t part, uint16_t low, uint16_t high)
{
    return (uint16_t)any_u32(part, low, high, UINT16_MAX);
}

static int32_t any_s32(uint8_t part, int32_t low, int32_t high)
{
    if (part == WITHIN) {
        return ANY_S32(low, high);
    }
    if (part == ANYWHERE) {
        return ANY_S32(S32_MIN, INT32_MAX);
    }
    return (part == BELOW_RANGE) ? ANY_S32(S32_MIN, low - 1) : ANY_S32(high + 1, INT32_MAX);
}

#endif
