/*
 * ADXL345 driver: a state machine that never waits.
 *
 *   stopped -> probe (0x53, then 0x1D) -> configure in standby -> read back -> streaming
 *                ^------------------- fault (named, retried with back-off) <-----'
 *
 * While streaming, the data-ready interrupt stamps the time and starts one burst; the I2C interrupt moves its bytes
 * into a queue; main takes samples out. What a late read left in the sensor's FIFO (stream mode, 32 deep) is drained
 * from main with interpolated stamps. One sensor, one instance: the interrupts share its state.
 *
 * Contexts: every function here is for main. The two handlers are in adxl345_burst.c.
 */
#ifndef ADXL345_H
#define ADXL345_H

#include <stdbool.h>
#include <stdint.h>

#define ADXL345_QUEUE_LENGTH 8u /* power of two; one slot stays free */

typedef struct {
    uint32_t t_us;  /* of data-ready (hal_time_us); interpolated for samples drained from the FIFO */
    int16_t lsb[3]; /* x, y, z; full resolution, 256 LSB/g nominal */
} adxl345_sample_t;

typedef struct {
    uint16_t rate_dhz; /* output data rate in 0.1 Hz: 125, 250, 500, 1000, 2000, 4000, 8000 */
    uint8_t range_g;   /* 2, 4, 8, 16; always full resolution */
    bool self_test;    /* the sensor's electrostatic force acts on all axes: readings are shifted (p. 22) */
    uint8_t address;   /* 7 bits: 0x53 or 0x1D, no other is asked; 0: both */
} adxl345_config_t;

/* What is wrong, in the order in which the driver finds out. Numbers are part of the protocol (docs/protocol.md). */
typedef enum {
    ADXL345_FAULT_NONE = 0,
    ADXL345_FAULT_NO_SENSOR = 1,     /* no ACK at 0x53 nor at 0x1D */
    ADXL345_FAULT_WRONG_ID = 2,      /* somebody answers, but DEVID is not 0xE5 */
    ADXL345_FAULT_BUS = 3,           /* a transfer did not end in time on free lines, bus error, arbitration lost */
    ADXL345_FAULT_READ_BACK = 4,     /* a register does not hold what was written */
    ADXL345_FAULT_INT1_SILENT = 5,   /* data are ready inside the sensor, but INT1 does not rise */
    ADXL345_FAULT_NO_DATA = 6,       /* the sensor answers but measures no more: it has lost power or its registers */
    ADXL345_FAULT_SCL_LOW = 7,       /* somebody holds SCL low */
    ADXL345_FAULT_SDA_LOW = 8,       /* somebody holds SDA low, and 16 clocks have not freed it */
    ADXL345_FAULT_INT1_STUCK = 9,    /* INT1 stays high without data */
    ADXL345_FAULT_STUCK = 10,        /* the same values again and again */
    ADXL345_FAULT_TORN = 11,         /* three readings in a row were none of this sensor */
    ADXL345_FAULT_TWO_SENSORS = 12,  /* an axis jumps between a value and its double: two sensors on one address */
    ADXL345_FAULT_INT1_FLICKERS = 13 /* more edges than samples: nothing drives D2 */
} adxl345_fault_t;

typedef enum {
    ADXL345_STOPPED,
    ADXL345_STARTING, /* probe, configure, read back, first sample awaited */
    ADXL345_STREAMING,
    ADXL345_QUIESCING, /* new configuration asked for: standby, FIFO drained, then STARTING */
    ADXL345_FAULTY     /* waiting for the next try */
} adxl345_phase_t;

/* True for the rates and ranges that the chip and the bus carry (data sheet p. 18: 800 Hz needs 400 kHz). */
bool adxl345_config_valid(const adxl345_config_t *config);

/* Once, before interrupts are on: everything stopped, nothing on the bus yet. */
void adxl345_init(void);

/* Start, or start again with another configuration: samples already latched by the sensor are delivered first. */
void adxl345_start(const adxl345_config_t *config);

/* Standby after the samples that are already latched have been delivered. */
void adxl345_stop(void);

/* Advances the state machine by at most one step. Call after every wake-up; never waits. */
void adxl345_poll(uint32_t now_us);

/*
 * Oldest sample out of the queue; NULL when it is empty. Frees its slot, so a waiting FIFO entry can be read. What is
 * pointed at stays until the next adxl345_poll, _start or _stop.
 */
const adxl345_sample_t *adxl345_take(void);

/* Samples waiting in the queue. */
uint8_t adxl345_queued(void);

/* Time of the oldest sample in the queue; false when it is empty. */
bool adxl345_oldest_us(uint32_t *t_us);

/*
 * One waits in the sensor: INT1 is high, and is believed. Not where the newest read found none and no edge came after
 * it.
 */
bool adxl345_sample_waits(void);

adxl345_phase_t adxl345_phase(void);

/* While ADXL345_STREAMING with a fault samples go on: something is wrong with them, or with how they come. */
adxl345_fault_t adxl345_fault(void);

/* The sensor is looked for and configured again because it failed, though that need not be a fault yet. Main. */
bool adxl345_interrupted(void);

/*
 * The moment by which adxl345_poll must have acted, which main passes to hal_wake_at before it sleeps: a poll later
 * than this means that main is stuck. Past, and of no meaning, while the driver is stopped.
 */
uint32_t adxl345_deadline_us(void);

/* 7-bit address at which an ADXL345 was found last; 0x53 before any was. */
uint8_t adxl345_address(void);

/* The device that ADXL345_FAULT_WRONG_ID is about, as it was when that was found: its address, and its DEVID. */
uint8_t adxl345_foreign_address(void);
uint8_t adxl345_foreign_id(void);

/* Measured time between samples, us (nominal until measured), by the board's clock. */
uint32_t adxl345_period_us(void);

/* The same as output data rate, 0.01 Hz: of 16 samples in a row that were read in time; 0 until there were. Divides. */
uint32_t adxl345_rate_chz(void);

/* Counters, saturating. Each transfer that failed is in one of the last four, whether its sample was lost or not. */
typedef struct {
    uint16_t samples_drained;   /* read late, with an interpolated stamp */
    uint16_t samples_stuck;     /* as ADXL345_MARK_STUCK */
    uint16_t restarts;          /* sensor configured again after a fault */
    uint16_t nacks;             /* address or data not acknowledged */
    uint16_t arbitrations_lost; /* noise, or another master */
    uint16_t bus_errors;        /* START or STOP out of place, or a status that cannot be */
    uint16_t timeouts;          /* did not end, or not begin, in time */
} adxl345_counters_t;
void adxl345_counters(adxl345_counters_t *out);

/* What came over the bus and was no new sample, saturating. None of it went out. */
typedef struct {
    uint16_t failed;   /* torn, shifted, or nobody there */
    uint16_t empty;    /* INT1 was high, but the sensor had no new sample */
    uint16_t overruns; /* readings of a FIFO that had filled up: samples were lost */
} adxl345_readings_t;
void adxl345_readings(adxl345_readings_t *out);

/* One of these counters by its place: first those of adxl345_counters_t, then those of adxl345_readings_t. */
uint16_t adxl345_count(uint8_t at);

/* Since the last call: ADXL345_MARK_*, the bits of the row's flags that the driver knows of (docs/protocol.md). */
enum { ADXL345_MARK_STUCK = 32, ADXL345_MARK_INTEGRITY = 64 };
uint8_t adxl345_marks(void);

#endif
