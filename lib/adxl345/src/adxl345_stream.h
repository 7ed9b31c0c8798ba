/*
 * Inside the driver: the step in which samples come. Above adxl345_driver.h, below adxl345.c. Main only.
 */
#ifndef ADXL345_STREAM_H
#define ADXL345_STREAM_H

#include "adxl345_driver.h"

/* The sensor measures from now on: expects its first sample. */
void adxl345_stream_start(adxl345_driver_t *d);

/* STEP_STREAM, once a poll. */
void adxl345_stream_poll(adxl345_driver_t *d);

/* STEP_ASK_SOURCE has INT_SOURCE: reads the sample that waits, waits on, or fails for want of data. */
void adxl345_stream_source_asked(adxl345_driver_t *d);

/* INT1 is known to be silent or stuck high: samples are read by the clock. */
bool adxl345_stream_without_edges(void);

#endif
