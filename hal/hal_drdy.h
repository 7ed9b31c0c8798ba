/* The sensor's data-ready line INT1 on D2 (active high): a latched level, so an edge can be missed. */
#ifndef HAL_DRDY_H
#define HAL_DRDY_H

#include <stdbool.h>

/* From now on for ever, each rising edge runs the handler. Main, once. */
void hal_drdy_enable(void);

/* The level now, which an input that flickers does not have: false. Any context. */
bool hal_drdy_high(void);

/*
 * More edges than a sensor makes have come within a tick of the clock (HAL_TICK_US), as on a wire that is off. None is
 * heard for 31 ticks; then they are counted for one, in which the level is not believed yet. Any context.
 */
bool hal_drdy_flickers(void);

/* Edges in a tick that are too many, at first and when it is seen whether it is over: a sensor at 800 Hz makes 7. */
enum { HAL_DRDY_EDGES = 9, HAL_DRDY_EDGES_AGAIN = 8, HAL_DRDY_DEAF_TICKS = 32 };

/*
 * The port's HAL_DRDY_ISR() { ... } defines what an edge does whose level stands and that is believed: stamp a time,
 * start a burst, nothing else.
 */
#include "hal_drdy_port.h"

#endif
