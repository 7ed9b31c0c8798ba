/* INT0 is pin PD2 = D2. */
#ifndef HAL_DRDY_PORT_H
#define HAL_DRDY_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_body.h"
#include "hal_drdy.h"

#define HAL_DRDY_ISR() ISR(INT0_vect)

/*
 * GPIOR1 and GPIOR2 take a cycle to read and one to write: edges left in this tick, and ticks until D2 is believed
 * again.
 */
HAL_BODY void hal_drdy_enable(void)
{
    EICRA = _BV(ISC01) | _BV(ISC00);
    EIFR = _BV(INTF0);
    EIMSK = _BV(INT0);
}

HAL_BODY bool hal_drdy_flickers(void)
{
    return GPIOR2 != 0;
}

HAL_BODY bool hal_drdy_high(void)
{
    return !hal_drdy_flickers() && (PIND & _BV(PD2)) != 0;
}

HAL_BODY bool hal_drdy_edge_isr(void)
{
    uint8_t left = (uint8_t)(GPIOR1 - 1u);
    GPIOR1 = left;
    if (left == 0) {
        EIMSK = left;
        GPIOR2 = HAL_DRDY_DEAF_TICKS;
    }
    return hal_drdy_high();
}

#endif
