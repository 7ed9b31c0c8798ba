/*
 * Lines that begin with '#': the banner, answers to commands, faults. They wait in a short queue and go out one line at
 * a time when the line has room beside a data row, so they never push a row out. Main only.
 */
#ifndef REPLIES_H
#define REPLIES_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    REPLY_BANNER, /* who we are, reset cause, how to get help; ends with the csv header */
    REPLY_HELP,
    REPLY_STATUS,
    REPLY_STOPPED,
    REPLY_GOING,
    REPLY_SAVED, /* waits until the save is over, and reports how it went */
    REPLY_LOADED,
    REPLY_DEFAULTS,
    REPLY_ODR,
    REPLY_NOISE, /* measurements; argument: measure_outcome_t */
    REPLY_SELFTEST,
    REPLY_TARE,
    REPLY_CAL,
    REPLY_CAL6,
    REPLY_LISTING,  /* all settings, with what is legal; the last of the commands' names */
    REPLY_SETTING,  /* argument: which of settings_table.h, with REPLY_CHANGED after it was set */
    REPLY_ILLEGAL,  /* argument: which of settings_table.h */
    REPLY_TOO_SLOW, /* settings_cycles */
    REPLY_UNKNOWN,  /* no such command */
    REPLY_TOO_LONG, /* a line that is too long, or has characters that no command has */
    REPLY_GARBAGE,
    REPLY_STREAMING,   /* not while sampling */
    REPLY_BUSY,        /* one measurement at a time */
    REPLY_FAULT_BEGIN, /* argument: adxl345_fault_t */
    REPLY_FAULT_END
} reply_kind_t;

enum { REPLY_CHANGED = 0x80 };

/* Queue a reply; false when the queue is full (nothing queued). */
bool replies_add(reply_kind_t kind, uint8_t argument);

/* Room for one more reply. */
bool replies_room(void);

/* A reply from the first kind to the last is not out yet. */
bool replies_hold(reply_kind_t first, reply_kind_t last);

/* All replies are out. */
bool replies_empty(void);

/* At most one line, if there is room for it and a data row; false: there is nothing to do. */
bool replies_pass(void);

/* Forget everything queued. */
void replies_start(void);

#endif
