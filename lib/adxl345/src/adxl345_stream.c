/*
 * The step of the state machine that receives samples: when to start a burst without an edge of INT1, and what has
 * failed. A burst on a sensor without a sample is short and changes nothing, so it also serves to find out why none
 * comes. All of it runs in main.
 */
#include "adxl345_stream.h"

#include "adxl345_burst.h"
#include "adxl345_counters.h"
#include "adxl345_integrity.h"
#include "adxl345_registers.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_i2c.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "machine.h"

#define TRANSFER_US ((uint32_t)TRANSFER_LIMIT * LIMIT_US)
#define FIRST_US 2000u  /* plus one period after Measure the first sample is due (p. 5: 1.1 ms) */
#define SLOW_US 18000u  /* with this much extra for a slow start */
#define SILENT_US 3000u /* plus three periods without a sample is a fault */

/*
 * Time after a sample at which the edge of the next one is overdue: five quarters of a period, six at 800 Hz, where the
 * burst started by an edge has not ended sooner.
 */
static uint16_t patience_2us(uint16_t half_us)
{
    uint16_t quarter_us = half_us / 4u;
    if (half_us < 1024) {
        half_us += quarter_us;
    }
    return half_us + quarter_us;
}

/*
 * A silent INT1, or one that is already high, gives no edge. The time is short enough that a fast sensor does not fill
 * its FIFO.
 */
static MACHINE_APART void look_after(adxl345_driver_t *d)
{
    uint16_t after_2us = patience_2us(d->half_us);
    if (d->fault != ADXL345_FAULT_NONE || hal_drdy_high()) {
        after_2us = d->half_us - d->half_us / 16u;
    }
    d->deadline_us = adxl345_burst_last_us() + (uint32_t)after_2us * 2u;
}

void adxl345_stream_start(adxl345_driver_t *d)
{
    if (d->after_fault) {
        adxl345_counters_add(COUNTER_RESTARTS);
        adxl345_integrity_forget();
        adxl345_watch_start();
    }
    adxl345_integrity_start(&d->config);
    d->first_sample_seen = false;
    adxl345_burst_expect(d->now_us + FIRST_US);
    adxl345_driver_enter(STEP_STREAM, 0);
    look_after(d);
    adxl345_burst_set_mode(BURST_READ); /* last: an edge may come with it */
}

static void sample_arrived(adxl345_driver_t *d)
{
    d->after_fault = false;
    d->first_sample_seen = true;
    d->back_off = BACK_OFF_MIN;
    uint8_t fault = adxl345_burst_int1();
    if (fault == ADXL345_FAULT_INT1_FLICKERS && fault != d->fault) {
        adxl345_counters_add(COUNTER_STORMS);
    }
    d->fault = fault;
}

/* A burst, or the STOP after one, is on the bus: it may hang. */
static void look_at_bus(adxl345_driver_t *d)
{
    uint32_t end_us = adxl345_burst_begun_us() + TRANSFER_US;
    if (adxl345_burst_running()) {
        d->deadline_us = end_us;
    } else {
        hal_wake(); /* the end of a STOP raises no interrupt */
    }
    if (adxl345_driver_reached(end_us) && adxl345_driver_transfer_failed(I2C_BUS_TIMEOUT)) {
        adxl345_driver_enter(STEP_STREAM, RETURN_LIMIT);
    }
}

/* Acts on the readings; a sensor that has lost its configuration is configured again at once. */
static bool readings_failed(void)
{
    adxl345_fault_t fault = adxl345_integrity_fault();
    if (fault == ADXL345_FAULT_NONE) {
        return false;
    }
    adxl345_driver_fail(fault);
    if (fault == ADXL345_FAULT_NO_DATA) {
        adxl345_driver_probe();
    }
    return true;
}

/* Main may be late: only a burst that began after a sample was due can find the sensor empty. */
static bool failed(adxl345_driver_t *d, reading_t reading)
{
    if (readings_failed()) {
        return true;
    }
    if (adxl345_burst_failures() >= (uint8_t)TRIES) {
        adxl345_driver_give_up(d, adxl345_burst_failed_state());
        return true;
    }
    if (reading != READING_EMPTY || adxl345_sample_waits()) {
        return false;
    }
    uint32_t due_us = adxl345_burst_last_us() + (uint32_t)d->half_us * 6u + SILENT_US;
    if (!d->first_sample_seen) {
        due_us += SLOW_US;
    }
    if (!adxl345_driver_reached(due_us)) {
        return false;
    }
    adxl345_driver_fail(ADXL345_FAULT_NO_DATA);
    return true;
}

void adxl345_stream_poll(adxl345_driver_t *d, reading_t reading)
{
    if (failed(d, reading)) {
        return;
    }
    if (reading != READING_NONE) {
        if (reading == READING_GOOD) {
            sample_arrived(d);
        }
        look_after(d); /* at once if it is time */
    }
    if (!adxl345_sample_waits() && !adxl345_driver_deadline_passed()) {
        return;
    }
    if (adxl345_burst_running() || hal_i2c_stop_pending()) {
        look_at_bus(d);
        return;
    }
    adxl345_burst_read(); /* does nothing while the queue is full */
    adxl345_driver_set_limit(TRANSFER_LIMIT);
}
