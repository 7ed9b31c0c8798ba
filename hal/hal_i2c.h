/*
 * I2C master at command level: each call is one bus event, so the transfer state machine above
 * (lib/adxl345/src/i2c_bus.h) is portable and can be given any status byte in a test. Nothing here waits but
 * hal_i2c_clear. The names of the states are those of the ATmega328P's two-wire interface (data sheet tables 26-3,
 * 26-4). Any context unless a function says otherwise.
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

/* The bus while no master uses it. */
enum hal_i2c_lines { HAL_I2C_FREE, HAL_I2C_SCL_LOW, HAL_I2C_SDA_LOW };

/* Take the pins; SCL 363.6 kHz (tLOW 1.375 us, in the ADXL345's spec), or 400 kHz if fast. */
void hal_i2c_enable(bool fast);

/* Release the pins at once; whatever ran is abandoned. */
void hal_i2c_disable(void);

/*
 * Clocks a slave that holds SDA out of its byte, at most 16 clocks of 15 us (UM10204 3.1.16), and gives a STOP by hand:
 * a reset of the MCU in the middle of a read leaves it so. Returns which line is low then, or HAL_I2C_FREE. Gives no
 * clock to an SCL that is low; never drives a line high. Main, while disabled, interrupts on.
 */
uint8_t hal_i2c_clear(void);

/* Ask for a START or repeated START. */
void hal_i2c_start(void);

/* Send an address or data byte. */
void hal_i2c_send(uint8_t byte);

/* Clock one byte in and answer it with ACK or NACK. */
void hal_i2c_receive(bool ack);

/* The byte that came in. */
uint8_t hal_i2c_received(void);

/* Ask for a STOP; no interrupt follows. */
void hal_i2c_stop(void);

/* Give the bus up after a lost arbitration. */
void hal_i2c_release(void);

/* HAL_I2C_* of the event that raised the interrupt. */
uint8_t hal_i2c_status(void);

/* A STOP has not reached the bus yet. */
bool hal_i2c_stop_pending(void);

/* The port's HAL_I2C_ISR() { ... } defines the handler that runs after every event but STOP. */
#include "hal_i2c_port.h"

#endif
