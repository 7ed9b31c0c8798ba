/* Idle sleep that loses no wake-up. */
#ifndef HAL_SLEEP_H
#define HAL_SLEEP_H

/* Main has work: called by handlers, or by main to stay awake. Any context. */
void hal_wake(void);

/*
 * Returns at once if hal_wake was called since the last return, else sleeps until it is. A handler that has no work for
 * main does not end the sleep. Main.
 */
void hal_sleep_until_wake(void);

#include "hal_sleep_port.h"

#endif
