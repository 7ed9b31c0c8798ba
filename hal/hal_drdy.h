/* The sensor's data-ready line INT1 on D2 (active high): a latched level, so an edge can be missed. */
#ifndef HAL_DRDY_H
#define HAL_DRDY_H

#include <stdbool.h>

/* From now on for ever, each rising edge runs the handler. Main, once. */
void hal_drdy_enable(void);

/* The level now. Any context. */
bool hal_drdy_high(void);

/* The port's HAL_DRDY_ISR() { ... } defines the handler: stamp a time, start a burst, nothing else. */
#include "hal_drdy_port.h"

#endif
