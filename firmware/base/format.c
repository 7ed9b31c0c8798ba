/* Decimal text; see format.h. The last two digits are done in 8 bits, the next in 16, only the rest in 32. */
#include "base/format.h"

#include "machine.h"

static const uint32_t powers[] IN_FLASH = { 1000000000ul, 100000000ul, 10000000ul, 1000000ul, 100000ul, 10000ul };

/* How often `power` goes into *value, as a digit; leaves the remainder in *value. */
MACHINE_INLINE char take_digit(uint16_t *value, uint16_t power)
{
    char digit = '0';
    while (*value >= power) {
        *value = (uint16_t)(*value - power);
        digit++;
    }
    return digit;
}

static char *two_digits(char *at, uint8_t value, bool leading)
{
    char tens = '0';
    while (value >= 10u) {
        value = (uint8_t)(value - 10u);
        tens++;
    }
    if (leading || tens != '0') {
        *at++ = tens;
    }
    *at++ = (char)('0' + (char)value);
    return at;
}

/* All four digits of a value below 10000. */
static char *four_digits(char *at, uint16_t value)
{
    *at++ = take_digit(&value, 1000u);
    *at++ = take_digit(&value, 100u);
    return two_digits(at, (uint8_t)value, true);
}

char *format_u16(char *at, uint16_t value)
{
    if (value >= 1000u) {
        if (value >= 10000u) {
            *at++ = take_digit(&value, 10000u);
        }
        return four_digits(at, value);
    }
    if (value >= 100u) {
        *at++ = take_digit(&value, 100u);
        return two_digits(at, (uint8_t)value, true);
    }
    return two_digits(at, (uint8_t)value, false);
}

char *format_i16(char *at, int16_t value)
{
    uint16_t magnitude = (uint16_t)value;
    if (value < 0) {
        *at++ = '-';
        magnitude = (uint16_t)(0u - magnitude);
    }
    return format_u16(at, magnitude);
}

char *format_u32(char *at, uint32_t value)
{
    if (value <= UINT16_MAX) {
        return format_u16(at, (uint16_t)value);
    }
    bool leading = false;
    for (uint8_t i = 0; i < sizeof powers / sizeof powers[0]; i++) {
        uint32_t power = flash_u32(&powers[i]);
        char digit = '0';
        while (value >= power) {
            value -= power;
            digit++;
        }
        leading = leading || digit != '0';
        if (leading) {
            *at++ = digit;
        }
    }
    return four_digits(at, (uint16_t)value);
}

char *format_hundredths(char *at, int16_t value)
{
    uint16_t rest = (uint16_t)value;
    if (value < 0) {
        *at++ = '-';
        rest = (uint16_t)(0u - rest);
    }
    if (rest < 100u) {
        *at++ = '0';
        *at++ = '.';
        return two_digits(at, (uint8_t)rest, true);
    }
    at = format_u16(at, rest);
    at[0] = at[-1];
    at[-1] = at[-2];
    at[-2] = '.';
    return at + 1;
}
