/*
 * Reports when the sensor fails and when it is back, by lines and by the LED. Main only.
 */
#ifndef SENSOR_WATCH_H
#define SENSOR_WATCH_H

#include <stdint.h>

/* When rows begin; the banner has reported a fault that is there by now. */
void sensor_watch_start(uint32_t now_us);

/* When rows may have been waited for long enough: every few ms, after adxl345_poll. */
void sensor_watch_pass(uint32_t now_us);

/* Of the last fault whose end is reported: how long it was, how many samples are missing, where they come from now. */
typedef struct {
    uint32_t ms;
    uint32_t lost;
    uint8_t address;
} sensor_outage_t;
const sensor_outage_t *sensor_watch_outage(void);

#endif
