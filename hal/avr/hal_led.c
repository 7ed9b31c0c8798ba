/* D13 is PB5. */
#include "hal_led.h"

#include <avr/io.h>

void hal_led_init(void)
{
    DDRB |= _BV(PB5);
}

void hal_led_set(bool on)
{
    if (on) {
        PORTB |= _BV(PB5);
    } else {
        PORTB &= (uint8_t)~_BV(PB5);
    }
}
