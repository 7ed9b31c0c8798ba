/*
 * How long no sample has come, in missing samples and in units of 25 ms, up to a second: rows and the recovery depend
 * on it. Each filter keeps the same count for itself (filter_missing). Counted, not measured, so that the chip gets the
 * same result as the PC. Main only.
 */
#ifndef SILENCE_H
#define SILENCE_H

#include <stdbool.h>
#include <stdint.h>

enum { SILENCE_FAULT_FROM = 3 };

/* A sample has come. */
void silence_end(void);

/* A sample is missing, at the rate that the filters have, 0.1 Hz. */
void silence_step(uint16_t rate_dhz);

/* Missing samples in a row, up to SILENCE_FAULT_FROM. */
uint8_t silence_samples(void);

/* Enough samples are missing for the estimate to hold (100 ms); a second has passed without one. */
bool silence_holds(void);
bool silence_long(void);

#endif
