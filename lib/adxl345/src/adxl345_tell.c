/* What the driver tells of itself: samples, phase, fault, times, counters. */
#include "adxl345_burst.h"
#include "adxl345_driver.h"
#include "adxl345_integrity.h"
#include "adxl345_period.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_pointer.h"

static uint16_t counters[COUNTERS];

void driver_count(counter_t counter)
{
    uint16_t *count = &counters[counter];
    HAL_POINTER(count); /* else its address is computed twice */
    if (*count != UINT16_MAX) {
        (*count)++;
    }
}

void driver_forget_counters(void)
{
    for (uint8_t at = 0; at < COUNTERS; at++) {
        counters[at] = 0;
    }
}

const adxl345_sample_t *adxl345_take(void)
{
    if (burst_queued() == 0) {
        return NULL;
    }
    const burst_entry_t *entry = burst_take();
    if (!entry->exact) {
        driver_count(COUNTER_DRAINED);
    }
    if (entry->stuck) {
        driver.marks |= ADXL345_MARK_STUCK;
        driver_count(COUNTER_STUCK);
    }
    return &entry->sample;
}

uint8_t adxl345_marks(void)
{
    uint8_t marks = driver.marks;
    driver.marks = 0;
    return marks;
}

HAL_APART uint8_t adxl345_queued(void)
{
    return burst_queued();
}

bool adxl345_oldest_us(uint32_t *t_us)
{
    return burst_oldest_us(t_us);
}

bool adxl345_sample_coming(void)
{
    return driver_streams() && !burst_found_empty() && (burst_running() || hal_drdy_high());
}

uint32_t adxl345_lateness_us(void)
{
    return stream_without_edges() ? 2u * period_us() : 0;
}

adxl345_phase_t adxl345_phase(void)
{
    uint8_t phase = driver.step / STEP_PHASE(1);
    return phase == ADXL345_STREAMING && !driver.first_sample_seen ? ADXL345_STARTING : (adxl345_phase_t)phase;
}

adxl345_fault_t adxl345_fault(void)
{
    if (driver.fault != ADXL345_FAULT_NONE || !driver_streams()) {
        return (adxl345_fault_t)driver.fault;
    }
    if (integrity_int1_stuck()) {
        return ADXL345_FAULT_INT1_STUCK;
    }
    if (integrity_stuck()) {
        return ADXL345_FAULT_STUCK;
    }
    return watch_two_sensors() ? ADXL345_FAULT_TWO_SENSORS : ADXL345_FAULT_NONE;
}

bool adxl345_interrupted(void)
{
    return driver.after_fault;
}

HAL_APART uint32_t adxl345_deadline_us(void)
{
    return driver.deadline_us;
}

uint8_t adxl345_address(void)
{
    return driver.known;
}

uint8_t adxl345_foreign_address(void)
{
    return driver.foreign_address;
}

uint8_t adxl345_foreign_id(void)
{
    return driver.foreign_id;
}

uint32_t adxl345_period_us(void)
{
    return period_us();
}

/* 1e8 us x 256 over the period, both by 8 that 32 bits are enough; that rounds by 1.3e-5 at 800 Hz, less below. */
uint32_t adxl345_rate_chz(void)
{
    if (!period_measured()) {
        return 0;
    }
    uint32_t eighth_us_q8 = (period_us_q8() + 4u) >> 3;
    return (UINT32_C(3200000000) + (eighth_us_q8 >> 1)) / eighth_us_q8;
}

void adxl345_counters(adxl345_counters_t *out)
{
    *out = (adxl345_counters_t){ counters[COUNTER_DRAINED], counters[COUNTER_STUCK], counters[COUNTER_RESTARTS],
                                 counters[COUNTER_NACKS],   counters[COUNTER_LOST],  counters[COUNTER_BUS_ERRORS],
                                 counters[COUNTER_TIMEOUTS] };
}

void adxl345_readings(adxl345_readings_t *out)
{
    *out = (adxl345_readings_t){ counters[COUNTER_FAILED], counters[COUNTER_EMPTY], counters[COUNTER_OVERRUNS] };
}

uint16_t adxl345_count(uint8_t at)
{
    return counters[at];
}
