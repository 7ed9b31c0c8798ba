/*
 * The driver's state machine: finds the sensor, configures it, puts it into standby, backs off. The step that receives
 * samples is in adxl345_stream.c, what the steps share in adxl345_driver.c, what the driver reports about itself in
 * adxl345_report.c. Each step issues at most one register access and has a deadline; adxl345_poll checks the result and
 * moves on. All of it runs in main; the interrupts are in adxl345_burst.c.
 */
#include "adxl345.h"

#include "adxl345_burst.h"
#include "adxl345_counters.h"
#include "adxl345_driver.h"
#include "adxl345_integrity.h"
#include "adxl345_registers.h"
#include "adxl345_stream.h"
#include "adxl345_table.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "machine.h"

/* Further attempts to reach a sensor that a stop did not reach, for one second. */
enum { RESTS = 40 };

/* Addresses the sensor that was found last: a device at the other address may be a different one. */
static MACHINE_APART void rest_sensor(void)
{
    adxl345_driver_state()->address = adxl345_driver_state()->known;
    adxl345_driver_begin_access(STEP_STANDBY);
}

void adxl345_init(void)
{
    if (!MACHINE_RAM_CLEARED) {
        adxl345_burst_init();
        adxl345_counters_clear();
        adxl345_integrity_forget();
        adxl345_watch_start();
        adxl345_driver_stopped();
        adxl345_driver_state()->issued = false;
        adxl345_driver_state()->garbled = 0;
    }
    adxl345_driver_state()->address = ADXL345_ADDRESS_LOW;
    adxl345_driver_state()->known = ADXL345_ADDRESS_LOW;
}

/* If samples may be waiting, starts to put the sensor into standby; true while that is under way. */
static bool quiesce(void)
{
    adxl345_driver_state()->now_us = hal_time_us();
    if (adxl345_driver_streams()) {
        adxl345_burst_set_mode(BURST_STAMP);
        adxl345_driver_enter(STEP_QUIET_STANDBY, TRANSFER_LIMIT);
        return true;
    }
    return adxl345_driver_state()->step == STEP_QUIET_STANDBY || adxl345_driver_state()->step == STEP_QUIET_DRAIN;
}

void adxl345_start(const adxl345_config_t *config)
{
    adxl345_driver_t *d = adxl345_driver_here();
    bool quiescing = quiesce();
    d->config = *config;
    d->half_us = adxl345_table_half_period_us(config->rate_dhz);
    d->stop_wanted = false;
    d->renewed = true;
    d->back_off = BACK_OFF_MIN;
    if (!quiescing) {
        adxl345_driver_probe();
    }
}

void adxl345_stop(void)
{
    bool quiescing = quiesce();
    adxl345_driver_state()->stop_wanted = true;
    adxl345_driver_state()->rests = RESTS;
    if (!quiescing && adxl345_driver_state()->step != STEP_OFF) {
        rest_sensor();
    }
}

/* Register and value of the step. */
static table_row_t row_of(const adxl345_driver_t *d)
{
    return adxl345_table_row(d->step & STEP_ROW, &d->config);
}

/* The step's register access failed: retries with a free bus, or gives up. */
static void access_failed(adxl345_driver_t *d, i2c_bus_state_t state)
{
    if (!adxl345_driver_transfer_failed(state)) {
        return;
    }
    d->issued = false;
    d->tries++;
    if (d->tries == TRIES) {
        adxl345_driver_give_up(d, state);
    } else {
        adxl345_driver_set_limit(TRANSFER_LIMIT);
        hal_wake();
    }
}

/*
 * A device that is not an ADXL345. The first one reported is kept until the fault is cleared, unless only one address
 * is to be probed.
 */
static void foreign(adxl345_driver_t *d, uint8_t id)
{
    if (d->config.address != 0 || (d->fault != ADXL345_FAULT_WRONG_ID && d->found != ADXL345_FAULT_WRONG_ID)) {
        d->foreign_address = d->address;
        d->foreign_id = id;
    }
    adxl345_driver_not_here(d, ADXL345_FAULT_WRONG_ID);
}

