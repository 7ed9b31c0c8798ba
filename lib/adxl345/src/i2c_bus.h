/*
 * One I2C transfer at a time: writes `tx`, then (if rx_length, up to I2C_BUS_RX_MAX) a repeated START and a read into
 * `rx`, which is part of the bus structure so that the handler knows its address. A read whose first byte lacks
 * I2C_BUS_MORE ends with the second: the sensor has no sample, and its data stay unread.
 *
 * Each command has exactly one status for success; any other ends the transfer, even one that would be valid at another
 * moment. So no byte is stored that was not requested, and no transfer succeeds without all of its steps. The steps run
 * in the I2C interrupt; everything is inline so that the handler that includes this saves few registers. A hanging
 * transfer raises no interrupt: its owner watches the time and takes the bus again.
 */
#ifndef I2C_BUS_H
#define I2C_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_i2c.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "machine.h"

#define I2C_BUS_TX_MAX 2
#define I2C_BUS_RX_MAX 10
#define I2C_BUS_MORE 0x80u /* in the first byte received: more than one byte follows it */

typedef enum {
    I2C_BUS_IDLE, /* no transfer yet */
    I2C_BUS_BUSY,
    I2C_BUS_OK,
    I2C_BUS_NACK_ADDRESS, /* no device at that address */
    I2C_BUS_NACK_DATA,
    I2C_BUS_LOST,   /* arbitration lost: noise, or a second master */
    I2C_BUS_ERROR,  /* illegal START or STOP on the bus, or a status that is impossible at this step */
    I2C_BUS_TIMEOUT /* the owner took the bus again during the transfer */
} i2c_bus_state_t;

typedef struct {
    volatile uint8_t state; /* i2c_bus_state_t; leaves BUSY only in the interrupt or if the bus is taken again */
    uint8_t address;        /* 7 bits, shifted left by one */
    uint8_t tx_length;
    uint8_t rx_length;
    uint8_t count;    /* bytes sent, then bytes requested */
    uint8_t expected; /* HAL_I2C_*: the status if the last command succeeded; kept after the transfer */
    uint8_t tx[I2C_BUS_TX_MAX];
    uint8_t rx[I2C_BUS_RX_MAX]; /* valid from the end of a transfer to the next read */
} i2c_bus_t;

/*
 * True if a transfer can begin: none under way, and the last STOP is out (interrupts off, or in an interrupt). A macro:
 * the compiler turns a function's result into a byte and tests that, which costs a handler 6 cycles.
 */
#define I2C_BUS_FREE(bus) ((bus)->state != I2C_BUS_BUSY && !hal_i2c_stop_pending())

/* Begins the transfer set up in *bus. Only if I2C_BUS_FREE; interrupts off, or in an interrupt. */
MACHINE_INLINE void i2c_bus_begin(i2c_bus_t *bus)
{
    bus->count = 0;
    bus->expected = HAL_I2C_STARTED;
    bus->state = I2C_BUS_BUSY;
    hal_i2c_start();
}

/*
 * Bytes that the current or last transfer has requested from the device. All but the last were received, and the last
 * one too if the transfer succeeded.
 */
static inline uint8_t i2c_bus_asked(const i2c_bus_t *bus)
{
    return bus->expected >= HAL_I2C_RECEIVED_ACK ? bus->count : 0;
}

static inline void i2c_bus_finish(i2c_bus_t *bus, i2c_bus_state_t state)
{
    hal_i2c_stop();
    bus->state = (uint8_t)state;
    hal_wake();
}

/* All bytes are sent. */
static inline void i2c_bus_step_sent(i2c_bus_t *bus)
{
    if (bus->rx_length == 0) {
        i2c_bus_finish(bus, I2C_BUS_OK);
        return;
    }
    hal_i2c_start();
    bus->expected = HAL_I2C_RESTARTED;
}

/* NACKs the last byte so that the device releases SDA; the second is the last if the first byte says so. */
MACHINE_INLINE void i2c_bus_step_read(i2c_bus_t *bus, uint8_t count)
{
    bus->count = count;
    if (count < bus->rx_length && (count != 2u || (bus->rx[0] & I2C_BUS_MORE))) {
        hal_i2c_receive(true);
        bus->expected = HAL_I2C_RECEIVED_ACK;
    } else {
        hal_i2c_receive(false);
        bus->expected = HAL_I2C_RECEIVED_NACK;
    }
}

/* Any status but the expected one. A NACK counts as one only where an acknowledge was expected. */
static inline void i2c_bus_unexpected(i2c_bus_t *bus, uint8_t status)
{
    enum { REFUSED = HAL_I2C_SENT_NACK - HAL_I2C_SENT_ACK };
    i2c_bus_state_t state = I2C_BUS_ERROR;
    if (status == HAL_I2C_ARBITRATION_LOST) {
        hal_i2c_release();
        bus->state = I2C_BUS_LOST;
        hal_wake();
        return;
    }
    if (status == (uint8_t)(bus->expected + REFUSED)) {
        if (status == HAL_I2C_SENT_NACK) {
            state = I2C_BUS_NACK_DATA;
        } else if (status == HAL_I2C_WRITE_ADDRESS_NACK || status == HAL_I2C_READ_ADDRESS_NACK) {
            state = I2C_BUS_NACK_ADDRESS;
        }
    }
    i2c_bus_finish(bus, state);
}

/* The steps before the first received byte. */
static inline void i2c_bus_step_send(i2c_bus_t *bus, uint8_t status)
{
    uint8_t byte;
    uint8_t expected = HAL_I2C_WRITE_ADDRESS_ACK;
    if (status <= HAL_I2C_RESTARTED) {
        byte = bus->address;
        if (status == HAL_I2C_RESTARTED) {
            byte |= 1u;
            expected = HAL_I2C_READ_ADDRESS_ACK;
        }
    } else { /* the address or a byte was sent */
        uint8_t count = bus->count;
        if (count >= bus->tx_length) {
            i2c_bus_step_sent(bus);
            return;
        }
        byte = bus->tx[count];
        bus->count = (uint8_t)(count + 1u);
        expected = HAL_I2C_SENT_ACK;
    }
    hal_i2c_send(byte);
    bus->expected = expected;
}

/* One bus event (interrupt). A stale event of an abandoned transfer is ignored. */
static inline void i2c_bus_step(i2c_bus_t *bus)
{
    uint8_t status = hal_i2c_status();
    if (bus->state != I2C_BUS_BUSY) {
        hal_i2c_disable();
        return;
    }
    if (status != bus->expected) {
        i2c_bus_unexpected(bus, status);
        return;
    }
    uint8_t count = 1;
    if (status >= HAL_I2C_RECEIVED_ACK) { /* first, because it is the most frequent */
        count = bus->count;
        bus->rx[count - 1u] = hal_i2c_received();
        if (status == HAL_I2C_RECEIVED_NACK) {
            i2c_bus_finish(bus, I2C_BUS_OK);
            return;
        }
        count++;
    } else if (status != HAL_I2C_READ_ADDRESS_ACK) {
        i2c_bus_step_send(bus, status);
        return;
    }
    i2c_bus_step_read(bus, count);
}

#endif
