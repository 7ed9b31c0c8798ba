/* COBS and CRC, a byte at a time. */
#include "nav_frame.h"

#include "hal_uart.h"

#define CRC_START 0xFFFFu
enum { CODE_WHOLE = 0xFF }; /* the code of a run with no zero after it */

/* Eight steps of the shift register at once, without a table: x^16 + x^12 + x^5 + 1. */
uint16_t frame_crc(uint16_t crc, uint8_t byte)
{
    uint8_t high = (uint8_t)((uint8_t)(crc >> 8) ^ byte);
    high = (uint8_t)(high ^ (uint8_t)(high >> 4));
    uint16_t next = (uint16_t)((uint32_t)crc << 8);
    next = (uint16_t)(next ^ (uint16_t)((uint16_t)high << 12));
    next = (uint16_t)(next ^ (uint16_t)((uint16_t)high << 5));
    return (uint16_t)(next ^ high);
}

static uint16_t crc_of(const uint8_t *bytes, uint8_t length)
{
    uint16_t crc = CRC_START;
    while (length-- != 0) {
        crc = frame_crc(crc, *bytes++);
    }
    return crc;
}

void frame_reader_init(frame_reader_t *reader)
{
    reader->length = 0;
    reader->run = 0;
    reader->whole = true;
    reader->begun = false;
}

static void keep(frame_reader_t *reader, uint8_t byte)
{
    if (reader->length >= FRAME_TAKEN_MAX + FRAME_CRC) {
        reader->length = FRAME_TOO_LONG;
        return;
    }
    reader->bytes[reader->length++] = byte;
}

static frame_result_t end_of_frame(frame_reader_t *reader)
{
    bool complete = reader->run == 0 && reader->length != FRAME_TOO_LONG && reader->length > FRAME_CRC;
    uint8_t record = (uint8_t)(reader->length - FRAME_CRC);
    frame_reader_init(reader);
    if (!complete) {
        return FRAME_BROKEN;
    }
    uint16_t crc = (uint16_t)(reader->bytes[record] | (uint16_t)((uint16_t)reader->bytes[record + 1u] << 8));
    if (crc != crc_of(reader->bytes, record)) {
        return FRAME_BROKEN;
    }
    reader->length = record;
    return FRAME_GOOD;
}

/* The first byte after the end of a frame begins the next. */
static void begin(frame_reader_t *reader)
{
    frame_reader_init(reader);
    reader->begun = true;
}

frame_result_t frame_take(frame_reader_t *reader, uint8_t byte)
{
    if (byte == 0) {
        return reader->begun ? end_of_frame(reader) : FRAME_MORE;
    }
    if (!reader->begun) {
        begin(reader);
    }
    if (reader->run != 0) {
        reader->run--;
        keep(reader, byte);
        return FRAME_MORE;
    }
    if (!reader->whole) {
        keep(reader, 0);
    }
    reader->whole = byte == CODE_WHOLE;
    reader->run = (uint8_t)(byte - 1u);
    return FRAME_MORE;
}

/* Works backwards, so that the distance to the next zero is known at each zero. */
void frame_send(uint8_t *frame, uint8_t length)
{
    uint8_t end = (uint8_t)(length + FRAME_CRC + 1);
    uint16_t crc = crc_of(&frame[1], length);
    uint8_t *check = &frame[(uint8_t)(length + 1u)];
    check[0] = (uint8_t)crc;
    check[1] = (uint8_t)(crc >> 8);
    uint8_t next = end;
    for (uint8_t at = (uint8_t)(end - 1u); at != 0; at--) {
        if (frame[at] == 0) {
            frame[at] = (uint8_t)(next - at);
            next = at;
        }
    }
    frame[0] = next;
    frame[end] = 0;
    (void)hal_uart_tx_write((const char *)frame, (uint8_t)(end + 1u));
}
