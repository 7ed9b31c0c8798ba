/* The board's LED (D13). */
#ifndef HAL_LED_H
#define HAL_LED_H

#include <stdbool.h>

/* Makes the pin an output; the LED is off. Main, once. */
void hal_led_init(void);

/* Any context. */
void hal_led_set(bool on);

#endif
