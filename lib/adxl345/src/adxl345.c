/*
 * The driver's state machine. Each step issues at most one register access, and has a deadline; adxl345_poll looks at
 * the result and goes on. All in main; the interrupts are in adxl345_burst.c.
 */
#include "adxl345.h"

#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "adxl345_table.h"
#include "hal_drdy.h"
#include "hal_sleep.h"
#include "hal_time.h"

/* A register access takes under 0.2 ms, a burst under 0.4 ms. */
enum { TRANSFER_LIMIT_MS = 3, DRAIN_LIMIT_MS = 100, BACK_OFF_MIN_MS = 5, BACK_OFF_MAX_MS = 25 };

#define TURN_ON_MS 20u /* p. 5: period + 1.1 ms, with room for a slow start */
#define MARGIN_MS 3u
#define BURST_TRIES 3u
#define SILENCE_MAX_MS 160u

typedef enum {
    STEP_OFF,
    STEP_PROBE,
    STEP_CONFIGURE,
    STEP_READ_BACK,
    STEP_MEASURE,
    STEP_STREAM,
    STEP_ASK_SOURCE, /* no data in time: does the sensor have some? */
    STEP_QUIET_STANDBY,
    STEP_QUIET_DRAIN,
    STEP_BACK_OFF
} step_t;

static struct {
    adxl345_config_t config;
    adxl345_counters_t counters;
    uint32_t now_us; /* of the poll or call that runs */
    uint32_t deadline_us;
    uint32_t nominal_us; /* between samples, for the configured rate */
    uint8_t back_off_ms;
    uint8_t silence_ms; /* without a sample until the sensor is asked */
    uint8_t step;
    uint8_t row; /* of settings */
    uint8_t address;
    uint8_t device_id;
    uint8_t fault;
    uint8_t seen_successes;
    bool issued; /* the step's register access is on the bus */
    bool first_sample_seen;
    bool stop_wanted; /* after quiescing: stop, not start */
    bool alternate_tried;
} driver;

/* Three missing samples, but never so long that the watchdog (250 ms) could take the silence for a hang. */
static uint8_t silence_limit_ms(uint16_t rate_dhz)
{
    uint16_t limit_ms = (uint16_t)(30000u / rate_dhz);
    return (uint8_t)(MARGIN_MS + (limit_ms > SILENCE_MAX_MS ? SILENCE_MAX_MS : limit_ms));
}

static void saturating_add(uint16_t *counter)
{
    if (*counter != UINT16_MAX) {
        (*counter)++;
    }
}

static void enter(step_t step, uint16_t limit_ms)
{
    driver.step = (uint8_t)step;
    driver.issued = false;
    driver.deadline_us = driver.now_us + (uint32_t)limit_ms * 1000u;
    hal_wake();
}

