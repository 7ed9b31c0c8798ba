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

/* Looks for a sample, because INT1 or the clock says so; in BURST_READ. Nothing where bus or queue has no room. */
void adxl345_burst_read(void);

/*
 * The verdict on a burst that has ended, by itself or because the bus was taken. To be called in every pass, else no
 * other burst begins. A good sample goes into the queue; of others nothing goes out.
 */
reading_t adxl345_burst_judge(void);

/* A burst is on the bus, or has not been judged. */
bool adxl345_burst_running(void);

/*
 * The newest burst was begun with INT1 low, and it has not risen since. An edge may have begun another one: a hint
 * then.
 */
bool adxl345_burst_by_clock(void);

/* When the newest burst was put on the bus, and the stamp of the newest sample; until the first, when to count from. */
uint32_t adxl345_burst_begun_us(void);
uint32_t adxl345_burst_last_us(void);
void adxl345_burst_expect(uint32_t t_us);

/* Bursts that failed on the bus one after another; 0 after one that did not. */
uint8_t adxl345_burst_failures(void);

/* How the newest of them ended; another burst may be on the bus by now. */
i2c_bus_state_t adxl345_burst_failed_state(void);

/* No slot is free: samples wait in the sensor until main takes one. */
bool adxl345_burst_queue_full(void);

/* Oldest entry out, which stays as it is until the next burst is judged. The queue must not be empty. */
const burst_entry_t *adxl345_burst_take(void);

#endif
