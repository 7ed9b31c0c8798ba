/* Idle sleep (SM2:0 = 0). SEI takes effect after the next instruction, so no interrupt runs between SEI and SLEEP. */
#include "hal_sleep.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

void hal_sleep_until_wake(void)
{
    SMCR = _BV(SE);
    for (;;) {
        cli();
        if (GPIOR0 != 0) {
            GPIOR0 = 0;
            sei();
            return;
        }
        sei();
        sleep_cpu();
    }
}
