/*
 * Whether the sensor reads gravity at rest. Before calibration an ADXL345 level on any side reads 0.63 to 1.37 g, with
 * offset and scale at the limits of its data sheet (p. 3 and 4, at 3.3 V p. 33). Main only.
 */
#ifndef GRAVITY_H
#define GRAVITY_H

#include <stdbool.h>
#include <stdint.h>

/* Another sensor may follow. */
void gravity_forget(void);

/*
 * A second with all its samples, and the estimates at its end: whether the board was at rest; |a|^2 in 4,096 LSB^2.
 * A second that moves proves nothing about the sensor, but the seconds before it were perhaps no rest either.
 */
void gravity_second(bool still, uint16_t square);

/* For ten seconds at rest in a row it was outside 0.612..1.392 g, and since then in no second at rest within. */
bool gravity_absent(void);

#endif
