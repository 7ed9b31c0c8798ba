/* Reports when the sensor fails and when it is back, in lines and by the LED. Main only. */
#ifndef SENSOR_WATCH_H
#define SENSOR_WATCH_H

#include <stdint.h>

#include "adxl345.h"

/*
 * Faults that are none of the driver's (adxl345_fault_t): at rest the sensor does not read gravity; I2C is slower than
 * it could be (adxl345_i2c_fell_back).
 */
enum { FAULT_OTHER_PART = ADXL345_FAULT_INT1_FLICKERS + 1, FAULT_I2C_SLOWED };

/* Call once, before the passes, when the banner reports the sensor: returns the fault for it to report, or none. */
uint8_t sensor_watch_start(uint32_t now_us);

/* Call every few ms, in passes that poll the driver. */
void sensor_watch_pass(uint32_t now_us);

/* Call once a second: the faults that are none of the driver's begin and end then. */
void sensor_watch_second(void);

/* The fault in force: the driver's if there is one, else one of these or none. */
uint8_t sensor_watch_fault(void);

/* The last fault whose end was reported: its duration, the samples lost, and the sensor's address after it. */
typedef struct {
    uint32_t ms;
    uint32_t lost;
    uint8_t address;
} sensor_outage_t;
const sensor_outage_t *sensor_watch_outage(void);

#endif
