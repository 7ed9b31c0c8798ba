/*
 * The driver's state machine; what it tells of itself is in adxl345_tell.c. Each step issues at most one register
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
#include "hal_sleep.h"
#include "hal_time.h"

/* A register access takes under 0.2 ms, a burst under 0.4 ms. */
enum { TRANSFER_LIMIT_MS = 3, DRAIN_LIMIT_MS = 100, BACK_OFF_MIN_MS = 5, BACK_OFF_MAX_MS = 25 };

#define MARGIN_US 3000u
#define TURN_ON_MS 20u /* p. 5: period + 1.1 ms, with room for a slow start */
#define BURST_TRIES 3u
#define TRANSFER_LIMIT_US (TRANSFER_LIMIT_MS * INT32_C(1000))
#define LOOK_US 500ul /* behind the moment when a sample was due, and again and again while none comes */

adxl345_driver_t driver;

/*
 * What a poll does finds the driver through a pointer; what is called from elsewhere too, and small, at its fixed
 * address.
 */
static inline adxl345_driver_t *here(void)
{
    adxl345_driver_t *d = &driver;
    HAL_POINTER(d);
    return d;
}

static void set_limit(uint8_t limit_ms)
{
    driver.deadline_us = driver.now_us + (uint32_t)limit_ms * 1000u;
}

static void enter(step_t step, uint8_t limit_ms)
{
    driver.step = (uint8_t)step;
    driver.issued = false;
    set_limit(limit_ms);
    hal_wake();
}

static bool deadline_passed(void)
{
    return hal_time_reached(driver.now_us, driver.deadline_us);
}

/* A fault that was there is not mended, but it is not asked for any more. */
static void stopped(void)
{
    driver.fault = ADXL345_FAULT_NONE;
    driver.step = STEP_OFF;
}

static void fail(adxl345_fault_t fault)
{
    burst_set_mode(BURST_IGNORE);
    if (driver.stop_wanted) {
        stopped();
        return;
    }
    driver.fault = (uint8_t)fault;
    enter(STEP_BACK_OFF, driver.back_off_ms);
    driver.back_off_ms = (uint8_t)(driver.back_off_ms * 2u);
    if (driver.back_off_ms > BACK_OFF_MAX_MS) {
        driver.back_off_ms = BACK_OFF_MAX_MS;
    }
}

/* False when somebody holds a line low: that is a fault then. */
static bool take_bus(void)
{
    uint8_t lines = burst_take_bus(driver.address, driver.config.rate_dhz == 8000);
    if (lines == HAL_I2C_FREE) {
        return true;
    }
    fail((adxl345_fault_t)(ADXL345_FAULT_SCL_LOW - HAL_I2C_SCL_LOW + lines));
    return false;
}

static void probe(void)
{
    burst_set_mode(BURST_IGNORE);
    enter(STEP_PROBE, TRANSFER_LIMIT_MS);
    (void)take_bus();
}

/* With a new configuration; what was measured of a sensor that has to be found again still holds. */
static void begin(void)
{
    period_start(driver.nominal_us);
    driver.alternate_tried = false;
    probe();
}

void adxl345_init(void)
{
    burst_init();
    integrity_init();
    stopped();
    driver.address = ADXL345_ADDRESS_LOW;
    driver.issued = false;
}

/* Where samples may be waiting, begins to put the sensor to rest; true when that is under way. */
static bool quiesce(void)
{
    driver.now_us = hal_time_us();
    if (driver.step == STEP_STREAM || driver.step == STEP_ASK_SOURCE) {
        burst_set_mode(BURST_STAMP);
        enter(STEP_QUIET_STANDBY, TRANSFER_LIMIT_MS);
    }
    return driver.step == STEP_QUIET_STANDBY || driver.step == STEP_QUIET_DRAIN;
}

