#include "adxl345_counters.h"

#include "adxl345.h"
#include "machine.h"

static uint16_t counters[COUNTERS];
static uint8_t marked;

void adxl345_counters_add(counter_t counter)
{
    uint16_t *count = &counters[counter];
    MACHINE_POINTER(count); /* otherwise its address is computed twice */
    if (*count != UINT16_MAX) {
        (*count)++;
    }
}

void adxl345_counters_mark(uint8_t marks)
{
    marked |= marks;
}

void adxl345_counters_clear(void)
{
    for (uint8_t at = 0; at < COUNTERS; at++) {
        counters[at] = 0;
    }
    marked = 0;
}

uint8_t adxl345_marks(void)
{
    uint8_t marks = marked;
    marked = 0;
    return marks;
}

void adxl345_counters(adxl345_counters_t *out)
{
    *out = (adxl345_counters_t){ counters[COUNTER_DRAINED], counters[COUNTER_STUCK], counters[COUNTER_RESTARTS],
                                 counters[COUNTER_NACKS],   counters[COUNTER_LOST],  counters[COUNTER_BUS_ERRORS],
                                 counters[COUNTER_TIMEOUTS] };
}

void adxl345_readings(adxl345_readings_t *out)
{
    *out = (adxl345_readings_t){ counters[COUNTER_FAILED], counters[COUNTER_EMPTY], counters[COUNTER_OVERRUNS],
                                 counters[COUNTER_STORMS] };
}

uint16_t adxl345_count(uint8_t at)
{
    return counters[at];
}
