/*
 * The driver's state machine: finds the sensor, configures it, puts it to rest, backs off. The step in which samples
 * come is in adxl345_stream.c, what the driver tells of itself in adxl345_tell.c. Each step issues at most one register
 * access, and has a deadline; adxl345_poll looks at the result and goes on. All in main; the interrupts are in
 * adxl345_burst.c.
 */
#include "adxl345.h"

#include "adxl345_burst.h"
#include "adxl345_driver.h"
#include "adxl345_integrity.h"
#include "adxl345_period.h"
#include "adxl345_registers.h"
#include "adxl345_table.h"
#include "adxl345_watch.h"
#include "hal_drdy.h"
#include "hal_pointer.h"
#include "hal_ram.h"
#include "hal_sleep.h"
#include "hal_time.h"

/* A sensor that was not reached by a stop is looked for so many times more, for a second. */
enum { RESTS = 40 };

adxl345_driver_t driver;

/*
 * What touches much of the driver finds it through a pointer, what touches little at its fixed address.
 */
static inline adxl345_driver_t *here(void)
{
    adxl345_driver_t *d = &driver;
    HAL_POINTER(d);
    return d;
}

void driver_set_limit(uint8_t limit)
{
    driver.deadline_us = driver.now_us + (uint32_t)limit * LIMIT_US;
}

void driver_enter(step_t step, uint8_t limit)
{
    driver.step = (uint8_t)step;
    driver.issued = false;
    driver.tries = 0;
    driver_set_limit(limit);
    hal_wake();
}

HAL_APART bool driver_reached(uint32_t t_us)
{
    return (int32_t)(t_us - driver.now_us) <= 0; /* hal_time_reached as a value takes 24 B more */
}

HAL_APART bool driver_deadline_passed(void)
{
    return driver_reached(driver.deadline_us);
}

/* A fault that was there is not mended, but it is not asked for any more. */
static HAL_APART void stopped(void)
{
    driver.fault = ADXL345_FAULT_NONE;
    driver.after_fault = false;
    driver.step = STEP_OFF;
}

void driver_fail(adxl345_fault_t fault)
{
    adxl345_driver_t *d = here();
    burst_set_mode(BURST_IGNORE);
    if (d->stop_wanted) {
        stopped();
        if (d->rests != 0) {
            d->rests--;
            driver_enter(STEP_REST_LATER, BACK_OFF_MAX);
        }
        return;
    }
    d->fault = (uint8_t)fault;
    d->after_fault = true;
    driver_enter(STEP_BACK_OFF, d->back_off);
    d->back_off = (uint8_t)(d->back_off * 2u);
    if (d->back_off > BACK_OFF_MAX) {
        d->back_off = BACK_OFF_MAX;
    }
}

bool driver_take_bus(void)
{
    uint8_t lines = burst_take_bus(driver.address, driver.config.rate_dhz == 8000);
    if (lines == HAL_I2C_FREE) {
        return true;
    }
    driver_fail((adxl345_fault_t)(ADXL345_FAULT_SCL_LOW - HAL_I2C_SCL_LOW + lines));
    return false;
}

/* With a bus of its own, of which no data come. */
static void begin_access(step_t step)
{
    burst_set_mode(BURST_IGNORE);
    driver_enter(step, TRANSFER_LIMIT);
    (void)driver_take_bus();
}

/* The one that was found last: who answers at the other address may be another device. */
static HAL_APART void rest_sensor(void)
{
    driver.address = driver.known;
    begin_access(STEP_STANDBY);
}

/* What was measured of a sensor that has to be found again still holds, unless its rate is another one now. */
void driver_probe(void)
{
    adxl345_driver_t *d = here();
    if (d->renewed) {
        d->renewed = false;
        period_start(d->half_us);
    }
    uint8_t only = d->config.address;
    d->found = ADXL345_FAULT_NONE;
    if (only != 0) {
        d->address = only;
    }
    begin_access(STEP_PROBE);
}

void adxl345_init(void)
{
    burst_init();
    if (!HAL_RAM_CLEARED) {
        driver_forget_counters();
        integrity_forget();
        watch_start();
        stopped();
        driver.issued = false;
        driver.marks = 0;
    }
    driver.address = ADXL345_ADDRESS_LOW;
    driver.known = ADXL345_ADDRESS_LOW;
}

/* Where samples may be waiting, begins to put the sensor to rest; true when that is under way. */
static bool quiesce(void)
{
    driver.now_us = hal_time_us();
    if (driver_streams()) {
        burst_set_mode(BURST_STAMP);
        driver_enter(STEP_QUIET_STANDBY, TRANSFER_LIMIT);
        return true;
    }
    return driver.step == STEP_QUIET_STANDBY || driver.step == STEP_QUIET_DRAIN;
}

void adxl345_start(const adxl345_config_t *config)
{
    adxl345_driver_t *d = here();
    bool quiescing = quiesce();
    d->config = *config;
    d->half_us = table_half_period_us(config->rate_dhz);
    d->stop_wanted = false;
    d->renewed = true;
    d->back_off = BACK_OFF_MIN;
    if (!quiescing) {
        driver_probe();
    }
}

void adxl345_stop(void)
{
    bool quiescing = quiesce();
    driver.stop_wanted = true;
    driver.rests = RESTS;
    if (!quiescing && driver.step != STEP_OFF) {
        rest_sensor();
    }
}

/* Register and value of the step. */
static table_row_t row_of(const adxl345_driver_t *d)
{
    return table_row(d->step & STEP_ROW, &d->config);
}