void adxl345_start(const adxl345_config_t *config)
{
    bool quiescing = quiesce();
    driver.config = *config;
    driver.nominal_us = table_period_us(config->rate_dhz);
    driver.stop_wanted = false;
    driver.back_off_ms = BACK_OFF_MIN_MS;
    if (!quiescing) {
        begin();
    }
}

void adxl345_stop(void)
{
    if (!quiesce()) {
        burst_set_mode(BURST_IGNORE);
        (void)burst_take_bus(driver.address, false);
        stopped();
    }
    driver.stop_wanted = true;
}

/* Puts the step's register access on the bus; false when the bus is not free. */
static bool issue(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_PROBE:
        return burst_read_register(ADXL345_DEVID);
    case STEP_CONFIGURE:
        return burst_write_register(table_register(d->row), table_value(d->row, &d->config));
    case STEP_READ_BACK:
        return burst_read_register(table_register(d->row));
    case STEP_MEASURE:
        return burst_write_register(ADXL345_POWER_CTL, ADXL345_POWER_MEASURE);
    case STEP_ASK_SOURCE:
        return burst_read_register(ADXL345_INT_SOURCE);
    default: /* STEP_QUIET_STANDBY */
        return burst_write_register(ADXL345_POWER_CTL, 0);
    }
}

static void count_failure(i2c_bus_state_t state)
{
    uint16_t *counter = &driver.counters.bus_errors;
    if (state == I2C_BUS_LOST) {
        counter = &driver.counters.arbitrations_lost;
    } else if (state == I2C_BUS_NACK_ADDRESS || state == I2C_BUS_NACK_DATA) {
        counter = &driver.counters.nacks;
    }
    saturating_add(counter);
}

/* A transfer failed, or three bursts did: names the fault, or tries the other address. */
static void give_up(adxl345_driver_t *d, i2c_bus_state_t state)
{
    if (state != I2C_BUS_NACK_ADDRESS) {
        fail(ADXL345_FAULT_BUS);
        return;
    }
    d->address = d->address == ADXL345_ADDRESS_LOW ? ADXL345_ADDRESS_HIGH : ADXL345_ADDRESS_LOW;
    if (d->step == STEP_PROBE && !d->alternate_tried) {
        d->alternate_tried = true;
        probe();
    } else {
        fail(ADXL345_FAULT_NO_SENSOR);
    }
}

/* A transfer did not end, or did not even begin, in time. */
static void timed_out(adxl345_driver_t *d)
{
    saturating_add(&d->counters.timeouts);
    if (take_bus()) {
        give_up(d, I2C_BUS_TIMEOUT);
    }
}

static void start_measuring(adxl345_driver_t *d)
{
    integrity_start(d->config.range_g);
    watch_start();
    d->first_sample_seen = false;
    d->timed = TIMED_NONE;
    d->was_empty = false;
    d->seen_good = integrity_good();
    burst_expect(d->now_us + TURN_ON_MS * 1000ul);
    burst_set_mode(BURST_READ); /* last: an edge may come with it */
    enter(STEP_STREAM, 1);
}

static void read_back(adxl345_driver_t *d)
{
    if (burst_register_value() != table_value(d->row, &d->config)) {
        fail(ADXL345_FAULT_READ_BACK);
        return;
    }
    d->row++;
    enter(d->row < TABLE_ROWS ? STEP_READ_BACK : STEP_MEASURE, TRANSFER_LIMIT_MS);
}

static void probed(adxl345_driver_t *d)
{
    d->device_id = burst_register_value();
    if (d->device_id != ADXL345_DEVID_VALUE) {
        fail(ADXL345_FAULT_WRONG_ID);
        return;
    }
    d->row = 0;
    enter(STEP_CONFIGURE, TRANSFER_LIMIT_MS);
}

/* Since the newest burst that met a sample, or until the first is expected (negative). */
static int32_t silent_for_us(void)
{
    return (int32_t)(driver.now_us - burst_met_sample_us());
}

