/* The strap that selects safe settings: D4 tied to ground during start-up. */
#ifndef HAL_STRAP_H
#define HAL_STRAP_H

#include <stdbool.h>

/* Enables the pull-up. Main, once, a few microseconds before hal_strap_low. */
void hal_strap_init(void);

/* D4 is tied to ground. Main. */
bool hal_strap_low(void);

#endif
