/*
 * The board's LED (D13).
 *
 *   void hal_led_init(void)        main, once
 *   void hal_led_set(bool on)      any context
 */
#ifndef HAL_LED_H
#define HAL_LED_H

#include <stdbool.h>
#include <stdint.h>

#include "hal_port.h"

#endif
