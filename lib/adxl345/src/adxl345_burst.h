/*
 * Inside the driver: the bus, the two interrupt handlers, and the queue of samples that were found good.
 * Functions are for main unless they say otherwise.
 */
#ifndef ADXL345_BURST_H
#define ADXL345_BURST_H

#include <stddef.h>

#include "adxl345.h"
#include "adxl345_integrity.h"
#include "i2c_bus.h"

/* What an edge of data-ready does. */
typedef enum {
    BURST_IGNORE, /* nothing: not streaming */
    BURST_STAMP,  /* keep its time; main is using the bus */
    BURST_READ    /* keep its time and read the sample at once */
} burst_mode_t;

typedef struct {
    adxl345_sample_t sample;
    bool exact; /* stamped by its own edge; false: interpolated */
    bool stuck; /* as adxl345_integrity_stuck */
} burst_entry_t;

/* Forget everything: queue, stamps, bus state. */
void adxl345_burst_init(void);

void adxl345_burst_set_mode(burst_mode_t mode);

/*
 * Take the pins (again): HAL_I2C_FREE, or the line that is low. A transfer that runs is abandoned, a slave in its byte
 * clocked out of it.
 */
uint8_t adxl345_burst_take_bus(uint8_t address, bool fast);

/*
 * Register access outside streaming: false when the bus is not free yet. Poll adxl345_burst_bus_state until it is not
 * busy; the byte read is adxl345_burst_register_value.
 */
bool adxl345_burst_access(uint8_t reg, uint8_t value, bool read);
i2c_bus_state_t adxl345_burst_bus_state(void);
uint8_t adxl345_burst_register_value(void);

/* The byte read is the value that the access was given. */
bool adxl345_burst_register_holds(void);

/*
 * A sample waits, by INT1 or by the sensor's registers: start reading it if bus and queue are free. is_new: one that
 * was not there a moment ago, else the next in the FIFO. True when a burst was started.
 */
bool adxl345_burst_read(bool is_new);

/*
 * The verdict on a burst that has ended, by itself or because the bus was taken. To be called in every pass, else no
 * other burst begins. A good sample goes into the queue; of others nothing goes out.
 */
reading_t adxl345_burst_judge(void);

/* A burst is on the bus, or has not been judged. */
bool adxl345_burst_running(void);

/* The newest burst met no sample; false again with adxl345_burst_set_mode(BURST_READ). */
bool adxl345_burst_found_empty(void);

/* The newest good reading left samples in the sensor's FIFO. An edge may have begun another since: a hint then. */
bool adxl345_burst_left_more(void);

/* When the newest burst was put on the bus; until the first, the moment by which it is expected (before BURST_READ). */
uint32_t adxl345_burst_begun_us(void);
void adxl345_burst_expect(uint32_t t_us);

/* The same, but an empty burst does not count: the time of the sample before it. */
uint32_t adxl345_burst_met_sample_us(void);

/* Bursts that failed on the bus one after another; 0 after one that did not. */
uint8_t adxl345_burst_failures(void);

/* How the newest of them ended; another burst may be on the bus by now. */
i2c_bus_state_t adxl345_burst_failed_state(void);

/* No slot is free: samples wait in the sensor until main takes one. */
bool adxl345_burst_queue_full(void);

/* Oldest entry out, which stays as it is until the next burst is judged. The queue must not be empty. */
const burst_entry_t *adxl345_burst_take(void);

#endif
