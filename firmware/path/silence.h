/*
 * How long no sample has come, in missing samples and in 25 ms, up to a second: rows and the way back depend on it.
 * Each filter counts the same for itself (filter_missing). Counted, not measured, so that the chip counts as the PC
 * does. Main only.
 */
#ifndef SILENCE_H
#define SILENCE_H

#include <stdbool.h>
#include <stdint.h>

enum { SILENCE_FAULT_FROM = 3 };

/* A sample has come. */
void silence_end(void);

/* One is missing, at the rate that the filters have, 0.1 Hz. */
void silence_step(uint16_t rate_dhz);

/* Samples in a row, up to SILENCE_FAULT_FROM. */
uint8_t silence_samples(void);

/* So many samples are missing that the estimate holds (100 ms); that a second has passed without one. */
bool silence_holds(void);
bool silence_long(void);

#endif
