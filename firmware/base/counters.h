/* Events counted since the start, for `status`; each counter saturates. Main only. */
#ifndef COUNTERS_H
#define COUNTERS_H

#include <stdint.h>

/* In the order in which `status` prints them. */
enum counter {
    COUNT_SECONDS, /* since the start */
    COUNT_SAMPLES,
    COUNT_GATED,      /* samples that a filter's gate refused, on any axis */
    COUNT_REACQUIRED, /* samples on which a filter restarted */
    COUNT_CLIPPED,
    COUNT_ROWS,
    COUNT_DROPPED, /* rows that did not fit into the transmit ring */
    COUNT_HELD,    /* rows held back for a person who is reading */
    COUNT_REFUSED, /* lines: too long, garbage, unknown, illegal value */
    COUNT_LOST,    /* samples that are missing */
    COUNT_LATE,    /* samples that came after their rows were out */
    COUNTERS
};

void counters_start(void);

/* The current count of a kind (enum counter). */
uint32_t counted(uint8_t what);

/* Adds one to a kind. */
void count(uint8_t what);

/* Adds missing samples. */
void count_lost(uint32_t missing);

#endif
