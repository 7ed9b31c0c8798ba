/*
 * Inside the driver: the time between samples, measured from their stamps, because a sensor's clock is 2 to 4 % off.
 * Main only.
 */
#ifndef ADXL345_PERIOD_H
#define ADXL345_PERIOD_H

#include <stdbool.h>
#include <stdint.h>

/* Starts with the nominal period, half of which is 625..40000 us. */
void adxl345_period_start(uint16_t half_us);

/* The stamp of the next sample, us; exact: the sample was read as soon as it was ready. */
void adxl345_period_sample(uint32_t t_us, bool exact);

/* adxl345_period_us in 1/16 us, and whether it was measured; nominal until then. */
uint32_t adxl345_period_us_q4(void);
bool adxl345_period_measured(void);

#endif
