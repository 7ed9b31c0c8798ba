/*
 * A line to the navigation image that is memory, and a PC at its end: frames by the definition, in an encoder and a
 * decoder of their own. In place of the HAL's UART, clock and reset cause.
 */
#ifndef NAV_LINE_H
#define NAV_LINE_H

#include <stddef.h>
#include <stdint.h>

enum { NAV_LINE_RECORDS = 16, NAV_LINE_HEAD = 2 };

typedef struct {
    uint8_t bytes[256];
    size_t length;
} nav_line_record_t;

/* What the board said in the last run, and how many of them. */
extern nav_line_record_t nav_line_said[NAV_LINE_RECORDS];
extern size_t nav_line_said_count;

extern uint8_t nav_line_room;     /* of the board's transmitter */
extern uint8_t nav_line_sequence; /* of the next record */

/* An empty line; the board starts and greets. */
void nav_line_begin(void);

/* The bytes are typed and not taken yet; what was typed before and is taken may be forgotten, with the answers. */
void nav_line_type(const uint8_t *bytes, size_t length);
void nav_line_put(uint8_t type, const void *body, size_t length);
void nav_line_forget(void);

/* The board takes what it can; fails the test when what it says is no frame. */
void nav_line_run(void);

/* Of the last record's answer, which must be there and have counted the bytes taken. */
uint8_t nav_line_answer(void);

/* put, run, and the answer to it. */
uint8_t nav_line_ask(uint8_t type, const void *body, size_t length);

/* A record as a frame with its zero; its length. */
size_t nav_line_frame(const uint8_t *record, size_t length, uint8_t *to);

/* Bytes that the board has sent, from the first; how many. */
const uint8_t *nav_line_sent(size_t *count);

#endif
