/*
 * Fills in for samples that do not come: decides when one is missing, and the time of its row. Main only.
 *
 * With T the sample period, sample n after the last one counts as missing if it has not come by (n + 1/2) T; its row
 * gets the time of the last one + n T, computed, so that the rows do not depend on when main looked. After a second
 * without samples, a row every 100 ms is enough.
 */
#ifndef COAST_H
#define COAST_H

#include <stdbool.h>
#include <stdint.h>

/* No sample is expected yet: none is missing before the first one, whenever that comes. May be called repeatedly. */
void coast_wait(uint32_t now_us);

/* At this time the next sample counts as missing, if it has not come. */
bool coast_due(uint32_t t_us);

/* The time from which it does. */
uint32_t coast_due_us(void);

/*
 * A sample is missing before one that has come (`sample`), or before the present: true if the pipeline fills its place.
 * period_us: time between samples. Before a sample that comes after a long gap, rows that were not written during the
 * gap are left out.
 */
bool coast_over(uint32_t period_us, bool sample);

/*
 * A sample with this time has come; samples missing before it are counted. True: it goes into the pipeline, and the
 * next is expected one period later. False: it is not later than the newest row; it is counted, and must not be used.
 */
bool coast_sample(uint32_t t_us, uint32_t period_us);

#endif
