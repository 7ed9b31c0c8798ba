/* The one I2C verb that is more than a register access: getting a slave to let go of SDA. */
#include "hal_i2c.h"

#include <util/delay.h>

enum { CLOCKS_MAX = 16, HALF_CLOCK_US = 5 };

void hal_i2c_clear(void)
{
    for (uint8_t clocks = CLOCKS_MAX; clocks != 0 && !(PINC & _BV(PC4)); clocks--) {
        DDRC |= _BV(PC5);
        _delay_us(HALF_CLOCK_US);
        DDRC &= (uint8_t)~_BV(PC5);
        _delay_us(HALF_CLOCK_US);
    }
}
