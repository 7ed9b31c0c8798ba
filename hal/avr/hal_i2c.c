/*
 * The one I2C function that is more than a register access: it makes a slave release SDA, with a bit-banged STOP. Each
 * clock also pulls SDA low while SCL is low and releases it while SCL is high, which is a STOP as soon as the slave
 * lets SDA rise. So the slave's bit position need not be known, and there is no clock more than it needs.
 *
 * SDA is PC4, SCL is PC5. Open drain through the direction register: the port bits stay 0, so a line is never driven
 * high.
 */
#include "hal_i2c.h"

#include <avr/io.h>
#include <util/delay.h>

#define EXACT(period) ((16ul + 2ul * HAL_I2C_TWBR(period)) * 4000000ul == F_CPU * (period))
_Static_assert(EXACT(HAL_I2C_364_KHZ) && EXACT(HAL_I2C_400_KHZ) && EXACT(HAL_I2C_100_KHZ), "SCL is exact");

enum { CLOCKS_MAX = 16, STEP_US = 5 }; /* STEP_US: rise time of a line with 10 kOhm and 400 pF */

uint8_t hal_i2c_clear(void)
{
    for (uint8_t clocks = 0;; clocks++) {
        _delay_us(STEP_US);
        uint8_t lines = PINC;
        if (!(lines & _BV(PC5))) {
            return HAL_I2C_SCL_LOW;
        }
        if ((lines & _BV(PC4)) && clocks != 0) {
            return HAL_I2C_FREE;
        }
        if (clocks == CLOCKS_MAX) {
            return HAL_I2C_SDA_LOW;
        }
        DDRC |= _BV(PC5);
        DDRC |= _BV(PC4);
        _delay_us(STEP_US);
        DDRC &= (uint8_t)~_BV(PC5);
        _delay_us(STEP_US);
        DDRC &= (uint8_t)~_BV(PC4);
    }
}
