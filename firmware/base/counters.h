/* What happened how often since the start, for `status`; each stays at its greatest value. Main only. */
#ifndef COUNTERS_H
#define COUNTERS_H

#include <stdint.h>

/* In the order in which `status` prints them. */
enum counter {
    COUNT_SECONDS, /* since the start */
    COUNT_SAMPLES,
    COUNT_GATED,      /* samples that a filter refused, on any axis */
    COUNT_REACQUIRED, /* samples on which a filter restarted */
    COUNT_CLIPPED,
    COUNT_ROWS,
    COUNT_DROPPED, /* rows for which the line had no room */
    COUNT_HELD,    /* rows that waited for a person who reads */
    COUNT_REFUSED, /* lines: too long, garbage, unknown, illegal value */
    COUNT_LOST,    /* samples that did not come */
    COUNT_LATE,    /* samples that came when their rows were out */
    COUNTERS
};

void counters_start(void);

/* How many so far of a kind (enum counter). */
uint32_t counted(uint8_t what);

/* One more of a kind. */
void count(uint8_t what);

/* So many samples are missing. */
void count_lost(uint32_t missing);

#endif
