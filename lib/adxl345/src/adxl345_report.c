/* What the driver reports about itself: samples, phase, fault, times. */
#include "adxl345_burst.h"
#include "adxl345_counters.h"
#include "adxl345_driver.h"
#include "adxl345_integrity.h"
#include "adxl345_period.h"
#include "adxl345_watch.h"

const adxl345_sample_t *adxl345_take(void)
{
    if (adxl345_queued() == 0) {
        return NULL;
    }
    const burst_entry_t *entry = adxl345_burst_take();
    if (!entry->exact) {
        adxl345_counters_add(COUNTER_DRAINED);
    }
    if (entry->stuck) {
        adxl345_counters_mark(ADXL345_MARK_STUCK);
        adxl345_counters_add(COUNTER_STUCK);
    }
    return &entry->sample;
}

adxl345_phase_t adxl345_phase(void)
{
    uint8_t phase = adxl345_driver_state()->step / STEP_PHASE(1);
    return phase == ADXL345_STREAMING && !adxl345_driver_state()->first_sample_seen ? ADXL345_STARTING
                                                                                    : (adxl345_phase_t)phase;
}

adxl345_fault_t adxl345_fault(void)
{
    if (adxl345_driver_state()->fault != ADXL345_FAULT_NONE || !adxl345_driver_streams()) {
        return (adxl345_fault_t)adxl345_driver_state()->fault;
    }
    if (adxl345_integrity_int1_stuck()) {
        return ADXL345_FAULT_INT1_STUCK;
    }
    if (adxl345_integrity_stuck()) {
        return ADXL345_FAULT_STUCK;
    }
    return adxl345_watch_two_sensors() ? ADXL345_FAULT_TWO_SENSORS : ADXL345_FAULT_NONE;
}

bool adxl345_interrupted(void)
{
    return adxl345_driver_state()->after_fault;
}

uint32_t adxl345_deadline_us(void)
{
    return adxl345_driver_state()->deadline_us;
}

uint8_t adxl345_address(void)
{
    return adxl345_driver_state()->known;
}

uint8_t adxl345_foreign_address(void)
{
    return adxl345_driver_state()->foreign_address;
}

uint8_t adxl345_foreign_id(void)
{
    return adxl345_driver_state()->foreign_id;
}

/* 1e8 us over the period. */
uint32_t adxl345_rate_chz(void)
{
    if (!adxl345_period_measured()) {
        return 0;
    }
    uint32_t us_q4 = adxl345_period_us_q4();
    return (UINT32_C(1600000000) + (us_q4 >> 1)) / us_q4;
}