/* Goes on with the table: all rows are written, then all are read back. */
static void configured(adxl345_driver_t *d)
{
    uint8_t step = d->step;
    if ((step & STEP_READS) && !adxl345_burst_register_holds()) {
        if (step == STEP_PROBE) {
            foreign(d, adxl345_burst_register_value());
        } else {
            adxl345_driver_fail(ADXL345_FAULT_READ_BACK);
        }
        return;
    }
    d->known = d->address;
    step++;
    if (step == STEP_PROBE + 1) {
        step = STEP_CONFIGURE;
    } else if (step == STEP_MEASURE) {
        step = STEP_READ_BACK;
    } else if (step == (STEP_MEASURE | STEP_READS)) {
        step = STEP_MEASURE;
    }
    adxl345_driver_enter((step_t)step, TRANSFER_LIMIT);
}

/* The step's register access succeeded. */
static void advance(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_MEASURE:
        adxl345_stream_start(d);
        break;
    case STEP_STANDBY:
        adxl345_driver_stopped();
        break;
    case STEP_QUIET_STANDBY:
        adxl345_burst_set_mode(BURST_READ);
        adxl345_driver_enter(STEP_QUIET_DRAIN, DRAIN_LIMIT);
        break;
    default:
        configured(d);
        break;
    }
}

/* A step with one register access: one time limit for getting the bus, and the same again for the transfer. */
static void access_step(adxl345_driver_t *d)
{
    i2c_bus_state_t state = I2C_BUS_BUSY;
    if (d->issued) {
        state = adxl345_burst_bus_state();
    } else {
        table_row_t row = row_of(d);
        if (adxl345_burst_access(row.reg, row.value, (d->step & STEP_READS) != 0)) {
            d->issued = true;
            adxl345_driver_set_limit(TRANSFER_LIMIT);
            return;
        }
        hal_wake(); /* the end of a STOP raises no interrupt */
    }
    if (state == I2C_BUS_OK) {
        advance(d);
        return;
    }
    if (state == I2C_BUS_BUSY) {
        if (!adxl345_driver_deadline_passed()) {
            return;
        }
        state = I2C_BUS_TIMEOUT;
    }
    access_failed(d, state);
}

static void drain_step(adxl345_driver_t *d)
{
    bool waiting = adxl345_sample_waits();
    if (waiting) {
        adxl345_burst_read();
    }
    if ((waiting || adxl345_burst_running() || adxl345_queued() != 0) && !adxl345_driver_deadline_passed()) {
        hal_wake();
        return;
    }
    adxl345_burst_set_mode(BURST_IGNORE);
    if (d->stop_wanted) {
        adxl345_driver_stopped();
        return;
    }
    adxl345_driver_probe();
}

/* All steps except STEP_STREAM, which takes most polls. */
static MACHINE_APART void other_step(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_QUIET_DRAIN:
        drain_step(d);
        break;
    case STEP_BACK_OFF:
        if (adxl345_driver_deadline_passed()) {
            adxl345_driver_probe();
        }
        break;
    case STEP_REST_LATER:
        if (adxl345_driver_deadline_passed()) {
            rest_sensor();
        }
        break;
    default:
        access_step(d);
        break;
    }
}

void adxl345_poll(uint32_t now_us)
{
    adxl345_driver_t *d = adxl345_driver_here();
    d->now_us = now_us;
    reading_t reading = adxl345_burst_judge();
    if (reading == READING_FAILED) {
        (void)adxl345_driver_transfer_failed(adxl345_burst_failed_state());
    }
    if (d->step == STEP_STREAM) {
        adxl345_stream_poll(d, reading);
    } else if (d->step != STEP_OFF) {
        other_step(d);
    }
}
