/*
 * Frames on the serial line: a record, its CRC-16 (CCITT, start 0xFFFF, low byte first), both as COBS, then a zero
 * byte. Zero occurs nowhere else, so a reader that has lost synchronisation finds it again at the next frame (Cheshire
 * and Baker, "Consistent Overhead Byte Stuffing", 1999). All functions: main.
 */
#ifndef NAV_FRAME_H
#define NAV_FRAME_H

#include <stdbool.h>
#include <stdint.h>

enum {
    FRAME_TAKEN_MAX = 31, /* bytes of the longest accepted record, an IMU record */
    FRAME_CRC = 2,
    FRAME_TOO_LONG = 0xFF,
    FRAME_OVERHEAD = FRAME_CRC + 2 /* bytes on the line beyond those of a record shorter than 252 */
};

typedef struct {
    uint8_t bytes[FRAME_TAKEN_MAX + FRAME_CRC];
    uint8_t length; /* FRAME_TOO_LONG: no room, dropped up to its end */
    uint8_t run;    /* bytes before the next removed zero; 0: the next byte is a code */
    bool whole;     /* the run that ends had 254 bytes: no zero was removed after it */
    bool begun;     /* at least one byte of a frame has arrived */
} frame_reader_t;

typedef enum { FRAME_MORE, FRAME_GOOD, FRAME_BROKEN } frame_result_t;

void frame_reader_init(frame_reader_t *reader);

/*
 * One byte from the line. FRAME_GOOD: a record of reader->length bytes is in reader->bytes until the next call.
 * FRAME_BROKEN: a frame has ended whose CRC or stuffing is wrong, or that is shorter than one byte or longer than
 * FRAME_TAKEN_MAX. A zero after a zero is not a frame: senders may begin with one.
 */
frame_result_t frame_take(frame_reader_t *reader, uint8_t byte);

/*
 * Sends the record in frame[1] to frame[length], 1..250 bytes, and overwrites frame[0] to frame[length + 3] with the
 * bytes sent. The caller has checked that hal_uart_tx_room() is at least length + FRAME_OVERHEAD.
 */
void frame_send(uint8_t *frame, uint8_t length);

/* CRC-16/CCITT of `crc` and one more byte. */
uint16_t frame_crc(uint16_t crc, uint8_t byte);

#endif
