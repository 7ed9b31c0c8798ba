/*
 * One I2C transfer at a time: write `tx`, then (if rx_length) a repeated START and a read into `rx`.
 * The steps run in the I2C interrupt; everything is inline so that the handler that includes this saves few registers.
 * A transfer that hangs produces no interrupt: whoever started it watches the time and takes the bus anew.
 */
#ifndef I2C_BUS_H
#define I2C_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_i2c.h"

#define I2C_BUS_TX_MAX 2

typedef enum {
    I2C_BUS_IDLE, /* nothing since the bus was taken */
    I2C_BUS_BUSY,
    I2C_BUS_OK,
    I2C_BUS_NACK_ADDRESS, /* nobody at that address */
    I2C_BUS_NACK_DATA,
    I2C_BUS_LOST,   /* arbitration lost: noise, or a second master */
    I2C_BUS_ERROR,  /* illegal START or STOP on the bus, or a status that cannot be */
    I2C_BUS_TIMEOUT /* the owner took the bus anew while the transfer ran */
} i2c_bus_state_t;

typedef struct {
    volatile uint8_t state; /* i2c_bus_state_t; leaves BUSY only in the interrupt or when the bus is taken anew */
    uint8_t address;        /* 7 bit, shifted left by one */
    uint8_t tx_length;
    uint8_t rx_length;
    uint8_t index;
    uint8_t *rx; /* stays with the caller until the state leaves BUSY */
    uint8_t tx[I2C_BUS_TX_MAX];
} i2c_bus_t;

/* True when a transfer can begin: none under way and the last STOP is out (interrupts off, or in an interrupt). */
static inline bool i2c_bus_free(const i2c_bus_t *bus)
{
    return bus->state != I2C_BUS_BUSY && !hal_i2c_stop_pending();
}

/* Begins the transfer set up in *bus. Only when i2c_bus_free; interrupts off, or in an interrupt. */
static inline void i2c_bus_begin(i2c_bus_t *bus)
{
    bus->index = 0;
    bus->state = I2C_BUS_BUSY;
    hal_i2c_start();
}

static inline void i2c_bus_finish(i2c_bus_t *bus, i2c_bus_state_t state)
{
    hal_i2c_stop();
    bus->state = (uint8_t)state;
}

static inline void i2c_bus_step_write(i2c_bus_t *bus)
{
    if (bus->index < bus->tx_length) {
        hal_i2c_send(bus->tx[bus->index++]);
    } else if (bus->rx_length != 0) {
        hal_i2c_start();
    } else {
        i2c_bus_finish(bus, I2C_BUS_OK);
    }
}

/* One bus event (interrupt). A stale event of an abandoned transfer is ignored. */
static inline void i2c_bus_step(i2c_bus_t *bus)
{
    uint8_t status = hal_i2c_status();
    if (bus->state != I2C_BUS_BUSY) {
        hal_i2c_disable();
        return;
    }
    switch (status) {
    case HAL_I2C_STARTED:
        hal_i2c_send(bus->address);
        break;
    case HAL_I2C_RESTARTED:
        bus->index = 0;
        hal_i2c_send((uint8_t)(bus->address | 1u));
        break;
    case HAL_I2C_WRITE_ADDRESS_ACK:
    case HAL_I2C_SENT_ACK:
        i2c_bus_step_write(bus);
        break;
    case HAL_I2C_RECEIVED_ACK:
        bus->rx[bus->index++] = hal_i2c_received();
        hal_i2c_receive((uint8_t)(bus->index + 1u) < bus->rx_length);
        break;
    case HAL_I2C_READ_ADDRESS_ACK:
        hal_i2c_receive(bus->rx_length > 1u);
        break;
    case HAL_I2C_RECEIVED_NACK:
        bus->rx[bus->index] = hal_i2c_received();
        i2c_bus_finish(bus, I2C_BUS_OK);
        break;
    case HAL_I2C_WRITE_ADDRESS_NACK:
    case HAL_I2C_READ_ADDRESS_NACK:
        i2c_bus_finish(bus, I2C_BUS_NACK_ADDRESS);
        break;
    case HAL_I2C_SENT_NACK:
        i2c_bus_finish(bus, I2C_BUS_NACK_DATA);
        break;
    case HAL_I2C_ARBITRATION_LOST:
        hal_i2c_release();
        bus->state = I2C_BUS_LOST;
        break;
    default:
        i2c_bus_finish(bus, I2C_BUS_ERROR);
        break;
    }
}

#endif
