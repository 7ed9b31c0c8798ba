/* The level of D2 as a value, for main. The data-ready handler tests the pin itself. */
#include "hal_drdy.h"

#include <avr/io.h>

bool hal_drdy_high(void)
{
    return !hal_drdy_flickers() && (PIND & _BV(PD2)) != 0;
}
