/* The strap that asks for safe settings: D4 to ground while the board starts. */
#ifndef HAL_STRAP_H
#define HAL_STRAP_H

#include <stdbool.h>

/* Pull-up on. Main, once, a few microseconds before the next. */
void hal_strap_init(void);

/* D4 is at ground. Main. */
bool hal_strap_low(void);

#endif
