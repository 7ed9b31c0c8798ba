/* Inside the driver: its state, for its own two files. Main only. */
#ifndef ADXL345_DRIVER_H
#define ADXL345_DRIVER_H

#include "adxl345.h"

typedef enum {
    STEP_OFF,
    STEP_PROBE,
    STEP_CONFIGURE,
    STEP_READ_BACK,
    STEP_MEASURE,
    STEP_STREAM,
    STEP_ASK_SOURCE, /* no data in time: does the sensor have some? */
    STEP_QUIET_STANDBY,
    STEP_QUIET_DRAIN,
    STEP_BACK_OFF
} step_t;

/* The sample that is read without INT1, because the sensor says that it is there while the pin is low. */
typedef enum { TIMED_NONE, TIMED_WANTED, TIMED_READ } timed_t;

typedef struct {
    adxl345_config_t config;
    adxl345_counters_t counters;
    uint32_t now_us; /* of the poll or call that runs */
    uint32_t deadline_us;
    uint32_t nominal_us; /* between samples, for the configured rate */
    uint8_t back_off_ms;
    uint8_t step;
    uint8_t row; /* of settings */
    uint8_t address;
    uint8_t device_id;
    uint8_t fault;
    uint8_t seen_good;
    uint8_t marks; /* of the samples taken since adxl345_marks */
    bool issued;   /* the step's register access is on the bus */
    bool first_sample_seen;
    bool stop_wanted; /* after quiescing: stop, not start */
    bool alternate_tried;
    uint8_t timed;  /* timed_t */
    bool was_empty; /* when the sensor was asked last: a sample that is ready now is new */
} adxl345_driver_t;

extern adxl345_driver_t driver;

static inline void saturating_add(uint16_t *counter)
{
    if (*counter != UINT16_MAX) {
        (*counter)++;
    }
}

#endif
