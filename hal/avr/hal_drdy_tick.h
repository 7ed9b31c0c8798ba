/* Between two files of the chip's HAL: the clock's tick counts how long D2 is not heard. */
#ifndef HAL_DRDY_TICK_H
#define HAL_DRDY_TICK_H

#include <avr/io.h>

#include "hal_body.h"
#include "hal_drdy.h"

/* Each HAL_TICK_US; the clock's handler. In its last tick an input that flickered is heard, but not believed. */
HAL_BODY void hal_drdy_tick_isr(void)
{
    GPIOR1 = HAL_DRDY_EDGES;
    uint8_t ticks = GPIOR2;
    if (ticks != 0) {
        GPIOR1 = HAL_DRDY_EDGES_AGAIN;
        ticks--;
        GPIOR2 = ticks;
        if (ticks == 1) {
            EIFR = _BV(INTF0);
            EIMSK = _BV(INT0);
        }
    }
}

#endif
