/* Tells the user when the sensor fails and when it is back, and keeps rows coming meanwhile. Main only. */
#ifndef SENSOR_WATCH_H
#define SENSOR_WATCH_H

#include <stdint.h>

/* When rows begin; the banner has told a fault that is there by now. */
void sensor_watch_start(uint32_t now_us);

/* Once per pass of the main loop, after adxl345_poll. */
void sensor_watch_pass(uint32_t now_us);

#endif
