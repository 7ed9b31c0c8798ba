/*
 * Idle sleep without lost wake-ups.
 *
 *   void hal_wake(void)                    main has work (called by handlers, or by main to stay awake)
 *   void hal_sleep_until_wake(void)        returns at once if hal_wake was called since the last return, else sleeps
 *                                          until it is; handlers that need no work of main do not end the sleep (main)
 */
#ifndef HAL_SLEEP_H
#define HAL_SLEEP_H

#include <stdint.h>

#include "hal_port.h"

#endif
