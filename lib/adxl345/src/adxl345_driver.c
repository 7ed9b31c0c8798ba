/*
 * What every step of the driver does: enter the next step, keep its time limit, take the bus, fail, probe for the
 * sensor. The steps are one level up, in adxl345.c and adxl345_stream.c. All of it runs in main.
 */
#include "adxl345_driver.h"

#include "adxl345_burst.h"
#include "adxl345_counters.h"
#include "adxl345_period.h"
#include "adxl345_registers.h"
#include "hal_i2c.h"
#include "hal_sleep.h"

_Static_assert((int)ADXL345_I2C_364_KHZ == (int)GARBLED_ASKED, "not slow");
_Static_assert((int)ADXL345_I2C_100_KHZ == (int)GARBLED_ASKED + (int)GARBLED_SLOW, "slow");

static adxl345_driver_t driver;

adxl345_driver_t *adxl345_driver_state(void)
{
    return &driver;
}

void adxl345_driver_set_limit(uint8_t limit)
{
    adxl345_driver_state()->deadline_us = adxl345_driver_state()->now_us + (uint32_t)limit * LIMIT_US;
}

void adxl345_driver_enter(step_t step, uint8_t limit)
{
    adxl345_driver_state()->step = (uint8_t)step;
    adxl345_driver_state()->issued = false;
    adxl345_driver_state()->tries = 0;
    adxl345_driver_set_limit(limit);
    hal_wake();
}

MACHINE_APART bool adxl345_driver_reached(uint32_t t_us)
{
    return (int32_t)(t_us - adxl345_driver_state()->now_us) <= 0; /* returning hal_time_reached takes 24 B more */
}

bool adxl345_driver_deadline_passed(void)
{
    return adxl345_driver_reached(adxl345_driver_state()->deadline_us);
}

void adxl345_driver_stopped(void)
{
    adxl345_driver_state()->fault = ADXL345_FAULT_NONE;
    adxl345_driver_state()->after_fault = false;
    adxl345_driver_state()->step = STEP_OFF;
}

void adxl345_set_i2c(adxl345_i2c_t speed)
{
    if (((uint8_t)speed | adxl345_driver_state()->garbled) >= GARBLED_ASKED) {
        adxl345_driver_state()->garbled = (uint8_t)speed;
    }
}

bool adxl345_i2c_fell_back(void)
{
    return (uint8_t)(adxl345_driver_state()->garbled - GARBLED_SLOW) < GARBLED_ASKED - GARBLED_SLOW;
}

uint8_t adxl345_scl_025us(uint16_t rate_dhz)
{
    if (rate_dhz > SLOW_MAX_DHZ) {
        return rate_dhz == 8000 ? HAL_I2C_400_KHZ : HAL_I2C_364_KHZ;
    }
    return (adxl345_driver_state()->garbled & GARBLED_SLOW) != 0 ? HAL_I2C_100_KHZ : HAL_I2C_364_KHZ;
}

/* Ones that are late read as zeros: of another identity, which is just read, none is more than it should be. */
static bool garbles(adxl345_fault_t fault)
{
    if (fault == ADXL345_FAULT_WRONG_ID) {
        return (adxl345_burst_register_value() & (uint8_t)~ADXL345_DEVID_VALUE) == 0;
    }
    return fault == ADXL345_FAULT_BUS || fault == ADXL345_FAULT_READ_BACK || fault == ADXL345_FAULT_TORN;
}

void adxl345_driver_fail(adxl345_fault_t fault)
{
    adxl345_driver_t *d = adxl345_driver_here();
    adxl345_burst_set_mode(BURST_IGNORE);
    if (d->stop_wanted) {
        adxl345_driver_stopped();
        if (d->rests != 0) {
            d->rests--;
            adxl345_driver_enter(STEP_REST_LATER, BACK_OFF_MAX);
        }
        return;
    }
    if (d->garbled < GARBLED_ASKED && d->config.rate_dhz <= SLOW_MAX_DHZ && garbles(fault)) {
        d->garbled = (uint8_t)(d->garbled + 1u) % GARBLED_ASKED;
    }
    d->fault = (uint8_t)fault;
    d->after_fault = true;
    adxl345_driver_enter(STEP_BACK_OFF, d->back_off);
    d->back_off = (uint8_t)(d->back_off * 2u);
    if (d->back_off > BACK_OFF_MAX) {
        d->back_off = BACK_OFF_MAX;
    }
}

bool adxl345_driver_take_bus(void)
{
    uint8_t lines = adxl345_burst_take_bus(adxl345_driver_state()->address,
                                           adxl345_scl_025us(adxl345_driver_state()->config.rate_dhz));
    if (lines == HAL_I2C_FREE) {
        return true;
    }
    adxl345_driver_fail((adxl345_fault_t)(ADXL345_FAULT_SCL_LOW - HAL_I2C_SCL_LOW + lines));
    return false;
}

void adxl345_driver_begin_access(step_t step)
{
    adxl345_burst_set_mode(BURST_IGNORE);
    adxl345_driver_enter(step, TRANSFER_LIMIT);
    (void)adxl345_driver_take_bus();
}

/* The measured period of a sensor that has to be found again still holds, unless the rate has changed. */
void adxl345_driver_probe(void)
{
    adxl345_driver_t *d = adxl345_driver_here();
    if (d->renewed) {
        d->renewed = false;
        adxl345_period_start(d->half_us);
    }
    uint8_t only = d->config.address;
    d->found = ADXL345_FAULT_NONE;
    if (only != 0) {
        d->address = only;
    }
    adxl345_driver_begin_access(STEP_PROBE);
}

bool adxl345_driver_transfer_failed(i2c_bus_state_t state)
{
    uint8_t place = (uint8_t)(COUNTER_NACKS - I2C_BUS_NACK_DATA + (uint8_t)state);
    adxl345_counters_add((counter_t)(state == I2C_BUS_NACK_ADDRESS ? COUNTER_NACKS : place));
    return state != I2C_BUS_TIMEOUT || adxl345_driver_take_bus();
}

MACHINE_APART void adxl345_driver_not_here(adxl345_driver_t *d, adxl345_fault_t fault)
{
    uint8_t found = d->found;
    d->found = (uint8_t)fault;
    if (d->config.address == 0) {
        d->address ^= ADXL345_ADDRESS_LOW ^ ADXL345_ADDRESS_HIGH;
        if (found == ADXL345_FAULT_NONE) {
            adxl345_driver_begin_access(STEP_PROBE);
            return;
        }
    }
    if (fault == ADXL345_FAULT_NO_SENSOR && found != ADXL345_FAULT_NONE) {
        fault = (adxl345_fault_t)found;
    }
    adxl345_driver_fail(fault);
}

void adxl345_driver_give_up(adxl345_driver_t *d, i2c_bus_state_t state)
{
    if (state != I2C_BUS_NACK_ADDRESS || d->stop_wanted) {
        adxl345_driver_fail(ADXL345_FAULT_BUS);
    } else if (d->step == STEP_PROBE) {
        adxl345_driver_not_here(d, ADXL345_FAULT_NO_SENSOR);
    } else {
        d->after_fault = true;
        adxl345_driver_probe();
    }
}
