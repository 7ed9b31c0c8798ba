/*
 * What is to be reported in lines that begin with '#': the banner, replies to commands, faults. Any room posts a
 * notice; the console takes them in order and finds the texts (console/speaker.h). Main only.
 */
#ifndef NOTICES_H
#define NOTICES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/replies.h"

#define NOTICE_ID(name, ...) NOTICE_##name,
typedef enum { REPLIES(NOTICE_ID, NOTICE_ID) } notice_kind_t;
#undef NOTICE_ID

/*
 * Arguments: of a setting its index in settings_table.h, with NOTICE_CHANGED if it was set; of a measurement
 * measure_outcome_t; of a fault its code. NOTICE_SAVED waits until the save is over, then its result is reported.
 */
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