static void expect_sample(void)
{
    driver.deadline_us = driver.now_us + (uint32_t)driver.silence_ms * 1000u;
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

static void take_bus(void)
{
    burst_take_bus(driver.address, driver.config.rate_dhz == 8000);
}

static void probe(void)
{
    burst_set_mode(BURST_IGNORE);
    take_bus();
    enter(STEP_PROBE, TRANSFER_LIMIT_MS);
}

void adxl345_init(void)
{
    burst_init();
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
    driver.silence_ms = silence_limit_ms(config->rate_dhz);
    driver.stop_wanted = false;
    driver.back_off_ms = BACK_OFF_MIN_MS;
    if (!quiescing) {
        driver.alternate_tried = false;
        probe();
    }
}

void adxl345_stop(void)
{
    if (!quiesce()) {
        burst_set_mode(BURST_IGNORE);
        burst_take_bus(driver.address, false);
        stopped();
    }
    driver.stop_wanted = true;
}

/* Puts the step's register access on the bus; false when the bus is not free. */
static bool issue(void)
{
    switch (driver.step) {
    case STEP_PROBE:
        return burst_read_register(ADXL345_DEVID);
    case STEP_CONFIGURE:
        return burst_write_register(table_register(driver.row), table_value(driver.row, &driver.config));
    case STEP_READ_BACK:
        return burst_read_register(table_register(driver.row));
    case STEP_MEASURE:
        return burst_write_register(ADXL345_POWER_CTL, ADXL345_POWER_MEASURE);
    case STEP_ASK_SOURCE:
        return burst_read_register(ADXL345_INT_SOURCE);
    default: /* STEP_QUIET_STANDBY */
        return burst_write_register(ADXL345_POWER_CTL, 0);
    }
}

/* A transfer failed, or three bursts did: names the fault, or tries the other address. */
static void give_up(i2c_bus_state_t state)
{
    saturating_add(&driver.counters.bus_faults);
    if (state != I2C_BUS_NACK_ADDRESS) {
        fail(ADXL345_FAULT_BUS);
        return;
    }
    driver.address = driver.address == ADXL345_ADDRESS_LOW ? ADXL345_ADDRESS_HIGH : ADXL345_ADDRESS_LOW;
    if (driver.step == STEP_PROBE && !driver.alternate_tried) {
        driver.alternate_tried = true;
        probe();
    } else {
        fail(ADXL345_FAULT_NO_SENSOR);
    }
}

static void access_failed(i2c_bus_state_t state)
{
    if (state == I2C_BUS_TIMEOUT) {
        saturating_add(&driver.counters.timeouts);
    }
    give_up(state);
}

static void start_measuring(void)
{
    burst_set_mode(BURST_READ);
    burst_set_period(driver.nominal_us);
    driver.first_sample_seen = false;
    driver.seen_successes = burst_successes();
    enter(STEP_STREAM, (uint16_t)(TURN_ON_MS + 30000u / driver.config.rate_dhz));
}

static void read_back(void)
{
    if (burst_register_value() != table_value(driver.row, &driver.config)) {
        fail(ADXL345_FAULT_READ_BACK);
        return;
    }
    driver.row++;
    enter(driver.row < TABLE_ROWS ? STEP_READ_BACK : STEP_MEASURE, TRANSFER_LIMIT_MS);
}

static void probed(void)
{
    driver.device_id = burst_register_value();
    if (driver.device_id != ADXL345_DEVID_VALUE) {
        fail(ADXL345_FAULT_WRONG_ID);
        return;
    }
    driver.row = 0;
    enter(STEP_CONFIGURE, TRANSFER_LIMIT_MS);
}

/* INT1 may have risen just now. Ones of a sensor that is gone show in the bits of functions that are off. */
static void source_asked(void)
{
    if (hal_drdy_high()) {
        burst_set_mode(BURST_READ);
        enter(STEP_STREAM, driver.silence_ms);
        return;
    }
    uint8_t source = burst_register_value() & (uint8_t)(ADXL345_INT_DATA_READY | ADXL345_INT_EVENTS);
    fail(source == ADXL345_INT_DATA_READY ? ADXL345_FAULT_INT1_SILENT : ADXL345_FAULT_NO_DATA);
}

/* The step's register access ended well. */
static void advance(void)
{
    switch (driver.step) {
    case STEP_PROBE:
        probed();
        break;
    case STEP_CONFIGURE:
        driver.row++;
        if (driver.row == TABLE_ROWS) {
            driver.row = TABLE_READ_BACK;
            enter(STEP_READ_BACK, TRANSFER_LIMIT_MS);
        } else {
            enter(STEP_CONFIGURE, TRANSFER_LIMIT_MS);
        }
        break;
    case STEP_READ_BACK:
        read_back();
        break;
    case STEP_MEASURE:
        start_measuring();
        break;
    case STEP_ASK_SOURCE:
        source_asked();
        break;
    default: /* STEP_QUIET_STANDBY */
        burst_set_mode(BURST_READ);
        enter(STEP_QUIET_DRAIN, DRAIN_LIMIT_MS);
        break;
    }
}

/* A step with one register access. */
static void access_step(void)
{
    if (!driver.issued) {
        driver.issued = issue();
        if (!driver.issued && deadline_passed()) {
            take_bus();
            access_failed(I2C_BUS_TIMEOUT);
        }
        return;
    }
    i2c_bus_state_t state = burst_bus_state();
    if (state == I2C_BUS_BUSY) {
        if (!deadline_passed()) {
            return;
        }
        take_bus();
        state = I2C_BUS_TIMEOUT;
    }
    if (state == I2C_BUS_OK) {
        advance();
    } else {
        access_failed(state);
    }
}

static void sample_arrived(void)
{
    driver.seen_successes = burst_successes();
    if (driver.fault != ADXL345_FAULT_NONE) {
        saturating_add(&driver.counters.restarts);
    }
    driver.fault = ADXL345_FAULT_NONE;
    driver.first_sample_seen = true;
    driver.alternate_tried = false;
    driver.back_off_ms = BACK_OFF_MIN_MS;
    expect_sample();
}

static void stream_step(void)
{
    if (burst_failures() < BURST_TRIES) { /* else the state of the last one is still wanted */
        (void)burst_drain();
    }
    if (burst_running() && hal_time_reached(driver.now_us, burst_begun_us() + TRANSFER_LIMIT_MS * 1000ul)) {
        take_bus();
        saturating_add(&driver.counters.timeouts);
        saturating_add(&driver.counters.bus_faults);
    }
    if (burst_queue_full()) {
        expect_sample();
    }
    if (burst_failures() >= BURST_TRIES) {
        give_up(burst_bus_state());
    } else if (burst_successes() != driver.seen_successes) {
        sample_arrived();
    } else if (deadline_passed()) {
        burst_set_mode(BURST_STAMP);
        enter(STEP_ASK_SOURCE, TRANSFER_LIMIT_MS);
    }
}

static void drain_step(void)
{
    (void)burst_drain();
    bool empty = !hal_drdy_high() && !burst_running() && burst_queued() == 0;
    if (!empty && !deadline_passed()) {
        hal_wake();
        return;
    }
    burst_set_mode(BURST_IGNORE);
    if (driver.stop_wanted) {
        stopped();
        return;
    }
    driver.alternate_tried = false;
    probe();
}

void adxl345_poll(uint32_t now_us)
{
    driver.now_us = now_us;
    switch (driver.step) {
    case STEP_OFF:
        break;
    case STEP_STREAM:
        stream_step();
        break;
    case STEP_QUIET_DRAIN:
        drain_step();
        break;
    case STEP_BACK_OFF:
        if (deadline_passed()) {
            driver.alternate_tried = false;
            probe();
        }
        break;
    default:
        access_step();
        break;
    }
}

bool adxl345_take(adxl345_sample_t *out)
{
    burst_entry_t entry;
    if (!burst_take(&entry)) {
        return false;
    }
    if (!entry.exact) {
        saturating_add(&driver.counters.samples_drained);
    }
    *out = entry.sample;
    return true;
}

uint8_t adxl345_queued(void)
{
    return burst_queued();
}

adxl345_phase_t adxl345_phase(void)
{
    switch (driver.step) {
    case STEP_OFF:
        return ADXL345_STOPPED;
    case STEP_BACK_OFF:
        return ADXL345_FAULTY;
    case STEP_QUIET_STANDBY:
    case STEP_QUIET_DRAIN:
        return ADXL345_QUIESCING;
    case STEP_STREAM:
    case STEP_ASK_SOURCE:
        return driver.first_sample_seen ? ADXL345_STREAMING : ADXL345_STARTING;
    default:
        return ADXL345_STARTING;
    }
}

adxl345_fault_t adxl345_fault(void)
{
    return (adxl345_fault_t)driver.fault;
}

uint32_t adxl345_deadline_us(void)
{
    return driver.deadline_us;
}

uint8_t adxl345_address(void)
{
    return driver.address;
}

uint8_t adxl345_device_id(void)
{
    return driver.device_id;
}

uint32_t adxl345_period_us(void)
{
    return burst_period_us();
}

void adxl345_counters(adxl345_counters_t *out)
{
    *out = driver.counters;
}
