/* D4 is PD4. */
#include "hal_strap.h"

#include <avr/io.h>

void hal_strap_init(void)
{
    PORTD |= _BV(PD4);
}

bool hal_strap_low(void)
{
    return (PIND & _BV(PD4)) == 0;
}
