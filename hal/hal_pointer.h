/*
 * HAL_POINTER(p): from here on the compiler does not know what p points at, and keeps p in registers. On the UNO that
 * makes each access to the thing two bytes instead of four, where a function makes many. Any context.
 */
#ifndef HAL_POINTER_H
#define HAL_POINTER_H

#include "hal_port.h"

#endif
