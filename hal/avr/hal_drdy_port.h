/* INT0 is pin PD2 = D2. */
#ifndef HAL_DRDY_PORT_H
#define HAL_DRDY_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_body.h"
#include "hal_drdy.h"

#define HAL_DRDY_ISR() ISR(INT0_vect)

HAL_BODY void hal_drdy_enable(void)
{
    EICRA = _BV(ISC01) | _BV(ISC00);
    EIFR = _BV(INTF0);
    EIMSK = _BV(INT0);
}

HAL_BODY bool hal_drdy_high(void)
{
    return (PIND & _BV(PD2)) != 0;
}

#endif
