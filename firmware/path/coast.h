/*
 * What takes the place of samples that do not come: when one is missing, and the time of its row. Main only.
 *
 * With T the sample period, sample n after the last one is missing when it is not there at (n + 1/2) T; its row has the
 * time of the last one + n T, computed, so that the rows do not depend on when main looked. A second later a row each
 * 100 ms is enough.
 */
#ifndef COAST_H
#define COAST_H

#include <stdbool.h>
#include <stdint.h>

/* No sample is expected yet: none is missing before the first one, whenever that comes. Called as often as you like. */
void coast_wait(uint32_t now_us);

/* At this time the next sample is missing, if it has not come. */
bool coast_due(uint32_t t_us);

/* When that will be. */
uint32_t coast_due_us(void);

/*
 * A sample is missing, before one that has come (sample) or the present: true when the pipeline fills its place.
 * period_us: between samples. Before a sample that comes after a long gap the rows that were not written meanwhile are
 * left out.
 */
bool coast_over(uint32_t period_us, bool sample);

/*
 * A sample with this time has come. True: it goes into the pipeline; those that did not come before it are counted, and
 * the next is expected a period later. False: it is not after the newest row, which is counted, and not to be used.
 */
bool coast_sample(uint32_t t_us, uint32_t period_us);

#endif
