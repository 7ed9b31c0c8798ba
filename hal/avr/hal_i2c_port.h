/*
 * TWI of the ATmega328P (data sheet chapter 26). SCL is F_CPU / (16 + 2 TWBR): TWBR is 14, 12 and 72 at 16 MHz, 3, 2
 * and 32 at 8 MHz. The internal pull-ups (to 5 V) stay off.
 */
#ifndef HAL_I2C_PORT_H
#define HAL_I2C_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_body.h"
#include "hal_i2c.h"

#define HAL_I2C_TWBR(period_025us) ((uint8_t)(F_CPU / 8000000 * (period_025us)-8u))
#define HAL_I2C_ISR() ISR(TWI_vect)

enum { HAL_I2C_GO = _BV(TWINT) | _BV(TWEN) | _BV(TWIE) };

HAL_BODY void hal_i2c_enable(uint8_t period_025us)
{
    TWSR = 0;
    TWBR = HAL_I2C_TWBR(period_025us);
    TWCR = _BV(TWEN);
}

HAL_BODY void hal_i2c_disable(void)
{
    TWCR = 0;
}

HAL_BODY void hal_i2c_start(void)
{
    __asm__ volatile("" ::: "memory"); /* what the handler reads is written before this */
    TWCR = HAL_I2C_GO | _BV(TWSTA);
}

HAL_BODY void hal_i2c_send(uint8_t byte)
{
    TWDR = byte;
    TWCR = HAL_I2C_GO;
}

HAL_BODY void hal_i2c_receive(bool ack)
{
    TWCR = ack ? (HAL_I2C_GO | _BV(TWEA)) : HAL_I2C_GO;
}

HAL_BODY uint8_t hal_i2c_received(void)
{
    return TWDR;
}

HAL_BODY void hal_i2c_stop(void)
{
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
}

HAL_BODY void hal_i2c_release(void)
{
    TWCR = _BV(TWINT) | _BV(TWEN);
}

HAL_BODY uint8_t hal_i2c_status(void)
{
    return TWSR & 0xF8u;
}

HAL_BODY bool hal_i2c_stop_pending(void)
{
    return (TWCR & _BV(TWSTO)) != 0;
}

#endif
