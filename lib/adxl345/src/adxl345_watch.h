/* Inside the driver: do the readings look as if two sensors were driving one address? Main only. */
#ifndef ADXL345_WATCH_H
#define ADXL345_WATCH_H

#include <stdbool.h>
#include <stdint.h>

/* The next sample is the first of a run. */
void adxl345_watch_start(void);

/* The next sample and the previous one, x, y, z in LSB (-4096..4095). */
void adxl345_watch_sample(const int16_t now_lsb[3], const int16_t before_lsb[3]);

/*
 * An axis has repeatedly jumped between a value and its double: true from the eighth jump in close succession, or from
 * a few more at one in sixteen samples, until at most 255 samples after the last one.
 */
bool adxl345_watch_two_sensors(void);

#endif
