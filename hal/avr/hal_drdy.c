/* D2 as main sees it: of the many places that ask each would be longer than a call. */
#include "hal_drdy.h"

#include <avr/io.h>

#include "hal_drdy_port.h"
#include "machine.h"

MACHINE_APART bool hal_drdy_high(void)
{
    return !hal_drdy_flickers() && (PIND & _BV(PD2)) != 0;
}
