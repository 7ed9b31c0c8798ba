/*
 * Frames on the serial line: a record, its CRC-16 (CCITT, start 0xFFFF, low byte first), both as COBS, then a zero
 * byte. Zero stands nowhere else, so a reader that has lost its place finds it again at the next frame (Cheshire and
 * Baker, "Consistent Overhead Byte Stuffing", 1999). All functions: main.
 */
#ifndef NAV_FRAME_H
#define NAV_FRAME_H

#include <stdbool.h>
#include <stdint.h>

enum {
    FRAME_TAKEN_MAX = 31, /* bytes of a record that is taken: an IMU's, the longest */
    FRAME_CRC = 2,
    FRAME_TOO_LONG = 0xFF,
    FRAME_OVERHEAD = FRAME_CRC + 2 /* so many bytes on the line more than a record of less than 252 has */
};

typedef struct {
    uint8_t bytes[FRAME_TAKEN_MAX + FRAME_CRC];
    uint8_t length; /* FRAME_TOO_LONG: it has no room, and is forgotten up to its end */
    uint8_t run;    /* bytes that come before the next zero that was taken out; 0: a code byte comes */
    bool whole;     /* the run that ends was of 254 bytes: no zero was taken out behind it */
    bool begun;     /* something of a frame has come */
} frame_reader_t;

typedef enum { FRAME_MORE, FRAME_GOOD, FRAME_BROKEN } frame_result_t;

void frame_reader_init(frame_reader_t *reader);

/*
 * One byte from the line. FRAME_GOOD: a record of reader->length bytes stands in reader->bytes until the next call.
 * FRAME_BROKEN: a frame has ended whose CRC or stuffing is wrong, or that is shorter than one byte or longer than
 * FRAME_TAKEN_MAX. A zero behind a zero is no frame: senders may begin with one.
 */
frame_result_t frame_take(frame_reader_t *reader, uint8_t byte);

/*
 * Sends the record in frame[1] to frame[length], 1..250 bytes, and takes up frame[0] to frame[length + 3] with what
 * goes out. The caller has seen that hal_uart_tx_room() is at least length + FRAME_OVERHEAD.
 */
void frame_send(uint8_t *frame, uint8_t length);

/* CRC-16/CCITT of `crc` and one byte more. */
uint16_t frame_crc(uint16_t crc, uint8_t byte);

#endif
