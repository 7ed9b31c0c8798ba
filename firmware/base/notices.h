/*
 * What is to be reported in lines that begin with '#': the banner, replies to commands, faults. Any room posts a
 * notice; the console takes them in order and finds the texts (console/speaker.h). Main only.
 */
#ifndef NOTICES_H
#define NOTICES_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    NOTICE_BANNER, /* name and version, reset cause, how to get help; ends with the csv header */
    NOTICE_STOPPED,
    NOTICE_GOING,
    NOTICE_SAVED, /* waits until the save is over, then reports its result */
    NOTICE_LOADED,
    NOTICE_DEFAULTS,
    NOTICE_ODR,
    NOTICE_NOISE, /* measurements; argument: measure_outcome_t */
    NOTICE_SELFTEST,
    NOTICE_TARE,
    NOTICE_CAL,
    NOTICE_CAL6,
    NOTICE_VERSION,
    NOTICE_HELP, /* from here to LISTING: many lines, for a person to read */
    NOTICE_STATUS,
    NOTICE_LISTING,  /* all settings with their legal values; the last of the commands' names */
    NOTICE_SETTING,  /* argument: index in settings_table.h, with NOTICE_CHANGED if it was set */
    NOTICE_ILLEGAL,  /* argument: index in settings_table.h */
    NOTICE_TOO_SLOW, /* numbers: settings_cycles */
    NOTICE_UNKNOWN,  /* no such command */
    NOTICE_TOO_LONG, /* too long; GARBAGE: with characters that no command has */
    NOTICE_GARBAGE,
    NOTICE_BUSY,        /* refused while a measurement runs */
    NOTICE_FAULT_BEGIN, /* argument: adxl345_fault_t */
    NOTICE_FAULT_END
} notice_kind_t;

enum { NOTICE_CHANGED = 0x80 };

typedef struct {
    uint8_t kind; /* notice_kind_t */
    uint8_t argument;
} notice_t;

/* Queues a notice; false when the queue is full (nothing is queued). */
bool notices_add(notice_kind_t kind, uint8_t argument);

/* There is room for one more. */
bool notices_room(void);

/* A notice of a kind from first to last has not been printed yet. */
bool notices_hold(notice_kind_t first, notice_kind_t last);

/* All have been printed. */
bool notices_empty(void);

/* The oldest notice, while there is one. */
const notice_t *notices_oldest(void);

/* Removes the oldest notice, which has been printed. */
void notices_drop(void);

/* Empties the queue. */
void notices_start(void);

#endif
