/* Reports when the sensor fails and when it is back, in lines and by the LED. Main only. */
#ifndef SENSOR_WATCH_H
#define SENSOR_WATCH_H

#include <stdint.h>

/* Call when rows start; a fault present by then was reported by the banner. */
void sensor_watch_start(uint32_t now_us);

/* Call every few ms, in passes that poll the driver. */
void sensor_watch_pass(uint32_t now_us);

/* The last fault whose end was reported: its duration, the samples lost, and the sensor's address after it. */
typedef struct {
    uint32_t ms;
    uint32_t lost;
    uint8_t address;
} sensor_outage_t;
const sensor_outage_t *sensor_watch_outage(void);

#endif
