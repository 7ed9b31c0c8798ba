/*
 * I2C master at command level: each call causes one bus event, so the transfer state machine on top
 * (lib/adxl345/src/i2c_bus.h) is portable, and a test can feed it any status byte. Nothing here waits except
 * hal_i2c_clear. The states have the names of the ATmega328P's two-wire interface (data sheet tables 26-3, 26-4). Any
 * context unless a function says otherwise.
 */
#ifndef HAL_I2C_H
#define HAL_I2C_H

#include <stdbool.h>
#include <stdint.h>

enum hal_i2c_status {
    HAL_I2C_BUS_ERROR = 0x00,
    HAL_I2C_STARTED = 0x08,
    HAL_I2C_RESTARTED = 0x10,
    HAL_I2C_WRITE_ADDRESS_ACK = 0x18,
    HAL_I2C_WRITE_ADDRESS_NACK = 0x20,
    HAL_I2C_SENT_ACK = 0x28,
    HAL_I2C_SENT_NACK = 0x30,
    HAL_I2C_ARBITRATION_LOST = 0x38,
    HAL_I2C_READ_ADDRESS_ACK = 0x40,
    HAL_I2C_READ_ADDRESS_NACK = 0x48,
    HAL_I2C_RECEIVED_ACK = 0x50,
    HAL_I2C_RECEIVED_NACK = 0x58,
    HAL_I2C_NOTHING = 0xF8
};

/* The bus lines while no master uses them. */
enum hal_i2c_lines { HAL_I2C_FREE, HAL_I2C_SCL_LOW, HAL_I2C_SDA_LOW };

/* Periods of SCL in 0.25 us: 363.6 kHz, with tLOW 1.375 us within the ADXL345's specification, 400 and 100 kHz. */
enum { HAL_I2C_364_KHZ = 11, HAL_I2C_400_KHZ = 10, HAL_I2C_100_KHZ = 40 };

/* Takes the pins; SCL has this period. */
void hal_i2c_enable(uint8_t period_025us);

/* Releases the pins at once; a transfer in progress is abandoned. */
void hal_i2c_disable(void);

/*
 * Frees a bus whose SDA a slave holds low, as after an MCU reset in the middle of a read: clocks the rest of its byte
 * out, at most 16 clocks of 15 us (UM10204 3.1.16), with a bit-banged STOP. Returns the line that is still low, or
 * HAL_I2C_FREE. Sends no clock while SCL is held low; never drives a line high. Main, while disabled, interrupts on.
 */
uint8_t hal_i2c_clear(void);

/* Requests a START or repeated START. */
void hal_i2c_start(void);

/* Sends an address or data byte. */
void hal_i2c_send(uint8_t byte);

/* Clocks in one byte and answers it with ACK or NACK. */
void hal_i2c_receive(bool ack);

/* The byte received. */
uint8_t hal_i2c_received(void);

/* Requests a STOP; no interrupt follows. */
void hal_i2c_stop(void);

/* Releases the bus after a lost arbitration. */
void hal_i2c_release(void);

/* HAL_I2C_* of the event that raised the interrupt. */
uint8_t hal_i2c_status(void);

/* The STOP has not reached the bus yet. */
bool hal_i2c_stop_pending(void);

/* The port's HAL_I2C_ISR() { ... } defines the handler, which runs after every event except a STOP. */
#include "hal_i2c_port.h"

#endif
