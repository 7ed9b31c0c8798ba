/* Inside the driver: the step that receives samples. Above adxl345_driver.h, below adxl345.c. Main only. */
#ifndef ADXL345_STREAM_H
#define ADXL345_STREAM_H

#include "adxl345_driver.h"
#include "adxl345_integrity.h"

/* The sensor has started to measure: expects its first sample. */
void adxl345_stream_start(adxl345_driver_t *d);

/* STEP_STREAM, once per poll, with the verdict on the burst that ended since the last. */
void adxl345_stream_poll(adxl345_driver_t *d, reading_t reading);

#endif
