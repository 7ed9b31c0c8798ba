/*
 * What is to be said on lines that begin with '#': the banner, answers to commands, faults. Any room posts a notice;
 * the console takes them in their order and finds the words (console/speaker.h). Main only.
 */
#ifndef NOTICES_H
#define NOTICES_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    NOTICE_BANNER, /* who we are, reset cause, how to get help; ends with the csv header */
    NOTICE_STOPPED,
    NOTICE_GOING,
    NOTICE_SAVED, /* waits until the save is over, and reports how it went */
    NOTICE_LOADED,
    NOTICE_DEFAULTS,
    NOTICE_ODR,
    NOTICE_NOISE, /* measurements; argument: measure_outcome_t */
    NOTICE_SELFTEST,
    NOTICE_TARE,
    NOTICE_CAL,
    NOTICE_CAL6,
    NOTICE_VERSION,
    NOTICE_HELP, /* from here to LISTING many lines, for a person to read */
    NOTICE_STATUS,
    NOTICE_LISTING,  /* all settings, with what is legal; the last of the commands' names */
    NOTICE_SETTING,  /* argument: which of settings_table.h, with NOTICE_CHANGED after it was set */
    NOTICE_ILLEGAL,  /* argument: which of settings_table.h */
    NOTICE_TOO_SLOW, /* settings_cycles */
    NOTICE_UNKNOWN,  /* no such command */
    NOTICE_TOO_LONG, /* a line that is too long, or has characters that no command has */
    NOTICE_GARBAGE,
    NOTICE_BUSY,        /* not while a measurement runs */
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

/* Room for one more. */
bool notices_room(void);

/* A notice from the first kind to the last has not been said yet. */
bool notices_hold(notice_kind_t first, notice_kind_t last);

/* All have been said. */
bool notices_empty(void);

/* The oldest, to be read while they are not empty. */
const notice_t *notices_oldest(void);

/* The oldest has been said. */
void notices_drop(void);

/* Forgets everything queued. */
void notices_start(void);

#endif
