#include "output.h"

void output_text(const char *text)
{
    while (*text != '\0') {
        output_char(*text++);
    }
}

void output_u32(uint32_t value)
{
    char digits[10];
    uint8_t count = 0;
    do {
        digits[count++] = (char)('0' + (char)(value % 10U));
        value /= 10U;
    } while (value != 0U);
    while (count != 0U) {
        output_char(digits[--count]);
    }
}

void output_hex(uint32_t value, uint8_t digits)
{
    while (digits-- > 0U) {
        uint8_t nibble = (uint8_t)((value >> (uint8_t)(4U * digits)) & 0x0FU);
        output_char((char)(nibble < 10U ? '0' + nibble : 'a' - 10 + nibble));
    }
}
