/*
 * Inside the driver: the bus, the two interrupt handlers, and the queue of good samples. Functions are for main unless
 * stated otherwise.
 */
#ifndef ADXL345_BURST_H
#define ADXL345_BURST_H

#include <stddef.h>

#include "adxl345.h"
#include "adxl345_integrity.h"
#include "i2c_bus.h"

/* What a data-ready edge does. */
typedef enum {
    BURST_IGNORE, /* nothing: not streaming */
    BURST_STAMP,  /* store its time; main is using the bus */
    BURST_READ    /* store its time and read the sample at once */
} burst_mode_t;

typedef struct {
    adxl345_sample_t sample;
    bool exact; /* stamped by its own edge; false: interpolated */
    bool stuck; /* see adxl345_integrity_stuck */
} burst_entry_t;

/* Clears everything: queue, stamps, bus state. */
void adxl345_burst_init(void);

void adxl345_burst_set_mode(burst_mode_t mode);

/*
 * Takes over the pins (again). Returns HAL_I2C_FREE, or the line that is low. A running transfer is abandoned, and a
 * slave in the middle of a byte is clocked out of it.
 */
uint8_t adxl345_burst_take_bus(uint8_t address, uint8_t period_025us);

/*
 * Register access outside streaming: false if the bus is not free yet. Poll adxl345_burst_bus_state until it is not
 * busy; the byte read is adxl345_burst_register_value.
 */
bool adxl345_burst_access(uint8_t reg, uint8_t value, bool read);
i2c_bus_state_t adxl345_burst_bus_state(void);
uint8_t adxl345_burst_register_value(void);

/* The byte read equals the value given to the access. */
bool adxl345_burst_register_holds(void);

/*
 * Looks for a sample because INT1 or the clock indicates one; in BURST_READ. Does nothing if bus or queue has no room.
 */
void adxl345_burst_read(void);

/*
 * The verdict on a burst that has ended, by itself or because the bus was taken. Must be called in every pass, or no
 * other burst begins. A good sample goes into the queue; others are dropped.
 */
reading_t adxl345_burst_judge(void);

/* A burst is on the bus, or has not been judged yet. */
bool adxl345_burst_running(void);

/*
 * What is wrong with INT1 (adxl345_fault_t): it was low or flickered when main started the newest burst, and has not
 * risen since. If an edge may have started another one it is only a hint.
 */
uint8_t adxl345_burst_int1(void);

/* Start of the newest burst, and stamp of the newest sample; until the first one, the time to count from. */
uint32_t adxl345_burst_begun_us(void);
uint32_t adxl345_burst_last_us(void);
void adxl345_burst_expect(uint32_t t_us);

/* Consecutive bursts that failed on the bus; 0 after one that did not. */
uint8_t adxl345_burst_failures(void);

/* How the newest of them ended; another burst may already be on the bus. */
i2c_bus_state_t adxl345_burst_failed_state(void);

/* No slot is free: samples wait in the sensor until main takes one. */
bool adxl345_burst_queue_full(void);

/* Takes the oldest entry out; it is valid until the next burst is judged. The queue must not be empty. */
const burst_entry_t *adxl345_burst_take(void);

#endif
