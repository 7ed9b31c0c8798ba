/* GPIOR0 holds the wake flag: it takes one instruction to set and one cycle to test. */
#ifndef HAL_SLEEP_PORT_H
#define HAL_SLEEP_PORT_H

#include <avr/io.h>

#include "hal_body.h"
#include "hal_sleep.h"

HAL_BODY void hal_wake(void)
{
    GPIOR0 |= 1;
}

#endif
