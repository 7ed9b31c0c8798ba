/*
 * Inside the driver: its state, and what its steps share. Above stand adxl345_stream.c, which takes samples of the
 * sensor, then adxl345.c, which finds and configures it, and adxl345_report.c. Nothing here calls upwards. Main only.
 */
#ifndef ADXL345_DRIVER_H
#define ADXL345_DRIVER_H

#include "adxl345.h"
#include "adxl345_table.h"
#include "i2c_bus.h"
#include "machine.h"

/* Limits of time in half milliseconds: a byte holds them. A register access takes under 0.2 ms, a burst under 0.4. */
#define LIMIT_US 500u
enum { RETURN_LIMIT = 2, TRANSFER_LIMIT = 6, BACK_OFF_MIN = 10, BACK_OFF_MAX = 50, DRAIN_LIMIT = 200 };

/* Failed transfers of one kind that are a fault: a single one may be noise. */
enum { TRIES = 3 };

/*
 * A step has the phase that it belongs to in its upper three bits. One that accesses a register has the row of the
 * table in its lower four, and above them whether the register is read.
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
    STEP_STANDBY = STEP_PHASE(ADXL345_QUIESCING) | TABLE_STANDBY, /* a stop while no samples come */
    STEP_QUIET_DRAIN,
    STEP_BACK_OFF = STEP_PHASE(ADXL345_FAULTY)
} step_t;

typedef struct {
    adxl345_config_t config;
    uint32_t now_us; /* of the poll or call that runs */
    uint32_t deadline_us;
    uint16_t half_us;        /* half the nominal time between samples, for the configured rate */
    uint16_t patience_2us;   /* after a sample the edge of the next is overdue */
    uint8_t back_off;        /* limit */
    uint8_t step;            /* step_t */
    uint8_t address;         /* that is asked now */
    uint8_t known;           /* the address at which the sensor was found last */
    uint8_t foreign_address; /* of the device that ADXL345_FAULT_WRONG_ID is about, and what it reads as DEVID */
    uint8_t foreign_id;
    uint8_t fault;
    bool issued; /* the step's register access is on the bus */
    bool first_sample_seen;
    bool stop_wanted; /* after quiescing: stop, not start */
    uint8_t found;    /* at the first of both addresses: the fault that it would be; NONE: none asked yet */
    uint8_t rests;    /* attempts left to put a sensor to rest that a stop has not reached */
    uint8_t tries;    /* of the step's register access that failed */
    bool renewed;     /* a configuration was asked for that the sensor has not been looked for with */
    bool after_fault; /* since the sensor was configured last */
} adxl345_driver_t;

/* The one there is. */
adxl345_driver_t *adxl345_driver_state(void);

/* What touches much of the driver finds it through a pointer, what touches little at its fixed address. */
static inline adxl345_driver_t *adxl345_driver_here(void)
{
    adxl345_driver_t *d = adxl345_driver_state();
    MACHINE_POINTER(d);
    return d;
}

/* Bursts bring samples. */
static inline bool adxl345_driver_streams(void)
{
    return adxl345_driver_state()->step == STEP_STREAM;
}

/* The step that runs from now on, with a deadline after this limit; main passes again at once. */
void adxl345_driver_enter(step_t step, uint8_t limit);

/* Another deadline for the step that runs, counted from the poll's time. */
void adxl345_driver_set_limit(uint8_t limit);

/* The poll's time is t_us or later; that of the step's deadline. */
bool adxl345_driver_reached(uint32_t t_us);
bool adxl345_driver_deadline_passed(void);

/* Ends the step with a fault: backs off before the sensor is looked for again, or stops when that is asked for. */
void adxl345_driver_fail(adxl345_fault_t fault);

/* Nothing runs and no fault is reported: one that was there is not mended, but it is not asked for any more. */
void adxl345_driver_stopped(void);

/* Enters a step with one register access, on a bus of its own, of which no data come. */
void adxl345_driver_begin_access(step_t step);

/* Frees the bus of a transfer that hangs; false when somebody holds a line low: that is a fault then, and reported. */
bool adxl345_driver_take_bus(void);

/*
 * A transfer failed, or did not end or even begin in time: counted, and the bus freed where it hangs. False when
 * somebody holds a line low.
 */
bool adxl345_driver_transfer_failed(i2c_bus_state_t state);

/* Three transfers in a row failed: names the fault, or looks for a sensor that does not answer. */
void adxl345_driver_give_up(adxl345_driver_t *d, i2c_bus_state_t state);

/*
 * No sensor at this address. That is a fault when the other one, if it may be asked, has none either: by the name of
 * the device that did answer if there is one.
 */
void adxl345_driver_not_here(adxl345_driver_t *d, adxl345_fault_t fault);

/* Looks for the sensor at once, at the address that it had, then at the other one. */
void adxl345_driver_probe(void);

#endif
