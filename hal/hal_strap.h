/*
 * The strap that asks for safe settings: D4 to ground while the board starts.
 *
 *   void hal_strap_init(void)      pull-up on (main, once, a few microseconds before the next)
 *   bool hal_strap_low(void)       D4 is at ground (main)
 */
#ifndef HAL_STRAP_H
#define HAL_STRAP_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_port.h"

#endif
