/*
 * The step of the driver's state machine in which samples come: when the sensor is asked why none does, when it is read
 * by the clock because INT1 is silent or stuck, and what failed. All in main.
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

#define MARGIN_US 3000u
#define TRANSFER_US ((uint32_t)TRANSFER_LIMIT * LIMIT_US)
#define TURN_ON_MS 20u /* p. 5: period + 1.1 ms, with room for a slow start */

/* So many halves of the nominal time between samples. */
static MACHINE_APART uint32_t halves_us(uint8_t count)
{
    return (uint32_t)adxl345_driver_state()->half_us * count;
}

/* So long after the newest burst that met a sample, or after the moment by which the first is expected. */
static MACHINE_APART bool silent_for(uint32_t us)
{
    return adxl345_driver_reached(adxl345_burst_met_sample_us() + us);
}

/*
 * INT1 may have risen just now, unless it is always high. Ones of a sensor that is gone show in the bits of functions
 * that are off. A sensor that has none ready may still come: that is a fault after three periods.
 */
void adxl345_stream_source_asked(adxl345_driver_t *d)
{
    uint8_t source = adxl345_burst_register_value() & (uint8_t)(ADXL345_INT_DATA_READY | ADXL345_INT_EVENTS);
    if (source != ADXL345_INT_DATA_READY) {
        bool may_come = source == 0 && !silent_for(halves_us(6) + MARGIN_US);
        if (!may_come && (!hal_drdy_high() || adxl345_integrity_int1_stuck())) {
            adxl345_driver_fail(ADXL345_FAULT_NO_DATA);
            return;
        }
        d->was_empty = true;
    } else if (!hal_drdy_high()) { /* while it is high, the sample is read because it is */
        d->fault = ADXL345_FAULT_INT1_SILENT;
        d->timed = TIMED_WANTED;
    }
    adxl345_burst_set_mode(BURST_READ);
    adxl345_driver_enter(STEP_STREAM, RETURN_LIMIT);
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
    d->timed = TIMED_NONE;
    d->was_empty = false;
    d->seen_good = adxl345_integrity_good();
    adxl345_burst_expect(d->now_us + TURN_ON_MS * 1000ul);
    adxl345_burst_set_mode(BURST_READ); /* last: an edge may come with it */
    adxl345_driver_enter(STEP_STREAM, RETURN_LIMIT);
}

bool adxl345_stream_without_edges(void)
{
    return adxl345_driver_state()->fault == ADXL345_FAULT_INT1_SILENT || adxl345_integrity_int1_stuck();
}

/*
 * Without a sample until the sensor is asked: a quarter of a period after it was due, so that one whose edge is lost is
 * read before its row is filled, which happens at a half; but no sooner than a transfer may take, which is later at
 * 800 Hz alone. While INT1 is known to be silent or stuck less than a period, so that a sensor that is fast does not
 * fill its FIFO.
 */
static uint32_t patience_us(void)
{
    if (adxl345_stream_without_edges()) {
        return halves_us(3) >> 1;
    }
    uint32_t us = halves_us(5) >> 1;
    return us < TRANSFER_US ? TRANSFER_US : us;
}

static void sample_arrived(adxl345_driver_t *d)
{
    d->seen_good = adxl345_integrity_good();
    d->was_empty = false;
    d->after_fault = false;
    d->first_sample_seen = true;
    d->back_off = BACK_OFF_MIN;
    d->deadline_us = adxl345_burst_begun_us() + patience_us();
    if (d->timed == TIMED_READ) {
        d->timed = adxl345_burst_left_more() ? TIMED_WANTED : TIMED_NONE;
        return;
    }
    d->fault = ADXL345_FAULT_NONE;
    d->timed = TIMED_NONE;
}

/*
 * No sample came by the time it was due. A burst or the STOP after it may hang: the sample is read again, unless a
 * line that is low says why. Or there was none for so long that the sensor is asked; a burst that failed counts as a
 * sign of life: three in a row are a fault by themselves.
 */
static void look_for_sample(adxl345_driver_t *d)
{
    if (adxl345_burst_running() || hal_i2c_stop_pending()) {
        d->deadline_us = adxl345_burst_begun_us() + TRANSFER_US;
        if (adxl345_driver_deadline_passed() && adxl345_driver_transfer_failed(I2C_BUS_TIMEOUT)) {
            adxl345_driver_enter(STEP_STREAM, RETURN_LIMIT);
        }
    } else if (adxl345_burst_queue_full() || (hal_drdy_high() && !adxl345_burst_found_empty()) ||
               !silent_for(patience_us())) {
        adxl345_driver_set_limit(LOOK_LIMIT); /* main was late, or it is early */
    } else {
        adxl345_burst_set_mode(BURST_STAMP);
        adxl345_driver_enter(STEP_ASK_SOURCE, TRANSFER_LIMIT);
    }
}

/* What the readings say; a sensor that has lost its configuration is given it again at once. */
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

/* Begins the burst of a sample that waits, seen by INT1 or by the clock. */
static void fetch(adxl345_driver_t *d)
{
    bool by_clock = d->timed == TIMED_WANTED;
    if (!by_clock && !hal_drdy_high()) {
        return;
    }
    if (adxl345_burst_read(d->was_empty)) {
        if (by_clock) {
            d->timed = TIMED_READ;
        }
        adxl345_driver_set_limit(TRANSFER_LIMIT);
    } else if (hal_i2c_stop_pending()) {
        hal_wake(); /* the end of a STOP raises no interrupt */
    }
}

void adxl345_stream_poll(adxl345_driver_t *d)
{
    if (readings_failed()) {
        return;
    }
    if (adxl345_burst_failures() >= (uint8_t)TRIES) {
        adxl345_driver_give_up(d, adxl345_burst_failed_state());
        return;
    }
    if (adxl345_integrity_good() != d->seen_good) {
        sample_arrived(d);
    } else if (adxl345_driver_deadline_passed() || (adxl345_burst_found_empty() && !adxl345_burst_running())) {
        look_for_sample(d);
    }
    fetch(d);
}
