/* The board's LED (D13). */
#ifndef HAL_LED_H
#define HAL_LED_H

#include <stdbool.h>

/* Off, and a pin that can be set. Main, once. */
void hal_led_init(void);

/* Any context. */
void hal_led_set(bool on);

#endif