/* A sample waits: INT1 that is low has failed to tell, one that is stuck tells nothing. */
static void read_by_clock(adxl345_driver_t *d)
{
    if (!hal_drdy_high()) {
        d->fault = ADXL345_FAULT_INT1_SILENT;
        d->timed = TIMED_WANTED;
    } else if (integrity_int1_stuck()) {
        d->timed = TIMED_WANTED;
    }
}

/*
 * INT1 may have risen just now, unless it is always high. Ones of a sensor that is gone show in the bits of functions
 * that are off. A sensor that has none ready may still come: that is a fault after three periods.
 */
static void source_asked(adxl345_driver_t *d)
{
    uint8_t source = burst_register_value() & (uint8_t)(ADXL345_INT_DATA_READY | ADXL345_INT_EVENTS);
    bool has_data = source == ADXL345_INT_DATA_READY;
    bool may_come = source == 0 && silent_for_us() < (int32_t)(d->nominal_us * 3u + MARGIN_US);
    if (!has_data && !may_come && (!hal_drdy_high() || integrity_int1_stuck())) {
        fail(ADXL345_FAULT_NO_DATA);
        return;
    }
    burst_set_mode(BURST_READ);
    enter(STEP_STREAM, 1);
    d->was_empty = d->was_empty || !has_data;
    if (has_data) {
        read_by_clock(d);
    }
}

/* The step's register access ended well. */
static void advance(adxl345_driver_t *d)
{
    switch (d->step) {
    case STEP_PROBE:
        probed(d);
        break;
    case STEP_CONFIGURE:
        d->row++;
        if (d->row == TABLE_ROWS) {
            d->row = TABLE_READ_BACK;
            enter(STEP_READ_BACK, TRANSFER_LIMIT_MS);
        } else {
            enter(STEP_CONFIGURE, TRANSFER_LIMIT_MS);
        }
        break;
    case STEP_READ_BACK:
        read_back(d);
        break;
    case STEP_MEASURE:
        start_measuring(d);
        break;
    case STEP_ASK_SOURCE:
        source_asked(d);
        break;
    default: /* STEP_QUIET_STANDBY */
        burst_set_mode(BURST_READ);
        enter(STEP_QUIET_DRAIN, DRAIN_LIMIT_MS);
        break;
    }
}

/* A step with one register access: a limit for getting the bus, and the same again for the transfer. */
static void access_step(adxl345_driver_t *d)
{
    i2c_bus_state_t state = I2C_BUS_BUSY;
    if (d->issued) {
        state = burst_bus_state();
    } else if (issue(d)) {
        d->issued = true;
        set_limit(TRANSFER_LIMIT_MS);
        return;
    } else {
        hal_wake(); /* the end of a STOP tells nobody */
    }
    if (state == I2C_BUS_OK) {
        advance(d);
    } else if (state != I2C_BUS_BUSY) {
        count_failure(state);
        give_up(d, state);
    } else if (deadline_passed()) {
        timed_out(d);
    }
}

/*
 * Without a sample until the sensor is asked: two periods, or while INT1 is known to tell nothing less than one, so
 * that a sensor that is fast does not fill its FIFO.
 */
static uint32_t patience_us(adxl345_driver_t *d)
{
    uint32_t nominal_us = d->nominal_us;
    bool no_edges = d->fault == ADXL345_FAULT_INT1_SILENT || integrity_int1_stuck();
    return no_edges ? nominal_us - nominal_us / 4u : nominal_us * 2u;
}

static void sample_arrived(adxl345_driver_t *d)
{
    d->seen_good = integrity_good();
    d->first_sample_seen = true;
    d->alternate_tried = false;
    d->back_off_ms = BACK_OFF_MIN_MS;
    d->deadline_us = d->now_us + d->nominal_us + LOOK_US;
    if (d->timed == TIMED_READ) {
        d->deadline_us = burst_begun_us() + patience_us(d);
        d->timed = burst_left_more() ? TIMED_WANTED : TIMED_NONE;
        return;
    }
    if (d->fault != ADXL345_FAULT_NONE) {
        saturating_add(&d->counters.restarts);
        d->fault = ADXL345_FAULT_NONE;
    }
    d->timed = TIMED_NONE;
}

