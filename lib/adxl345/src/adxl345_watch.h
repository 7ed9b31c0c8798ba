/*
 * Inside the driver: do the readings look as if two sensors drove one address? Main only.
 */
#ifndef ADXL345_WATCH_H
#define ADXL345_WATCH_H

#include <stdbool.h>
#include <stdint.h>

/* The first sample of a run comes next. */
void adxl345_watch_start(void);

/* The next sample and the one before it, x, y, z in LSB (-4096..4095). */
void adxl345_watch_sample(const int16_t now_lsb[3], const int16_t before_lsb[3]);

/*
 * An axis has jumped between a value and its double again and again: from the eighth jump in close order, or some
 * more than one in sixteen samples, until 255 samples after the last one at most.
 */
bool adxl345_watch_two_sensors(void);

#endif
