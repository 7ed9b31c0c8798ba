/* Between reply_lines.c, which chooses the text of a line, and reply_values.c, which writes it with the values in it. */
#ifndef REPLY_SAID_H
#define REPLY_SAID_H

#include <stdbool.h>
#include <stdint.h>

/* What a line is about. */
typedef struct {
    uint8_t subject;      /* the reply's argument; a setting; the command of a measurement */
    uint8_t axis;         /* of this line of a measurement, or the position */
    uint8_t counters_out; /* how many `status` has written */
    bool more;            /* another line follows */
} said_t;

extern said_t said;

/* Writes a text (enum reply_text), with the values in it. */
void say(uint8_t text);

#endif
