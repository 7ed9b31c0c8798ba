/*
 * HAL_RAM_CLEARED: 1 where every static variable is 0 when the program begins, and it begins but once; what would set
 * them to 0 is left out there. On the PC 0: tests begin it again and again.
 */
#ifndef HAL_RAM_H
#define HAL_RAM_H

#include "hal_port.h"

#endif
