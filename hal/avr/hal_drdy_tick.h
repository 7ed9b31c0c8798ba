/* Internal to the AVR HAL: the timer tick counts how long D2 stays muted. */
#ifndef HAL_DRDY_TICK_H
#define HAL_DRDY_TICK_H

#include <avr/io.h>

#include "hal_body.h"
#include "hal_drdy.h"

/*
 * Called from the timer handler every HAL_TICK_US. In the last muted tick edges are counted again, but D2 is not
 * trusted yet.
 */
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
