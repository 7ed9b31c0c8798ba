/*
 * The sensor's data-ready line INT1 on D2 (active high).
 *
 *   void hal_drdy_enable(void)     interrupt on the rising edge, from now on for ever (main, once)
 *   bool hal_drdy_high(void)       the level now (any context): the line is a latched level, so an edge can be missed
 *   HAL_DRDY_ISR() { ... }         defines the handler: stamp a time, start a burst, nothing else
 */
#ifndef HAL_DRDY_H
#define HAL_DRDY_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_port.h"

#endif
