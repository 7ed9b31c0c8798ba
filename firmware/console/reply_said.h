/* Shared by reply_lines.c, which takes the texts of a line apart, and reply_values.c, which writes what is in them. */
#ifndef REPLY_SAID_H
#define REPLY_SAID_H

#include <stdint.h>

/* What a line is about. */
typedef struct {
    uint8_t subject;      /* a setting, a fault, a command, an axis or a position */
    uint8_t counters_out; /* how many counters `status` has printed */
} said_t;

/* Writes a byte of a text, or the value in its place; returns the text in which that continues, or TEXT_NONE. */
uint8_t say(said_t *said, uint8_t code);

#endif