bool driver_transfer_failed(i2c_bus_state_t state)
{
    uint8_t first = state == I2C_BUS_NACK_ADDRESS ? I2C_BUS_NACK_ADDRESS : I2C_BUS_NACK_DATA;
    driver_count((counter_t)(COUNTER_NACKS + (uint8_t)state - first));
    return state != I2C_BUS_TIMEOUT || driver_take_bus();
}

/*
 * No sensor at this address. That is a fault when the other one, if it may be asked, has none either: by the name of
 * the device that did answer if there is one.
 */
static HAL_APART void not_here(adxl345_driver_t *d, adxl345_fault_t fault)
{
    uint8_t found = d->found;
    d->found = (uint8_t)fault;
    if (d->config.address == 0) {
        d->address ^= ADXL345_ADDRESS_LOW ^ ADXL345_ADDRESS_HIGH;
        if (found == ADXL345_FAULT_NONE) {
            begin_access(STEP_PROBE);
            return;
        }
    }
    if (fault == ADXL345_FAULT_NO_SENSOR && found != ADXL345_FAULT_NONE) {
        fault = (adxl345_fault_t)found;
    }
    driver_fail(fault);
}

void driver_give_up(adxl345_driver_t *d, i2c_bus_state_t state)
{
    if (state != I2C_BUS_NACK_ADDRESS || d->stop_wanted) {
        driver_fail(ADXL345_FAULT_BUS);
    } else if (d->step == STEP_PROBE) {
        not_here(d, ADXL345_FAULT_NO_SENSOR);
    } else {
        d->after_fault = true;
        driver_probe();
    }
}

/* The step's register access failed: again, with a free bus, or that is enough. */
static void access_failed(adxl345_driver_t *d, i2c_bus_state_t state)
{
    if (!driver_transfer_failed(state)) {
        return;
    }
    d->issued = false;
    d->tries++;
    if (d->tries == TRIES) {
        driver_give_up(d, state);
    } else {
        driver_set_limit(TRANSFER_LIMIT);
        hal_wake();
    }
}

/*
 * What is said of a device that is none comes later: the first one is kept until the fault is over, unless one address
 * alone is to be asked.
 */
static void foreign(adxl345_driver_t *d, uint8_t id)
{
    if (d->config.address != 0 || (d->fault != ADXL345_FAULT_WRONG_ID && d->found != ADXL345_FAULT_WRONG_ID)) {
        d->foreign_address = d->address;
        d->foreign_id = id;
    }
    not_here(d, ADXL345_FAULT_WRONG_ID);
}

/* The rest of the table comes next: all rows are written, then all are read back. */
static void configured(adxl345_driver_t *d)
{
    uint8_t step = d->step;
    uint8_t value = burst_register_value();
    if ((step & STEP_READS) && value != row_of(d).value) {
        if (step == STEP_PROBE) {
            foreign(d, value);
        } else {
            driver_fail(ADXL345_FAULT_READ_BACK);
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
    driver_enter((step_t)step, TRANSFER_LIMIT);
}

/* The step's register access ended well. */
static void advance(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_MEASURE:
        stream_start(d);
        break;
    case STEP_ASK_SOURCE:
        stream_source_asked(d);
        break;
    case STEP_STANDBY:
        stopped();
        break;
    case STEP_QUIET_STANDBY:
        burst_set_mode(BURST_READ);
        driver_enter(STEP_QUIET_DRAIN, DRAIN_LIMIT);
        break;
    default:
        configured(d);
        break;
    }
}

/* A step with one register access: a limit for getting the bus, and the same again for the transfer. */
static void access_step(adxl345_driver_t *d)
{
    i2c_bus_state_t state = I2C_BUS_BUSY;
    if (d->issued) {
        state = burst_bus_state();
    } else {
        table_row_t row = row_of(d);
        if (burst_access(row.reg, row.value, (d->step & STEP_READS) != 0)) {
            d->issued = true;
            driver_set_limit(TRANSFER_LIMIT);
            return;
        }
        hal_wake(); /* the end of a STOP tells nobody */
    }
    if (state == I2C_BUS_OK) {
        advance(d);
        return;
    }
    if (state == I2C_BUS_BUSY) {
        if (!driver_deadline_passed()) {
            return;
        }
        state = I2C_BUS_TIMEOUT;
    }
    access_failed(d, state);
}

static void drain_step(adxl345_driver_t *d)
{
    bool waiting = hal_drdy_high() && !burst_found_empty();
    if (waiting) {
        (void)burst_read(false);
    }
    if ((waiting || burst_running() || burst_queued() != 0) && !driver_deadline_passed()) {
        hal_wake();
        return;
    }
    burst_set_mode(BURST_IGNORE);
    if (d->stop_wanted) {
        stopped();
        return;
    }
    driver_probe();
}

/* All but STEP_STREAM, in which most polls are. */
static HAL_APART void other_step(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_QUIET_DRAIN:
        drain_step(d);
        break;
    case STEP_BACK_OFF:
        if (driver_deadline_passed()) {
            driver_probe();
        }
        break;
    case STEP_REST_LATER:
        if (driver_deadline_passed()) {
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
    adxl345_driver_t *d = here();
    d->now_us = now_us;
    reading_t reading = burst_judge();
    if (reading > READING_GOOD) {
        hal_wake(); /* nobody takes it, and the next one may wait */
        if (reading == READING_FAILED) {
            (void)driver_transfer_failed(burst_failed_state());
        }
    }
    if (d->step == STEP_STREAM) {
        stream_poll(d);
    } else if (d->step != STEP_OFF) {
        other_step(d);
    }
}
