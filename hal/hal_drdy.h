/* The sensor's data-ready line, INT1 on D2 (active high): a latched level, so an edge can be missed. */
#ifndef HAL_DRDY_H
#define HAL_DRDY_H

#include <stdbool.h>

/* Enables the interrupt for good: each rising edge runs the handler. Main, once. */
void hal_drdy_enable(void);

/* The current level; false while the input flickers. Any context. */
bool hal_drdy_high(void);

/*
 * True after more edges in one tick (HAL_TICK_US) than a sensor can make, as on a disconnected wire. Edges are ignored
 * for 31 ticks, then counted for one tick, in which the level is not trusted yet. Any context.
 */
bool hal_drdy_flickers(void);

/*
 * Edges in one tick that count as flicker: normally, and while checking whether it is over. A sensor at 800 Hz makes 7.
 */
enum { HAL_DRDY_EDGES = 9, HAL_DRDY_EDGES_AGAIN = 8, HAL_DRDY_DEAF_TICKS = 32 };

/*
 * The port's HAL_DRDY_ISR() { ... } defines the handler of a trusted edge whose level is still high: take a time stamp,
 * start a burst, nothing else.
 */
#include "hal_drdy_port.h"

#endif
