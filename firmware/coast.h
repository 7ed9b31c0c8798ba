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

/* A sample with this time is older than the newest row: not to be used. Counts it. */
bool coast_too_late(uint32_t t_us);

/*
 * True when a sample is missing before t, one that has come (sample) or the present, and the pipeline has filled its
 * place: call again until it is false. period_us: between samples. Before a sample that comes after a long gap the rows
 * that were not written meanwhile are left out.
 */
bool coast_over(uint32_t t_us, uint32_t period_us, bool sample);

/* When the next sample will be missing, if it has not come. */
uint32_t coast_due_us(uint32_t period_us);

/* This sample goes into the pipeline: none is missing, and the next is expected a period later. */
void coast_end(uint32_t t_us, uint32_t period_us);

#endif
