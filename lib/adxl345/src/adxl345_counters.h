/*
 * Inside the driver: its counters and marks. The lowest of its parts: every other part may count, and this one calls
 * none. Main only.
 */
#ifndef ADXL345_COUNTERS_H
#define ADXL345_COUNTERS_H

#include <stdint.h>

/* By index in adxl345_count. */
typedef enum {
    COUNTER_DRAINED,
    COUNTER_STUCK,
    COUNTER_RESTARTS,
    COUNTER_NACKS, /* from here on in the order of i2c_bus_state_t */
    COUNTER_LOST,
    COUNTER_BUS_ERRORS,
    COUNTER_TIMEOUTS,
    COUNTER_FAILED,
    COUNTER_EMPTY,
    COUNTER_OVERRUNS,
    COUNTER_STORMS,
    COUNTERS
} counter_t;

/* Adds one, up to 65,535. */
void adxl345_counters_add(counter_t counter);

/* Adds these bits (ADXL345_MARK_*) to the next result of adxl345_marks. */
void adxl345_counters_mark(uint8_t marks);

/* Zeroes all counters and marks. */
void adxl345_counters_clear(void);

#endif
