/*
 * Inside the driver: the time between samples, measured from their stamps, since a sensor's clock is 2 to 4 % off. Main
 * only.
 */
#ifndef ADXL345_PERIOD_H
#define ADXL345_PERIOD_H

#include <stdbool.h>
#include <stdint.h>

/* Begins with the nominal one, of which half is 625..40000 us. */
void period_start(uint16_t half_us);

/* The stamp of the next sample, us; exact: the sample was read as it became ready. */
void period_sample(uint32_t t_us, bool exact);

/* The nominal one until it was measured. */
uint32_t period_us(void);

/* The same in 1/256 us, and whether it was measured. */
uint32_t period_us_q8(void);
bool period_measured(void);

#endif
