/* Decimal output against printf, over every 16-bit value and the corners of 32 bits. */
#include "base/text.h"

#include "base/format.h"
#include <stdio.h>

#include "hal_host.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "support/test.h"

static char sent[512];
static size_t sent_length;

static void on_tx(uint8_t byte)
{
    if (sent_length < sizeof sent - 1) {
        sent[sent_length++] = (char)byte;
        sent[sent_length] = '\0';
    }
}

void setUp(void)
{
    hal_host_config_t config = { .on_tx = on_tx };
    hal_host_begin(&config, NULL, false);
    hal_time_init();
    hal_uart_init(1000000);
}

/* The line as it left, without its end. */
static const char *line_out(void)
{
    sent_length = 0;
    text_close();
    while (!hal_uart_tx_idle()) {
        hal_sleep_until_wake();
    }
    TEST_ASSERT_EQUAL_CHAR('\n', sent[sent_length - 1]);
    sent[sent_length - 1] = '\0';
    return sent;
}

TEST(test_every_i16)
{
    char expected[16];
    for (int32_t v = INT16_MIN; v <= INT16_MAX; v++) {
        char text[FORMAT_I16_MAX + 1];
        *format_i16(text, (int16_t)v) = '\0';
        snprintf(expected, sizeof expected, "%d", (int)v);
        TEST_ASSERT_EQUAL_STRING(expected, text);
    }
}

TEST(test_u32_corners)
{
    static const uint32_t corners[] = { 0,         1,         9,          10,          65535,
                                        65536,     99999,     100000,     999999,      1000000,
                                        100000000, 999999999, 1000000000, 4000000009u, UINT32_MAX };
    char expected[16];
    for (size_t i = 0; i < sizeof corners / sizeof corners[0]; i++) {
        text_u32(corners[i]);
        snprintf(expected, sizeof expected, "%u", (unsigned)corners[i]);
        TEST_ASSERT_EQUAL_STRING(expected, line_out());
    }
}

TEST(test_u32_random)
{
    char expected[16];
    uint32_t v = 12345;
    for (int i = 0; i < 20000; i++) {
        v = v * 1664525u + 1013904223u;
        uint32_t value = v >> (v & 31u);
        text_u32(value);
        snprintf(expected, sizeof expected, "%u", (unsigned)value);
        TEST_ASSERT_EQUAL_STRING(expected, line_out());
    }
}

TEST(test_hundredths_of_every_angle)
{
    char expected[16];
    for (int v = -18000; v <= 18000; v++) {
        char text[FORMAT_HUNDREDTHS_MAX + 1];
        *format_hundredths(text, (int16_t)v) = '\0';
        snprintf(expected, sizeof expected, "%s%d.%02d", v < 0 ? "-" : "", v < 0 ? -v / 100 : v / 100,
                 v < 0 ? -v % 100 : v % 100);
        TEST_ASSERT_EQUAL_STRING(expected, text);
    }
}

TEST(test_tenths)
{
    text_tenths(125);
    TEST_ASSERT_EQUAL_STRING("12.5", line_out());
    text_tenths(8000);
    TEST_ASSERT_EQUAL_STRING("800", line_out());
    text_tenths(7);
    TEST_ASSERT_EQUAL_STRING("0.7", line_out());
}

TEST(test_hex)
{
    text_hex8(0xE5);
    text_hex8(0x0A);
    TEST_ASSERT_EQUAL_STRING("E50A", line_out());
}

TEST(test_open_answers_for_the_ring)
{
    TEST_ASSERT_TRUE(text_open(255));
    text_char('x');
    TEST_ASSERT_FALSE(text_open(255));
    TEST_ASSERT_TRUE(text_open(254));
    hal_uart_tx_discard();
    TEST_ASSERT_TRUE(text_open(255));
}
