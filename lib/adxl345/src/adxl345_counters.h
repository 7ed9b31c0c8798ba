/*
 * Inside the driver: what is counted and marked of its work. The lowest of its parts: each of the others may count, and
 * this one calls nobody. Main only.
 */
#ifndef ADXL345_COUNTERS_H
#define ADXL345_COUNTERS_H

#include <stdint.h>

/* By their places in adxl345_count. */
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
    COUNTERS
} counter_t;

/* One more, up to 65,535. */
void adxl345_counters_add(counter_t counter);

/* These bits (ADXL345_MARK_*) are in what adxl345_marks returns next. */
void adxl345_counters_mark(uint8_t marks);

/* All to zero, and no mark. */
void adxl345_counters_clear(void);

#endif
