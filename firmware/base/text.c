/* Text for replies: clear rather than fast. Data rows use format.h. */
#include "base/text.h"

#include "base/format.h"
#include "hal_uart.h"

bool text_open(uint8_t length)
{
    return hal_uart_tx_room() >= length;
}

void text_close(void)
{
    text_char('\n');
    hal_uart_tx_commit();
}

void text_char(char c)
{
    hal_uart_tx_stage((uint8_t)c);
}

void text_words(flash_text_t words)
{
    for (char c = flash_char(words); c != '\0'; c = flash_char(words)) {
        text_char(c);
        words++;
    }
}

void text_u32(uint32_t value)
{
    char digits[FORMAT_U32_MAX];
    const char *end = format_u32(digits, value);
    for (const char *at = digits; at != end; at++) {
        text_char(*at);
    }
}

void text_hex8(uint8_t value)
{
    for (uint8_t shift = 8; shift != 0;) {
        shift = (uint8_t)(shift - 4u);
        uint8_t nibble = (uint8_t)((uint8_t)(value >> shift) & 0x0Fu);
        uint8_t first = nibble < 10u ? (uint8_t)'0' : (uint8_t)('A' - 10);
        text_char((char)(uint8_t)(first + nibble));
    }
}

void text_tenths(uint16_t value)
{
    uint16_t tenths = value % 10u;
    text_u32(value / 10u);
    if (tenths != 0) {
        text_char('.');
        text_u32(tenths);
    }
}

flash_text_t text_nth(flash_text_t texts, uint8_t after)
{
    while (after != 0) {
        if (flash_char(texts++) == '\0') {
            after--;
        }
    }
    return texts;
}

bool text_equal(const char *ram, flash_text_t words)
{
    char c = flash_char(words);
    while (c != '\0' && (*ram == c || *ram == (char)(c + ('a' - 'A')))) {
        ram++;
        words++;
        c = flash_char(words);
    }
    return c == '\0' && *ram == '\0';
}
