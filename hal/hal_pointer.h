/*
 * HAL_POINTER(p): from here on the compiler does not know what p points at, and keeps p in registers. On the UNO that
 * makes each access to the thing two bytes instead of four, where a function makes many. Any context.
 *
 * HAL_APART: a function that is not copied into its caller, which has fewer registers to save then.
 */
#ifndef HAL_POINTER_H
#define HAL_POINTER_H

#define HAL_APART __attribute__((noinline))

#include "hal_port.h"

#endif
