/* Between reply_lines.c, which chooses the texts of a reply, and reply_values.c, which speaks the values in them. */
#ifndef REPLY_SAID_H
#define REPLY_SAID_H

#include <stdbool.h>
#include <stdint.h>

/* What the line that is being spoken is about. */
typedef struct {
    uint16_t rate_dhz;
    uint8_t filter;
    uint8_t subject;      /* the reply's argument; the setting in a list of settings */
    uint8_t counters_out; /* how many `status` has told */
    uint8_t axis;         /* of this line of a measurement, or the position */
    uint8_t next;         /* enum reply_text: where it goes on */
    uint8_t progress;     /* reply_progress_t, as far as the texts decide it */
    bool listed;          /* what is legal follows the setting */
} said_t;

extern said_t said;

/* A byte of a text: itself, a value in its place, or (enum say) how the line goes on. */
void say_byte(uint8_t c);

#endif
