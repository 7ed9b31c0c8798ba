/* Between reply_lines.c, which chooses the text of a line, and reply_values.c, which writes it with the values in it. */
#ifndef REPLY_SAID_H
#define REPLY_SAID_H

#include <stdint.h>

/* What a line is about. */
typedef struct {
    uint8_t subject;      /* a setting, a fault, a command, an axis or a position */
    uint8_t counters_out; /* how many `status` has written */
} said_t;

extern said_t said;

/* Writes a text (enum reply_text), with the values in it. */
void say(uint8_t text);

/* Writes a byte of a text: itself, a pair, or what stands in its place. */
void say_byte(uint8_t code);

#endif
