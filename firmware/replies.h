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
    REPLY_FILTER, /* the setting in force; argument: 1 after it was set, 0 after it was asked for */
    REPLY_RATE,
    REPLY_RANGE,
    REPLY_EVERY,
    REPLY_BAUD,
    REPLY_MODE,
    REPLY_ADDRESS,
    REPLY_AXES,
    REPLY_SETTINGS_END, /* the settings are the kinds from REPLY_FILTER to before here */
    REPLY_STOPPED = REPLY_SETTINGS_END,
    REPLY_GOING,
    REPLY_SAVED, /* waits until the save is over, and tells how */
    REPLY_LOADED,
    REPLY_DEFAULTS,
    REPLY_ODR,
    REPLY_NOISE, /* measurements; argument: measure_outcome_t */
    REPLY_SELFTEST,
    REPLY_TARE,
    REPLY_CAL,
    REPLY_CAL6,
    REPLY_LISTING,   /* all settings, those of parameters.h at the end */
    REPLY_PARAMETER, /* argument: which of parameters.h */
    REPLY_ILLEGAL_PARAMETER,
    REPLY_UNKNOWN,     /* argument: reply_problem */
    REPLY_REFUSED,     /* argument: reply_kind_t of the setting whose legal values to list */
    REPLY_TOO_SLOW,    /* argument: reply_combination of the filter and rate that do not go together */
    REPLY_STREAMING,   /* not while sampling */
    REPLY_BUSY,        /* one measurement at a time */
    REPLY_NO_ROOM,     /* an image without it */
    REPLY_FAULT_BEGIN, /* argument: adxl345_fault_t */
    REPLY_FAULT_END
} reply_kind_t;

enum reply_problem { PROBLEM_COMMAND, PROBLEM_TOO_LONG, PROBLEM_GARBAGE };

/* Queue a reply; false when the queue is full (nothing queued). */
bool replies_add(reply_kind_t kind, uint8_t argument);

/* Room for one more reply. */
bool replies_room(void);

/* A reply from the first kind to the last is not out yet. */
bool replies_hold(reply_kind_t first, reply_kind_t last);

/* All replies are out. */
bool replies_empty(void);

/* A line is being composed in the transmit ring: rows wait. */
bool replies_speaking(void);

/* At most one line, or a part of it, if there is room for it and a data row; false: there is nothing to do. */
bool replies_pass(void);

/* Forget everything queued. */
void replies_start(void);

#endif