/* A burst or the STOP behind it hangs: the sample is read again, unless a line that is low says why. */
static void end_hung_burst(adxl345_driver_t *d)
{
    saturating_add(&d->counters.timeouts);
    if (take_bus()) {
        enter(STEP_STREAM, 1);
    }
}

/*
 * No sample came by the time it was due: a burst may hang, or there was none for so long that the sensor is asked. One
 * that failed counts as a sign of life: three in a row are a fault by themselves.
 */
static void look_for_sample(adxl345_driver_t *d)
{
    int32_t since_us = (int32_t)(d->now_us - burst_begun_us());
    bool waiting = burst_queue_full() || (hal_drdy_high() && !burst_found_empty()); /* main was late */
    if (burst_bus_taken()) {
        if (since_us >= TRANSFER_LIMIT_US) {
            end_hung_burst(d);
        } else {
            d->deadline_us = d->now_us + (uint32_t)(TRANSFER_LIMIT_US - since_us);
        }
    } else if (!waiting && silent_for_us() >= (int32_t)patience_us(d)) {
        burst_set_mode(BURST_STAMP);
        enter(STEP_ASK_SOURCE, TRANSFER_LIMIT_MS);
    } else {
        d->deadline_us = d->now_us + LOOK_US;
    }
}

/* What the readings say; a sensor that has lost its configuration is given it again at once. */
static bool readings_failed(void)
{
    adxl345_fault_t fault = integrity_fault();
    if (fault == ADXL345_FAULT_NONE) {
        return false;
    }
    fail(fault);
    if (fault == ADXL345_FAULT_NO_DATA) {
        probe();
    }
    return true;
}

static void stream_step(adxl345_driver_t *d)
{
    if (readings_failed()) {
        return;
    }
    if (burst_failures() >= BURST_TRIES) {
        give_up(d, burst_bus_state());
        return;
    }
    if (integrity_good() != d->seen_good) {
        sample_arrived(d);
    } else if (deadline_passed() || (burst_found_empty() && !burst_running())) {
        look_for_sample(d);
    }
    if (d->timed != TIMED_WANTED) {
        if (burst_drain()) {
            set_limit(TRANSFER_LIMIT_MS);
        }
    } else if (burst_read(d->was_empty)) {
        d->timed = TIMED_READ;
        d->was_empty = false;
        set_limit(TRANSFER_LIMIT_MS);
    }
}

static void drain_step(adxl345_driver_t *d)
{
    bool waiting = hal_drdy_high() && !burst_found_empty();
    if (waiting) {
        (void)burst_read(false);
    }
    bool empty = !waiting && !burst_running() && burst_queued() == 0;
    if (!empty && !deadline_passed()) {
        hal_wake();
        return;
    }
    burst_set_mode(BURST_IGNORE);
    if (d->stop_wanted) {
        stopped();
        return;
    }
    begin();
}

HAL_APART void adxl345_poll(uint32_t now_us)
{
    adxl345_driver_t *d = here();
    d->now_us = now_us;
    reading_t reading = burst_judge();
    if (reading > READING_GOOD) {
        hal_wake(); /* nobody takes it, and the next one may wait */
        if (reading == READING_FAILED) {
            count_failure(burst_bus_state());
        }
    }
    switch (d->step) {
    case STEP_OFF:
        break;
    case STEP_STREAM:
        stream_step(d);
        break;
    case STEP_QUIET_DRAIN:
        drain_step(d);
        break;
    case STEP_BACK_OFF:
        if (deadline_passed()) {
            d->alternate_tried = false;
            probe();
        }
        break;
    default:
        access_step(d);
        break;
    }
}
