/*
 * Inside the driver: its state, and what its steps share. One level up are adxl345_stream.c, which receives samples,
 * then adxl345.c, which finds and configures the sensor, and adxl345_report.c. Nothing here calls upwards. Main only.
 */
#ifndef ADXL345_DRIVER_H
#define ADXL345_DRIVER_H

#include "adxl345.h"
#include "adxl345_table.h"
#include "i2c_bus.h"
#include "machine.h"

/* Time limits in half milliseconds, to fit a byte. At 100 kHz a register access takes 0.4 ms, a burst 1.2. */
#define LIMIT_US 500u
enum { RETURN_LIMIT = 2, TRANSFER_LIMIT = 6, BACK_OFF_MIN = 10, BACK_OFF_MAX = 50, DRAIN_LIMIT = 200 };

/* Faults of a garbled bus before SCL changes: 0.35 s of failed probes. A power of two, as the one above it. */
enum { GARBLED_SLOW = 16, GARBLED_ASKED = 32 };

/* The fastest rate that the sensor takes at 100 kHz (p. 18). */
#define SLOW_MAX_DHZ 2000u

/* Failed transfers of one kind that make a fault: a single one may be noise. */
enum { TRIES = 3 };

/*
 * A step has its phase in the upper three bits. If it accesses a register, the lower four bits are the row of the
 * table, and the bit above them says whether the register is read.
 */
#define STEP_PHASE(phase) ((phase) << 5)
enum { STEP_READS = 0x10, STEP_ROW = 0x0F };
typedef enum {
    STEP_OFF = STEP_PHASE(ADXL345_STOPPED),
    STEP_REST_LATER, /* stopped, but the sensor was not reached */
    STEP_PROBE = STEP_PHASE(ADXL345_STARTING) + STEP_READS + TABLE_DEVID,
    STEP_CONFIGURE = STEP_PHASE(ADXL345_STARTING) | TABLE_WRITTEN, /* and those after it up to STEP_MEASURE, */
    STEP_READ_BACK = STEP_PHASE(ADXL345_STARTING) | STEP_READS | TABLE_READ_BACK, /* here too */
    STEP_MEASURE = STEP_PHASE(ADXL345_STARTING) | TABLE_MEASURE,
    STEP_STREAM = STEP_PHASE(ADXL345_STREAMING),
    STEP_QUIET_STANDBY = STEP_PHASE(ADXL345_QUIESCING) | TABLE_WRITTEN,
    STEP_STANDBY = STEP_PHASE(ADXL345_QUIESCING) | TABLE_STANDBY, /* a stop while no samples arrive */
    STEP_QUIET_DRAIN,
    STEP_BACK_OFF = STEP_PHASE(ADXL345_FAULTY)
} step_t;

typedef struct {
    adxl345_config_t config;
    uint32_t now_us; /* time of the current poll or call */
    uint32_t deadline_us;
    uint16_t half_us;        /* half the nominal time between samples, for the configured rate */
    uint8_t back_off;        /* limit */
    uint8_t step;            /* step_t */
    uint8_t address;         /* address being probed */
    uint8_t known;           /* address at which the sensor was found last */
    uint8_t foreign_address; /* device that ADXL345_FAULT_WRONG_ID refers to, and what it returned as DEVID */
    uint8_t foreign_id;
    uint8_t fault;
    bool issued; /* the step's register access is on the bus */
    bool first_sample_seen;
    bool stop_wanted; /* after quiescing: stop, not start */
    uint8_t found;    /* the fault found at the first of both addresses; NONE: none probed yet */
    uint8_t rests;    /* attempts left to put into standby a sensor that a stop did not reach */
    uint8_t tries;    /* failed attempts of the step's register access */
    bool renewed;     /* a configuration was requested and the sensor has not been probed with it yet */
    bool after_fault; /* a fault occurred since the sensor was last configured */
    uint8_t garbled;  /* faults that a slower SCL may cure, of 32; from GARBLED_ASKED on the speed that was asked for */
} adxl345_driver_t;

/* The only instance. */
adxl345_driver_t *adxl345_driver_state(void);

/* Functions with many accesses use the driver through a pointer, those with few at its fixed address. */
static inline adxl345_driver_t *adxl345_driver_here(void)
{
    adxl345_driver_t *d = adxl345_driver_state();
    MACHINE_POINTER(d);
    return d;
}

/* Bursts are bringing samples. */
static inline bool adxl345_driver_streams(void)
{
    return adxl345_driver_state()->step == STEP_STREAM;
}

/* Enters a step, with a deadline after this limit; main makes another pass at once. */
void adxl345_driver_enter(step_t step, uint8_t limit);

/* Sets another deadline for the current step, counted from the time of the poll. */
void adxl345_driver_set_limit(uint8_t limit);

/* The time of the poll is t_us or later; the same for the deadline of the step. */
bool adxl345_driver_reached(uint32_t t_us);
bool adxl345_driver_deadline_passed(void);

/* Ends the step with a fault: backs off before the sensor is probed again, or stops if that was requested. */
void adxl345_driver_fail(adxl345_fault_t fault);

/* Nothing runs and no fault is reported: an existing one is not repaired, but it no longer matters. */
void adxl345_driver_stopped(void);

/* Enters a step with one register access, on a bus of its own, that brings no samples. */
void adxl345_driver_begin_access(step_t step);

/* Frees the bus from a hanging transfer; false if a line is held low: then reported as a fault. */
bool adxl345_driver_take_bus(void);

/*
 * A transfer failed, or did not begin or end in time: counts it, and frees the bus if it hangs. False if a line is held
 * low.
 */
bool adxl345_driver_transfer_failed(i2c_bus_state_t state);

/* Three transfers in a row failed: reports the fault, or probes for a sensor that does not answer. */
void adxl345_driver_give_up(adxl345_driver_t *d, i2c_bus_state_t state);

/*
 * No sensor at this address. It is a fault if the other address, when it may be probed, has none either. If a device
 * did answer, the fault names that.
 */
void adxl345_driver_not_here(adxl345_driver_t *d, adxl345_fault_t fault);

/* Probes for the sensor at once, at its last address, then at the other one. */
void adxl345_driver_probe(void);

#endif
