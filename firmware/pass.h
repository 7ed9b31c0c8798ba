/*
 * The time of a pass of the main loop: who works through a list of pieces asks before each whether there is time for
 * one more. A pass that ends for lack of time wakes itself (app.c). Main only.
 */
#ifndef PASS_H
#define PASS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_time.h"

/* No further piece begins after this: with the longest one, a row or a sample's axis, a pass stays below 1 ms. */
#define PASS_US 288u

/* The same while filters are initialised, which takes up to 0.8 ms for an axis. */
#define PASS_CHANGING_US 128u

/* A command begins no later: with the longest one a pass stays below 1 ms. */
#define PASS_EARLY_US 128u

typedef struct {
    uint8_t began; /* hal_time_lap */
    uint8_t limit; /* in HAL_LAP_US */
} pass_t;

extern pass_t pass;

bool pass_in_time(void);
bool pass_early(void);

#endif
