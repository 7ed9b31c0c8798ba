#include "nav_line.h"

#include <string.h>

#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "nav_link.h"
#include "unity.h"

enum { LINE_BYTES = 16384 };

static uint8_t to_board[LINE_BYTES], from_board[LINE_BYTES];
static size_t to_count, to_next, from_count, from_read;
uint8_t nav_line_room;
uint8_t nav_line_sequence;
nav_line_record_t nav_line_said[NAV_LINE_RECORDS];
size_t nav_line_said_count;

/* --- the line --- */
void hal_uart_init(uint32_t baud)
{
    TEST_ASSERT_EQUAL_UINT32(1000000, baud);
}

uint8_t hal_uart_tx_room(void)
{
    return nav_line_room;
}

bool hal_uart_tx_write(const char *line, uint8_t length)
{
    TEST_ASSERT_LESS_OR_EQUAL(nav_line_room, length);
    TEST_ASSERT_LESS_THAN(LINE_BYTES, from_count + length);
    memcpy(&from_board[from_count], line, length);
    from_count += length;
    return true;
}

bool hal_uart_rx(uint8_t *byte)
{
    if (to_next == to_count) {
        return false;
    }
    *byte = to_board[to_next++];
    return true;
}

uint32_t hal_time_us(void)
{
    return 0;
}

void hal_wake_at(uint32_t t_us)
{
    (void)t_us;
}

hal_reset_t hal_reset_cause(void)
{
    return HAL_RESET_WATCHDOG;
}

/* --- an encoder and a decoder by the definition, for what the board's is compared with --- */
static uint16_t crc_bit_by_bit(const uint8_t *bytes, size_t length)
{
    uint32_t crc = 0xFFFF;
    for (size_t i = 0; i < length * 8; i++) {
        uint32_t bit = ((uint32_t)bytes[i / 8] >> (7 - i % 8)) & 1u;
        uint32_t out = (crc >> 15) ^ bit;
        crc = ((crc << 1) & 0xFFFF) ^ (out ? 0x1021 : 0);
    }
    return (uint16_t)crc;
}

/* Each code byte is nav_line_put in when its run is over. */
static size_t stuff(const uint8_t *bytes, size_t length, uint8_t *to)
{
    size_t code_at = 0;
    size_t at = 1;
    uint8_t code = 1;
    for (size_t i = 0; i < length; i++) {
        if (bytes[i] != 0) {
            to[at++] = bytes[i];
            code++;
        }
        if (bytes[i] == 0 || code == 0xFF) {
            to[code_at] = code;
            code_at = at++;
            code = 1;
        }
    }
    to[code_at] = code;
    to[at++] = 0;
    return at;
}

size_t nav_line_frame(const uint8_t *bytes, size_t length, uint8_t *to)
{
    uint8_t whole[300];
    memcpy(whole, bytes, length);
    uint16_t crc = crc_bit_by_bit(bytes, length);
    whole[length] = (uint8_t)crc;
    whole[length + 1] = (uint8_t)(crc >> 8);
    return stuff(whole, length + 2, to);
}

static void unstuff(const uint8_t *bytes, size_t length, nav_line_record_t *record)
{
    record->length = 0;
    for (size_t at = 0; at < length;) {
        uint8_t code = bytes[at];
        TEST_ASSERT_NOT_EQUAL(0, code);
        for (size_t i = 1; i < code; i++) {
            record->bytes[record->length++] = bytes[at + i];
        }
        at += code;
        if (code != 0xFF && at < length) {
            record->bytes[record->length++] = 0;
        }
    }
    TEST_ASSERT_GREATER_OR_EQUAL(3, record->length);
    record->length -= 2;
    uint16_t crc = crc_bit_by_bit(record->bytes, record->length);
    TEST_ASSERT_EQUAL_HEX16(crc, record->bytes[record->length] | record->bytes[record->length + 1] << 8);
}

/* --- a PC --- */
void nav_line_type(const uint8_t *bytes, size_t length)
{
    TEST_ASSERT_LESS_THAN(LINE_BYTES, to_count + length);
    memcpy(&to_board[to_count], bytes, length);
    to_count += length;
}

static void read_answers(void)
{
    nav_line_said_count = 0;
    for (size_t at = from_read; at < from_count; at++) {
        if (from_board[at] == 0) {
            TEST_ASSERT_LESS_THAN(NAV_LINE_RECORDS, nav_line_said_count);
            unstuff(&from_board[from_read], at - from_read, &nav_line_said[nav_line_said_count++]);
            from_read = at + 1;
        }
    }
}

void nav_line_run(void)
{
    while (link_pass()) {
    }
    read_answers();
}

uint8_t nav_line_answer(void)
{
    TEST_ASSERT_GREATER_THAN(0, nav_line_said_count);
    const nav_line_record_t *last = &nav_line_said[nav_line_said_count - 1];
    TEST_ASSERT_EQUAL_CHAR(ANSWER_RECORD, last->bytes[0]);
    TEST_ASSERT_EQUAL(7, last->length);
    TEST_ASSERT_EQUAL_UINT16(to_next, last->bytes[5] | last->bytes[6] << 8);
    return last->bytes[3];
}

void nav_line_put(uint8_t type, const void *body, size_t length)
{
    uint8_t record[256] = { type, nav_line_sequence++ };
    uint8_t frame[300] = { 0 };
    if (length != 0) {
        memcpy(&record[NAV_LINE_HEAD], body, length);
    }
    nav_line_type(frame, nav_line_frame(record, NAV_LINE_HEAD + length, frame));
}

uint8_t nav_line_ask(uint8_t type, const void *body, size_t length)
{
    nav_line_put(type, body, length);
    nav_line_run();
    uint8_t answer = nav_line_answer();
    TEST_ASSERT_EQUAL_HEX8((uint8_t)(nav_line_sequence - 1), nav_line_said[nav_line_said_count - 1].bytes[1]);
    TEST_ASSERT_EQUAL_CHAR(type, nav_line_said[nav_line_said_count - 1].bytes[2]);
    return answer;
}

void nav_line_begin(void)
{
    to_count = 0;
    to_next = 0;
    from_count = 0;
    from_read = 0;
    nav_line_room = 127;
    nav_line_sequence = 7;
    link_start();
    read_answers();
}

void nav_line_forget(void)
{
    to_count = 0;
    to_next = 0;
    from_count = 0;
    from_read = 0;
}

const uint8_t *nav_line_sent(size_t *count)
{
    *count = from_count;
    return from_board;
}
